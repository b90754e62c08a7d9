// The stages take other options while they run, as dynamic_reconfigure wants it.
#include "core/mapping/grid_fixtures.h"
#include "core/mapping/loop_fixtures.h"
#include "scan_image_slam/core/fusion/scan_image_fusion.h"
#include "scan_image_slam/core/mapping/loop_closer.h"
#include "scan_image_slam/core/mapping/mapper.h"
#include "scan_image_slam/core/matching/bounded_icp.h"
#include "support_rooms.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr Stamp kStart = 1'000'000'000;

double LongestRange(const FusedModel& model) {
  double longest = 0.0;
  for (const ModelBeam& beam : model.beams) {
    if (beam.hit()) longest = std::max(longest, beam.range);
  }
  return longest;
}

TEST(NewOptions, OfTheFusionCountFromTheNextScanOn) {
  ScanImageFusion fusion{ScanImageFusionOptions()};
  const LaserScan scan = ScanOf(FurnishedRoom(), Pose2(), kStart, TestLaser());
  ASSERT_GT(LongestRange(fusion.Fuse(scan)), 2.0);
  ScanImageFusionOptions options;
  options.scan.max_range = 2.0;
  fusion.SetOptions(options);
  EXPECT_LE(LongestRange(fusion.Fuse(scan)), 2.0);
  options.scan.max_range = -1.0;
  EXPECT_THROW(fusion.SetOptions(options), std::invalid_argument);
  EXPECT_EQ(fusion.options().scan.max_range, 2.0) << "nothing is changed";
}

/// Stands in a room, with encoders.
class NewOptionsOfTheMatching : public testing::Test {
 protected:
  MatchedMotion Match() {
    stamp_ += FromSeconds(0.1);
    bounded_icp_.AddOdometry(stamp_, Pose2());
    return bounded_icp_.Match(ModelOf(FurnishedRoom(), Pose2(), stamp_, TestLaser()));
  }
  BoundedIcpOptions options_;
  BoundedIcp bounded_icp_{options_};
  Stamp stamp_ = kStart;
};

TEST_F(NewOptionsOfTheMatching, OpenTheWindowAndKeepTheChain) {
  const Stamp first = Match().stamp;
  ASSERT_LT(Match().window.half_distance, 0.4);
  options_.prediction.bounds.min_distance = 0.4;
  bounded_icp_.SetOptions(options_);
  const MatchedMotion match = Match();
  EXPECT_GE(match.window.half_distance, 0.4);
  EXPECT_EQ(match.start_stamp, first);
  EXPECT_EQ(match.status, MatchStatus::kMatched);
  bounded_icp_.Reset();
  Match();
  EXPECT_GE(Match().window.half_distance, 0.4) << "a reset forgets what was seen, not the options";
}

TEST_F(NewOptionsOfTheMatching, ReachTheRefinement) {
  Match();
  ASSERT_EQ(Match().status, MatchStatus::kMatched);
  options_.local_map_matcher.refinement.gate = 1e-9;  // no point lies so near to its wall
  bounded_icp_.SetOptions(options_);
  EXPECT_EQ(Match().status, MatchStatus::kTooFewPoints);
}

TEST_F(NewOptionsOfTheMatching, AreAllTakenOrNone) {
  Match();
  const double before = Match().window.half_distance;
  options_.prediction.bounds.min_distance = 0.4;
  options_.local_map_matcher.filter.edges.gate = -1.0;
  EXPECT_THROW(bounded_icp_.SetOptions(options_), std::invalid_argument);
  EXPECT_NEAR(Match().window.half_distance, before, 1e-9);
}

TEST(NewOptions, OfTheGridChangeWhatItsCountsMean) {
  OccupancyGrid grid(MetreCells());
  grid.Add(OneBeam({0.5, 0.5}, {4.5, 0.5}), Pose2());
  grid.TakeChanges();
  OccupancyGridOptions options = MetreCells();
  options.update_factor_occupied = 0.9;
  options.update_factor_free = 0.1;
  options.resolution = 0.5;
  grid.SetOptions(options);
  EXPECT_EQ(grid.Occupancy(4, 0), 90);
  EXPECT_EQ(grid.Occupancy(0, 0), 10);
  EXPECT_EQ(grid.resolution(), 1.0) << "cells keep their size";
  const CellBox changed = grid.TakeChanges();
  EXPECT_TRUE(changed.x.Contains(0) && changed.x.Contains(4) && changed.y.Contains(0));
}

TEST(NewOptions, OfTheMapperLeaveTheMapThere) {
  MapperOptions options;
  Mapper mapper(options);
  MatchedMotion match;
  match.stamp = match.start_stamp = match.reference_stamp = kStart;
  match.status = MatchStatus::kMatched;
  mapper.AddMatch(match);
  mapper.AddModel(ModelOf(FurnishedRoom(), Pose2(), kStart, TestLaser()), match);
  const CellBox box = mapper.grid().box();
  ASSERT_FALSE(box.empty());
  const auto greatest = [&] {
    int percent = -1;
    for (int y = box.y.begin; y < box.y.end; ++y) {
      for (int x = box.x.begin; x < box.x.end; ++x) {
        percent = std::max<int>(percent, mapper.grid().Occupancy(x, y));
      }
    }
    return percent;
  };
  ASSERT_EQ(greatest(), 75);
  options.grid.update_factor_occupied = 0.9;
  mapper.SetOptions(options);
  EXPECT_EQ(greatest(), 90);
  options.grid.update_factor_occupied = 0.2;
  EXPECT_THROW(mapper.SetOptions(options), std::invalid_argument);
  EXPECT_EQ(greatest(), 90) << "nothing is changed";
}

TEST(NewOptions, OfTheLoopCloserCountFromTheNextKeyframeOn) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
  LoopCloserOptions options;
  options.min_loop_way = 1e9;
  LoopCloser closer(options);
  const std::size_t count = drive.keyframes.size();
  for (std::size_t i = 0; i < count - 20; ++i) closer.Add(drive.keyframes[i]);
  ASSERT_EQ(closer.closures(), 0);
  options = LoopCloserOptions();
  options.enabled = false;  // can't be changed any more
  closer.SetOptions(options);
  for (std::size_t i = count - 20; i < count; ++i) closer.Add(drive.keyframes[i]);
  EXPECT_GT(closer.closures(), 0);
  EXPECT_EQ(closer.poses().size(), count);
}

}  // namespace
}  // namespace scan_image_slam
