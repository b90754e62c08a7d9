#include "scan_image_slam/core/mapping/mapper.h"

#include "core/geometry/pose_near.h"
#include "mapper_fixtures.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(Mapper, TheFirstPoseIsThatOfTheEncoders) {
  Mapper mapper{MapperOptions()};
  const MapPose pose = mapper.AddMatch(MatchAt(0, 0, {}, Pose2{3.0, -2.0, 1.5}));
  ExpectPoseNear(pose.map_from_base, {3.0, -2.0, 1.5});
  ExpectPoseNear(*pose.map_from_odom, {});
  EXPECT_EQ(pose.stamp, 0);
}

TEST(Mapper, WithoutEncodersTheMapBeginsAtTheRobot) {
  Mapper mapper{MapperOptions()};
  const MapPose pose = mapper.AddMatch(MatchAt(0, 0, {}));
  ExpectPoseNear(pose.map_from_base, {});
  EXPECT_FALSE(pose.map_from_odom);
}

TEST(Mapper, ChainsTheMotionToTheReferenceAndTheStart) {
  Mapper mapper{MapperOptions()};
  mapper.AddMatch(MatchAt(0, 0, {}, Pose2{10.0, 5.0, M_PI_2}));
  MatchedMotion match = MatchAt(0, FromSeconds(1.0), {0.5, 0.0, 0.0}, Pose2{10.0, 6.0, M_PI_2});
  match.start_from_reference = {2.0, 1.0, M_PI_2};  // then 0.5 m along the start's y
  const MapPose pose = mapper.AddMatch(match);
  ExpectPoseNear(pose.map_from_base, {10.0 - 1.5, 5.0 + 2.0, M_PI});
  EXPECT_EQ(pose.stamp, FromSeconds(1.0));
}

TEST(Mapper, MapFromOdomIsWhatTheEncodersAreWrongBy) {
  Mapper mapper{MapperOptions()};
  Dice dice;
  mapper.AddMatch(MatchAt(0, 0, {}, dice.Pose()));
  for (int i = 1; i < 20; ++i) {
    const Pose2 odom_from_base = dice.Pose();
    const MapPose pose = mapper.AddMatch(MatchAt(0, i, dice.Pose(), odom_from_base));
    ExpectPoseNear(*pose.map_from_odom * odom_from_base, pose.map_from_base);
  }
  EXPECT_FALSE(mapper.AddMatch(MatchAt(0, 20, dice.Pose())).map_from_odom);
}

TEST(Mapper, TellsTheCovarianceOfTheMatch) {
  Mapper mapper{MapperOptions()};
  MatchedMotion match = MatchAt(0, 0, {});
  match.covariance << 4, 1, 0, 1, 3, 0.5, 0, 0.5, 2;
  EXPECT_EQ(mapper.AddMatch(match).covariance, match.covariance);
}

TEST(MapperChain, AMissedBeginningIsMadeUpByTheEncoders) {
  Mapper mapper{MapperOptions()};
  ExpectPoseNear(
      mapper.AddMatch(MatchAt(0, 50, {7.0, 0.0, 0.3}, Pose2{1.0, 2.0, 0.5})).map_from_base,
      {1.0, 2.0, 0.5});
  const Pose2 step{0.1, 0.02, 0.05};
  ExpectPoseNear(mapper.AddMatch(MatchAt(0, 60, Pose2{7.0, 0.0, 0.3} * step)).map_from_base,
                 Pose2{1.0, 2.0, 0.5} * step);
}

/// A mapper that has come to (4, 1, 0.5), where its encoders say (3, 3, -1).
Mapper Arrived() {
  Mapper mapper{MapperOptions()};
  mapper.AddMatch(MatchAt(100, 100, {}, Pose2{}));
  mapper.AddMatch(MatchAt(100, 200, {4.0, 1.0, 0.5}, Pose2{3.0, 3.0, -1.0}));
  return mapper;
}

