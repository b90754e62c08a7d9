#include "scan_image_slam/core/mapping/loop_matcher.h"

#include "loop_fixtures.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

Submap SubmapAt(const Room& room, const Pose2& room_from_base) {
  return Submap({std::make_shared<Keyframe>(KeyframeAt(room, room_from_base, 0))}, {Pose2()},
                SubmapOptions());
}

LoopQuery QueryAt(const Room& room, const Pose2& room_from_base) {
  LoopQuery query;
  query.points = ToSurfacePoints(KeyframeAt(room, room_from_base, 1), Pose2());
  return query;
}

void ExpectNear(const Pose2& a, const Pose2& b) {
  EXPECT_NEAR(a.x, b.x, 0.01);
  EXPECT_NEAR(a.y, b.y, 0.01);
  EXPECT_NEAR(NormalizeAngle(a.theta - b.theta), 0.0, 0.005);
}

TEST(FindInSubmap, FindsThePlaceFromFarOff) {
  const Room room = FurnishedRoom();
  const Pose2 then{-0.5, 0.3, 0.1};
  Submap submap = SubmapAt(room, then);
  for (const Pose2& now : {Pose2{0.8, -0.6, 0.5}, Pose2{-1.2, 1.0, -0.4}, then}) {
    const auto match =
        FindInSubmap(QueryAt(room, now), &submap, {{0, 0, 0}, 3.0, 0.7}, LoopMatcherOptions());
    ASSERT_TRUE(match.has_value());
    ExpectNear(match->submap_from_base, then.Inverse() * now);
    EXPECT_GT(match->agreement, 0.95);
  }
}

TEST(FindInSubmap, DoesNotFindAnotherRoom) {
  Submap submap = SubmapAt(FurnishedRoom(), {0, 0, 0});
  const Room other = Rectangle(-2.5, -2.0, 5.0, 2.2) + Rectangle(0.5, 0.9, 1.9, 1.4);
  EXPECT_FALSE(FindInSubmap(QueryAt(other, {0.2, 0, 0}), &submap, {{0, 0, 0}, 3.0, 0.7},
                            LoopMatcherOptions()));
}

TEST(FindInSubmap, APlaceThatFitsTwiceIsNotFound) {
  // A rectangle looks the same from the other side, turned by half a turn.
  const Room room = Rectangle(-6.0, -1.5, 6.0, 1.5);
  Submap submap = SubmapAt(room, {0, 0, 0});
  EXPECT_FALSE(FindInSubmap(QueryAt(room, {1.0, 0.2, 0.0}), &submap, {{0, 0, 0}, 2.5, 3.2},
                            LoopMatcherOptions()));
  EXPECT_TRUE(FindInSubmap(QueryAt(room, {1.0, 0.2, 0.0}), &submap, {{0, 0, 0}, 2.5, 0.7},
                           LoopMatcherOptions()));
}

TEST(TrackInSubmap, RefinesAndTellsWhatItKnows) {
  const Room corridor = PlainCorridor();
  const Submap submap = SubmapAt(corridor, {0, 0, 0});
  const auto match = TrackInSubmap(QueryAt(corridor, {0.5, 0.1, 0.05}), submap, {0.4, 0.15, 0.03},
                                   LoopMatcherOptions());
  ASSERT_TRUE(match.has_value());
  EXPECT_NEAR(match->submap_from_base.y, 0.1, 0.01);
  EXPECT_NEAR(match->submap_from_base.theta, 0.05, 0.005);
  // Along the corridor nothing is known: what the start said stays, with no weight.
  EXPECT_NEAR(match->submap_from_base.x, 0.4, 0.02);
  const Eigen::Vector2d along(std::cos(0.05), -std::sin(0.05));
  const double known = along.dot(match->information.topLeftCorner<2, 2>() * along);
  EXPECT_LT(known, 1e-2 * match->information(1, 1));
}

TEST(TrackInSubmap, AWallWhereTheSubmapSawFreeSpaceContradictsIt) {
  const Room room = FurnishedRoom();
  const Submap submap = SubmapAt(room, {0, 0, 0});
  const Pose2 here{0.1, 0.0, 0.0};
  const auto same = TrackInSubmap(QueryAt(room, here), submap, here, LoopMatcherOptions());
  ASSERT_TRUE(same.has_value());
  // A new wall through the middle of the room.
  const Room changed = room + Room{{{0.9, -2.9}, {0.9, 0.8}}, {{-0.9, -2.9}, {-0.9, 2.9}}};
  const auto after = TrackInSubmap(QueryAt(changed, here), submap, here, LoopMatcherOptions());
  EXPECT_FALSE(after.has_value());
}

}  // namespace
}  // namespace scan_image_slam
