#include "scan_image_slam/core/simulation/robot_simulation.h"

#include "plain_world.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

std::vector<SensorEvent> EventsOf(const Scenario& scenario, const SimulationOptions& options) {
  RobotSimulation simulation(scenario, options);
  std::vector<SensorEvent> events;
  while (std::optional<SensorEvent> event = simulation.Next()) events.push_back(std::move(*event));
  return events;
}

template <typename Data>
std::vector<Data> Only(const std::vector<SensorEvent>& events) {
  std::vector<Data> chosen;
  for (const SensorEvent& event : events) {
    if (const Data* data = std::get_if<Data>(&event.data)) chosen.push_back(*data);
  }
  return chosen;
}

bool SameBytes(const LaserScan& a, const LaserScan& b) {
  return a.stamp == b.stamp && a.ranges.size() == b.ranges.size() &&
         std::memcmp(a.ranges.data(), b.ranges.data(), a.ranges.size() * sizeof(float)) == 0;
}

bool SameBytes(const CameraFrame& a, const CameraFrame& b) {
  return a.stamp == b.stamp && a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data, b.pixels.data, a.pixels.total() * a.pixels.elemSize()) == 0;
}

bool SameBytes(const OdometryReading& a, const OdometryReading& b) {
  return a.stamp == b.stamp && a.odom_from_base.x == b.odom_from_base.x &&
         a.odom_from_base.y == b.odom_from_base.y &&
         a.odom_from_base.theta == b.odom_from_base.theta;
}

template <typename Data>
bool AllSame(const std::vector<SensorEvent>& a, const std::vector<SensorEvent>& b) {
  const std::vector<Data> left = Only<Data>(a);
  const std::vector<Data> right = Only<Data>(b);
  if (left.empty() || left.size() != right.size()) return false;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!SameBytes(left[i], right[i])) return false;
  }
  return true;
}

SimulationOptions Seconds3(std::uint64_t seed = 1) {
  SimulationOptions options;
  options.seed = seed;
  options.duration = 3.0;
  return options;
}

TEST(RobotSimulation, SameSeedSameBytes) {
  const std::vector<SensorEvent> a = EventsOf(PlainScenario(), Seconds3());
  const std::vector<SensorEvent> b = EventsOf(PlainScenario(), Seconds3());
  EXPECT_TRUE(AllSame<LaserScan>(a, b));
  EXPECT_TRUE(AllSame<CameraFrame>(a, b));
  EXPECT_TRUE(AllSame<OdometryReading>(a, b));
  EXPECT_EQ(Only<LaserScan>(a).size(), 120U);
}

TEST(RobotSimulation, OtherSeedOtherNoise) {
  const std::vector<SensorEvent> a = EventsOf(PlainScenario(), Seconds3(1));
  const std::vector<SensorEvent> b = EventsOf(PlainScenario(), Seconds3(2));
  EXPECT_FALSE(AllSame<LaserScan>(a, b));
  EXPECT_FALSE(AllSame<CameraFrame>(a, b));
  EXPECT_FALSE(AllSame<OdometryReading>(a, b));
}

TEST(RobotSimulation, WithoutImagesTheOtherSensorsMeasureTheSame) {
  SimulationOptions options = Seconds3();
  const std::vector<SensorEvent> with = EventsOf(PlainScenario(), options);
  options.images = false;
  const std::vector<SensorEvent> without = EventsOf(PlainScenario(), options);
  EXPECT_TRUE(AllSame<LaserScan>(with, without));
  EXPECT_TRUE(AllSame<OdometryReading>(with, without));
  EXPECT_TRUE(Only<CameraFrame>(without).empty());
}