TEST(MapperChain, ANewOneGoesOnByWhatTheEncodersHaveSeenMeanwhile) {
  Mapper mapper = Arrived();
  const Pose2 meanwhile{0.3, 0.1, 0.2};
  const MapPose first = mapper.AddMatch(MatchAt(300, 300, {}, Pose2{3.0, 3.0, -1.0} * meanwhile));
  ExpectPoseNear(first.map_from_base, Pose2{4.0, 1.0, 0.5} * meanwhile);
  const MapPose second = mapper.AddMatch(MatchAt(300, 400, {1.0, 0.0, 0.0}));
  ExpectPoseNear(second.map_from_base, Pose2{4.0, 1.0, 0.5} * meanwhile * Pose2{1.0, 0.0, 0.0});
}

TEST(MapperChain, ANewOneWithoutEncodersGoesOnFromTheLastPose) {
  Mapper mapper = Arrived();
  ExpectPoseNear(mapper.AddMatch(MatchAt(300, 300, {})).map_from_base, {4.0, 1.0, 0.5});
}

TEST(MapperChain, ANewOneKeepsTheMap) {
  Mapper mapper = Arrived();
  mapper.AddModel(WallAhead(2.0), MatchAt(100, 200, {4.0, 1.0, 0.5}));
  mapper.AddMatch(MatchAt(300, 300, {}));
  EXPECT_GT(DrawnCells(mapper), 0);
}

TEST(MapperChain, AModelOfAnEarlierOneIsLeftOut) {
  Mapper mapper = Arrived();
  mapper.AddMatch(MatchAt(300, 300, {}));
  EXPECT_EQ(mapper.AddModel(WallAhead(2.0), MatchAt(100, 250, {6.0, 1.0, 0.5})), nullptr);
  EXPECT_EQ(DrawnCells(mapper), 0);
  EXPECT_NE(mapper.AddModel(WallAhead(2.0), MatchAt(300, 300, {})), nullptr);
  EXPECT_GT(DrawnCells(mapper), 0);
}

TEST(MapperChain, WhenTimeGoesBackTheMapBeginsAnew) {
  // To before the chain, and into the middle of it.
  for (const Stamp stamp : {50, 150}) {
    Mapper mapper = Arrived();
    mapper.AddModel(WallAhead(2.0), MatchAt(100, 200, {4.0, 1.0, 0.5}));
    ASSERT_GT(DrawnCells(mapper), 0);
    const MapPose pose = mapper.AddMatch(MatchAt(stamp, stamp, {}, Pose2{0.5, 0.0, 0.1}));
    ExpectPoseNear(pose.map_from_base, {0.5, 0.0, 0.1});
    EXPECT_EQ(DrawnCells(mapper), 0) << stamp;
  }
}

TEST(MapperChain, WhenTheClockIsSetBackTheRobotGoesOnInItsMap) {
  Mapper mapper{MapperOptions()};
  mapper.AddMatch(MatchAt(100, 100, {}, Pose2{1.0, 0.0, 0.0}));
  const MatchedMotion match = MatchAt(100, 200, {4.0, 1.0, 0.0}, Pose2{4.5, 1.0, 0.0});
  mapper.AddMatch(match);  // at (5, 1), where the encoders say (4.5, 1)
  mapper.AddModel(WallAhead(2.0), match);
  const int drawn = DrawnCells(mapper);
  ASSERT_GT(drawn, 0);
  mapper.ClockWasSet();
  const MatchedMotion later = MatchAt(50, 50, {}, Pose2{6.5, 1.0, 0.0});
  ExpectPoseNear(mapper.AddMatch(later).map_from_base, {7.0, 1.0, 0.0});
  EXPECT_NE(mapper.AddModel(WallAhead(2.0), later), nullptr);
  EXPECT_GT(DrawnCells(mapper), drawn);
}

