#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/matching/edge_map.h"
#include "scan_image_slam/core/matching/edge_match.h"
#include "scan_image_slam/core/matching/motion_predictor.h"
#include "scan_image_slam/core/matching/newcomers.h"

#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

struct PoseFilterOptions {
  /// From image to image an edge is off by less than from visit to visit.
  EdgeMapOptions edges = {/*gate=*/0.05};
  double max_new_slant = 17.0;    ///< of an edge to begin with: wall per angle of the view [m/rad]
  double edge_correlation = 4.0;  ///< see RefinementOptions [-]
  double edge_bias = 0.5;         ///< part of an edge's deviation that lasts while it is seen [-]
  double scale_stddev = 0.03;     ///< of the encoders' distance: wheels worn or soft [-]
  double camera_yaw_stddev = 0.6 * M_PI / 180.0;  ///< of the camera's yaw to the laser [rad]
  double keep_distance = 2.0;  ///< driven since an edge was seen, until it is forgotten [m]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// What is learned of the sensors while driving.
struct LearnedCalibration {
  double encoder_scale = 1.0;      ///< true way by that of the encoders [-]
  double camera_yaw = 0.0;         ///< to be added to that of the mount, positive left [rad]
  double camera_yaw_stddev = 0.0;  ///< [rad]
};

/// Puts together what encoders, laser and camera tell of the pose: an extended Kalman filter of the
/// pose, the scale of the encoders' distance, the camera's yaw and the vertical edges in view
/// (Smith, Self and Cheeseman 1990). The edges are in it because their places are as wrong as the
/// poses that they were seen from: taken for known, they would pull those that come.
class PoseFilter {
 public:
  explicit PoseFilter(const PoseFilterOptions& options);
  /// From the next edge on; the state stays.
  void SetOptions(const PoseFilterOptions& options) { options_ = options; }

  /// At a pose that is exact by definition; all else is forgotten.
  void Start(const Pose2& map_from_base);

  /// Moves the base from `map_from_last`. `covariance` is that of the motion, of (forward, left,
  /// turn) in the frame of the base [m, m, rad].
  void Predict(const Pose2& map_from_last, const MotionPrediction& prediction,
               const Eigen::Matrix3d& covariance);

  /// Walls come into view that tell of a direction of which nothing has told. They enter the map at
  /// the pose of now and are off as it is: from here on the way in the least known direction is
  /// measured from this place, and how far it may be off is kept apart.
  void Anchor();

  /// Takes what a scan tells: `information` of the pose, of (forward, left, turn) in the frame of
  /// `map_from_base`, and the gradient of its cost there. Directions without information count for
  /// nothing.
  void AddScan(const Pose2& map_from_base, const Eigen::Matrix3d& information,
               const Eigen::Vector3d& gradient);

  /// True if most of the edges that are known are not where they should be, though near: the
  /// prediction is wrong by more than it says, if by no more than `slip` [m].
  bool Contradicts(const std::vector<ModelEdge>& edges, double slip) const;

  /// Takes what an image tells, and begins edges that were near enough in an image before. Returns
  /// what became of each. Known ones are looked for within the gate; if most contradict the
  /// prediction, wheels have slipped, by at most `farthest_slip` [m], and within as much more.
  std::vector<EdgeMatch> AddEdges(const std::vector<ModelEdge>& edges, double farthest_slip = 0.0);

  const Pose2& map_from_base() const { return map_from_base_; }
  /// Of (forward, left, turn) in the frame of the base [m, m, rad].
  Eigen::Matrix3d PoseCovariance() const;
  /// The same, but relative to the anchor, and so to the walls around.
  Eigen::Matrix3d CovarianceFromAnchor() const;
  LearnedCalibration learned() const;
  int edges() const { return static_cast<int>(tracks_.size()); }  ///< in view

 private:
  double scale() const { return state_[kScale]; }
  double camera_yaw() const { return state_[kYaw]; }
  /// Of the view in the last image [rad].
  double view_yaw() const { return state_[kYaw] + state_[kImageTurn]; }

  // The state: the pose's error (x, y, turn in the map), the scale, the yaw, the turn of the last
  // image, x and y of each edge. The pose itself is kept apart, so its three entries are always
  // zero.
  static constexpr int kScale = 3;
  static constexpr int kYaw = 4;
  static constexpr int kImageTurn = 5;
  static constexpr int kFirstEdge = 6;

  struct Track {
    int sign = 0;
    double last_seen = 0.0;       // way
    double bearing_stddev = 0.0;  // smoothed [rad]
    double shift_variance = 0.0;  // of the place where it seems to be, along its surface [m^2]
  };
  /// What an edge should be, and how it depends on the state.
  struct Sight {
    double innovation = 0.0;   // [rad]
    double variance = 0.0;     // of the measurement [rad^2]
    Eigen::VectorXd jacobian;  // of the bearing by the state
  };

  int IndexOf(int track) const { return kFirstEdge + 2 * track; }
  Eigen::Vector2d LeastKnownDirection() const;  ///< of the position, in the map
  Eigen::Vector2d PlaceOf(int track) const { return state_.segment<2>(IndexOf(track)); }
  Eigen::Vector2d PlaceOf(const ModelEdge& edge) const;
  int Nearest(const ModelEdge& edge, double reach) const;
  Sight SightOf(const ModelEdge& edge, int track) const;
  double VarianceOf(const Sight& sight) const;
  void Update(double innovation, double variance, const Eigen::VectorXd& jacobian);
  void DoubtWay(double stddev);
  void BeginImage(double time_offset);
  void Welcome(const std::vector<const ModelEdge*>& unknown);
  void Begin(const ModelEdge& edge);
  void LetShift(const ModelEdge& edge, int id);
  double ShiftVariance(double bearing_stddev, const Eigen::Vector2d& along) const;
  void ForgetOld();

  PoseFilterOptions options_;
  Pose2 map_from_base_;
  Eigen::VectorXd state_;
  Eigen::MatrixXd covariance_;
  Eigen::Matrix2d anchor_covariance_ = Eigen::Matrix2d::Zero();  // of its place in the map [m^2]
  std::vector<Track> tracks_;
  Newcomers newcomers_;
  double way_ = 0.0;
};

}  // namespace scan_image_slam
