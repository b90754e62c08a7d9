#pragma once

#include "scan_image_slam/core/config/slam_parameters.h"
#include "scan_image_slam/core/mapping/back_end_thread.h"
#include "scan_image_slam/core/mapping/mapper.h"
#include "scan_image_slam/ros/busy_time.h"
#include "scan_image_slam/ros/input_watch.h"
#include "scan_image_slam/ros/live_parameters.h"
#include "scan_image_slam/ros/map_publisher.h"
#include "scan_image_slam/ros/path_publisher.h"
#include "scan_image_slam/ros/side_thread.h"
#include "scan_image_slam/ros/transform_publisher.h"
#include <scan_image_slam/IcpModel.h>
#include <scan_image_slam/SaveMap.h>
#include <scan_image_slam/ScanMatch.h>
#include <scan_image_slam/StateFile.h>

#include <future>
#include <memory>
#include <optional>
#include <string>

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <message_filters/subscriber.h>
#include <message_filters/time_synchronizer.h>
#include <nav_msgs/GetMap.h>
#include <nav_msgs/Path.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <std_srvs/Empty.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

namespace scan_image_slam {

/// Node around Mapper: `scan_match`, `icp_model` and `initialpose` in; `pose`, `trajectory`,
/// `encoder_trajectory`, `pose_graph`, `map`, `map_metadata`, `map_updates` and TF out; services
/// `dynamic_map`, `reset`, `pause`, `save_map`, `save_state` and `load_state`.
class MapperNode {
 public:
  /// Throws ParameterError or std::invalid_argument if the configuration is wrong.
  MapperNode(ros::NodeHandle node, ros::NodeHandle private_node);
  /// Saves the map a last time, if it is saved on its own at all.
  ~MapperNode();
  MapperNode(const MapperNode&) = delete;
  MapperNode& operator=(const MapperNode&) = delete;

 private:
  struct Options {
    MapperOptions mapper;
    LoopCloserOptions loop_closer;
    MapperNodeOptions node;
    ParameterSet Parameters() { return MapperParameters(&mapper, &loop_closer, &node); }
  };
  static Options ReadOptions(const ros::NodeHandle& private_node);
  void Take(const LiveParameters::Values& values);
  void OnMatch(const ScanMatchConstPtr& message);
  void OnMatchedModel(const IcpModelConstPtr& model,
                      const ros::MessageEvent<const ScanMatch>& match);
  std::shared_ptr<const Keyframe> Draw(const FusedModel& model, const MatchedMotion& match);
  void OnInitialPose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message);
  bool GetMap(nav_msgs::GetMap::Request& request, nav_msgs::GetMap::Response& response);
  bool Reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool Pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool SaveMap(SaveMapRequest& request, SaveMapResponse& response);
  bool SaveState(StateFileRequest& request, StateFileResponse& response);
  bool LoadState(StateFileRequest& request, StateFileResponse& response);
  void AdvertiseFileServices();
  void StartWithStateFile(ros::NodeHandle node);
  void TakeIn(const MapState& state, Mapper* loaded, const std::string& path);
  void Autosave();
  void FinishAutosave();
  void TakeTimeBack();
  void PublishPose(const MapPose& pose);
  /// Not only late: base_frame, which has its parent from them, must not get a second one.
  bool EncodersAreMissing(Stamp stamp);
  void ApplyNews();
  void ApplyLocation(const Location& location);
  void StartOver();
  void ResetMatching();
  void PublishMap();

  Options options_;
  Mapper mapper_;
  BackEndThread back_end_;
  std::optional<GraphState> graph_;
  bool trajectory_moved_ = false;  ///< the path is to be told anew, with the next map
  bool paused_ = false;
  bool has_encoders_ = false;
  std::optional<Stamp> without_encoders_since_;  ///< of the first pose
  std::optional<MapPose> last_pose_;
  double agreement_ = 0.0;  ///< of the last scan that was looked for in a loaded map [-]
  bool changed_ = false;    ///< the map, since it was last saved on its own
  std::future<std::string> autosaved_;  ///< valid while a file is being written
  InputWatch watch_;
  BusyTime map_time_;
  TransformPublisher transform_publisher_;
  MapPublisher map_publisher_;
  PathPublisher trajectory_;
  PathPublisher encoder_trajectory_;
  ros::Publisher pose_publisher_;
  ros::Publisher command_publisher_;
  ros::Publisher graph_publisher_;
  ros::ServiceServer get_map_service_;
  ros::ServiceServer reset_service_;
  ros::ServiceServer pause_service_;
  ros::Subscriber match_subscriber_;
  ros::Subscriber initial_pose_subscriber_;
  message_filters::Subscriber<IcpModel> paired_model_subscriber_;
  message_filters::Subscriber<ScanMatch> paired_match_subscriber_;
  message_filters::TimeSynchronizer<IcpModel, ScanMatch> pairs_;
  ros::WallTimer map_timer_;
  ros::WallTimer autosave_timer_;
  LiveParameters live_parameters_;
  SideThread files_;  ///< SaveMap, SaveState and LoadState run there
};

}  // namespace scan_image_slam