TEST(MapperChain, ANewOneIsNotKnownBetterThanTheLastPose) {
  Mapper mapper{MapperOptions()};
  MatchedMotion match = MatchAt(100, 200, {});
  match.covariance = Eigen::Vector3d(0.04, 0.01, 0.09).asDiagonal();
  mapper.AddMatch(match);
  EXPECT_TRUE(mapper.AddMatch(MatchAt(300, 300, {})).covariance.isApprox(match.covariance));
  // 2 m ahead, an error of heading has become one sideways too.
  const Eigen::Matrix3d later = mapper.AddMatch(MatchAt(300, 400, {2.0, 0.0, 0.0})).covariance;
  EXPECT_NEAR(later(0, 0), 0.04, 1e-12);
  EXPECT_NEAR(later(1, 1), 0.01 + 4.0 * 0.09, 1e-12);
  EXPECT_NEAR(later(1, 2), 2.0 * 0.09, 1e-12);
  EXPECT_NEAR(later(2, 2), 0.09, 1e-12);
}

TEST(MapperSetPose, MatchesGoOnFromThere) {
  Mapper mapper = Arrived();
  mapper.SetPose({-7.0, 2.0, M_PI_2});
  // The chain was at (4, 1, 0.5) and drives 2 m ahead.
  const MapPose pose =
      mapper.AddMatch(MatchAt(100, 300, Pose2{4.0, 1.0, 0.5} * Pose2{2.0, 0.0, 0.0}));
  ExpectPoseNear(pose.map_from_base, {-7.0, 4.0, M_PI_2});
}

TEST(MapperSetPose, ANewChainGoesOnFromThere) {
  Mapper mapper = Arrived();
  mapper.SetPose({-7.0, 2.0, M_PI_2});
  const Pose2 meanwhile{0.3, 0.0, 0.0};
  const MapPose pose = mapper.AddMatch(MatchAt(300, 300, {}, Pose2{3.0, 3.0, -1.0} * meanwhile));
  ExpectPoseNear(pose.map_from_base, {-7.0, 2.3, M_PI_2});
}

TEST(MapperSetPose, HoldsBeforeTheFirstMatch) {
  Mapper mapper{MapperOptions()};
  mapper.SetPose({-7.0, 2.0, M_PI_2});
  ExpectPoseNear(mapper.AddMatch(MatchAt(100, 100, {}, Pose2{1.0, 1.0, 1.0})).map_from_base,
                 {-7.0, 2.0, M_PI_2});
}

TEST(Mapper, ResetForgetsPoseAndMap) {
  Mapper mapper = Arrived();
  mapper.AddModel(WallAhead(2.0), MatchAt(100, 200, {4.0, 1.0, 0.5}));
  mapper.Reset();
  EXPECT_EQ(DrawnCells(mapper), 0);
  ExpectPoseNear(mapper.AddMatch(MatchAt(300, 300, {})).map_from_base, {});
}

TEST(Mapper, GoesOnWhenTheMapIsAsLargeAsItMayBe) {
  MapperOptions options;
  options.grid.max_cells = 300 * 300;
  Mapper mapper(options);
  constexpr Stamp kStart = 1000000000;
  const auto add = [&](Stamp stamp, double x) {
    const MatchedMotion match = MatchAt(kStart, stamp, {x, 0.0, 0.0});
    EXPECT_DOUBLE_EQ(mapper.AddMatch(match).map_from_base.x, x);
    return mapper.AddModel(WallAhead(2.0), match);
  };
  ASSERT_TRUE(add(kStart, 0.0));
  const int known = DrawnCells(mapper);
  EXPECT_THROW(add(kStart + 1, 1000.0), std::invalid_argument);
  EXPECT_EQ(mapper.drawn().size(), 1U);
  EXPECT_EQ(DrawnCells(mapper), known);
  // The scan that was left out is no keyframe, so numbers have no gap.
  const auto keyframe = add(kStart + 2, 1.0);
  ASSERT_TRUE(keyframe);
  EXPECT_EQ(keyframe->id, 1);
  EXPECT_EQ(mapper.drawn().size(), 2U);
}

}  // namespace
}  // namespace scan_image_slam
