#include "bag_report.h"

#include "scan_image_slam/core/recording/number_text.h"
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/sensor_frames.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <sstream>

namespace scan_image_slam {
namespace {

const char kIndent[] = "\n               ";

std::string DateText(const ros::Time& time) {
  const std::time_t seconds = static_cast<std::time_t>(time.sec);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &parts);
  return text;
}

std::string Paragraph(const std::string& head, const std::string& text) {
  std::string line = "  " + head;
  line.resize(std::max<std::size_t>(line.size(), sizeof kIndent - 2), ' ');
  return line + text + "\n";
}

std::string TopicText(const std::string& name, const RecordedTopic& topic) {
  std::string text = name + ": " + CountText(topic.messages, "message");
  if (topic.stamps.Rate() > 0.0) text += ", " + NumberText(topic.stamps.Rate(), 1) + " Hz";
  if (topic.stamps.MeanRate() < 0.8 * topic.stamps.Rate()) {
    text += " mostly, " + NumberText(topic.stamps.MeanRate(), 1) + " Hz on average";
  }
  if (topic.stamps.usable() > 0) {
    const double delay = topic.stamps.Delay();
    text += ", recorded " + DurationText(std::abs(delay)) + (delay < 0.0 ? " before" : " after") +
            " their stamps";
  }
  return text + ", frame " + (topic.frame.empty() ? "not named" : topic.frame);
}

std::string PositionText(const Eigen::Isometry3d& pose, const std::string& base) {
  const auto& t = pose.translation();
  const auto side = [](double value, const char* positive, const char* negative) {
    return NumberText(std::abs(value), 3) + " m " + (value < 0.0 ? negative : positive);
  };
  return side(t.x(), "ahead", "behind") + ", " + side(t.y(), "left", "right") + ", " +
         side(t.z(), "above", "below") + " of " + base;
}

std::string LaserText(const Eigen::Isometry3d& pose, const std::string& base) {
  const double yaw = Degrees(ToPose2(pose).theta);
  return PositionText(pose, base) + ", turned " + NumberText(yaw, 1) + " deg" +
         (pose.linear()(2, 2) < 0.0 ? ", upside down" : "");
}

Eigen::Vector3d OpticalAxis(const Eigen::Isometry3d& pose) { return pose.linear().col(2); }

std::string CameraText(const Eigen::Isometry3d& pose, const std::string& base) {
  const Eigen::Vector3d axis = OpticalAxis(pose);
  return PositionText(pose, base) + ", looking " +
         NumberText(Degrees(std::atan2(axis.y(), axis.x())), 1) + " deg left and " +
         NumberText(Degrees(-std::asin(axis.z())), 1) + " deg down";
}

std::string TransformsText(const RecordedTransforms& transforms) {
  constexpr std::size_t kMost = 12;
  std::string text;
  const auto links = transforms.Links();
  for (std::size_t i = 0; i < links.size() && i < kMost; ++i) {
    text += (i == 0       ? ""
             : i % 3 == 0 ? "," + std::string(kIndent)
                          : ", ") +
            links[i]->parent + " -> " + links[i]->child + (links[i]->Moves() ? " (moves)" : "");
  }
  if (links.size() > kMost) text += " and " + std::to_string(links.size() - kMost) + " more";
  return text.empty() ? "none" : text;
}

std::string OthersText(const BagContents& contents, const BagPlan& plan) {
  constexpr std::size_t kMost = 5;
  std::vector<std::string> names;
  for (const auto& [name, topic] : contents.topics) {
    const bool used = name == plan.scan || name == plan.image || name == plan.camera_info ||
                      name == plan.odom || name == "/tf" || name == "/tf_static";
    if (!used) names.push_back(name);
  }
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMost; ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > kMost) text += " and " + std::to_string(names.size() - kMost) + " more";
  return text;
}

void Append(const Findings& more, Findings* findings) {
  findings->insert(findings->end(), more.begin(), more.end());
}

