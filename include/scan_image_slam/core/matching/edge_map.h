#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/geometry/pose2.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

struct EdgeMapOptions {
  double gate = 0.1;             ///< farthest edge from its landmark, across the line of sight [m]
  double min_separation = 0.15;  ///< between two edges of one sign that can be told apart [m]
  double min_weight = 0.2;       ///< see ModelEdge [-]
  double max_range = 15.0;       ///< farther edges are not used [m]
  double surface_stddev = 0.03;  ///< how far an edge may lie off the laser's surface [m]
  /// Throws std::invalid_argument, naming the field, if a value is not positive and finite.
  void Validate() const;
};

/// A vertical edge in the map.
struct EdgeLandmark {
  Eigen::Vector2d position{0, 0};                            ///< [m]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< [m^2]
  int sign = 0;                                              ///< see ModelEdge
  int hits = 0;                                              ///< images that showed it
};

/// The edges of a model that can be told from their neighbours: within reach, and with no other of
/// their sign nearby that is about as strong (books on a shelf are mistaken for one another).
std::vector<ModelEdge> DistinctEdges(const std::vector<ModelEdge>& edges,
                                     const EdgeMapOptions& options);

/// The vertical edges seen so far. An edge is matched with the nearest landmark of its own sign.
class EdgeMap {
 public:
  explicit EdgeMap(const EdgeMapOptions& options);

  /// The landmark that an edge, placed by a pose of the base, belongs to; null if there is none.
  const EdgeLandmark* Find(const ModelEdge& edge, const RigidTransform2& map_from_base) const;

  /// Refines the landmarks of a model's edges and starts new ones. `covariance` is that of the
  /// pose, of (forward, left, turn) in the base frame.
  void Insert(const std::vector<ModelEdge>& edges, const Pose2& map_from_base,
              const Eigen::Matrix3d& covariance);

  const std::vector<EdgeLandmark>& landmarks() const { return landmarks_; }

 private:
  /// The landmark of a sign nearest to a place, at most `reach` away; -1 if there is none.
  int NearestId(const Eigen::Vector2d& place, int sign, double reach) const;

  EdgeMapOptions options_;
  std::vector<EdgeLandmark> landmarks_;
};

}  // namespace scan_image_slam
