#include "scan_image_slam/core/mapping/mapper.h"

#include "scan_image_slam/core/geometry/covariance.h"
#include "scan_image_slam/core/mapping/grid_scan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Eigenvalues>

namespace scan_image_slam {
namespace {

/// Stands for what was driven while the matching could not follow: so far may the pose have drifted
/// [m].
constexpr double kUnknownWay = 30.0;

/// So many scans in a row may fail, as when somebody walks by: the matching finds its way back in
/// the surroundings that it knows.
constexpr int kBriefGap = 5;

bool IsReliable(MatchStatus status) {
  return status != MatchStatus::kOnWindowEdge && status != MatchStatus::kTooFewPoints;
}

/// Of a motion that the matching could not follow: metres and tens of degrees.
Eigen::Matrix3d UnjoinedCovariance() {
  constexpr double kDistance = 1.0;  // [m]
  constexpr double kAngle = 0.3;     // [rad]
  return DiagonalCovariance(kDistance, kAngle);
}

/// What a covariance has grown by over a motion, as far as it has.
Eigen::Matrix3d Growth(const Eigen::Matrix3d& before, const Eigen::Matrix3d& after,
                       const Pose2& motion) {
  const Eigen::Matrix3d difference = after - TransportCovariance(before, motion);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(difference);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

}  // namespace

void MapperOptions::Validate() const {
  grid.Validate();
  const auto require = [](double value, const char* name) {
    if (!(std::isfinite(value) && value >= 0.0)) {
      throw std::invalid_argument(std::string(name) + " must be finite and not negative");
    }
  };
  require(map_update_distance_thresh, "map_update_distance_thresh");
  require(map_update_angle_thresh, "map_update_angle_thresh");
  require(map_update_time_thresh, "map_update_time_thresh");
  if (max_scans_per_place < 1) throw std::invalid_argument("max_scans_per_place must be positive");
}

Mapper::Mapper(const MapperOptions& options)
    : options_(options), drawn_(options.grid, options.max_scans_per_place) {
  options_.Validate();
}

void Mapper::SetOptions(const MapperOptions& options) {
  options.Validate();
  options_ = options;
  drawn_.SetOptions(options.grid, options.max_scans_per_place);
}

void Mapper::BeginChain(const MatchedMotion& match) {
  if (start_stamp_ && match.start_stamp < last_.stamp) TimeWentBack();
  Pose2 map_from_base;
  if (!has_pose_) {
    if (match.odom_from_base) map_from_base = *match.odom_from_base;
  } else if (last_.map_from_odom && match.odom_from_base) {
    map_from_base = *last_.map_from_odom * *match.odom_from_base;
  } else {
    map_from_base = last_.map_from_base;
  }
  start_stamp_ = match.start_stamp;
  map_from_start_ = map_from_base * match.start_from_base().Inverse();
  // Another process has followed this chain up to a moment ago: no need to search.
  if (lost_ && match.start_stamp == loaded_chain_.start_stamp &&
      match.stamp > loaded_chain_.stamp) {
    map_from_start_ = loaded_chain_.map_from_start;
    lost_ = false;
    joined_ = false;
  }
  start_covariance_ =
      TransportCovariance(last_.covariance, last_.map_from_base.Inverse() * map_from_start_);
}

MapPose Mapper::AddMatch(const MatchedMotion& match) {
  if (!start_stamp_ || match.start_stamp != *start_stamp_) BeginChain(match);
  last_.stamp = match.stamp;
  last_.lost = lost_;
  last_.map_from_base = map_from_start_ * match.start_from_base();
  last_.covariance =
      TransportCovariance(start_covariance_, match.start_from_base()) + match.covariance;
  last_.map_from_odom.reset();
  if (match.odom_from_base) {
    last_.map_from_odom = last_.map_from_base * match.odom_from_base->Inverse();
  }
  has_pose_ = true;
  failed_ = IsReliable(match.status) ? 0 : failed_ + 1;
  if (failed_ > kBriefGap) joined_ = false;
  if (!lost_) Track(last_);
  return last_;
}

void Mapper::Track(const MapPose& pose) {
  constexpr double kLeastSpacing = 0.05;  // of a trajectory that is thinned [m]
  if (!tracked_.empty()) {
    const Pose2 tracked = MapFromBase(tracked_.back().pose, keyframe_poses_);
    const double moved = (pose.map_from_base.translation() - tracked.translation()).norm();
    if (moved < tracked_spacing_) return;
  }
  if (static_cast<int>(tracked_.size()) >= options_.max_trajectory_poses) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < tracked_.size(); i += 2) tracked_[kept++] = tracked_[i];
    tracked_.resize(kept);
    tracked_spacing_ = std::max(kLeastSpacing, 2.0 * tracked_spacing_);
  }
  tracked_.push_back({pose.stamp, Attach(pose.map_from_base)});
}

