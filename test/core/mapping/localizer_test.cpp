#include "scan_image_slam/core/mapping/localizer.h"

#include "angled_room.h"
#include "loop_fixtures.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kFar = 12.0;  // range of the laser [m]

/// The map of a drive that was measured without an error.
GraphMemory MapOf(const Room& room, const std::vector<Eigen::Vector2d>& corners,
                  double max_range = kFar) {
  LoopCloserOptions off;
  off.enabled = false;
  LoopCloser closer(off);
  for (const auto& made : Drive(room, corners, DriftPerKeyframe()).keyframes) {
    auto keyframe = std::make_shared<Keyframe>(*made);
    const Pose2 pose = Drive(room, corners, DriftPerKeyframe()).truth[made->id];
    keyframe->points = KeyframeAt(room, pose, made->id, max_range).points;
    closer.Add(keyframe);
  }
  return closer.memory();
}

GraphMemory MapOfAngledRoom() {
  return MapOf(AngledRoom(), {{-3, -2}, {3, -2}, {3, -1}, {-1, -1}, {-1, 2}});
}

/// The sightings of one drive; its chain of matches begins at the first.
class Robot {
 public:
  Robot(Room room, double max_range = kFar) : room_(std::move(room)), max_range_(max_range) {}

  /// The next sighting, from `room_from_base`.
  Sighting See(const Pose2& room_from_base) {
    Sighting sighting;
    sighting.keyframe = KeyframeAt(room_, room_from_base, number_, max_range_);
    sighting.keyframe.joined = number_++ > 0;
    if (sighting.keyframe.joined) {
      sighting.keyframe.previous_from_base = last_.Inverse() * room_from_base;
    } else {
      start_ = room_from_base;
    }
    way_ += sighting.keyframe.previous_from_base.translation().norm();
    sighting.keyframe.way = way_;
    sighting.start_stamp = 1000;
    sighting.start_from_base = start_.Inverse() * room_from_base;
    last_ = room_from_base;
    return sighting;
  }
  /// The same, where the robot thinks to be elsewhere.
  Sighting See(const Pose2& room_from_base, const Pose2& map_from_base) {
    Sighting sighting = See(room_from_base);
    sighting.map_from_base = map_from_base;
    return sighting;
  }
  const Pose2& start() const { return start_; }

 private:
  Room room_;
  double max_range_;
  int number_ = 0;
  double way_ = 0.0;
  Pose2 start_;
  Pose2 last_;
};

void ExpectAt(const std::optional<Location>& location, const Pose2& map_from_start) {
  ASSERT_TRUE(location && location->map_from_start);
  EXPECT_EQ(location->start_stamp, 1000);
  const Pose2 off = map_from_start.Inverse() * *location->map_from_start;
  EXPECT_LT(off.translation().norm(), 0.03);
  EXPECT_LT(std::abs(off.theta), 0.01);
}

TEST(Localizer, FindsALostRobotByOneScanWhereverItLooks) {
  Localizer localizer(MapOfAngledRoom(), LocalizerOptions());
  TestRandom random(3);
  for (int i = 0; i < 12; ++i) {
    const Pose2 pose{random.Uniform(-3.0, 0.5), random.Uniform(-2.5, 0.5),
                     random.Uniform(-M_PI, M_PI)};
    Robot robot(AngledRoom());
    SCOPED_TRACE(i);
    ExpectAt(localizer.Look(robot.See(pose)), pose);
  }
}

TEST(Localizer, ChoosesNoneOfTwoPlacesThatLookAlike) {
  // Turned by half a turn an empty room is the same.
  const Room room = Rectangle(-4, -3, 4, 3);
  Localizer localizer(MapOf(room, {{-3, -2}, {3, -2}, {3, 2}, {-3, 2}}), LocalizerOptions());
  Robot robot(room);
  for (int i = 0; i < 12; ++i) {
    EXPECT_FALSE(localizer.Look(robot.See({-2.5 + 0.4 * i, 0.7, 0.1}))) << i;
  }
}

/// A plain corridor from x = -6 to 6 that leads into a hall with a box.
Room CorridorAndHall() {
  return Room{{{-6, 1}, {6, 1}}, {{-6, -1}, {6, -1}}, {{-6, -1}, {-6, 1}}, {{6, 1}, {6, 4}},
              {{6, 4}, {12, 4}}, {{12, 4}, {12, -4}}, {{12, -4}, {6, -4}}, {{6, -4}, {6, -1}}} +
         Rectangle(9, 1, 10.5, 3);
}

