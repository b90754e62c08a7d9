// Writes a bag of the simulated robot's sensors, and beside it the truth.

#include "progress_line.h"
#include "run_tool.h"
#include "scan_image_slam/core/evaluation/trajectory.h"
#include "scan_image_slam/core/simulation/robot_simulation.h"
#include "scan_image_slam/ros/package_files.h"
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/simulation_messages.h"

#include <cstdint>
#include <filesystem>
#include <iostream>
#include <limits>

#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <rosbag/bag.h>
#include <sensor_msgs/CompressedImage.h>
#include <tf2_msgs/TFMessage.h>

namespace scan_image_slam {
namespace {

struct Arguments {
  std::string world;
  std::string out;
  std::string image_format = "jpeg";
  int jpeg_quality = 90;
  double duration = 0.0;
  bool no_images = false;
  bool encoder_errors = false;
  SimulationOptions options;
};

void Declare(CLI::App& app, Arguments& a) {
  app.add_option("--world", a.world, "world file, or name of a shipped one, e.g. corridor")
      ->required();
  app.add_option("--out", a.out, "bag to write; the truth goes beside it as .gt.tum")->required();
  app.add_option("--seed", a.options.seed, "of all random numbers")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()))
      ->capture_default_str();
  app.add_option("--duration", a.duration, "length [s]; without it, until the path is driven")
      ->check(CLI::Range(0.1, 1e5));
  app.add_option("--path", a.options.path, "path of the world file to drive; default the first");
  app.add_option("--rounds", a.options.rounds,
                 "drive the path so often: from its end on to its first way point")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_flag("--no-noise", a.options.ideal, "ideal sensors and encoders");
  app.add_flag("--encoder-errors", a.encoder_errors,
               "with --no-noise: encoders keep their errors of radius and wheel base");
  app.add_flag("--no-images", a.no_images, "no camera; the other sensors measure the same");
  app.add_option("--image-format", a.image_format,
                 "jpeg on /image_raw/compressed, or mono8, bgr8, bayer_rggb8 on /image_raw")
      ->check(CLI::IsMember({"jpeg", "mono8", "bgr8", "bayer_rggb8"}))
      ->capture_default_str();
  app.add_option("--jpeg-quality", a.jpeg_quality, "1 to 100")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
}

/// OUT.gt.tum for OUT.bag.
std::string TruthFile(const std::string& bag) {
  std::filesystem::path path(bag);
  if (path.extension() == ".bag") path.replace_extension();
  return path.string() + ".gt.tum";
}

/// Writes what the robot's computer would get; the truth is kept apart.
class BagWriter {
 public:
  BagWriter(const Arguments& arguments, const RobotSimulation& simulation, rosbag::Bag& bag)
      : arguments_(arguments), simulation_(simulation), bag_(bag) {
    WriteStaticTransforms();
  }

  void Write(const SensorEvent& event) {
    arrival_ = ToRosTime(event.arrival);
    std::visit([this](const auto& data) { Write(data); }, event.data);
  }

  const Trajectory& truth() const { return truth_; }

 private:
  void WriteStaticTransforms() {
    const Stamp start = arguments_.options.start;
    const tf2_msgs::TFMessage message = StaticTransforms(simulation_, start);
    // Without this header rosbag play would not latch the topic.
    auto header = boost::make_shared<ros::M_string>();
    (*header)["type"] = ros::message_traits::datatype(message);
    (*header)["md5sum"] = ros::message_traits::md5sum(message);
    (*header)["message_definition"] = ros::message_traits::definition(message);
    (*header)["latching"] = "1";
    bag_.write("/tf_static", ToRosTime(start), message, header);
  }

  void Write(const LaserScan& scan) {
    bag_.write("/scan", arrival_, ToMessage(scan, simulation_.scenario().laser.Period()));
  }

  void Write(const OdometryReading& reading) {
    bag_.write("/odom", arrival_, ToMessage(reading));
    tf2_msgs::TFMessage transforms;
    transforms.transforms.push_back(ToTransform(reading));
    bag_.write("/tf", arrival_, transforms);
  }

  void Write(const CameraFrame& frame) {
    const sensor_msgs::CameraInfo info = ToMessage(simulation_.camera_lens(), frame.stamp);
    if (arguments_.image_format == "jpeg") {
      sensor_msgs::CompressedImage image;
      image.header = info.header;
      const std::string encoding = EncodingName(frame.encoding);
      image.format = encoding + "; jpeg compressed " + encoding;
      cv::imencode(".jpg", frame.pixels, image.data,
                   {cv::IMWRITE_JPEG_QUALITY, arguments_.jpeg_quality});
      bag_.write("/image_raw/compressed", arrival_, image);
    } else {
      bag_.write("/image_raw", arrival_, ToMessage(frame));
    }
    bag_.write("/camera_info", arrival_, info);
  }

  void Write(const GroundTruth& truth) { truth_.push_back({truth.stamp, truth.world_from_base}); }

  const Arguments& arguments_;
  const RobotSimulation& simulation_;
  rosbag::Bag& bag_;
  Trajectory truth_;
  ros::Time arrival_;
};

void SetEncoding(const Arguments& arguments, Scenario& scenario) {
  if (arguments.image_format == "mono8") scenario.camera.encoding = ImageEncoding::kMono8;
  if (arguments.image_format == "bgr8") scenario.camera.encoding = ImageEncoding::kBgr8;
  if (arguments.image_format == "bayer_rggb8") {
    scenario.camera.encoding = ImageEncoding::kBayerRggb8;
  }
}

void Simulate(const Arguments& arguments, RobotSimulation& simulation) {
  rosbag::Bag bag;
  try {
    bag.open(arguments.out, rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error("cannot write " + arguments.out + ": " + error.what());
  }
  BagWriter writer(arguments, simulation, bag);
  ProgressLine progress("simulate");
  while (const std::optional<SensorEvent> event = simulation.Next()) {
    writer.Write(*event);
    progress.Show(simulation.progress());
  }
  progress.Finish();
  bag.close();
  WriteTumFile(TruthFile(arguments.out), writer.truth());
}

int Main(int argc, char** argv) {
  CLI::App app("Simulates a robot with a laser, a camera and wheel encoders; writes a bag.");
  Arguments arguments;
  Declare(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kSuccess : kWrongUsage;
  }
  arguments.options.images = !arguments.no_images;
  arguments.options.ideal_encoders = !arguments.encoder_errors;
  if (arguments.duration > 0.0) arguments.options.duration = arguments.duration;
  cv::setNumThreads(1);  // several runs may share the machine
  try {
    Scenario scenario = LoadScenario(FindWorld(arguments.world));
    SetEncoding(arguments, scenario);
    RobotSimulation simulation(std::move(scenario), arguments.options);
    Simulate(arguments, simulation);
  } catch (const std::invalid_argument& error) {  // e.g. an unknown path
    std::cerr << "simulate: " << error.what() << '\n';
    return kWrongUsage;
  } catch (const std::exception& error) {
    std::cerr << "simulate: " << error.what() << '\n';
    return kUnusableInput;
  }
  return kSuccess;
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) { return scan_image_slam::Main(argc, argv); }
