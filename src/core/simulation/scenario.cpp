#include "scan_image_slam/core/simulation/scenario.h"

#include "option_fields.h"
#include "scan_image_slam/core/simulation/world_loader.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace scan_image_slam {
namespace {

constexpr int kDeepestInclude = 8;
constexpr double kLongest = 1e5;  // of a run [s]

RobotPath ReadPath(YamlSection& section) {
  RobotPath path;
  path.name = section.Text("name", path.name);
  const Eigen::Vector2d start = section.Point("start");
  path.start = {start.x(), start.y(), section.Number("heading_deg", -360.0, 360.0, 0.0) * kDegree};
  for (const std::vector<double>& row : section.Table("way_points", 2, -1e4, 1e4)) {
    path.way_points.emplace_back(row[0], row[1]);
  }
  FieldReader field(section);
  field.Number("speed", path.speed, 0.01, 20.0);
  field.Angle("turn_rate_deg", path.turn_rate, 0.1, 720.0);
  field.Number("acceleration", path.acceleration, 0.01, 20.0);
  field.Number("corner_radius", path.corner_radius, 0.0, 100.0);
  field.Number("start_pause", path.start_pause, 0.0, 1e4);
  field.Number("end_pause", path.end_pause, 0.0, 1e4);
  section.Done();
  try {
    MakeLegs(path);
  } catch (const std::invalid_argument& error) {
    section.Fail("way_points", error.what());
  }
  return path;
}

Fault ReadFault(YamlSection& section) {
  static const std::vector<std::string> kNames = {
      "camera_off",     "camera_frozen",  "camera_black", "camera_overexposed",
      "camera_covered", "camera_delayed", "camera_clock", "laser_off",
      "encoders_off",   "encoders_reset", "encoders_slip"};
  Fault fault;
  section.Text("kind");
  fault.kind = static_cast<Fault::Kind>(section.Choice("kind", kNames, 0));
  fault.from = section.Number("from", 0.0, kLongest);
  if (fault.kind != Fault::Kind::kEncodersReset) {
    fault.to = section.Number("to", 0.0, kLongest);
    if (fault.to <= fault.from) section.Fail("to", "must be later than 'from'");
  }
  switch (fault.kind) {
    case Fault::Kind::kCameraDelayed:
      fault.value = section.Number("delay", 0.0, 60.0);
      break;
    case Fault::Kind::kCameraClock:
      fault.value = section.Number("offset", -1000.0, 1000.0);
      break;
    case Fault::Kind::kEncodersSlip:
      fault.value = section.Number("angle_deg", -3600.0, 3600.0) * kDegree;
      break;
    default:
      break;
  }
  section.Done();
  return fault;
}

template <typename Options>
void ReadOptions(YamlSection section, Options& options) {
  FieldReader reader(section);
  VisitFields(options, reader);
  section.Done();
  try {
    options.Validate();
  } catch (const std::invalid_argument& error) {
    section.Fail("", error.what());
  }
}

void ReadFile(const std::string& file, int depth, Scenario& scenario, NamedFaces& names) {
  YamlSection root = YamlSection::FromFile(file);
  if (root.Has("include")) {
    if (depth == kDeepestInclude) root.Fail("include", "goes too deep, or in a circle");
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    const std::string included = (folder / root.Text("include")).string();
    if (!std::filesystem::exists(included)) root.Fail("include", included + " does not exist");
    ReadFile(included, depth + 1, scenario, names);
  }
  root.Text("description", "-");
  ReadWorld(root, scenario.world, names);

  std::vector<RobotPath> paths;
  for (YamlSection& section : root.Children("paths")) paths.push_back(ReadPath(section));
  scenario.paths.insert(scenario.paths.begin(), paths.begin(), paths.end());

  YamlSection sensors = root.Child("sensors");
  ReadOptions(sensors.Child("laser"), scenario.laser);
  ReadOptions(sensors.Child("camera"), scenario.camera);
  ReadOptions(sensors.Child("base"), scenario.base);
  sensors.Done();
  for (YamlSection& section : root.Children("faults"))
    scenario.faults.push_back(ReadFault(section));
  root.Done();
  if (depth == 0 && scenario.paths.empty()) root.Fail("paths", "is missing");
}

}  // namespace

Scenario LoadScenario(const std::string& file) {
  Scenario scenario;
  NamedFaces names;
  ReadFile(file, 0, scenario, names);
  return scenario;
}

const RobotPath& FindPath(const Scenario& scenario, const std::string& name) {
  if (name.empty() && !scenario.paths.empty()) return scenario.paths.front();
  std::string known;
  for (const RobotPath& path : scenario.paths) {
    if (path.name == name) return path;
    known += (known.empty() ? "" : ", ") + path.name;
  }
  throw std::invalid_argument("there is no path '" + name + "', only: " + known);
}

}  // namespace scan_image_slam
