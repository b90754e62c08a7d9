#include "scan_image_slam/core/config/slam_parameters.h"

#include "parameter_ranges.h"

namespace scan_image_slam {
namespace {

void AddOdometryInput(OdometryInput* o, ParameterSet* set) {
  set->Add("base_frame", &o->base_frame, "frame of the robot's base");
  set->Add("odom_frame", &o->odom_frame, "frame of the encoders' dead reckoning");
  set->AddChoice(
      "odom_source", &o->source,
      {{"auto", OdometrySource::kAuto},
       {"topic", OdometrySource::kTopic},
       {"tf", OdometrySource::kTf},
       {"none", OdometrySource::kNone}},
      "where the encoders are read: topic odom, transform odom_frame -> base_frame, auto "
      "(TF while nothing comes on the topic), or none");
  set->Add(
      "odom_max_wait", &o->max_wait, "s", {0.0, 1.0},
      "a scan waits so long for the encoders to reach its stamp, 0.2 s for the first reading of "
      "all; then they are extrapolated");
}

void AddOdometryLimits(OdometryOptions* o, ParameterSet* set) {
  set->Add("odometry/max_speed", &o->max_speed, "m/s", kPositive,
           "a faster step of the odometry is a reset of the odometry, not a motion");
  set->Add("odometry/max_turn_rate", &o->max_turn_rate, "rad/s", kPositive,
           "a faster turn of the odometry is a reset of the odometry, not a motion");
  set->Add("odometry/max_extrapolation", &o->max_extrapolation, "s", kPositive,
           "age of the newest reading up to which the encoders count as present");
  set->Add("odometry/history", &o->history, "s", kPositive, "readings kept");
}

void AddSensorPose(const std::string& prefix, SensorPose* o, ParameterSet* set) {
  set->Add(prefix + "/from_tf", &o->from_tf,
           "take the pose on the base from TF; false: from the parameters below");
  set->Add(prefix + "/x", &o->x, "m", kAny, "forward of base_frame");
  set->Add(prefix + "/y", &o->y, "m", kAny, "left of base_frame");
  set->Add(prefix + "/z", &o->z, "m", kAny, "above base_frame");
  set->AddDegrees(prefix + "/roll_deg", &o->roll, kAngle, "about the forward axis");
  set->AddDegrees(prefix + "/pitch_deg", &o->pitch, kAngle, "positive looks down");
  set->AddDegrees(prefix + "/yaw_deg", &o->yaw, kAngle, "positive looks left");
}

void AddMotionBounds(MotionBounds* o, ParameterSet* set) {
  // The search tries every motion in the window: no user shall open it beyond all bounds.
  constexpr ParameterRange kGrowth{0.0, 10.0};
  set->Add("window/distance_per_distance", &o->distance_per_distance, "m/m", kGrowth,
           "D grows with the way driven: wheel radius and slip");
  set->Add("window/distance_per_angle", &o->distance_per_angle, "m/rad", kGrowth,
           "D grows with the angle turned: slip");
  set->Add("window/distance_per_time", &o->distance_per_time, "m/s", kGrowth,
           "D grows with the time between scans: wheels that spin or block, late stamps");
  set->Add("window/min_distance", &o->min_distance, "m", {0.0, 1.0}, "floor of D");
  set->Add("window/angle_per_angle", &o->angle_per_angle, "rad/rad", kGrowth,
           "Phi grows with the angle turned: wheel base and slip");
  set->Add("window/angle_per_distance", &o->angle_per_distance, "rad/m", kGrowth,
           "Phi grows with the way driven: unequal wheels");
  set->Add("window/angle_per_time", &o->angle_per_time, "rad/s", kGrowth,
           "Phi grows with the time between scans: wheels that spin or block, late stamps");
  set->Add("window/min_angle", &o->min_angle, "rad", {0.0, 3.15}, "floor of Phi");
  set->Add("window/lateral_per_distance", &o->lateral_per_distance, "-", {0.0, 2.0},
           "sideways bound of the refinement as a fraction of D; 0 for a pure arc");
  set->Add("window/max_time", &o->max_time, "s", {0.0, 10.0},
           "longer gaps do not widen the window further");
}

void AddMotionNoise(MotionNoise* o, ParameterSet* set) {
  set->Add("noise/distance_per_distance", &o->distance_per_distance, "m/m", kNotNegative,
           "usual error of the encoders (one standard deviation) along the way");
  set->Add("noise/distance_per_time", &o->distance_per_time, "m/s", kNotNegative,
           "the same with the time between scans");
  set->Add("noise/min_distance", &o->min_distance, "m", kPositive, "floor of that error");
  set->Add("noise/lateral_fraction", &o->lateral_fraction, "-", kPositive,
           "error sideways, as a fraction of that along the way");
  set->Add("noise/angle_per_angle", &o->angle_per_angle, "rad/rad", kNotNegative,
           "usual error of the encoders' heading with the angle turned");
  set->Add("noise/angle_per_distance", &o->angle_per_distance, "rad/m", kNotNegative,
           "the same with the way driven");
  set->Add("noise/angle_per_time", &o->angle_per_time, "rad/s", kNotNegative,
           "the same with the time between scans");
  set->Add("noise/min_angle", &o->min_angle, "rad", kPositive, "floor of that error");
}

void AddSearchGrid(const std::string& prefix, SearchGrid* o, ParameterSet* set) {
  set->Add(prefix + "/distance_step", &o->distance_step, "m", kPositive,
           "grid step of the exhaustive search along the way");
  set->Add(prefix + "/angle_step", &o->angle_step, "rad", kPositive,
           "grid step of the exhaustive search in angle");
  set->Add(prefix + "/deviation_cost", &o->deviation_cost, "m", kNotNegative,
           "added to e per grid step away from the prediction: ties go to the encoders");
}

void AddLocalMapMatcher(LocalMapMatcherOptions* o, ParameterSet* set) {
  AddSearchGrid("search", &o->grid, set);
  set->Add("search/point_spacing", &o->point_spacing, "m", kPositive,
           "between the points of the scan that the search looks at");
  set->Add("search/max_distance", &o->max_distance, "m", kPositive,
           "most that one point adds to e, so that new surroundings do not drown the known");
  set->Add("laser/range_stddev", &o->noise.range_stddev, "m", kPositive,
           "standard deviation of a range");
  set->Add("laser/bearing_stddev", &o->noise.bearing_stddev, "rad", kNotNegative,
           "standard deviation of a bearing");
  set->Add("surface/radius", &o->surface.radius, "m", kPositive,
           "half length of the line fitted around each point for its normal");
  set->Add("surface/max_incidence", &o->surface.max_incidence, "rad", {0.1, 1.57},
           "between ray and normal of the most grazing wall that is followed");
  set->Add("local_map/spacing", &o->local_map.spacing, "m", kPositive,
           "between surface elements along a wall");
  set->Add("local_map/reach", &o->local_map.reach, "m", kPositive,
           "farthest point that still finds an element");
  set->Add("local_map/max_merge_offset", &o->local_map.max_merge_offset, "m", kPositive,
           "across the wall, of a point that belongs to an element");
  set->Add("local_map/min_normal_cosine", &o->local_map.min_normal_cosine, "-", {-1.0, 1.0},
           "between the normals of a point and of the element it belongs to");
  set->Add("local_map/still_time", &o->local_map.still_time, "s", kPositive,
           "that small things must have stood still, unlike people, before they are matched");
  set->Add("local_map/insert_distance", &o->insert_distance, "m", kNotNegative,
           "driven since the last scan that entered the map");
  set->Add("local_map/insert_angle", &o->insert_angle, "rad", kNotNegative,
           "turned since the last scan that entered the map");
  set->Add("local_map/insert_first", &o->insert_first, "-", {1.0, 1e6},
           "scans at the start that enter the map in any case");
  set->Add("local_map/forget_distance", &o->forget_distance, "m", kPositive,
           "what was not seen on the last stretch of this length is left to the mapper");
  set->Add("local_map/min_matched_fraction", &o->min_matched_fraction, "-", kFraction,
           "of the points of a scan, to let it enter the map");
  set->Add("edge_map/gate", &o->filter.edges.gate, "m", kPositive,
           "farthest edge from its landmark");
  set->Add("edge_map/min_separation", &o->filter.edges.min_separation, "m", kPositive,
           "between two edges of one sign that can be told apart");
  set->Add("edge_map/min_weight", &o->filter.edges.min_weight, "-", {0.01, 1.0},
           "share of the region of interest that must be vertical edge");
  set->Add("edge_map/max_range", &o->filter.edges.max_range, "m", kPositive,
           "farther edges are not used");
  set->Add("edge_map/surface_stddev", &o->filter.edges.surface_stddev, "m", kPositive,
           "how far an edge may lie off the surface that the laser sees");
  set->Add("filter/scale_stddev", &o->filter.scale_stddev, "-", {0.0, 1.0},
           "how wrong the distance of the encoders usually is, as a share; learned while driving");
  set->AddDegrees("filter/camera_yaw_stddev_deg", &o->filter.camera_yaw_stddev, {0.0, 10.0},
                  "how wrong the yaw of the camera may be; learned while driving");
  set->Add("filter/max_new_slant", &o->filter.max_new_slant, "m/rad", kPositive,
           "max_edge_slant for edges to begin with; less than that by more than its noise");
  set->Add("filter/edge_correlation", &o->filter.edge_correlation, "-", {1.0, 1e6},
           "edges of successive images that err together, as if they were one");
  set->Add("filter/edge_bias", &o->filter.edge_bias, "-", {0.0, 10.0},
           "part of an edge's standard deviation that lasts from image to image");
  set->Add("filter/keep_distance", &o->filter.keep_distance, "m", kPositive,
           "driven since an edge was seen, until it is forgotten");
  RefinementOptions& r = o->refinement;
  set->Add("refinement/max_iterations", &r.max_iterations, "-", {0.0, 100.0},
           "least squares steps; 0 leaves the motion on the grid");
  set->Add("refinement/gate", &r.gate, "m", kPositive,
           "farthest point from its element, across the wall");
  set->Add("refinement/along_gate", &r.along_gate, "m", kPositive, "the same along the wall");
  set->Add("refinement/model_stddev", &r.model_stddev, "m", kPositive,
           "roughness of walls and what else the map leaves out");
  set->Add("refinement/kernel", &r.kernel, "-", kPositive,
           "residuals of so many standard deviations count half");
  set->Add("refinement/correlation", &r.correlation, "-", {1.0, 1e6},
           "points of a scan that err together, as if they were one");
  set->Add("refinement/min_normal_cosine", &r.min_normal_cosine, "-", {-1.0, 1.0},
           "between the normals of a point and its element");
  set->Add(
      "refinement/degenerate_ratio", &r.degenerate_ratio, "-", kFraction,
      "of the information along and across; below it only walls that face a direction, wider than "
      "people, tell of it, and without them the prediction");
  set->Add("refinement/prior_kernel", &o->prior_kernel, "-", kPositive,
           "encoders that are off by so many standard deviations count half");
}

void AddFrameMatcher(FrameMatcherOptions* o, ParameterSet* set) {
  AddSearchGrid("frame", &o->grid, set);
  set->AddDegrees("frame/field_of_view_deg", &o->field_of_view, {1.0, 360.0},
                  "whole model of the current scan (beams 1 to 400 of the paper)");
  set->AddDegrees("frame/frontal_field_of_view_deg", &o->frontal_field_of_view, {1.0, 360.0},
                  "part of the previous model that is matched (beams 101 to 300 of the paper)");
  set->Add("frame/max_distance", &o->max_distance, "m", kPositive, "most that one point adds to e");
  set->Add("frame/edge_gain", &o->edge_gain, "-", kNotNegative,
           "weight of a beam whose edge fills the region of interest, beside 1 for each beam");
  set->Add("frame/range_stddev", &o->range_stddev, "m", kPositive,
           "standard deviation of a range, for the covariance");
}

}  // namespace

ParameterSet FusionParameters(ScanImageFusionOptions* o, ScanImageFusionNodeOptions* node) {
  ParameterSet set("scan_image_fusion");
  AddOdometryInput(&node->odometry, &set);
  set.Add("use_camera", &node->use_camera,
          "false: laser only, the image topics are not subscribed");
  set.Add("image_transport", &node->image_transport,
          "raw, compressed, or another transport of image_transport");
  AddSensorPose("laser", &node->laser, &set);
  AddSensorPose("camera", &node->camera, &set);
  set.Add("publish_mounts", &node->publish_mounts,
          "publish the poses of laser and camera that are given above as static transforms; not "
          "where others publish them");
  set.Add("min_range", &o->scan.min_range, "m", kNotNegative,
          "nearer hits are not used, beside the range_min of the scan");
  set.Add("max_range", &o->scan.max_range, "m", kPositive,
          "farther hits are not used, beside the range_max of the scan");
  set.AddDegrees("field_of_view_deg", &o->scan.field_of_view, {1.0, 360.0},
                 "beams used, around the robot's front");
  set.AddDegrees("min_beam_spacing_deg", &o->scan.min_beam_spacing, {0.0, 45.0},
                 "beams nearer to the last used one are left out");
  set.Add("max_image_age", &o->max_image_age, "s", kPositive,
          "between the stamps of an image and of the scan it is fused with");
  set.Add("camera_time_offset", &o->camera_time_offset, "s", {-10.0, 10.0},
          "added to the stamps of the images");
  set.Add("roi_below", &o->edges.roi_below, "m", kNotNegative,
          "how far the region of interest reaches below the laser's line on the wall");
  set.Add("roi_above", &o->edges.roi_above, "m", kNotNegative,
          "how far the region of interest reaches above the laser's line on the wall");
  set.Add("edge_threshold", &o->edges.edge_threshold, "grey levels", kPositive,
          "step that makes an edge pixel");
  set.Add("min_edge_length", &o->edges.min_edge_length, "m", kNotNegative,
          "vertical run that makes an edge");
  set.Add("min_edge_rows", &o->edges.min_edge_rows, "px", kNotNegative,
          "the same in rows of the picture");
  set.Add("column_tolerance", &o->edges.column_tolerance, "px", kPositive,
          "runs in columns so near to each other are one edge");
  set.Add(
      "max_edge_slant", &o->max_edge_slant, "m/rad", kPositive,
      "metres of wall in an angle of the view, range by the cosine of the incidence; farther and "
      "more grazing, the details of doors and posters run into one another: not used");
  set.Add("edge_bearing_stddev", &o->edge_bearing_stddev, "px", kPositive,
          "standard deviation of an edge's column, beside that of its fit");
  AddOdometryLimits(&o->odometry, &set);
  set.AllowLive({"odom_max_wait", "min_range", "max_range", "field_of_view_deg",
                 "min_beam_spacing_deg", "max_image_age", "camera_time_offset", "roi_below",
                 "roi_above", "edge_threshold", "min_edge_length", "min_edge_rows",
                 "column_tolerance", "max_edge_slant", "edge_bearing_stddev"});
  return set;
}

ParameterSet BoundedIcpParameters(BoundedIcpOptions* o, BoundedIcpNodeOptions* node) {
  ParameterSet set("bounded_icp");
  AddOdometryInput(&node->odometry, &set);
  set.AddChoice(
      "reference", &o->reference,
      {{"local_map", Reference::kLocalMap}, {"previous_frame", Reference::kPreviousFrame}},
      "what scans are matched with: local_map (all that was seen, refined below the grid "
      "step) or previous_frame (the letter of the paper)");
  set.Add("reference_distance", &o->reference_distance, "m", kPositive,
          "motions are told from a scan at most so far back");
  set.AddDegrees("reference_angle_deg", &o->reference_angle, {1.0, 180.0},
                 "motions are told from a scan at most so much turned");
  AddMotionBounds(&o->prediction.bounds, &set);
  set.Add("window/lateral_per_distance_without_encoders",
          &o->prediction.lateral_per_distance_without_encoders, "-", {0.0, 2.0},
          "sideways bound without encoders, as a fraction of D");
  AddMotionNoise(&o->prediction.noise, &set);
  AddLocalMapMatcher(&o->local_map_matcher, &set);
  AddFrameMatcher(&o->frame_matcher, &set);
  AddOdometryLimits(&o->prediction.odometry, &set);
  set.AllowLive({"odom_max_wait", "window/", "noise/", "edge_map/", "filter/", "refinement/"});
  return set;
}

std::vector<ParameterSet> SlamOptions::Parameters() {
  return {FusionParameters(&fusion, &fusion_node),
          BoundedIcpParameters(&bounded_icp, &bounded_icp_node),
          MapperParameters(&mapper, &loop_closer, &mapper_node)};
}

}  // namespace scan_image_slam
