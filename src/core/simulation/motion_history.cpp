#include "scan_image_slam/core/simulation/motion_history.h"

#include <algorithm>

namespace scan_image_slam {

void MotionHistory::Add(const TrueState& state) {
  states_.push_back(state);
  while (states_.size() > 2 && Seconds(state.time - states_[1].time) > length_) {
    states_.pop_front();
  }
}

TrueState MotionHistory::At(Stamp time) const {
  const auto after =
      std::lower_bound(states_.begin(), states_.end(), time,
                       [](const TrueState& state, Stamp wanted) { return state.time < wanted; });
  TrueState state = after == states_.end() ? states_.back() : *after;
  state.time = time;
  if (after == states_.begin() || after == states_.end()) return state;
  // The steps are about a millisecond long, in which the chord and the arc are the same.
  const TrueState& a = *(after - 1);
  const TrueState& b = *after;
  const double f = Seconds(time - a.time) / Seconds(b.time - a.time);
  const Pose2& p = a.world_from_base;
  const Pose2& q = b.world_from_base;
  state.world_from_base = {p.x + f * (q.x - p.x), p.y + f * (q.y - p.y),
                           NormalizeAngle(p.theta + f * NormalizeAngle(q.theta - p.theta))};
  state.speed = a.speed + f * (b.speed - a.speed);
  state.turn_rate = a.turn_rate + f * (b.turn_rate - a.turn_rate);
  return state;
}

}  // namespace scan_image_slam
