#pragma once

#include "scan_image_slam/core/baseline/hole_map.h"
#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/sensor/stamp.h"

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// The algorithm that the paper compares itself with, after Steux and El Hamzaoui: tinySLAM, a SLAM
/// algorithm in less than 200 lines C-language program (ICARCV 2010). A baseline for evaluation,
/// not a part of the SLAM. The defaults are those of the original, which draws every scan.
struct CoreSlamOptions {
  double cell_size = 0.01;      ///< [m]
  double hole_width = 0.6;      ///< of the V around an obstacle [m]
  int quality = 50;             ///< weight of a new ray, out of 256
  double sigma_distance = 0.1;  ///< of the first tries around the odometry's pose [m]
  double sigma_angle = 0.349;   ///< 20 degrees [rad]
  int max_failures = 1000;      ///< tries in a row without improvement that end the search
  double min_range = 0.3;       ///< nearer hits are not used [m]
  int rays_per_beam = 3;        ///< drawn side by side, so that beams leave no gaps
  double update_period = 0.0;   ///< least time between two scans drawn into the map [s]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// Hits of one scan in the base frame.
struct CoreSlamScan {
  Stamp stamp = 0;
  Eigen::Vector2d origin{0, 0};       ///< of the rays [m]
  double beam_spacing = 0.0;          ///< [rad]
  std::vector<Eigen::Vector2d> hits;  ///< corrected for the motion during the sweep [m]
};

/// The laser's part of a model, all of it.
CoreSlamScan ToCoreSlamScan(const FusedModel& model, double min_range);

class CoreSlam {
 public:
  /// `normal` draws the random numbers of the search, of mean 0 and standard deviation 1.
  CoreSlam(const CoreSlamOptions& options, std::function<double()> normal);

  /// Localises the scan and draws it into the map. `odom_from_base` is the odometry's pose at the
  /// same time, if it is known. The map's frame begins at the first scan's base.
  Pose2 Add(const CoreSlamScan& scan, const std::optional<Pose2>& odom_from_base);

  const HoleMap& map() const { return map_; }
  int tries() const { return tries_; }  ///< of the last search

  /// Mean value of the map under the hits of a scan: the lower, the better they fit.
  double Distance(const CoreSlamScan& scan, const Pose2& map_from_base) const;

 private:
  Pose2 Search(const CoreSlamScan& scan, const Pose2& start);
  void Draw(const CoreSlamScan& scan, const Pose2& map_from_base);

  CoreSlamOptions options_;
  HoleMap map_;
  std::function<double()> normal_;
  Pose2 map_from_base_;
  std::optional<Pose2> last_odom_from_base_;
  std::optional<Stamp> drawn_stamp_;
  int tries_ = 0;
};

}  // namespace scan_image_slam
