#pragma once

#include <utility>

#include <boost/make_shared.hpp>
#include <ros/publisher.h>

namespace scan_image_slam {

/// Publishes a message so that subscribers in the same process, as nodelets have, get it uncopied.
template <typename Message>
void PublishShared(const ros::Publisher& publisher, Message message) {
  publisher.publish(boost::make_shared<Message>(std::move(message)));
}

}  // namespace scan_image_slam
