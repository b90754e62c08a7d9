#include "scan_image_slam/core/evaluation/trajectory.h"

#include "scan_image_slam/core/evaluation/number_table.h"
#include "scan_image_slam/core/evaluation/stamp_text.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <locale>
#include <stdexcept>

namespace scan_image_slam {
namespace {

// Files with three decimals are common, files with a wrong column order are far off.
constexpr double kQuaternionTolerance = 0.01;

struct Quaternion {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double w = 1.0;

  double norm() const { return std::sqrt(x * x + y * y + z * z + w * w); }
  /// Heading of the x axis seen from above, for any norm.
  double yaw() const { return std::atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z); }
};

double YawAt(NumberTable& table, std::size_t column) {
  const Quaternion q{table.NumberAt(column), table.NumberAt(column + 1), table.NumberAt(column + 2),
                     table.NumberAt(column + 3)};
  if (std::abs(q.norm() - 1.0) > kQuaternionTolerance) {
    table.Fail("norm of the quaternion is " + std::to_string(q.norm()) + " instead of 1");
  }
  return q.yaw();
}

StampedPose ReadPose(NumberTable& table) {
  StampedPose pose;
  pose.stamp = table.StampAt(0);
  pose.pose.x = table.NumberAt(1);
  pose.pose.y = table.NumberAt(2);
  table.NumberAt(3);  // tz must be a number, too
  pose.pose.theta = YawAt(table, 4);
  return pose;
}

void RequireFinite(const StampedPose& pose) {
  if (IsFinite(pose.pose)) {
    return;
  }
  throw std::invalid_argument("pose at " + FormatStamp(pose.stamp) + " s is not finite");
}

[[noreturn]] void FailWithErrno(const std::string& what, const std::string& path) {
  throw std::runtime_error(what + " " + path + ": " + std::strerror(errno));
}

}  // namespace

Trajectory ReadTum(std::istream& input, const std::string& source) {
  NumberTable table(input, source, {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"});
  Trajectory trajectory;
  std::size_t previous_line = 0;
  while (table.Next()) {
    const StampedPose pose = ReadPose(table);
    if (!trajectory.empty() && pose.stamp <= trajectory.back().stamp) {
      table.Fail("timestamp " + FormatStamp(pose.stamp) + " does not increase: line " +
                 std::to_string(previous_line) + " has " + FormatStamp(trajectory.back().stamp));
    }
    trajectory.push_back(pose);
    previous_line = table.line_number();
  }
  if (trajectory.empty()) throw std::runtime_error(source + ": holds no poses");
  return trajectory;
}

Trajectory ReadTumFile(const std::string& path) {
  std::ifstream input(path);
  if (!input) FailWithErrno("cannot open", path);
  return ReadTum(input, path);
}

void WriteTum(std::ostream& output, const Trajectory& trajectory) {
  std::ostream text(output.rdbuf());  // leaves the caller's format and locale alone
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(9);
  for (const StampedPose& pose : trajectory) {
    RequireFinite(pose);
    const double half_angle = NormalizeAngle(pose.pose.theta) / 2.0;
    text << FormatStamp(pose.stamp) << ' ' << pose.pose.x << ' ' << pose.pose.y << ' ' << 0.0 << ' '
         << 0.0 << ' ' << 0.0 << ' ' << std::sin(half_angle) << ' ' << std::cos(half_angle) << '\n';
  }
  text.flush();
  if (!text) throw std::runtime_error("writing the trajectory failed");
}

void WriteTumFile(const std::string& path, const Trajectory& trajectory) {
  std::ofstream output(path);
  if (!output) FailWithErrno("cannot write", path);
  try {
    WriteTum(output, trajectory);
  } catch (const std::runtime_error&) {
    FailWithErrno("cannot write", path);
  }
}

}  // namespace scan_image_slam