bool Mapper::WorthDrawing(const MatchedMotion& match, const Pose2& map_from_base) const {
  if (!IsReliable(match.status)) return false;
  if (!drawn_stamp_) return true;
  const Pose2 moved = map_from_drawn_.Inverse() * map_from_base;
  return moved.translation().norm() >= options_.map_update_distance_thresh ||
         std::abs(moved.theta) >= options_.map_update_angle_thresh ||
         Seconds(match.stamp - *drawn_stamp_) >= options_.map_update_time_thresh;
}

bool Mapper::WorthKeeping(const MatchedMotion& match) const {
  if (!IsReliable(match.status)) return false;
  if (keyframe_poses_.empty() || match.start_stamp != kept_start_stamp_) return true;
  return IsFar(Attach(map_from_start_ * match.start_from_base()).keyframe_from_base);
}

/// Also where the robot stands, and where the matching is at a loss: it may have been carried away.
bool Mapper::WorthLooking(const MatchedMotion& match) const {
  constexpr double kPeriod = 1.0;  // [s]
  if (!looked_stamp_ || match.start_stamp != looked_start_stamp_) return true;
  if (Seconds(match.stamp - *looked_stamp_) >= kPeriod) return true;
  return IsReliable(match.status) &&
         (!joined_ || IsFar(start_from_looked_.Inverse() * match.start_from_base()));
}

bool Mapper::IsFar(const Pose2& motion) const {
  return motion.translation().norm() >= options_.keyframe_distance ||
         std::abs(motion.theta) >= options_.keyframe_angle;
}

std::shared_ptr<const Keyframe> Mapper::Keep(const FusedModel& model, const MatchedMotion& match) {
  auto keyframe = std::make_shared<Keyframe>(MakeKeyframe(model, match, options_.keyframe));
  const Pose2 map_from_base = map_from_start_ * match.start_from_base();
  keyframe->previous_from_base = Attach(map_from_base).keyframe_from_base;
  keyframe->id = NextKeyframe();
  keyframe->joined = joined_ && match.start_stamp == kept_start_stamp_;
  if (keyframe->id > 0) {
    way_ += keyframe->joined ? keyframe->previous_from_base.translation().norm() : kUnknownWay;
  }
  keyframe->way = way_;
  keyframe->covariance =
      DiagonalCovariance(options_.keyframe_distance_stddev, options_.keyframe_angle_stddev);
  if (keyframe->joined) {
    keyframe->covariance +=
        Growth(kept_covariance_, match.covariance, keyframe->previous_from_base);
  } else {
    keyframe->covariance = UnjoinedCovariance();
  }
  joined_ = true;
  kept_start_stamp_ = match.start_stamp;
  kept_covariance_ = match.covariance;
  keyframe_poses_[keyframe->id] = map_from_base;
  return keyframe;
}

std::shared_ptr<const Keyframe> Mapper::AddModel(const FusedModel& model,
                                                 const MatchedMotion& match) {
  if (!growing()) return nullptr;
  // It may have been under way for longer than its chain has lasted.
  if (!start_stamp_ || match.start_stamp != *start_stamp_) return nullptr;
  const Pose2 map_from_base = map_from_start_ * match.start_from_base();
  const bool keep = WorthKeeping(match);
  if (WorthDrawing(match, map_from_base)) {
    // First, as it throws if the map is as large as it may be.
    drawn_.Add({std::make_shared<const GridScan>(
                    MakeGridScan(model, match.sweep_correction, options_.grid)),
                keep ? AttachedPose{NextKeyframe(), Pose2()} : Attach(map_from_base),
                map_from_base});
    drawn_stamp_ = match.stamp;
    map_from_drawn_ = map_from_base;
  }
  return keep ? Keep(model, match) : nullptr;
}

std::optional<Sighting> Mapper::Look(const FusedModel& model, const MatchedMotion& match) {
  if (growing() || !WorthLooking(match)) return std::nullopt;
  Sighting sighting;
  sighting.start_stamp = match.start_stamp;
  sighting.start_from_base = match.start_from_base();
  if (!lost_) sighting.map_from_base = map_from_start_ * sighting.start_from_base;
  Keyframe& keyframe = sighting.keyframe;
  keyframe = MakeKeyframe(model, match, options_.keyframe);
  keyframe.joined = joined_ && looked_stamp_ && match.start_stamp == looked_start_stamp_;
  if (keyframe.joined) {
    keyframe.previous_from_base = start_from_looked_.Inverse() * sighting.start_from_base;
    looked_way_ += keyframe.previous_from_base.translation().norm();
  }
  keyframe.way = looked_way_;
  joined_ = true;
  looked_stamp_ = match.stamp;
  looked_start_stamp_ = match.start_stamp;
  start_from_looked_ = sighting.start_from_base;
  return sighting;
}

