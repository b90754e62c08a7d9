#include "bag_plan.h"

#include "scan_image_slam/core/config/slam_parameters.h"
#include "scan_image_slam/core/fusion/scan_model.h"
#include "scan_image_slam/core/recording/number_text.h"
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/sensor_frames.h"

#include <algorithm>

namespace scan_image_slam {
namespace {

bool EndsWith(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

std::string Folder(const std::string& topic) { return topic.substr(0, topic.rfind('/')); }

/// Plans step by step: laser, encoders, base, camera.
class Planner {
 public:
  Planner(const BagContents& contents, const BagTopics& wanted)
      : contents_(contents), wanted_(wanted) {}

  BagPlan Plan() {
    ChooseScans();
    if (!plan_.usable()) return plan_;
    ChooseEncoders();
    ChooseBase();
    PlaceLaser();
    if (plan_.usable()) ChooseCamera();
    return plan_;
  }

 private:
  using Usable = std::function<std::size_t(const RecordedTopic&)>;

  void Tell(Severity severity, const std::string& text, const std::string& advice) {
    plan_.findings.push_back({severity, text, advice});
  }

  /// The wanted topic, or the usual one, or the one that holds most.
  std::string Choose(const std::string& wanted, const std::string& usual,
                     const std::vector<std::string>& names, const Usable& usable) const {
    if (!wanted.empty()) {
      std::string name = WithSlash(wanted);
      if (std::find(names.begin(), names.end(), name) != names.end()) return name;
      throw BagError(contents_.path + ": there is no topic " + wanted + " of the type expected");
    }
    std::string best;
    std::size_t most = 0;
    for (const std::string& name : names) {
      const std::size_t count = usable(contents_.topics.at(name));
      if (name == usual && count > 0) return name;
      if (count > most) {
        most = count;
        best = name;
      }
    }
    return best;
  }

  void TellOthers(const std::vector<std::string>& names, const std::string& chosen,
                  const std::string& option) {
    std::string others;
    for (const std::string& name : names) {
      if (name != chosen) others += (others.empty() ? "" : ", ") + name;
    }
    if (others.empty()) return;
    Tell(Severity::kNote, chosen + " is used, not " + others, "choose with " + option);
  }

  void ChooseScans() {
    const std::vector<std::string> names = contents_.TopicsOfType(kScanType);
    plan_.scan = Choose(wanted_.scan, "/scan", names,
                        [](const RecordedTopic& topic) { return topic.scans.scans(); });
    if (!plan_.scan.empty() && Scans().scans.scans() == 0) plan_.scan.clear();
    if (plan_.usable()) {
      TellOthers(names, plan_.scan, "--scan-topic");
      return;
    }
    Tell(Severity::kError,
         names.empty() ? "there are no scans: no topic of type sensor_msgs/LaserScan"
                       : "none of the scans can be used",
         "record the laser's topic, e.g. with record.launch; point clouds are not taken");
  }

  void ChooseEncoders() {
    const std::vector<std::string> names = contents_.TopicsOfType(kOdometryType);
    plan_.odom = Choose(wanted_.odom, "/odom", names,
                        [](const RecordedTopic& topic) { return topic.stamps.usable(); });
    const RecordedTopic* topic = plan_.odom.empty() ? nullptr : &contents_.topics.at(plan_.odom);
    if (topic != nullptr && !Overlaps(topic->stamps)) {
      plan_.odom.clear();
      topic = nullptr;
    }
    const RecordedTransforms::Link* link = contents_.transforms.MovingLinkAbove(Scans().frame);
    plan_.odom_frame = topic != nullptr ? topic->frame : link != nullptr ? link->parent : "";
    if (plan_.odom_frame.empty()) plan_.odom_frame = OdometryInput{}.odom_frame;
    if (topic != nullptr) {
      TellOthers(names, plan_.odom, "--odom-topic");
      return;
    }
    const bool has_transform =
        link != nullptr && link->parent != MapperNodeOptions{}.map_frame && Overlaps(link->stamps);
    if (!names.empty()) {
      plan_.odom_source = has_transform ? OdometrySource::kTf : OdometrySource::kNone;
    }
    if (has_transform) {
      Tell(Severity::kNote,
           "no odometry topic is used: the encoders are taken from the transform " + link->parent +
               " -> " + link->child,
           "");
    } else {
      Tell(Severity::kWarning, "there are no encoders: the robot is taken to keep its velocity",
           "record the base's odometry (nav_msgs/Odometry) or its transform odom -> base_link; "
           "without, quick turns and corridors may be lost");
    }
  }

  bool Overlaps(const StampRecord& stamps) const {
    const StampRecord& scans = Scans().stamps;
    return stamps.usable() > 1 && stamps.first() <= scans.last() && stamps.last() >= scans.first();
  }

  void ChooseBase() {
    const std::string usual = OdometryInput{}.base_frame;
    const std::string driven =
        plan_.odom.empty() ? "" : contents_.topics.at(plan_.odom).child_frame;
    const RecordedTransforms::Link* link = contents_.transforms.MovingLinkAbove(Scans().frame);
    std::vector<std::string> candidates = {usual, driven, "base_footprint",
                                           link == nullptr ? "" : link->child};
    // Where base_link is not what the encoders measure, the robot would swing round the wrong
    // point.
    if (!driven.empty() && !SamePlace(usual, driven)) std::swap(candidates[0], candidates[1]);
    for (const std::string& frame : candidates) {
      if (frame.empty() || !LookUp(frame, Scans().frame).found) continue;
      plan_.base_frame = frame;
      return;
    }
    plan_.place_of_laser_known = false;
    for (const std::string& frame : {driven, link == nullptr ? "" : link->child, usual}) {
      if (plan_.base_frame.empty()) plan_.base_frame = frame;
    }
    if (plan_.odom.empty() && contents_.transforms.empty() && !Scans().frame.empty()) {
      plan_.base_frame = Scans().frame;  // nothing else is in the bag
      plan_.place_of_laser_known = true;
    }
  }

  FrameLookup LookUp(const std::string& base, const std::string& sensor) const {
    return LookUpSensor(*contents_.mounts, base, sensor);
  }

  /// Of two frames, in the plane, as far as that is known.
  bool SamePlace(const std::string& a, const std::string& b) const {
    const FrameLookup lookup = LookUp(a, b);
    if (!lookup.found) return true;
    const Pose2 pose = ToPose2(lookup.base_from_sensor);
    return pose.translation().norm() < 0.005 && std::abs(pose.theta) < 0.005;
  }

  void PlaceLaser() {
    if (!plan_.place_of_laser_known) {
      Tell(Severity::kWarning,
           "laser: " + LookUp(plan_.base_frame, Scans().frame).problem +
               "; it is taken to be at the base, looking forward",
           "write its place into robot.yaml (first line below), and record /tf and /tf_static");
      return;
    }
    plan_.base_from_laser = LookUp(plan_.base_frame, Scans().frame).base_from_sensor;
    try {
      LaserMount::From(*plan_.base_from_laser);
    } catch (const std::invalid_argument& error) {
      Tell(Severity::kError, plan_.scan + ": " + error.what(),
           "correct the transform " + plan_.base_frame + " -> " + Scans().frame);
      plan_.scan.clear();
    }
  }

  void ChooseCamera() {
    const std::vector<std::string> names = contents_.ImageTopics();
    if (names.empty()) {
      Tell(Severity::kNote, "there are no images: laser and encoders only",
           "in corridors the camera tells how far the robot has come");
      return;
    }
    const auto readable = [](const RecordedTopic& topic) {
      return static_cast<std::size_t>(topic.images.readable()) * topic.stamps.usable();
    };
    std::string usual = "/image_raw";
    if (std::find(names.begin(), names.end(), usual) == names.end()) usual += kCompressedEnding;
    std::string wanted = WithSlash(wanted_.image);
    if (!wanted.empty() && contents_.topics.count(wanted) == 0) wanted += kCompressedEnding;
    plan_.image = Choose(wanted, usual, names, readable);
    std::optional<Finding> problem =
        plan_.image.empty() ? Problem("none of the images can be used", "") : CameraProblem();
    if (!problem) {
      TellOthers(names, plan_.image, "--image-topic");
      CheckLiveCamera();
      return;
    }
    plan_.image.clear();
    plan_.camera_info.clear();
    plan_.findings.push_back(*problem);
  }

  void CheckLiveCamera() {
    const bool compressed = contents_.topics.at(plan_.image).type == kCompressedImageType;
    plan_.camera_works_live = !compressed || EndsWith(plan_.image, kCompressedEnding);
    if (plan_.camera_works_live) return;
    Tell(Severity::kNote,
         plan_.image + ": bag.launch can't play it, as its name does not end in " +
             kCompressedEnding,
         "");
  }

  static Finding Problem(const std::string& text, const std::string& advice) {
    return {Severity::kError, "the images are left out: " + text, advice};
  }

  /// Finds calibration and place of the camera. Says why it can't be used, if so.
  std::optional<Finding> CameraProblem() {
    const RecordedTopic& images = contents_.topics.at(plan_.image);
    const std::vector<std::string> infos = contents_.TopicsOfType(kCameraInfoType);
    if (infos.empty()) {
      return Problem("there is no calibration (no topic of type sensor_msgs/CameraInfo)",
                     "record camera_info beside the images");
    }
    if (!Overlaps(images.stamps)) {
      return Problem(plan_.image + " has no time in common with " + plan_.scan,
                     "synchronise the clocks");
    }
    // Images and camera_info of a camera are neighbours.
    std::string folder = Folder(plan_.image);
    if (EndsWith(plan_.image, kCompressedEnding)) folder = Folder(folder);
    plan_.camera_info = Choose(wanted_.camera_info, folder + "/camera_info", infos,
                               [](const RecordedTopic& topic) { return topic.messages; });
    const RecordedTopic& info = contents_.topics.at(plan_.camera_info);
    for (const Finding& finding :
         CheckCalibration(plan_.camera_info, info.calibration, images.images)) {
      if (finding.severity == Severity::kError) return Problem(finding.text, finding.advice);
    }
    const FrameLookup camera = LookUp(plan_.base_frame, info.frame);
    if (!camera.found) {
      return Problem("camera: " + camera.problem,
                     "record /tf_static; or write the camera's place into a configuration "
                     "(scan_image_fusion/camera/from_tf: false, x, y, z, pitch_deg, yaw_deg), let "
                     "calibrate_camera_laser correct it, and give it instead of --no-images");
    }
    plan_.base_from_camera = camera.base_from_sensor;
    return std::nullopt;
  }

  const RecordedTopic& Scans() const { return contents_.topics.at(plan_.scan); }

  const BagContents& contents_;
  const BagTopics& wanted_;
  BagPlan plan_;
};

}  // namespace

BagPlan MakeBagPlan(const BagContents& contents, const BagTopics& wanted) {
  return Planner(contents, wanted).Plan();
}

}  // namespace scan_image_slam
