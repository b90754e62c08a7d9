#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/matching/nearest_field.h"
#include "scan_image_slam/core/matching/surface.h"

#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

struct LocalMapOptions {
  double spacing = 0.05;           ///< of the surface elements along a wall [m]
  double reach = 0.25;             ///< farthest point that still finds an element [m]
  double max_merge_offset = 0.1;   ///< across the wall, of a point that belongs to an element [m]
  double min_normal_cosine = 0.7;  ///< between the normals of a point and its element [-]
  double still_time = 1.0;  ///< seen for so long, longer than a foot rests, an element stands [s]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// A small piece of wall, estimated from all points that have hit it.
struct SurfaceElement {
  Eigen::Vector2f position{0, 0};  ///< [m]
  Eigen::Vector2f normal{0, 0};    ///< unit vector towards the free side
  float information = 0.0f;        ///< about the position along the normal [1/m^2]
  float angle_information = 0.0f;  ///< about the direction of the normal [1/rad^2]
  float last_seen = 0.0f;          ///< way driven when a scan hit it last [m]
  float since = 0.0f;              ///< time since when scans have hit it without a break [s]
  int last_insertion = 0;          ///< the latest scan that hit it
  bool stands = false;             ///< it has been there for a while, unlike what walks by
};

/// What the scans have seen so far, as surface elements: the reference of the matching that does
/// not drift with every frame. Elements stay where they were first seen along the wall and are
/// refined across it; where nothing new is seen, the map does not grow.
class LocalMap {
 public:
  LocalMap(const LocalMapOptions& options, const RangeNoise& noise);

  /// Adds a scan taken at `map_from_base`, after `way` metres and `time` seconds; points without a
  /// normal are left out.
  void Insert(const std::vector<SurfacePoint>& points, const Pose2& map_from_base, double way = 0.0,
              double time = 0.0);

  /// Drops what no scan has hit since `way`.
  void ForgetBefore(double way);

  /// The element nearest to a place in the map [m], or null if none is within reach.
  const SurfaceElement* Nearest(const Eigen::Vector2d& place) const {
    const int id = field_.Nearest(place);
    return id < 0 ? nullptr : &elements_[id];
  }

  /// Distance from a place to the nearest element, which reaches half its spacing to each side; at
  /// most `max_distance` [m].
  double Distance(const Eigen::Vector2d& place, double max_distance) const;

  const std::vector<SurfaceElement>& elements() const { return elements_; }
  void Clear();

 private:
  void Begin(const SurfacePoint& point, double time);
  int ElementOf(const SurfacePoint& point) const;
  void Merge(int id, const SurfacePoint& point);
  void Watch(int id, double time);

  LocalMapOptions options_;
  RangeNoise noise_;
  std::vector<SurfaceElement> elements_;
  NearestField field_;
  int insertion_ = 0;  ///< number of the latest scan
};

}  // namespace scan_image_slam