TEST(RobotSimulation, EventsComeInTheOrderOfArrivalAndNotBeforeTheirStamp) {
  const std::vector<SensorEvent> events = EventsOf(PlainScenario(), Seconds3());
  Stamp last = 0;
  for (const SensorEvent& event : events) {
    EXPECT_GE(event.arrival, last);
    last = event.arrival;
    if (const auto* frame = std::get_if<CameraFrame>(&event.data)) {
      EXPECT_GT(event.arrival, frame->stamp);
    }
  }
  // Free-running: images are not in step with scans.
  EXPECT_EQ(Only<CameraFrame>(events).size(), 90U);
}

TEST(RobotSimulation, SteppingWithAClockGivesTheSameEvents) {
  const std::vector<SensorEvent> whole = EventsOf(PlainScenario(), Seconds3());
  RobotSimulation simulation(PlainScenario(), Seconds3());
  std::vector<SensorEvent> stepped;
  for (int i = 1; i <= 110; ++i) {
    const Stamp time = SimulationOptions{}.start + FromSeconds(0.03 * i);
    for (SensorEvent& event : simulation.Advance(time)) {
      EXPECT_LE(event.arrival, time);
      stepped.push_back(std::move(event));
    }
  }
  EXPECT_EQ(stepped.size(), whole.size());
  EXPECT_TRUE(AllSame<LaserScan>(whole, stepped));
  EXPECT_TRUE(AllSame<CameraFrame>(whole, stepped));
  EXPECT_TRUE(AllSame<OdometryReading>(whole, stepped));
}

TEST(RobotSimulation, IdealOdometryIsTheTruth) {
  SimulationOptions options;
  options.ideal = true;
  options.images = false;
  const std::vector<SensorEvent> events = EventsOf(PlainScenario(), options);
  const std::vector<GroundTruth> truth = Only<GroundTruth>(events);
  int compared = 0;
  std::size_t next = 1;
  for (const OdometryReading& reading : Only<OdometryReading>(events)) {
    while (next < truth.size() && truth[next].stamp < reading.stamp) ++next;
    if (next == truth.size() || reading.stamp < truth[next - 1].stamp) continue;
    const double fraction = Seconds(reading.stamp - truth[next - 1].stamp) /
                            Seconds(truth[next].stamp - truth[next - 1].stamp);
    const Pose2 pose =
        Interpolate(truth[next - 1].world_from_base, truth[next].world_from_base, fraction);
    const Pose2 error = pose.Inverse() * (Pose2{2.0, 2.0, 0.0} * reading.odom_from_base);
    EXPECT_LT(error.translation().norm(), 2e-4);
    EXPECT_LT(std::abs(error.theta), 1e-6);
    ++compared;
  }
  EXPECT_GT(compared, 200);
  EXPECT_NEAR(truth.back().world_from_base.x, 6.0, 0.03);
}

TEST(RobotSimulation, IdealScansFitTheTruth) {
  SimulationOptions options;
  options.ideal = true;
  options.images = false;
  std::optional<LaserScan> scan;
  int compared = 0;
  for (const SensorEvent& event : EventsOf(PlainScenario(), options)) {
    if (const auto* data = std::get_if<LaserScan>(&event.data)) scan = *data;
    const auto* truth = std::get_if<GroundTruth>(&event.data);
    if (truth == nullptr) continue;
    ASSERT_TRUE(scan.has_value());
    ASSERT_EQ(truth->stamp, scan->stamp);
    // The first beam looks 135 degrees to the right, at the wall y = 0.
    const double laser_y = truth->world_from_base.y + 0.15 * std::sin(truth->world_from_base.theta);
    const double bearing = truth->world_from_base.theta + scan->angle_min;
    EXPECT_NEAR(scan->ranges[0], -laser_y / std::sin(bearing), 1e-4);
    ++compared;
  }
  EXPECT_GT(compared, 200);
}