TEST(Localizer, WaitsInAPlainCorridorForMoreEvidence) {
  constexpr double kNear = 3.0;
  Localizer localizer(
      MapOf(CorridorAndHall(), {{-5, 0}, {11, 0}, {11, -3}, {7, -3}, {7, 3}}, kNear),
      LocalizerOptions());
  Robot robot(CorridorAndHall(), kNear);
  std::optional<Location> location;
  double x = -2.0;
  for (; !location && x < 9.0; x += 0.4) {
    location = localizer.Look(robot.See({x, 0.2, 0.0}));
    EXPECT_TRUE(x > 2.0 || !location) << "at " << x << " walls alone are seen";
  }
  ExpectAt(location, robot.start());
}

TEST(Localizer, FindsNothingInSurroundingsThatAreNotInTheMap) {
  Localizer localizer(MapOfAngledRoom(), LocalizerOptions());
  Robot robot(RingOfCorridors());
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(localizer.Look(robot.See({-6.0 + 0.4 * i, -4.0, 0.0}))) << i;
  }
}

TEST(Localizer, CorrectsARobotThatItFollows) {
  Localizer localizer(MapOfAngledRoom(), LocalizerOptions());
  Robot robot(AngledRoom());
  for (int i = 0; i < 5; ++i) {
    const Pose2 truth{-1.0 + 0.4 * i, -0.7, 0.2};
    ExpectAt(localizer.Look(robot.See(truth, truth * Pose2{0.08, -0.05, 0.03})), {-1.0, -0.7, 0.2});
  }
}

TEST(Localizer, FindsARobotThatWasPlacedRoughlyByHand) {
  Localizer localizer(MapOfAngledRoom(), LocalizerOptions());
  Robot robot(AngledRoom());
  const Pose2 truth{-0.5, 0.3, 1.2};
  ExpectAt(localizer.Look(robot.See(truth, truth * Pose2{0.9, -0.7, 0.35})), truth);
}

TEST(Localizer, TellsThatARobotWasCarriedAwayAndFindsIt) {
  const LocalizerOptions options;
  Localizer localizer(MapOfAngledRoom(), options);
  // In truth it drives along the south wall; the matching has not noticed anything.
  Robot robot(AngledRoom());
  std::optional<Location> told;
  int sightings = 0;
  for (; !told && sightings < 10; ++sightings) {
    const Pose2 driven{0.2 * sightings, 0, 0};
    told = localizer.Look(robot.See(Pose2{-1, -2, 0} * driven, Pose2{-1, 1, 2} * driven));
  }
  ASSERT_TRUE(told);
  EXPECT_FALSE(told->map_from_start) << "the robot is lost";
  EXPECT_EQ(sightings, options.max_misses) << "neither at the first doubt nor never";
  EXPECT_LT(told->agreement, options.min_agreement);
  ExpectAt(localizer.Look(robot.See({0.5, -2, 0})), robot.start());
}

TEST(Localizer, TellsThatARobotSeesThroughTheWallsOfTheMap) {
  const LocalizerOptions options;
  Localizer localizer(MapOfAngledRoom(), options);
  Room larger = AngledRoom();
  for (RoomWall& wall : larger) wall = {2.5 * wall.from, 2.5 * wall.to};
  Robot robot(larger, 30.0);
  std::optional<Location> told;
  for (int i = 0; i < options.max_misses; ++i) {
    EXPECT_FALSE(told);
    const Pose2 pose{-1 + 0.2 * i, -1, 0.3};
    told = localizer.Look(robot.See(pose, pose));
  }
  ASSERT_TRUE(told);
  EXPECT_FALSE(told->map_from_start);
}

TEST(Localizer, LeavesARobotAloneThatDrivesBeyondTheMap) {
  // Only the south side is known, and the corner where the east side begins.
  Localizer localizer(MapOf(RingOfCorridors(), {{-7, -4}, {3, -4}}, 4.0), LocalizerOptions());
  Robot robot(RingOfCorridors(), 4.0);
  int corrected = 0;
  for (int i = 0; i < 16; ++i) {
    const Pose2 truth{7, -4 + 0.4 * i, M_PI / 2};
    const std::optional<Location> location = localizer.Look(robot.See(truth, truth));
    if (!location) continue;
    ASSERT_TRUE(location->map_from_start) << "what is not known contradicts nothing";
    ++corrected;
  }
  EXPECT_LT(corrected, 16);
}

}  // namespace
}  // namespace scan_image_slam
