#include "parameter_ranges.h"
#include "scan_image_slam/core/config/slam_parameters.h"

namespace scan_image_slam {
namespace {

void AddLoopClosing(MapperOptions* o, LoopCloserOptions* loop, ParameterSet* set) {
  set->Add("keyframe_distance", &o->keyframe_distance, "m", kPositive,
           "driven since the last scan that was kept to recognise places by");
  set->Add("keyframe_angle", &o->keyframe_angle, "rad", kPositive,
           "turned since the last scan that was kept");
  set->Add("loop/enabled", &loop->enabled,
           "recognise places seen before and correct the map; false: poses stay as matched");
  set->Add("loop/min_way", &loop->min_loop_way, "m", kPositive,
           "driven between two visits of a place; not less than bounded_icp keeps in mind "
           "(local_map/forget_distance)");
  set->Add("loop/max_distance", &loop->max_distance, "m", kPositive,
           "between two scans that are compared");
  set->Add("loop/window_per_way", &loop->window_per_way, "m/m", kNotNegative,
           "how fast the search window grows with the way since the last visit");
  set->Add("loop/max_window", &loop->max_window, "m", kPositive, "largest half of that window");
  set->Add("loop/angle_per_way", &loop->angle_per_way, "rad/m", kNotNegative,
           "how fast the window grows in angle");
  set->Add("loop/max_angle", &loop->max_angle, "rad", {0.0, 3.15},
           "largest half of the window in angle");
  set->Add("loop/min_agreement", &loop->matcher.min_agreement, "-", kFraction,
           "of the points that the former visit should have seen, on its walls");
  set->Add("loop/min_overlap", &loop->matcher.min_overlap, "-", kFraction,
           "of all points, on walls of the former visit");
  set->Add("loop/max_rival_score", &loop->matcher.rival_score, "-", kFraction,
           "another pose that fits so well, relative to the best, makes a place ambiguous");
}

}  // namespace

ParameterSet MapperParameters(MapperOptions* o, LoopCloserOptions* loop, MapperNodeOptions* node) {
  ParameterSet set("mapper");
  set.Add("map_frame", &node->map_frame, "frame of the map");
  set.Add("odom_frame", &node->odom_frame, "frame of the encoders' dead reckoning");
  set.Add("base_frame", &node->base_frame, "frame of the robot's base");
  set.Add("pub_map_odom_transform", &node->pub_map_odom_transform,
          "publish map_frame -> odom_frame (without encoders: map_frame -> base_frame)");
  set.Add("transform_publish_period", &node->transform_publish_period, "s", {0.001, 10.0},
          "between two transforms");
  set.Add("tf_delay", &node->tf_delay, "s", {0.0, 10.0},
          "transforms are stamped so far ahead, so that others need not wait for the next one");
  set.Add("map_update_interval", &node->map_update_interval, "s", {0.01, 3600.0},
          "between two maps");
  set.Add("trajectory_spacing", &node->trajectory_spacing, "m", kNotNegative,
          "between the poses of the paths");
  set.Add("map_folder", &node->map_folder,
          "folder that save_map and save_state write to, and nothing outside it; relative paths "
          "start at the working directory of the node (with roslaunch: ~/.ros)");
  set.Add("state_file", &node->state_file,
          "map to begin with, as save_state wrote it, from map_folder on; it need not be there, "
          "but for localization");
  set.Add("localization", &node->localization,
          "find and follow the robot in the map of state_file, which stays as it is");
  set.Add("autosave_period", &node->autosave_period, "s", {0.0, 86400.0},
          "the map is written to state_file so often, and at the end; 0: not at all");
  set.Add("resolution", &o->grid.resolution, "m", {0.001, 10.0}, "side of a cell of the map");
  set.Add("max_map_cells", &o->grid.max_cells, "-", {1e4, 2e9},
          "the map grows no farther, and that is told; a cell takes 8 bytes");
  set.Add("update_factor_occupied", &o->grid.update_factor_occupied, "-", {0.501, 0.999},
          "probability that a cell with one hit is occupied");
  set.Add("update_factor_free", &o->grid.update_factor_free, "-", {0.001, 0.499},
          "probability that a cell that one beam has crossed is occupied");
  set.Add("map_max_range", &o->grid.max_range, "m", kPositive, "beams are drawn up to here");
  set.AddChoice("no_return_policy", &o->grid.no_return_policy,
                {{"ignore", NoReturnPolicy::kIgnore},
                 {"clear_to_max", NoReturnPolicy::kClearToMax},
                 {"clear_to_max_legacy", NoReturnPolicy::kClearToMaxLegacy}},
                "what beams without a return clear: ignore (nothing), clear_to_max (up to "
                "map_max_range where the driver says +Inf, as REP-117 wants) or "
                "clear_to_max_legacy (also for NaN, 0 and ranges below the minimum)");
  set.Add("map_update_distance_thresh", &o->map_update_distance_thresh, "m", kNotNegative,
          "driven since the last scan that was drawn");
  set.Add("map_update_angle_thresh", &o->map_update_angle_thresh, "rad", kNotNegative,
          "turned since the last scan that was drawn");
  set.Add("map_update_time_thresh", &o->map_update_time_thresh, "s", kNotNegative,
          "passed since the last scan that was drawn");
  set.Add("max_scans_per_place", &o->max_scans_per_place, "-", {1, 1000},
          "kept in the map of those taken within half a metre and 45 degrees: the latest");
  AddLoopClosing(o, loop, &set);
  set.AllowLive({"transform_publish_period", "tf_delay", "map_update_interval",
                 "update_factor_occupied", "update_factor_free", "map_update_distance_thresh",
                 "map_update_angle_thresh", "map_update_time_thresh", "max_scans_per_place",
                 "loop/min_way", "loop/max_distance", "loop/min_agreement", "loop/min_overlap",
                 "loop/max_rival_score"});
  return set;
}

}  // namespace scan_image_slam