/// What is the same for all topics.
Findings CheckTopic(const std::string& name, const RecordedTopic& topic) {
  Findings findings = CheckStamps(name, topic.stamps);
  for (const auto& [reason, count] : topic.refused) {
    findings.push_back({Severity::kWarning,
                        name + ": " + CountText(static_cast<std::size_t>(count), "message") +
                            " can't be used: " + reason,
                        "mend the driver"});
  }
  if (topic.frames.size() > 1) {
    findings.push_back({Severity::kWarning,
                        name + ": its messages name " + std::to_string(topic.frames.size()) +
                            " frames; all are taken to be in " + topic.frame,
                        "give each sensor a topic of its own"});
  }
  if (topic.frame.empty()) {
    findings.push_back(
        {Severity::kWarning, name + ": header.frame_id is empty", "set the driver's frame_id"});
  }
  return findings;
}

/// Of any quaternion, as this is only told.
double Yaw(const geometry_msgs::Quaternion& q) {
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
}

Finding Disagreement(const RecordedTransforms::Link& link) {
  std::string text = "transform " + link.parent + " -> " + link.child + " takes " +
                     std::to_string(link.values.size()) + " values:";
  for (const auto& [transform, times] : link.values) {
    const auto& t = transform.translation;
    text += (&transform == &link.values.front().transform ? " " : "; ") +
            ("x " + NumberText(t.x, 3) + ", y " + NumberText(t.y, 3) + ", z " + NumberText(t.z, 3) +
             " m, yaw " + NumberText(Degrees(Yaw(transform.rotation)), 1) + " deg (" +
             CountText(times, "time") + ")");
  }
  return {Severity::kWarning, text + "; the most frequent one is used",
          "let only one program publish it, with the right value"};
}

Findings CheckFrames(const BagContents& contents, const BagPlan& plan) {
  Findings findings;
  for (const RecordedTransforms::Link* link : contents.transforms.Links()) {
    if (link->Disagrees()) findings.push_back(Disagreement(*link));
    const auto parents = contents.transforms.LinksTo(link->child);
    if (parents.size() < 2 || parents.front() != link) continue;
    findings.push_back({Severity::kWarning,
                        "frame " + link->child + " has several parents: " + parents[0]->parent +
                            ", " + parents[1]->parent,
                        "only one program may publish the transform to a frame"});
  }
  for (const RecordedTransforms::Link* link : contents.transforms.LinksTo(plan.odom_frame)) {
    findings.push_back(
        {Severity::kNote,
         "the bag holds " + link->parent + " -> " + link->child + " of another program",
         "nothing: it is not used, and bag.launch keeps it out"});
  }
  if (!plan.odom.empty() &&
      !LookUpSensor(*contents.mounts, plan.odom_frame, plan.base_frame).found) {
    findings.push_back({Severity::kNote,
                        "there is no transform " + plan.odom_frame + " -> " + plan.base_frame +
                            ": mapping does without, but rviz can't show the robot in the map",
                        "record /tf"});
  }
  if (plan.base_from_camera && std::abs(OpticalAxis(*plan.base_from_camera).z()) > 0.87) {
    findings.push_back({Severity::kWarning, "the camera looks straight up or down by its transform",
                        "header.frame_id of camera_info must name the optical frame: z forward, x "
                        "right, y down"});
  }
  return findings;
}

bool IsImage(const RecordedTopic& topic) {
  return topic.type == kImageType || topic.type == kCompressedImageType;
}

/// Of each kind of sensor the topic that is used, or all, as one wants to know why none is.
std::vector<std::string> TopicsToCheck(const BagContents& contents, const BagPlan& plan) {
  std::vector<std::string> names;
  for (const auto& [name, topic] : contents.topics) {
    const std::string* used = topic.type == kScanType       ? &plan.scan
                              : topic.type == kOdometryType ? &plan.odom
                              : IsImage(topic)              ? &plan.image
                                                            : nullptr;
    if (used != nullptr && (used->empty() || *used == name)) names.push_back(name);
  }
  return names;
}

}  // namespace

