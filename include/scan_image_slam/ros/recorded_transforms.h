#pragma once

#include "scan_image_slam/core/recording/stamp_record.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <ros/time.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

namespace scan_image_slam {

/// The transforms of a recording. Sensors do not move on the robot: between two frames of which the
/// transform does not move, the one that comes most often holds for all times.
class RecordedTransforms {
 public:
  void Add(const tf2_msgs::TFMessage& message, const ros::Time& recorded);

  /// All transforms from a frame to its parent.
  struct Link {
    struct Value {
      geometry_msgs::Transform transform;
      std::size_t times;
    };
    std::string parent;
    std::string child;
    StampRecord stamps;
    std::vector<Value> values;  ///< different ones, up to a limit

    bool Moves() const;          ///< takes many values
    bool Disagrees() const;      ///< takes a few values, as if there were several publishers
    const Value& Usual() const;  ///< the most frequent one
  };
  std::vector<const Link*> Links() const;
  /// Of a frame; more than one if it has several parents.
  std::vector<const Link*> LinksTo(const std::string& child) const;
  /// From a frame upwards, the first link that moves; null if there is none.
  const Link* MovingLinkAbove(std::string frame) const;
  bool empty() const { return links_.empty(); }

  /// The usual value of each link, to look up transforms.
  std::unique_ptr<tf2::BufferCore> MakeBuffer() const;

 private:
  std::map<std::pair<std::string, std::string>, Link> links_;  ///< by child and parent
};

}  // namespace scan_image_slam
