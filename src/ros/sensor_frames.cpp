#include "scan_image_slam/ros/sensor_frames.h"

#include "scan_image_slam/core/config/text_similarity.h"
#include "scan_image_slam/core/recording/number_text.h"
#include "scan_image_slam/ros/sensor_conversions.h"

#include <algorithm>
#include <vector>

#include <tf2/exceptions.h>

namespace scan_image_slam {
namespace {

std::string DescribeTree(const tf2::BufferCore& tf, const std::string& wanted) {
  std::vector<std::string> frames;
  tf._getFrameStrings(frames);
  if (frames.empty()) return "; TF is empty: is anything publishing transforms?";
  std::sort(frames.begin(), frames.end());
  std::string text = "; TF holds " + ListText(frames);
  if (std::find(frames.begin(), frames.end(), wanted) != frames.end()) return text;
  const std::string similar = MostSimilar(wanted, frames);
  if (!IsSimilar(wanted, similar)) return text;
  return text + "; did you mean " + similar + " instead of " + wanted + "?";
}

/// A frame and all above it.
std::vector<std::string> Upwards(const tf2::BufferCore& tf, const std::string& frame) {
  constexpr std::size_t kDeepest = 100;
  std::vector<std::string> frames = {frame};
  std::string parent;
  while (frames.size() < kDeepest && tf._getParent(frames.back(), ros::Time(0), parent)) {
    frames.push_back(parent);
  }
  return frames;
}

/// True if a frame is on the way between two others, ends included.
bool IsBetween(const tf2::BufferCore& tf, const std::string& a, const std::string& b,
               const std::string& frame) {
  std::vector<std::string> above_a = Upwards(tf, a);
  std::vector<std::string> above_b = Upwards(tf, b);
  std::string meeting;
  while (!above_a.empty() && !above_b.empty() && above_a.back() == above_b.back()) {
    meeting = above_a.back();
    above_a.pop_back();
    above_b.pop_back();
  }
  const auto has = [&](const std::vector<std::string>& frames) {
    return std::find(frames.begin(), frames.end(), frame) != frames.end();
  };
  return meeting == frame || has(above_a) || has(above_b);
}

}  // namespace

FrameLookup LookUpSensor(const tf2::BufferCore& tf, const std::string& base_frame,
                         const std::string& sensor_frame) {
  FrameLookup lookup;
  const std::string sensor = StripSlash(sensor_frame);
  const std::string base = StripSlash(base_frame);
  if (sensor.empty()) {
    lookup.problem = "the messages of the sensor name no frame (header.frame_id is empty)";
    return lookup;
  }
  if (sensor == base) {
    lookup.found = true;
    return lookup;
  }
  try {
    lookup.base_from_sensor = ToIsometry(tf.lookupTransform(base, sensor, ros::Time(0)).transform);
    lookup.found = true;
  } catch (const tf2::TransformException&) {
    std::vector<std::string> frames;
    tf._getFrameStrings(frames);
    const bool base_known = std::find(frames.begin(), frames.end(), base) != frames.end();
    lookup.problem =
        "no transform " + base + " -> " + sensor + DescribeTree(tf, base_known ? sensor : base);
  } catch (const std::invalid_argument& error) {
    lookup.problem = "transform " + base + " -> " + sensor + ": " + error.what();
  }
  return lookup;
}

FrameLookup LookUpOnBase(const tf2::BufferCore& tf, const std::string& base_frame,
                         const std::string& frame, const std::string& odom_frame) {
  const std::string on_base = StripSlash(frame);
  const std::string base = StripSlash(base_frame);
  const std::string odom = StripSlash(odom_frame);
  if (on_base == base || !IsBetween(tf, on_base, base, odom)) {
    return LookUpSensor(tf, base, on_base);
  }
  FrameLookup lookup;
  lookup.problem = "no transform " + base + " -> " + on_base + " but by way of " + odom +
                   ", in which the base moves";
  return lookup;
}

}  // namespace scan_image_slam
