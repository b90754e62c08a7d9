#include "scan_image_slam/core/pipeline/slam_pipeline.h"

#include <limits>
#include <utility>

namespace scan_image_slam {
namespace {

/// Half a second of scans at the highest rate of usual lasers.
constexpr std::size_t kMaxWaitingScans = 20;

}  // namespace

SlamPipeline::SlamPipeline(const SlamOptions& options, OnResult on_result, RunStage run)
    : on_result_(std::move(on_result)),
      run_(std::move(run)),
      fusion_(options.fusion),
      bounded_icp_(options.bounded_icp),
      mapper_(options.mapper),
      back_end_(options.loop_closer),
      gate_(options.fusion_node.odometry.max_wait, kMaxWaitingScans,
            options.fusion_node.odometry.source != OdometrySource::kNone) {}

void SlamPipeline::Load(const MapState& state, MapUse use) {
  mapper_.Load(state, use);
  back_end_.Load(state.graph);
}

MapState SlamPipeline::Save() const {
  MapState state = mapper_.State();
  state.graph = back_end_.loop_closer().memory();
  return state;
}

void SlamPipeline::AddOdometry(Stamp stamp, const Pose2& odom_from_base, Stamp now) {
  fusion_.AddOdometry(stamp, odom_from_base);
  bounded_icp_.AddOdometry(stamp, odom_from_base);
  ReleaseScans(now);
}

void SlamPipeline::AddImage(const CameraImage& image, Stamp now) {
  ReleaseScans(now);
  run_(Stage::kFusion, [&] { fusion_.AddImage(image); });
}

void SlamPipeline::AddScan(const LaserScan& scan, Stamp now) {
  // One far ahead of time would make all that follow it stale.
  const bool leaps = time_guard_.Check(scan.stamp, now, false) == TimeGuard::Verdict::kAhead;
  if (leaps || (last_scan_stamp_ && scan.stamp <= *last_scan_stamp_)) {
    ++stale_;
    return;
  }
  last_scan_stamp_ = scan.stamp;
  gate_.Push(scan, scan.stamp, now);
  ReleaseScans(now);
}

void SlamPipeline::Finish() { ReleaseScans(std::numeric_limits<Stamp>::max()); }

void SlamPipeline::ReleaseScans(Stamp now) {
  while (const std::optional<LaserScan> scan = gate_.Pop(now, fusion_.odometry())) Process(*scan);
}

void SlamPipeline::Process(const LaserScan& scan) {
  PipelineResult result;
  std::shared_ptr<const Keyframe> keyframe;
  std::optional<Sighting> sighting;
  run_(Stage::kFusion, [&] { result.model = fusion_.Fuse(scan); });
  run_(Stage::kMatch, [&] { result.match = bounded_icp_.Match(result.model); });
  run_(Stage::kMap, [&] {
    result.pose = mapper_.AddMatch(result.match);
    keyframe = mapper_.AddModel(result.model, result.match);
    sighting = mapper_.Look(result.model, result.match);
  });
  if (keyframe) {
    run_(Stage::kLoop, [&] {
      if (!back_end_.Add(keyframe)) return;
      mapper_.Correct(loop_closer().poses(), loop_closer().let_go());
      back_end_.ForgetLetGo(keyframe->id);
    });
  }
  if (sighting) {
    run_(Stage::kLoop, [&] {
      const bool was_lost = mapper_.lost();
      if (const auto location = back_end_.Look(*sighting)) mapper_.Locate(*location);
      if (mapper_.lost() && !was_lost) bounded_icp_.BeginAnew();  // its surroundings are others
    });
  }
  on_result_(result);
}

}  // namespace scan_image_slam
