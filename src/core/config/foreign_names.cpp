#include "scan_image_slam/core/config/foreign_names.h"

#include <algorithm>

namespace scan_image_slam {
namespace {

constexpr const char* kGmapping = "gmapping";
constexpr const char* kHector = "hector_mapping";
constexpr const char* kToolbox = "slam_toolbox";
constexpr const char* kMatcher = "laser_scan_matcher";

std::vector<ForeignName> NamesOfGmapping() {
  const std::string drawing = "for drawing; every scan is matched";
  const std::string one_map = "there is one map, without particles";
  const std::string grows = "the map grows where it is needed";
  return {
      {"angularUpdate", kGmapping, {"mapper/map_update_angle_thresh"}, drawing},
      {"astep", kGmapping, {"bounded_icp/search/angle_step"}, ""},
      {"delta", kGmapping, {"mapper/resolution"}, ""},
      {"iterations", kGmapping, {"bounded_icp/refinement/max_iterations"}, ""},
      {"kernelSize", kGmapping, {}, "the window follows from the encoders"},
      {"lasamplerange", kGmapping, {}, one_map},
      {"lasamplestep", kGmapping, {}, one_map},
      {"linearUpdate", kGmapping, {"mapper/map_update_distance_thresh"}, drawing},
      {"llsamplerange", kGmapping, {}, one_map},
      {"llsamplestep", kGmapping, {}, one_map},
      {"lsigma", kGmapping, {"bounded_icp/laser/range_stddev"}, ""},
      {"lskip", kGmapping, {"scan_image_fusion/min_beam_spacing_deg"}, "as an angle"},
      {"lstep", kGmapping, {"bounded_icp/search/distance_step"}, ""},
      {"maxRange",
       kGmapping,
       {"mapper/map_max_range", "scan_image_fusion/max_range"},
       "the first for drawing, the second for everything"},
      {"maxUrange",
       kGmapping,
       {"mapper/map_max_range", "scan_image_fusion/max_range"},
       "the first for drawing, the second for everything"},
      {"minimumScore", kGmapping, {"bounded_icp/local_map/min_matched_fraction"}, "as a fraction"},
      {"occ_thresh", kGmapping, {}, "the map holds probabilities"},
      {"ogain", kGmapping, {}, one_map},
      {"particles", kGmapping, {}, one_map},
      {"resampleThreshold", kGmapping, {}, one_map},
      {"sigma", kGmapping, {"bounded_icp/laser/range_stddev"}, ""},
      {"srr", kGmapping, {"bounded_icp/noise/distance_per_distance"}, ""},
      {"srt", kGmapping, {"bounded_icp/window/distance_per_angle"}, "as a bound"},
      {"str", kGmapping, {"bounded_icp/noise/angle_per_distance"}, ""},
      {"stt", kGmapping, {"bounded_icp/noise/angle_per_angle"}, ""},
      {"temporalUpdate", kGmapping, {"mapper/map_update_time_thresh"}, drawing},
      {"throttle_scans", "gmapping, slam_toolbox", {}, "every scan is matched"},
      {"xmax", kGmapping, {}, grows},
      {"xmin", kGmapping, {}, grows},
      {"ymax", kGmapping, {}, grows},
      {"ymin", kGmapping, {}, grows},
  };
}

std::vector<ForeignName> NamesOfHector() {
  const std::string level = "the laser must be level";
  const std::string grows = "the map grows where it is needed";
  const std::string pose = "there is the topic pose";
  return {
      {"advertise_map_service", kHector, {}, "the service dynamic_map is always there"},
      {"laser_max_dist", kHector, {"scan_image_fusion/max_range"}, ""},
      {"laser_min_dist", kHector, {"scan_image_fusion/min_range"}, ""},
      {"laser_z_max_value", kHector, {}, level},
      {"laser_z_min_value", kHector, {}, level},
      {"map_multi_res_levels", kHector, {}, "the window follows from the encoders"},
      {"map_pub_period", kHector, {"mapper/map_update_interval"}, ""},
      {"map_resolution", kHector, {"mapper/resolution"}, ""},
      {"map_size", kHector, {}, grows},
      {"map_start_x", kHector, {}, grows},
      {"map_start_y", kHector, {}, grows},
      {"output_timing", kHector, {}, "slam_offline tells times in report.json"},
      {"pub_map_scanmatch_transform", kHector, {}, pose},
      {"pub_odometry", kHector, {}, pose},
      {"scan_subscriber_queue_size",
       kHector,
       {},
       "scans that have waited for 0.2 s are left out, and told"},
      {"scan_topic",
       "hector_mapping, slam_toolbox",
       {},
       "remap the topic scan, or give the launch argument scan_topic"},
      {"tf_map_scanmatch_transform_frame_name", kHector, {}, pose},
      {"use_tf_pose_start_estimate", kHector, {"bounded_icp/odom_source"}, "auto or tf"},
      {"use_tf_scan_transformation", kHector, {"scan_image_fusion/laser/from_tf"}, ""},
  };
}

std::vector<ForeignName> NamesOfOthers() {
  return {
      {"do_loop_closing", kToolbox, {"mapper/loop/enabled"}, ""},
      {"loop_match_minimum_response_fine",
       kToolbox,
       {"mapper/loop/min_agreement", "mapper/loop/min_overlap"},
       ""},
      {"loop_search_maximum_distance", kToolbox, {"mapper/loop/max_distance"}, ""},
      {"max_laser_range", kToolbox, {"mapper/map_max_range"}, ""},
      {"minimum_time_interval", kToolbox, {}, "every scan is matched"},
      {"minimum_travel_distance", kToolbox, {"mapper/keyframe_distance"}, "for loop closing"},
      {"minimum_travel_heading", kToolbox, {"mapper/keyframe_angle"}, "for loop closing"},
      {"transform_timeout", kToolbox, {"mapper/tf_delay"}, ""},
      {"fixed_frame", kMatcher, {"mapper/map_frame"}, ""},
      {"kf_dist_angular", kMatcher, {"bounded_icp/local_map/insert_angle"}, ""},
      {"kf_dist_linear", kMatcher, {"bounded_icp/local_map/insert_distance"}, ""},
      {"max_correspondence_dist", kMatcher, {"bounded_icp/refinement/gate"}, ""},
      {"use_imu", kMatcher, {}, "an IMU is not used"},
      {"use_odom", kMatcher, {"bounded_icp/odom_source"}, "auto or none"},
  };
}

}  // namespace

const std::vector<ForeignName>& ForeignNames() {
  static const std::vector<ForeignName> kNames = [] {
    std::vector<ForeignName> names = NamesOfGmapping();
    for (const auto& others : {NamesOfHector(), NamesOfOthers()}) {
      names.insert(names.end(), others.begin(), others.end());
    }
    std::sort(names.begin(), names.end(),
              [](const ForeignName& a, const ForeignName& b) { return a.name < b.name; });
    return names;
  }();
  return kNames;
}

const ForeignName* FindForeignName(const std::string& name) {
  for (const ForeignName& foreign : ForeignNames()) {
    if (foreign.name == name) return &foreign;
  }
  return nullptr;
}

std::string Explain(const ForeignName& foreign) {
  std::string use;
  for (const std::string& name : foreign.here) use += (use.empty() ? "use " : " and ") + name;
  if (use.empty()) use = "there is nothing like it here";
  return "a parameter of " + foreign.packages + ", not used; " + use +
         (foreign.remark.empty() ? "" : " (" + foreign.remark + ")");
}

}  // namespace scan_image_slam
