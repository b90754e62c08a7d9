#include "scan_image_slam/ros/map_publisher.h"

#include "scan_image_slam/ros/publish_shared.h"

#include <algorithm>
#include <utility>

#include <map_msgs/OccupancyGridUpdate.h>

namespace scan_image_slam {
namespace {

IndexRange Unite(const IndexRange& a, const IndexRange& b) {
  if (a.size() <= 0) return b;
  if (b.size() <= 0) return a;
  return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

IndexRange Intersect(const IndexRange& a, const IndexRange& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

bool Same(const IndexRange& a, const IndexRange& b) { return a.begin == b.begin && a.end == b.end; }

}  // namespace

MapPublisher::MapPublisher(ros::NodeHandle node, std::string map_frame)
    : map_frame_(std::move(map_frame)) {
  map_publisher_ = node.advertise<nav_msgs::OccupancyGrid>("map", 1, true);
  metadata_publisher_ = node.advertise<nav_msgs::MapMetaData>("map_metadata", 1, true);
  updates_publisher_ = node.advertise<map_msgs::OccupancyGridUpdate>("map_updates", 10);
}

void MapPublisher::StartOver() {
  map_ = nav_msgs::OccupancyGrid();
  box_ = CellBox();
  changed_ = CellBox();
}

/// Brings `map_` up to date; true if anything has changed.
bool MapPublisher::Refresh(OccupancyGrid* grid, const ros::Time& stamp) {
  CellBox changed = grid->TakeChanges();
  const CellBox& box = grid->box();
  if (!Same(box.x, box_.x) || !Same(box.y, box_.y)) {
    box_ = box;
    changed = box;
    resized_ = true;
    map_.info.resolution = static_cast<float>(grid->resolution());
    map_.info.width = static_cast<std::uint32_t>(box.x.size());
    map_.info.height = static_cast<std::uint32_t>(box.y.size());
    map_.info.origin.position.x = box.x.begin * grid->resolution();
    map_.info.origin.position.y = box.y.begin * grid->resolution();
    map_.info.origin.orientation.w = 1.0;
    map_.info.map_load_time = stamp;
    map_.data.assign(static_cast<std::size_t>(box.x.size()) * box.y.size(), -1);
  }
  changed = {Intersect(changed.x, box_.x), Intersect(changed.y, box_.y)};
  if (changed.empty()) return false;
  for (int y = changed.y.begin; y < changed.y.end; ++y) {
    auto* row = map_.data.data() + static_cast<std::size_t>(y - box_.y.begin) * box_.x.size();
    for (int x = changed.x.begin; x < changed.x.end; ++x) {
      row[x - box_.x.begin] = grid->Occupancy(x, y);
    }
  }
  map_.header.stamp = stamp;
  map_.header.frame_id = map_frame_;
  changed_ = {Unite(changed_.x, changed.x), Unite(changed_.y, changed.y)};
  return true;
}

const nav_msgs::OccupancyGrid& MapPublisher::Current(OccupancyGrid* grid, const ros::Time& stamp) {
  Refresh(grid, stamp);
  return map_;
}

void MapPublisher::Publish(OccupancyGrid* grid, const ros::Time& stamp) {
  Refresh(grid, stamp);
  if (changed_.empty()) return;
  if (!resized_) {
    map_msgs::OccupancyGridUpdate update;
    update.header = map_.header;
    update.x = changed_.x.begin - box_.x.begin;
    update.y = changed_.y.begin - box_.y.begin;
    update.width = static_cast<std::uint32_t>(changed_.x.size());
    update.height = static_cast<std::uint32_t>(changed_.y.size());
    for (int y = changed_.y.begin; y < changed_.y.end; ++y) {
      const auto row =
          map_.data.begin() + static_cast<std::ptrdiff_t>(y - box_.y.begin) * box_.x.size();
      update.data.insert(update.data.end(), row + (changed_.x.begin - box_.x.begin),
                         row + (changed_.x.end - box_.x.begin));
    }
    PublishShared(updates_publisher_, std::move(update));
  }
  PublishShared(map_publisher_, map_);
  PublishShared(metadata_publisher_, map_.info);
  changed_ = CellBox();
  resized_ = false;
}

}  // namespace scan_image_slam
