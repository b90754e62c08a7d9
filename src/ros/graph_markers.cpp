#include "scan_image_slam/ros/graph_markers.h"

namespace scan_image_slam {
namespace {

geometry_msgs::Point ToPoint(const Pose2& pose) {
  geometry_msgs::Point point;
  point.x = pose.x;
  point.y = pose.y;
  return point;
}

std_msgs::ColorRGBA OpaqueColour(float red, float green, float blue) {
  std_msgs::ColorRGBA colour;
  colour.r = red;
  colour.g = green;
  colour.b = blue;
  colour.a = 1.0F;
  return colour;
}

}  // namespace

visualization_msgs::MarkerArray ToMarkers(const GraphState& graph, const std::string& map_frame,
                                          const ros::Time& stamp) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = map_frame;
  marker.header.stamp = stamp;
  marker.pose.orientation.w = 1.0;

  visualization_msgs::Marker keyframes = marker;
  keyframes.ns = "keyframes";
  keyframes.type = visualization_msgs::Marker::POINTS;
  keyframes.scale.x = 0.06;
  keyframes.scale.y = 0.06;
  keyframes.color = OpaqueColour(0.1F, 0.5F, 0.1F);

  visualization_msgs::Marker way = marker;
  way.ns = "way";
  way.type = visualization_msgs::Marker::LINE_LIST;
  way.scale.x = 0.02;
  way.color = OpaqueColour(0.1F, 0.7F, 0.1F);

  visualization_msgs::Marker closures = marker;
  closures.ns = "closures";
  closures.type = visualization_msgs::Marker::LINE_LIST;
  closures.scale.x = 0.03;
  closures.color = OpaqueColour(0.9F, 0.2F, 0.7F);

  for (const auto& [id, pose] : graph.poses) {
    keyframes.points.push_back(ToPoint(pose));
    const auto next = graph.poses.find(id + 1);
    if (next == graph.poses.end()) continue;  // it was let go, as its place was known
    way.points.push_back(ToPoint(pose));
    way.points.push_back(ToPoint(next->second));
  }
  for (const auto& [from, to] : graph.closures) {
    closures.points.push_back(ToPoint(graph.poses.at(from)));
    closures.points.push_back(ToPoint(graph.poses.at(to)));
  }
  visualization_msgs::MarkerArray array;
  array.markers = {keyframes, way, closures};
  return array;
}

}  // namespace scan_image_slam