TEST(RobotSimulation, ErrorsOfTheEncodersCanBeKeptWithoutNoise) {
  SimulationOptions options;
  options.ideal = true;
  options.ideal_encoders = false;
  options.images = false;
  Scenario scenario = PlainScenario();
  scenario.base.left_radius_error = 0.05;
  scenario.base.right_radius_error = 0.05;
  const std::vector<OdometryReading> readings = Only<OdometryReading>(EventsOf(scenario, options));
  EXPECT_NEAR(readings.back().odom_from_base.x, 4.0 * 1.05, 0.03);
}

TEST(RobotSimulation, DrivenByHandItStopsBeforeTheWall) {
  SimulationOptions options;
  options.images = false;
  options.follow_path = false;
  options.duration = 30.0;
  RobotSimulation simulation(PlainScenario(), options);
  simulation.Drive({0.5, 0.0});
  while (simulation.Next()) {
  }
  EXPECT_GT(simulation.truth().world_from_base.x, 9.0);
  EXPECT_LT(simulation.truth().world_from_base.x, 9.85);
  EXPECT_NEAR(simulation.truth().speed, 0.0, 1e-9);
}

TEST(RobotSimulation, AnUnknownPathIsRefusedByName) {
  SimulationOptions options;
  options.path = "nowhere";
  try {
    RobotSimulation simulation(PlainScenario(), options);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "there is no path 'nowhere', only: default");
  }
}

// ---- faults ----

std::vector<SensorEvent> RunWith(const Fault& fault) {
  Scenario scenario = PlainScenario();
  scenario.faults = {fault};
  return EventsOf(scenario, Seconds3());
}

double Since(Stamp stamp) { return Seconds(stamp - SimulationOptions{}.start); }

template <typename Data>
int CountBetween(const std::vector<SensorEvent>& events, double from, double to) {
  int count = 0;
  for (const Data& data : Only<Data>(events)) {
    count += Since(data.stamp) >= from && Since(data.stamp) < to ? 1 : 0;
  }
  return count;
}

TEST(Faults, SensorsFallSilent) {
  const auto camera = RunWith({Fault::Kind::kCameraOff, 1.0, 2.0, 0.0});
  EXPECT_EQ(CountBetween<CameraFrame>(camera, 1.01, 1.98), 0);
  EXPECT_GE(CountBetween<CameraFrame>(camera, 2.0, 3.0), 28);
  EXPECT_GE(CountBetween<LaserScan>(camera, 1.0, 2.0), 39);
  const auto laser = RunWith({Fault::Kind::kLaserOff, 1.0, 2.0, 0.0});
  EXPECT_EQ(CountBetween<LaserScan>(laser, 1.001, 1.999), 0);
  EXPECT_GE(CountBetween<LaserScan>(laser, 2.0, 3.0), 38);
  const auto encoders = RunWith({Fault::Kind::kEncodersOff, 1.0, 2.0, 0.0});
  EXPECT_EQ(CountBetween<OdometryReading>(encoders, 1.0, 2.0), 0);
  EXPECT_GE(CountBetween<OdometryReading>(encoders, 2.0, 3.0), 28);
}

TEST(Faults, ASilentCameraDoesNotChangeTheOtherSensors) {
  const auto without = EventsOf(PlainScenario(), Seconds3());
  const auto with = RunWith({Fault::Kind::kCameraOff, 1.0, 2.0, 0.0});
  EXPECT_TRUE(AllSame<LaserScan>(with, without));
  EXPECT_TRUE(AllSame<OdometryReading>(with, without));
}

TEST(Faults, AFrozenCameraRepeatsItsLastImageWithNewStamps) {
  Stamp last_stamp = 0;
  const std::uint8_t* last = nullptr;
  int frozen = 0;
  for (const CameraFrame& frame :
       Only<CameraFrame>(RunWith({Fault::Kind::kCameraFrozen, 1.0, 2.0, 0.0}))) {
    EXPECT_GT(frame.stamp, last_stamp);
    if (last != nullptr && Since(frame.stamp) > 1.01 && Since(frame.stamp) < 1.98) {
      EXPECT_EQ(frame.pixels.data, last);
      ++frozen;
    }
    last_stamp = frame.stamp;
    last = frame.pixels.data;
  }
  EXPECT_GE(frozen, 28);
}

