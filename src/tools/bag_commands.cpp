#include "bag_commands.h"

#include <filesystem>

namespace scan_image_slam {
namespace {

const char kConfig[] = "robot.yaml";  // written where the laser's place is not known

/// For the shell, in quotes only where it must be.
std::string Quoted(const std::string& word) {
  const std::string plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:=,+@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// One line: a command and its options.
class Line {
 public:
  explicit Line(std::string command) : text_(std::move(command)) {}
  Line& Add(const std::string& word) {
    text_ += " " + Quoted(word);
    return *this;
  }
  /// Only if the value is not the usual one.
  void AddOther(const std::string& option, const std::string& value, const std::string& usual) {
    if (value != usual) Add(option).Add(value);
  }
  void SetOther(const std::string& argument, const std::string& value, const std::string& usual) {
    if (value != usual) Add(argument + ":=" + value);
  }
  void AddAsIs(const std::string& text) { text_ += " " + text; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string SourceName(OdometrySource source) {
  return source == OdometrySource::kTf ? "tf" : source == OdometrySource::kNone ? "none" : "auto";
}

std::string Offline(const BagContents& contents, const BagPlan& plan, const std::string& program) {
  const OdometryInput usual;
  Line line(program);
  line.Add("--bag").Add(contents.path).Add("--out").Add("results");
  line.AddOther("--scan-topic", plan.scan, "/scan");
  if (!plan.odom.empty()) line.AddOther("--odom-topic", plan.odom, "/odom");
  if (plan.image.empty()) {
    if (!contents.ImageTopics().empty()) line.Add("--no-images");
  } else {
    // Raw images are preferred by themselves.
    const std::string raw = "/image_raw";
    line.AddOther("--image-topic", plan.image,
                  contents.topics.count(raw) != 0 ? raw : raw + kCompressedEnding);
    line.AddOther("--camera-info-topic", plan.camera_info, "/camera_info");
  }
  line.AddOther("--base-frame", plan.base_frame, usual.base_frame);
  if (plan.odom.empty() && plan.odom_frame != usual.odom_frame) {
    line.Add("--set").Add("scan_image_fusion/odom_frame=" + plan.odom_frame);
  }
  if (plan.odom_source != OdometrySource::kAuto) {
    line.Add("--set").Add("scan_image_fusion/odom_source=" + SourceName(plan.odom_source));
  }
  if (!plan.place_of_laser_known) line.Add("--config").Add(kConfig);
  return line.text();
}

void AddLiveCamera(const BagContents& contents, const BagPlan& plan, Line* line) {
  if (plan.image.empty() || !plan.camera_works_live) {
    line->Add("use_camera:=false");
    return;
  }
  if (contents.topics.at(plan.image).type == kCompressedImageType) {
    line->SetOther("image_topic", plan.image.substr(0, plan.image.rfind('/')), "/image_raw");
  } else {
    line->SetOther("image_topic", plan.image, "/image_raw");
    line->Add("image_transport:=raw");
  }
  line->SetOther("camera_info_topic", plan.camera_info, "/camera_info");
}

std::string Live(const BagContents& contents, const BagPlan& plan) {
  const OdometryInput usual;
  Line line("roslaunch scan_image_slam bag.launch");
  line.Add("bag:=" + std::filesystem::absolute(contents.path).lexically_normal().string());
  line.SetOther("scan_topic", plan.scan, "/scan");
  if (!plan.odom.empty()) line.SetOther("odom_topic", plan.odom, "/odom");
  AddLiveCamera(contents, plan, &line);
  line.SetOther("base_frame", plan.base_frame, usual.base_frame);
  line.SetOther("odom_frame", plan.odom_frame, usual.odom_frame);
  line.SetOther("odom_source", SourceName(plan.odom_source), "auto");
  if (!plan.place_of_laser_known) line.AddAsIs(std::string("config:=$PWD/") + kConfig);
  return line.text();
}

}  // namespace

BagTopics PlannedTopics(const BagPlan& plan) {
  BagTopics topics;
  topics.scan = plan.scan;
  topics.odom = plan.odom;
  topics.image = plan.image;
  topics.camera_info = plan.camera_info;
  topics.use_images = !plan.image.empty();
  return topics;
}

SlamOptions PlannedOptions(const BagPlan& plan) {
  SlamOptions options;
  options.fusion_node.odometry.base_frame = plan.base_frame;
  options.fusion_node.odometry.odom_frame = plan.odom_frame;
  options.fusion_node.odometry.source = plan.odom_source;
  options.fusion_node.laser.from_tf = plan.place_of_laser_known;
  return options;
}

std::vector<std::string> CommandLines(const BagContents& contents, const BagPlan& plan,
                                      const std::string& slam_offline) {
  std::vector<std::string> lines;
  if (!plan.place_of_laser_known) {
    lines.push_back(
        "echo 'scan_image_fusion: {laser: {from_tf: false, x: 0.0, y: 0.0, yaw_deg: 0.0}}' > " +
        std::string(kConfig));
  }
  lines.push_back(Offline(contents, plan, slam_offline));
  lines.push_back(Live(contents, plan));
  return lines;
}

}  // namespace scan_image_slam
