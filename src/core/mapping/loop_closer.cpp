#include "scan_image_slam/core/mapping/loop_closer.h"

#include "scan_image_slam/core/geometry/covariance.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <Eigen/LU>

namespace scan_image_slam {
namespace {

/// Adds an error of its own to what is known: (information^-1 + noise)^-1, also where nothing is.
Eigen::Matrix3d WithNoise(const Eigen::Matrix3d& information, const Eigen::Matrix3d& noise) {
  const Eigen::Matrix3d sum =
      (Eigen::Matrix3d::Identity() + information * noise).inverse() * information;
  return 0.5 * (sum + sum.transpose());
}

/// How far a pose is from the expected one, in standard deviations.
double Deviation(const Pose2& expected_from_found, const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d d = expected_from_found.coordinates();
  return std::sqrt(d.dot(covariance.inverse() * d));
}

}  // namespace

LoopCloser::LoopCloser(const LoopCloserOptions& options) : options_(options) {}

void LoopCloser::SetOptions(const LoopCloserOptions& options) {
  const bool enabled = options_.enabled;
  options_ = options;
  options_.enabled = enabled;
}

bool LoopCloser::Add(std::shared_ptr<const Keyframe> keyframe) {
  if (keyframe->id == 0) *this = LoopCloser(options_);  // the map has begun anew
  const int id = keyframe->id;
  const Keyframe& added = *keyframe;
  Enter(std::move(keyframe));
  if (id == 0) {
    poses_[id] = added.previous_from_base;
  } else {
    poses_[id] = poses_.at(id - 1) * added.previous_from_base;
    Join({id - 1, id, added.previous_from_base, added.covariance.inverse(), !added.joined});
  }
  ReleaseKnown();
  if (!options_.enabled) return false;
  const std::vector<std::pair<int, int>> candidates = Candidates(id);
  if (candidates.empty()) return false;
  std::vector<int> near_ids;
  near_ids.reserve(candidates.size());
  for (const auto& [near_id, submap_id] : candidates) near_ids.push_back(near_id);
  std::vector<GraphConstraint> closures;
  const GraphWays ways(links_, id, near_ids);
  for (const auto& [near_id, submap_id] : candidates) {
    if (auto closure = Close(id, submap_id, near_id, ways)) closures.push_back(*closure);
  }
  if (closures.empty()) return false;
  for (const GraphConstraint& closure : closures) Join(closure);
  Optimize(closures);
  return true;
}

void LoopCloser::Load(GraphMemory memory) {
  *this = LoopCloser(options_);
  keyframes_ = std::move(memory.keyframes);
  poses_ = std::move(memory.poses);
  JoinOnly(memory.constraints);
  submaps_ = std::move(memory.submaps);
  next_to_release_ = memory.next_to_release;
  closures_since_optimization_ = memory.closures_since_optimization;
}

void LoopCloser::Enter(std::shared_ptr<const Keyframe> keyframe) {
  const int id = keyframe->id;
  keyframes_[id] = std::move(keyframe);
  links_[id] = {};
  ExtendSubmaps(id);
}

/// Makes two keyframes neighbours, as far from one another as they may have drifted.
void LoopCloser::Join(const GraphConstraint& constraint) {
  constexpr double kRecognised = 0.5;  // [m]
  const auto [from, to] = std::make_pair(constraint.from, constraint.to);
  const double way =
      constraint.closes_loop() ? kRecognised : keyframes_.at(to)->way - keyframes_.at(from)->way;
  const int index = static_cast<int>(constraints_.size());
  links_.at(from).push_back({to, index, way});
  links_.at(to).push_back({from, index, way});
  constraints_.push_back(constraint);
  closures_ += constraint.closes_loop() ? 1 : 0;
}

/// Forgets all other constraints.
void LoopCloser::JoinOnly(const std::vector<GraphConstraint>& constraints) {
  links_.clear();
  for (const auto& [id, keyframe] : keyframes_) links_[id] = {};
  constraints_.clear();
  closures_ = 0;
  for (const GraphConstraint& constraint : constraints) Join(constraint);
}

void LoopCloser::ExtendSubmaps(int id) {
  const Keyframe& keyframe = *keyframes_.at(id);
  const bool begins = submaps_.empty() || !keyframe.joined ||
                      keyframe.way - submaps_.rbegin()->second.way > 0.5 * options_.submap_way;
  for (auto submap = submaps_.rbegin(); submap != submaps_.rend(); ++submap) {
    KeyframeRange& range = submap->second;
    if (range.end != id) break;
    if (keyframe.joined && keyframe.way - range.way <= options_.submap_way) {
      range.end = id + 1;
    }
  }
  const int next = submaps_.empty() ? 0 : submaps_.rbegin()->first + 1;
  if (begins) submaps_[next] = {id, id + 1, keyframe.way};
}

Submap& LoopCloser::GetSubmap(int id) {
  CachedSubmap& cached = cache_[id];
  cached.used = ++use_count_;
  if (!cached.submap) {
    const KeyframeRange range = submaps_.at(id);
    std::vector<std::shared_ptr<const Keyframe>> keyframes;
    const auto end = keyframes_.lower_bound(range.end);
    for (auto kept = keyframes_.lower_bound(range.begin); kept != end; ++kept) {
      keyframes.push_back(kept->second);
    }
    cached.submap = std::make_unique<Submap>(keyframes, ChainOf(keyframes), options_.submap);
  }
  if (static_cast<int>(cache_.size()) > options_.max_cached_submaps) {
    const auto oldest = std::min_element(
        cache_.begin(), cache_.end(),
        [](const auto& a, const auto& b) { return a.second.used < b.second.used; });
    cache_.erase(oldest);
  }
  return *cached.submap;
}

/// Keyframes of former visits near a keyframe and the submaps that hold them, nearest first.
std::vector<std::pair<int, int>> LoopCloser::Candidates(int id) const {
  constexpr double kStretch = 1.1;  // of a submap, by the graph
  const double way = WayAt(id);
  const Eigen::Vector2d place = poses_.at(id).translation();
  const double farthest = options_.max_distance + options_.max_window;
  struct Candidate {
    double distance;
    int near_id;
    int submap_id;
  };
  std::vector<Candidate> found;
  for (const auto& [submap_id, range] : submaps_) {
    const auto end = keyframes_.lower_bound(range.end);
    if (way - std::prev(end)->second->way < options_.min_loop_way) break;
    auto pose = poses_.lower_bound(range.begin);
    const double to_begin = (pose->second.translation() - place).norm();
    if (to_begin > farthest + kStretch * options_.submap_way) continue;
    Candidate best{std::numeric_limits<double>::infinity(), 0, submap_id};
    for (auto kept = keyframes_.lower_bound(range.begin); kept != end; ++kept, ++pose) {
      if (kept->second->points.empty()) continue;
      const double distance = (pose->second.translation() - place).norm();
      if (distance < best.distance) {
        best.distance = distance;
        best.near_id = kept->first;
      }
    }
    if (best.distance < farthest) found.push_back(best);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  std::vector<std::pair<int, int>> chosen;
  for (const Candidate& c : found) {
    const KeyframeRange& range = submaps_.at(c.submap_id);
    const bool overlaps = std::any_of(chosen.begin(), chosen.end(), [&](const auto& other) {
      const KeyframeRange& other_range = submaps_.at(other.second);
      return range.begin < other_range.end && other_range.begin < range.end;
    });
    if (overlaps) continue;
    chosen.push_back({c.near_id, c.submap_id});
    if (static_cast<int>(chosen.size()) == options_.max_matches) break;
  }
  return chosen;
}

LoopQuery LoopCloser::MakeQuery(int id, double way) const {
  LoopQuery query;
  Pose2 base_from_keyframe;
  for (int i = id; keyframes_.count(i) > 0 && WayAt(id) - WayAt(i) <= way; --i) {
    const Keyframe& keyframe = *keyframes_.at(i);
    const std::vector<SurfacePoint> points = ToSurfacePoints(keyframe, base_from_keyframe);
    query.points.insert(query.points.end(), points.begin(), points.end());
    if (!keyframe.joined) break;
    base_from_keyframe = base_from_keyframe * keyframe.previous_from_base.Inverse();
  }
  query.edges = DistinctEdges(keyframes_.at(id)->edges, options_.submap.edge_map);
  return query;
}

std::optional<GraphConstraint> LoopCloser::Close(int id, int submap_id, int near_id,
                                                 const GraphWays& ways) {
  const double way = ways.Length(near_id);
  const double half =
      std::min(options_.max_window, options_.min_window + options_.window_per_way * way);
  const double half_angle =
      std::min(options_.max_angle, options_.min_angle + options_.angle_per_way * way);
  const double distance = (poses_.at(near_id).translation() - poses_.at(id).translation()).norm();
  if (distance > options_.max_distance + half) return std::nullopt;
  Submap& submap = GetSubmap(submap_id);
  const Pose2& submap_from_near =
      submap.submap_from_keyframes()[keyframes_.find(near_id) -
                                     keyframes_.lower_bound(submaps_.at(submap_id).begin)];
  const Pose2 expected = submap_from_near * (poses_.at(near_id).Inverse() * poses_.at(id));
  const bool track = half < options_.track_window;
  const std::optional<LoopMatch> match =
      track ? TrackInSubmap(MakeQuery(id, 0.0), submap, expected, options_.matcher)
            : FindInSubmap(MakeQuery(id, options_.query_way), &submap, {expected, half, half_angle},
                           options_.matcher);
  if (!match) return std::nullopt;
  const Eigen::Matrix3d drift = DiagonalCovariance(options_.unseen_drift, options_.unseen_turn);
  if (!track && Deviation(expected.Inverse() * match->submap_from_base,
                          ways.Covariance(constraints_, near_id, drift)) > options_.max_deviation) {
    return std::nullopt;
  }
  GraphConstraint closure;
  closure.from = near_id;
  closure.to = id;
  closure.from_from_to = submap_from_near.Inverse() * match->submap_from_base;
  closure.information = WithNoise(
      match->information,
      DiagonalCovariance(options_.closure_distance_stddev, options_.closure_angle_stddev));
  closure.robust = true;
  closure.overlap = match->overlap;
  return closure;
}

void LoopCloser::Optimize(const std::vector<GraphConstraint>& closures) {
  constexpr double kSurprise = 3.0;  // standard deviations
  constexpr int kMaxClosures = 30;
  constexpr int kMaxShare = 10;  // one in so many, so that the time does not grow with its square
  constexpr int kRecent = 40;
  const bool surprise = std::any_of(closures.begin(), closures.end(),
                                    [&](const auto& c) { return Contradicted(c, kSurprise); });
  closures_since_optimization_ += static_cast<int>(closures.size());
  const bool all = surprise || closures_since_optimization_ >=
                                   std::max(kMaxClosures, this->closures() / kMaxShare);
  if (all) closures_since_optimization_ = 0;
  const int end = poses_.rbegin()->first + 1;
  OptimizeGraph(constraints_, all ? 1 : std::max(1, end - kRecent), options_.graph, &poses_);
  if (!all) return;
  if (TakeBack()) OptimizeGraph(constraints_, 1, options_.graph, &poses_);
  LetKnownGo();
}

bool LoopCloser::Contradicted(const GraphConstraint& constraint, double deviation) const {
  return SquaredResidual(constraint, poses_) > deviation * deviation;
}

/// Forgets the closures that the rest of the graph contradicts. Returns true if there are any.
bool LoopCloser::TakeBack() {
  std::vector<GraphConstraint> kept;
  for (const GraphConstraint& c : constraints_) {
    if (!c.closes_loop() || !Contradicted(c, options_.max_deviation)) kept.push_back(c);
  }
  if (kept.size() == constraints_.size()) return false;
  JoinOnly(kept);
  return true;
}

/// Lets go what keyframes saw of known places, as soon as no query asks for it, and the submaps of
/// which nothing is left.
void LoopCloser::ReleaseKnown() {
  const KnownPlaces places(keyframes_, poses_, constraints_, links_, options_.known_places);
  const double way = keyframes_.rbegin()->second->way - options_.query_way;
  const int judged = next_to_release_;
  for (; WayAt(next_to_release_) < way; ++next_to_release_) {
    std::shared_ptr<const Keyframe>& keyframe = keyframes_.at(next_to_release_);
    const bool known = options_.enabled ? places.AnchorOf(next_to_release_).has_value()
                                        : places.HasManyViews(next_to_release_);
    if (keyframe->points.empty() || !known) continue;
    auto released = std::make_shared<Keyframe>(*keyframe);
    released->points = std::vector<KeptPoint>();
    released->edges = std::vector<ModelEdge>();
    keyframe = std::move(released);
  }
  for (auto submap = submaps_.end(); submap != submaps_.begin();) {
    const KeyframeRange range = (--submap)->second;
    if (range.end <= judged) break;
    const bool is_left =
        range.end > next_to_release_ ||
        std::any_of(keyframes_.lower_bound(range.begin), keyframes_.lower_bound(range.end),
                    [](const auto& kept) { return !kept.second->points.empty(); });
    if (is_left) continue;
    cache_.erase(submap->first);
    submap = submaps_.erase(submap);
  }
}

/// Lets go what says nothing new: the graph would grow for as long as the robot drives.
void LoopCloser::LetKnownGo() {
  const KnownPlaces places(keyframes_, poses_, constraints_, links_, options_.known_places);
  const int latest = keyframes_.rbegin()->first;
  Anchors needless;
  for (const auto& [id, keyframe] : keyframes_) {
    if (id == 0) continue;
    if (id >= next_to_release_) break;
    if (!places.IsNeedless(id)) continue;
    const int anchor = *places.AnchorOf(id);
    needless[id] = {anchor, poses_.at(anchor).Inverse() * poses_.at(id)};
  }
  if (needless.empty()) return;
  const std::vector<GraphConstraint> kept = Without(needless, constraints_);
  for (const auto& [id, anchor] : needless) {
    LetGo(id);
    let_go_.push_back({id, latest, anchor});
  }
  JoinOnly(kept);
}

/// The next keyframe then tells of the motion since the one before. Submaps that hold it are made
/// anew when they are asked for.
void LoopCloser::LetGo(int id) {
  const auto let_go = keyframes_.find(id);
  auto next = std::make_shared<Keyframe>(*std::next(let_go)->second);
  next->covariance =
      TransportCovariance(let_go->second->covariance, next->previous_from_base) + next->covariance;
  next->previous_from_base = let_go->second->previous_from_base * next->previous_from_base;
  next->joined = next->joined && let_go->second->joined;
  std::next(let_go)->second = std::move(next);
  keyframes_.erase(let_go);
  poses_.erase(id);
  for (auto cached = cache_.begin(); cached != cache_.end();) {
    const KeyframeRange& range = submaps_.at(cached->first);
    cached = range.begin <= id && id < range.end ? cache_.erase(cached) : std::next(cached);
  }
}

Anchors LoopCloser::let_go() const {
  Anchors anchors;
  for (const LetGoKeyframe& keyframe : let_go_) anchors[keyframe.id] = keyframe.anchor;
  return anchors;
}

void LoopCloser::ForgetLetGo(int keyframe) {
  while (!let_go_.empty() && let_go_.front().latest <= keyframe) let_go_.pop_front();
}

}  // namespace scan_image_slam
