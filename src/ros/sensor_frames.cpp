#include "scan_image_slam/ros/sensor_frames.h"

#include "scan_image_slam/core/config/text_similarity.h"
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
  std::string text = "; TF holds ";
  for (std::size_t i = 0; i < frames.size(); ++i) text += (i == 0 ? "" : ", ") + frames[i];
  if (std::find(frames.begin(), frames.end(), wanted) != frames.end()) return text;
  const std::string similar = MostSimilar(wanted, frames);
  if (!IsSimilar(wanted, similar)) return text;
  return text + "; did you mean " + similar + " instead of " + wanted + "?";
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

}  // namespace scan_image_slam
