// The part of MapperNode that saves and loads its map.

#include "scan_image_slam/core/mapping/map_file.h"
#include "scan_image_slam/core/mapping/state_file.h"
#include "scan_image_slam/ros/map_files.h"
#include "scan_image_slam/ros/mapper_node.h"

#include <chrono>
#include <filesystem>
#include <utility>

#include <ros/console.h>

namespace scan_image_slam {

namespace {

/// Draws the map, which takes a while.
Mapper Loaded(const MapState& state, const MapperOptions& options, const MapperNodeOptions& node) {
  Mapper mapper(options);
  mapper.Load(state, node.localization ? MapUse::kLocalize : MapUse::kContinue);
  return mapper;
}

}  // namespace

/// A map that was begun elsewhere, and where to keep it.
void MapperNode::StartWithStateFile(ros::NodeHandle node) {
  MapperNodeOptions& options = options_.node;
  if (options.state_file.empty()) {
    transform_publisher_.Set(options.odom_frame, Pose2());
    for (const auto& [needs, name] :
         {std::make_pair(options.localization, "localization"),
          std::make_pair(options.autosave_period > 0.0, "autosave_period")}) {
      if (needs) throw ParameterError(std::string("mapper/") + name + ": needs mapper/state_file");
    }
    return;
  }
  options.state_file = PathFrom(options.map_folder, options.state_file);
  if (options.localization || std::filesystem::exists(options.state_file)) {
    const MapState state = ReadState(options.state_file);
    Mapper loaded = Loaded(state, options_.mapper, options);
    TakeIn(state, &loaded, options.state_file);
    changed_ = false;
  } else {
    ROS_WARN_STREAM("there is no " << options.state_file << ": the map begins empty");
    transform_publisher_.Set(options.odom_frame, Pose2());
  }
  if (options.localization || options.autosave_period <= 0.0) return;
  autosave_timer_ = node.createWallTimer(ros::WallDuration(options.autosave_period),
                                         [this](const ros::WallTimerEvent&) { Autosave(); });
}

/// `loaded` takes what was there before, to be thrown away where nothing waits for that.
void MapperNode::TakeIn(const MapState& state, Mapper* loaded, const std::string& path) {
  loaded->SetOptions(options_.mapper);
  std::swap(mapper_, *loaded);
  back_end_.Load(state.graph);
  StartOver();
  changed_ = true;
  ROS_INFO_STREAM(path << ": " << state.graph.keyframes.size() << " keyframes, "
                       << state.drawn.size() << " scans");
}

/// Writes in the back-end's thread. A file that could not be written is told, and tried again.
void MapperNode::Autosave() {
  constexpr std::chrono::seconds kNow(0);
  if (autosaved_.valid() && autosaved_.wait_for(kNow) != std::future_status::ready) return;
  FinishAutosave();
  if (!changed_ || !mapper_.growing()) return;
  changed_ = false;
  autosaved_ = back_end_.Save(mapper_.State(), options_.node.state_file);
}

/// Waits for a file that is being written.
void MapperNode::FinishAutosave() {
  if (!autosaved_.valid()) return;
  std::string problem;
  try {
    problem = autosaved_.get();
  } catch (const std::future_error& error) {
    problem = error.what();
  }
  watch_.SetProblem("autosave", problem);
  if (problem.empty()) return;
  changed_ = true;
  ROS_ERROR_STREAM("autosave: " << problem);
}

MapperNode::~MapperNode() {
  if (options_.node.localization || options_.node.autosave_period <= 0.0) return;
  try {
    FinishAutosave();
    Autosave();
    FinishAutosave();
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM("autosave: " << error.what());
  }
}

void MapperNode::AdvertiseFileServices() {
  files_.Advertise<SaveMapRequest, SaveMapResponse>(
      "save_map", [this](auto& request, auto& response) { return SaveMap(request, response); });
  files_.Advertise<StateFileRequest, StateFileResponse>(
      "save_state", [this](auto& request, auto& response) { return SaveState(request, response); });
  files_.Advertise<StateFileRequest, StateFileResponse>(
      "load_state", [this](auto& request, auto& response) { return LoadState(request, response); });
}

bool MapperNode::SaveMap(SaveMapRequest& request, SaveMapResponse& response) {
  try {
    OccupancyGrid grid{OccupancyGridOptions()};
    std::string stem;
    files_.InNodeThread([&] {
      grid = mapper_.grid();
      stem = PathInside(options_.node.map_folder, request.name);
    });
    const MapImage map = ToMapImage(grid);
    if (map.width == 0) throw std::runtime_error("there is no map yet");
    response.path = WriteMap(map, stem);
    response.success = true;
  } catch (const std::exception& error) {
    response.success = false;
    response.message = error.what();
    ROS_ERROR_STREAM("save_map: " << error.what());
  }
  return true;
}

bool MapperNode::SaveState(StateFileRequest& request, StateFileResponse& response) {
  try {
    std::future<std::string> written;
    files_.InNodeThread([&] {
      response.path = PathInside(options_.node.map_folder, request.path);
      written = back_end_.Save(mapper_.State(), response.path);
    });
    response.message = written.get();
    response.success = response.message.empty();
    if (!response.success) ROS_ERROR_STREAM("save_state: " << response.message);
  } catch (const std::exception& error) {
    response.message = error.what();
    ROS_ERROR_STREAM("save_state: " << error.what());
  }
  return true;
}

bool MapperNode::LoadState(StateFileRequest& request, StateFileResponse& response) {
  try {
    Options options;
    files_.InNodeThread([&] { options = options_; });
    response.path = PathFrom(options.node.map_folder, request.path);
    MapState state = ReadState(response.path);
    state.chain = KnownChain();  // who loads another map has a reason to look for the robot
    Mapper loaded = Loaded(state, options.mapper, options.node);
    files_.InNodeThread([&] { TakeIn(state, &loaded, response.path); });
    response.success = true;
  } catch (const std::exception& error) {
    response.message = error.what();
    ROS_ERROR_STREAM("load_state: " << error.what());
  }
  return true;
}

}  // namespace scan_image_slam