std::string DescribeContents(const BagContents& contents, const BagPlan& plan) {
  std::ostringstream text;
  text << contents.path << ": " << DurationText(contents.end.toSec() - contents.begin.toSec())
       << ", " << NumberText(contents.megabytes, 1) << " MB, from " << DateText(contents.begin)
       << "\n";
  const auto describe = [&](const char* head, const std::string& name, const std::string& more) {
    if (name.empty()) {
      text << Paragraph(head, "none");
      return;
    }
    text << Paragraph(
        head, TopicText(name, contents.topics.at(name)) + (more.empty() ? "" : kIndent + more));
  };
  const auto topic = [&](const std::string& name) -> const RecordedTopic& {
    static const RecordedTopic kNone;
    return name.empty() ? kNone : contents.topics.at(name);
  };
  describe("scans", plan.scan, plan.usable() ? DescribeScans(topic(plan.scan).scans) : "");
  describe("encoders", plan.odom,
           NumberText(topic(plan.odom).odometry.way(), 1) + " m driven, " +
               NumberText(Degrees(topic(plan.odom).odometry.turned()), 0) + " deg turned, " +
               plan.odom_frame + " -> " + topic(plan.odom).child_frame);
  describe("images", plan.image, DescribeImages(topic(plan.image).images));
  if (!plan.camera_info.empty()) {
    describe("calibration", plan.camera_info,
             DescribeCalibration(*topic(plan.camera_info).calibration.intrinsics));
  }
  text << Paragraph("transforms", TransformsText(contents.transforms));
  if (plan.base_from_laser) {
    text << Paragraph("laser", LaserText(*plan.base_from_laser, plan.base_frame));
  }
  if (plan.base_from_camera) {
    text << Paragraph("camera", CameraText(*plan.base_from_camera, plan.base_frame));
  }
  const std::string others = OthersText(contents, plan);
  if (!others.empty()) text << Paragraph("not used", others);
  return text.str();
}

Findings CheckContents(const BagContents& contents, const BagPlan& plan) {
  Findings findings = plan.findings;
  const StampRecord* scans = plan.usable() ? &contents.topics.at(plan.scan).stamps : nullptr;
  for (const std::string& name : TopicsToCheck(contents, plan)) {
    const RecordedTopic& topic = contents.topics.at(name);
    Append(CheckTopic(name, topic), &findings);
    if (scans != nullptr && name != plan.scan) {
      Append(CompareStamps(plan.scan, *scans, name, topic.stamps), &findings);
    }
    if (IsImage(topic)) Append(CheckImages(name, topic.images), &findings);
  }
  if (plan.usable()) {
    Append(CheckRecordingClock(plan.scan, *scans), &findings);
    Append(CheckScans(plan.scan, contents.topics.at(plan.scan).scans, scans->Period()), &findings);
    Append(CheckFrames(contents, plan), &findings);
  }
  if (!plan.odom.empty()) {
    const RecordedTopic& topic = contents.topics.at(plan.odom);
    Append(CheckOdometry(plan.odom, topic.odometry, topic.stamps.first()), &findings);
  }
  if (!plan.image.empty()) {
    Append(CheckCalibration(plan.camera_info, contents.topics.at(plan.camera_info).calibration,
                            contents.topics.at(plan.image).images),
           &findings);
  }
  std::stable_sort(findings.begin(), findings.end(),
                   [](const Finding& a, const Finding& b) { return a.severity < b.severity; });
  return findings;
}

std::string FindingsText(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    const char* name = finding.severity == Severity::kError     ? "error"
                       : finding.severity == Severity::kWarning ? "warning"
                                                                : "note";
    text += "  " + std::string(name) + ": " + finding.text + "\n";
    if (!finding.advice.empty()) text += "    -> " + finding.advice + "\n";
  }
  return text;
}

}  // namespace scan_image_slam
