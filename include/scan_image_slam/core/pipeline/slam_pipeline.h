#pragma once

#include "scan_image_slam/core/config/slam_parameters.h"
#include "scan_image_slam/core/fusion/scan_image_fusion.h"
#include "scan_image_slam/core/mapping/back_end.h"
#include "scan_image_slam/core/mapping/mapper.h"
#include "scan_image_slam/core/matching/bounded_icp.h"
#include "scan_image_slam/core/sensor/odometry_gate.h"
#include "scan_image_slam/core/sensor/time_guard.h"

#include <functional>
#include <optional>

namespace scan_image_slam {

enum class Stage { kFusion, kMatch, kMap, kLoop };

/// What happens to one scan on its way through the stages.
struct PipelineResult {
  FusedModel model;
  MatchedMotion match;
  MapPose pose;
};

/// The three stages in one process, joined as the nodes are joined by topics.
class SlamPipeline {
 public:
  /// `run` is called with each stage's work and must call it; a tool measures time there.
  using RunStage = std::function<void(Stage, const std::function<void()>&)>;
  using OnResult = std::function<void(const PipelineResult&)>;
  SlamPipeline(const SlamOptions& options, OnResult on_result, RunStage run = RunWithoutMeasuring);

  ScanImageFusion& fusion() { return fusion_; }
  Mapper& mapper() { return mapper_; }
  const BoundedIcp& bounded_icp() const { return bounded_icp_; }
  const LoopCloser& loop_closer() const { return back_end_.loop_closer(); }

  /// Takes up a map that was saved; see Mapper::Load.
  void Load(const MapState& state, MapUse use);
  /// The map as it is now, to be saved.
  MapState Save() const;

  /// Inputs, in the order of their arrival at times `now` [ns].
  void AddOdometry(Stamp stamp, const Pose2& odom_from_base, Stamp now);
  void AddImage(const CameraImage& image, Stamp now);
  void AddScan(const LaserScan& scan, Stamp now);
  /// Lets the scans go that still wait, at the end of the input.
  void Finish();

  /// Scans that were left out: their stamps do not advance, or too many were waiting.
  int dropped() const { return stale_ + gate_.dropped(); }

 private:
  static void RunWithoutMeasuring(Stage, const std::function<void()>& work) { work(); }
  void ReleaseScans(Stamp now);
  void Process(const LaserScan& scan);

  OnResult on_result_;
  RunStage run_;
  ScanImageFusion fusion_;
  BoundedIcp bounded_icp_;
  Mapper mapper_;
  BackEnd back_end_;
  OdometryGate<LaserScan> gate_;
  TimeGuard time_guard_;
  std::optional<Stamp> last_scan_stamp_;
  int stale_ = 0;
};

}  // namespace scan_image_slam