AttachedPose Mapper::Attach(const Pose2& map_from_base) const {
  if (keyframe_poses_.empty()) return {-1, map_from_base};
  const auto& [id, map_from_keyframe] = *keyframe_poses_.rbegin();
  return {id, map_from_keyframe.Inverse() * map_from_base};
}

int Mapper::NextKeyframe() const {
  return keyframe_poses_.empty() ? 0 : keyframe_poses_.rbegin()->first + 1;
}

void Mapper::Correct(GraphPoses keyframe_poses, const Anchors& let_go) {
  if (keyframe_poses.empty() || keyframe_poses.rbegin()->first >= NextKeyframe()) return;
  const auto [last, map_from_last] = *keyframe_poses.rbegin();
  const Pose2 moved = map_from_last * keyframe_poses_.at(last).Inverse();
  for (auto later = keyframe_poses_.upper_bound(last); later != keyframe_poses_.end(); ++later) {
    keyframe_poses.emplace_hint(keyframe_poses.end(), later->first, moved * later->second);
  }
  keyframe_poses_ = std::move(keyframe_poses);
  if (!let_go.empty()) {
    for (TrackedPose& tracked : tracked_) tracked.pose = Reattached(tracked.pose, let_go);
    drawn_.Reattach(let_go);
  }
  if (growing()) {
    MoveRobot(moved);
    map_from_drawn_ = moved * map_from_drawn_;
  }
  drawn_.BeginRedraw();
}

void Mapper::MoveRobot(const Pose2& new_from_old) {
  map_from_start_ = new_from_old * map_from_start_;
  last_.map_from_base = new_from_old * last_.map_from_base;
  if (last_.map_from_odom) last_.map_from_odom = new_from_old * *last_.map_from_odom;
}

std::vector<MapPose> Mapper::Trajectory() const {
  std::vector<MapPose> poses;
  poses.reserve(tracked_.size());
  for (const TrackedPose& tracked : tracked_) {
    MapPose pose;
    pose.stamp = tracked.stamp;
    pose.map_from_base = MapFromBase(tracked.pose, keyframe_poses_);
    poses.push_back(pose);
  }
  return poses;
}

MapState Mapper::State() const {
  MapState state;
  state.drawn = drawn_.scans();
  state.chain = loaded_chain_;
  if (growing() && start_stamp_) state.chain = {*start_stamp_, last_.stamp, map_from_start_};
  return state;
}

void Mapper::Load(const MapState& state, MapUse use) {
  if (use == MapUse::kLocalize && state.graph.keyframes.empty()) {
    throw std::invalid_argument("the state holds no map to localise in");
  }
  Mapper loaded(options_);  // the map in use stays if this one is too large
  loaded.keyframe_poses_ = state.graph.poses;
  loaded.loaded_chain_ = state.chain;
  loaded.drawn_.Load(state.drawn);
  loaded.drawn_.Reattach(state.graph.let_go);
  loaded.drawn_.BeginRedraw();  // what the graph knew better when it was saved
  if (!state.graph.keyframes.empty()) loaded.way_ = state.graph.keyframes.rbegin()->second->way;
  loaded.localize_ = use == MapUse::kLocalize;
  loaded.loaded_ = loaded.lost_ = !loaded.keyframe_poses_.empty();
  *this = std::move(loaded);
}

void Mapper::Reset() {
  if (localize_) {
    Forget();
  } else {
    *this = Mapper(options_);
  }
}

/// Leaves the map as it is, and the robot to be found in it.
void Mapper::Forget() {
  lost_ = true;
  start_stamp_.reset();
  looked_stamp_.reset();
  told_stamp_.reset();
  last_ = MapPose();
  has_pose_ = false;
  tracked_.clear();
  tracked_spacing_ = 0.0;
}

void Mapper::TimeWentBack() {
  if (loaded_) {
    Forget();
  } else {
    Reset();
  }
}

void Mapper::ClockWasSet() {
  start_stamp_.reset();  // the next match begins another chain
  drawn_stamp_.reset();
  looked_stamp_.reset();
  told_stamp_.reset();
}

void Mapper::Locate(const Location& location) {
  const bool of_this_chain = start_stamp_ && location.start_stamp == *start_stamp_;
  const bool outdated = told_stamp_ && location.stamp <= *told_stamp_;
  if (growing() || !of_this_chain || outdated) return;
  if (lost_ && location.map_from_start) start_covariance_.setZero();
  lost_ = !location.map_from_start;
  if (lost_) return;
  MoveRobot(*location.map_from_start * map_from_start_.Inverse());
  if (growing()) joined_ = false;  // the first keyframe does not follow the last one of the map
}

void Mapper::SetPose(const Pose2& map_from_base) {
  MoveRobot(map_from_base * last_.map_from_base.Inverse());
  last_.map_from_base = map_from_base;
  has_pose_ = true;
  joined_ = false;
  lost_ = false;
  told_stamp_ = last_.stamp;
}

}  // namespace scan_image_slam
