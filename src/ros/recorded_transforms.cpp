#include "scan_image_slam/ros/recorded_transforms.h"

#include "scan_image_slam/ros/sensor_conversions.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

constexpr std::size_t kManyValues = 5;

/// Up to numbers that were rounded on their way.
bool Same(const geometry_msgs::Transform& a, const geometry_msgs::Transform& b) {
  const auto same = [](double x, double y) { return std::abs(x - y) < 1e-4; };
  return same(a.translation.x, b.translation.x) && same(a.translation.y, b.translation.y) &&
         same(a.translation.z, b.translation.z) && same(a.rotation.x, b.rotation.x) &&
         same(a.rotation.y, b.rotation.y) && same(a.rotation.z, b.rotation.z) &&
         same(a.rotation.w, b.rotation.w);
}

}  // namespace

bool RecordedTransforms::Link::Moves() const { return values.size() >= kManyValues; }

bool RecordedTransforms::Link::Disagrees() const { return values.size() > 1 && !Moves(); }

const RecordedTransforms::Link::Value& RecordedTransforms::Link::Usual() const {
  return *std::max_element(values.begin(), values.end(),
                           [](const Value& a, const Value& b) { return a.times < b.times; });
}

void RecordedTransforms::Add(const tf2_msgs::TFMessage& message, const ros::Time& recorded) {
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    const std::string parent = StripSlash(transform.header.frame_id);
    const std::string child = StripSlash(transform.child_frame_id);
    Link& link = links_[{child, parent}];
    link.parent = parent;
    link.child = child;
    link.stamps.Add(static_cast<Stamp>(transform.header.stamp.toNSec()),
                    static_cast<Stamp>(recorded.toNSec()));
    const auto known = std::find_if(
        link.values.begin(), link.values.end(),
        [&](const Link::Value& value) { return Same(value.transform, transform.transform); });
    if (known != link.values.end()) {
      ++known->times;
    } else if (link.values.size() < kManyValues) {
      link.values.push_back({transform.transform, 1});
    }
  }
}

std::vector<const RecordedTransforms::Link*> RecordedTransforms::Links() const {
  std::vector<const Link*> links;
  for (const auto& [frames, link] : links_) links.push_back(&link);
  return links;
}

std::vector<const RecordedTransforms::Link*> RecordedTransforms::LinksTo(
    const std::string& child) const {
  std::vector<const Link*> links;
  for (const auto& [frames, link] : links_) {
    if (frames.first == child) links.push_back(&link);
  }
  return links;
}

const RecordedTransforms::Link* RecordedTransforms::MovingLinkAbove(std::string frame) const {
  for (std::size_t steps = 0; steps <= links_.size(); ++steps) {  // a tree has no longer way
    const std::vector<const Link*> links = LinksTo(frame);
    if (links.empty()) return nullptr;
    for (const Link* link : links) {
      if (link->Moves()) return link;
    }
    frame = links.front()->parent;
  }
  return nullptr;
}

std::unique_ptr<tf2::BufferCore> RecordedTransforms::MakeBuffer() const {
  auto buffer = std::make_unique<tf2::BufferCore>();
  // Of several parents the last one counts: one that does not move.
  for (const bool moves : {true, false}) {
    for (const Link* link : Links()) {
      if (link->Moves() != moves) continue;
      geometry_msgs::TransformStamped transform;
      transform.header.frame_id = link->parent;
      transform.child_frame_id = link->child;
      transform.transform = link->Usual().transform;
      buffer->setTransform(transform, "bag", true);
    }
  }
  return buffer;
}

}  // namespace scan_image_slam
