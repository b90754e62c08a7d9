#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/make_shared.hpp>
#include <ros/serialization.h>
#include <rosbag/message_instance.h>

namespace scan_image_slam {

/// For a first look at a message: a number that may be the length of an array is never more than
/// one beyond the bytes that are left. So an array that can't be there is not allocated, and told
/// as what leaves the message; ros::serialization::IStream makes room for it first.
struct FirstLookStream : ros::serialization::Stream {
  // NOLINTNEXTLINE(readability-identifier-naming): roscpp asks for this name
  static const ros::serialization::StreamType stream_type = ros::serialization::stream_types::Input;

  FirstLookStream(std::uint8_t* data, std::uint32_t size) : Stream(data, size) {}

  template <typename Value>
  void next(Value& value) {
    ros::serialization::deserialize(*this, value);
  }

  void next(std::uint32_t& value) {
    ros::serialization::deserialize(*this, value);
    value = std::min(value, getLength() + 1);
  }
};

/// A message of a bag, or nothing if it is of another type. Throws std::invalid_argument if its
/// content is not as long as it says.
template <typename Message>
boost::shared_ptr<const Message> ReadMessage(const rosbag::MessageInstance& instance) {
  if (!instance.isType<Message>()) return nullptr;
  const std::uint32_t size = instance.size();
  std::vector<std::uint8_t> bytes(std::size_t{size} + 1);  // an empty one has a place, too
  ros::serialization::OStream target(bytes.data(), size);
  instance.write(target);
  auto message = boost::make_shared<Message>();
  try {
    FirstLookStream first_look(bytes.data(), size);
    Message ignored;
    ros::serialization::deserialize(first_look, ignored);
    ros::serialization::IStream stream(bytes.data(), size);
    ros::serialization::deserialize(stream, *message);
  } catch (const ros::serialization::StreamOverrunException&) {
    throw std::invalid_argument("a message of " + std::to_string(size) +
                                " bytes is shorter than it says");
  }
  return message;
}

}  // namespace scan_image_slam