double MeanGrey(Fault::Kind kind) {
  double sum = 0.0;
  int count = 0;
  for (const CameraFrame& frame : Only<CameraFrame>(RunWith({kind, 1.0, 2.0, 0.0}))) {
    if (Since(frame.stamp) < 1.01 || Since(frame.stamp) > 1.98) continue;
    sum += cv::mean(frame.pixels)[0];
    ++count;
  }
  EXPECT_GT(count, 20);
  return sum / count;
}

TEST(Faults, BlackCoveredAndOverexposedImages) {
  EXPECT_LT(MeanGrey(Fault::Kind::kCameraBlack), 2.0);
  EXPECT_NEAR(MeanGrey(Fault::Kind::kCameraCovered), 12.0, 3.0);
  EXPECT_GT(MeanGrey(Fault::Kind::kCameraOverexposed), 235.0);  // darker in the corners
}

TEST(Faults, DelayedImagesArriveLaterWithTheSameStamps) {
  const auto normal = Only<CameraFrame>(EventsOf(PlainScenario(), Seconds3()));
  const auto events = RunWith({Fault::Kind::kCameraDelayed, 1.0, 2.0, 0.4});
  int delayed = 0;
  std::size_t i = 0;
  for (const SensorEvent& event : events) {
    const auto* frame = std::get_if<CameraFrame>(&event.data);
    if (frame == nullptr) continue;
    ++i;
    delayed += Seconds(event.arrival - frame->stamp) > 0.4 ? 1 : 0;
  }
  EXPECT_EQ(i, normal.size());
  EXPECT_NEAR(delayed, 30, 1);
}

TEST(Faults, TheCamerasClockCanBeWrong) {
  const auto normal = Only<CameraFrame>(EventsOf(PlainScenario(), Seconds3()));
  const auto wrong = Only<CameraFrame>(RunWith({Fault::Kind::kCameraClock, 0.0, 10.0, -0.25}));
  ASSERT_EQ(normal.size(), wrong.size());
  for (std::size_t i = 0; i < normal.size(); ++i) {
    EXPECT_EQ(wrong[i].stamp, normal[i].stamp - FromSeconds(0.25));
  }
}

TEST(Faults, EncodersJumpToZero) {
  double before = 0.0;
  double after = 1.0;
  for (const OdometryReading& reading :
       Only<OdometryReading>(RunWith({Fault::Kind::kEncodersReset, 2.0, 0.0, 0.0}))) {
    if (Since(reading.stamp) < 2.0) before = reading.odom_from_base.x;
    if (Since(reading.stamp) > 2.01 && after == 1.0) after = reading.odom_from_base.x;
  }
  EXPECT_GT(before, 0.4);
  EXPECT_LT(after, 0.05);
}

TEST(Faults, EncodersTurnByAnAngleThatIsNotThere) {
  const auto normal = Only<OdometryReading>(EventsOf(PlainScenario(), Seconds3()));
  const auto turned =
      Only<OdometryReading>(RunWith({Fault::Kind::kEncodersSlip, 1.0, 2.0, M_PI_2}));
  ASSERT_EQ(normal.size(), turned.size());
  for (std::size_t i = 0; i < normal.size(); ++i) {
    const double false_turn =
        NormalizeAngle(turned[i].odom_from_base.theta - normal[i].odom_from_base.theta);
    // The reading is 8 ms older than its stamp.
    const double time = Since(normal[i].stamp) - 0.008;
    const double share = std::min(std::max(time - 1.0, 0.0), 1.0);
    EXPECT_NEAR(false_turn, share * M_PI_2, 0.004) << time;
  }
}

}  // namespace
}  // namespace scan_image_slam
