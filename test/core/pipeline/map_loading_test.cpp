// A map that is saved and loaded: going on with it, and finding the way in it.
#include "core/mapping/angled_room.h"
#include "core/mapping/grid_fixtures.h"
#include "pipeline_fixtures.h"
#include "scan_image_slam/core/mapping/state_file.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr int kScans = 100;  // 4 m

/// By way of the bytes of a file.
MapState SavedBy(const PipelineRun& run) { return DecodeState(EncodeState(run.pipeline.Save())); }

/// Another drive in the same room, from elsewhere, with encoders that begin at zero again.
TestDrive LaterDrive() {
  TestDrive drive;
  drive.room = AngledRoom();
  drive.start = {1.0, -1.0, 2.6};
  drive.velocity = {0.3, 0.0, -0.1};
  drive.seed = 9;
  return drive;
}

class MapLoading : public ::testing::Test {
 protected:
  MapLoading() {
    first_.room = AngledRoom();
    before_.Drive(first_, kScans);
    saved_ = SavedBy(before_);
  }
  /// Largest distance of a pose from the truth, in the frame of the first drive [m].
  double ErrorInMap(const PipelineRun& run, const TestDrive& drive) const {
    double largest = 0.0;
    for (const PipelineResult& result : run.results) {
      if (result.pose.lost) continue;
      const Pose2 truth =
          first_.PoseAt(0.0).Inverse() * drive.PoseAt(Seconds(result.pose.stamp - kRunStart));
      const Pose2& pose = result.pose.map_from_base;
      largest = std::max(largest, (pose.translation() - truth.translation()).norm());
    }
    return largest;
  }
  static int Lost(const PipelineRun& run) {
    return static_cast<int>(std::count_if(run.results.begin(), run.results.end(),
                                          [](const auto& r) { return r.pose.lost; }));
  }

  TestDrive first_;
  PipelineRun before_;
  MapState saved_;
};

TEST_F(MapLoading, AMapThatWasLoadedOutlivesALeapBackInTime) {
  PipelineRun after;
  after.pipeline.Load(saved_, MapUse::kContinue);
  after.Drive(LaterDrive(), kScans);
  Mapper& mapper = after.pipeline.mapper();
  ASSERT_TRUE(mapper.growing());
  const std::size_t drawn = mapper.drawn().scans().size();
  mapper.TimeWentBack();
  EXPECT_TRUE(mapper.lost());
  EXPECT_FALSE(mapper.empty());
  EXPECT_EQ(mapper.drawn().scans().size(), drawn);
  before_.pipeline.mapper().TimeWentBack();
  EXPECT_TRUE(before_.pipeline.mapper().empty()) << "one of this run does not";
}

TEST_F(MapLoading, TheMapIsDrawnAsItWas) {
  ASSERT_GT(saved_.graph.keyframes.size(), 5U);
  PipelineRun after;
  after.pipeline.Load(saved_, MapUse::kContinue);
  ExpectSameOccupancy(after.pipeline.mapper().grid(), before_.pipeline.mapper().grid());
  EXPECT_EQ(EncodeState(after.pipeline.Save()), EncodeState(saved_));
}

TEST_F(MapLoading, AMapThatIsTooLargeLeavesTheOneInUse) {
  SlamOptions options;
  options.mapper.grid.max_cells = 1000;
  PipelineRun after(options);
  const std::string before = EncodeState(after.pipeline.Save());
  EXPECT_THROW(after.pipeline.Load(saved_, MapUse::kLocalize), std::invalid_argument);
  EXPECT_EQ(EncodeState(after.pipeline.Save()), before);
  EXPECT_FALSE(after.pipeline.mapper().lost());
}

TEST_F(MapLoading, GoesOnOnceTheRobotIsFound) {
  PipelineRun after;
  after.pipeline.Load(saved_, MapUse::kContinue);
  after.Drive(LaterDrive(), kScans);
  EXPECT_GE(Lost(after), 1) << "at first nobody knows where it is";
  EXPECT_LT(Lost(after), 5) << "one look around the room is enough";
  EXPECT_LT(ErrorInMap(after, LaterDrive()), 0.04);
  const MapState grown = after.pipeline.Save();
  EXPECT_GT(grown.graph.keyframes.size(), saved_.graph.keyframes.size() + 3);
  EXPECT_FALSE(grown.graph.keyframes.at(static_cast<int>(saved_.graph.keyframes.size()))->joined);
  EXPECT_GT(grown.drawn.size(), saved_.drawn.size());
  EXPECT_EQ(after.pipeline.mapper().Trajectory().size(), after.results.size() - Lost(after))
      << "the path of this drive alone";
}

TEST_F(MapLoading, NothingEntersTheMapWhileTheRobotIsLost) {
  TestDrive elsewhere = LaterDrive();
  elsewhere.room = Rectangle(-9, -1.3, 9, 1.3) + Rectangle(2, -1.3, 2.5, -0.8);
  elsewhere.start = {-6, 0, 0};
  elsewhere.velocity = {0.5, 0, 0};
  PipelineRun after;
  after.pipeline.Load(saved_, MapUse::kContinue);
  after.Drive(elsewhere, kScans);
  EXPECT_EQ(Lost(after), kScans);
  EXPECT_EQ(EncodeState(after.pipeline.Save()), EncodeState(saved_));
}

TEST_F(MapLoading, ToLocaliseInItStaysAsItIsBitForBit) {
  PipelineRun after;
  after.pipeline.Load(saved_, MapUse::kLocalize);
  after.Drive(LaterDrive(), kScans);
  EXPECT_LT(Lost(after), 5);
  EXPECT_LT(ErrorInMap(after, LaterDrive()), 0.04);
  EXPECT_EQ(EncodeState(after.pipeline.Save()), EncodeState(saved_));
  ExpectSameOccupancy(after.pipeline.mapper().grid(), before_.pipeline.mapper().grid());
}

TEST_F(MapLoading, ARobotThatIsCarriedAwayIsLostAndFoundAgain) {
  PipelineRun after;
  after.pipeline.Load(saved_, MapUse::kLocalize);
  const TestDrive drive = LaterDrive();
  after.Drive(drive, kScans);
  const std::size_t carried = after.results.size();
  // The encoders do not notice; the scans come from elsewhere.
  TestRandom random(4);
  const Pose2 truth{-2.0, 0.5, -1.0};
  for (int i = 0; i < 100; ++i) {
    const Stamp stamp = kRunStart + FromSeconds(drive.period * (kScans + i));
    after.pipeline.AddOdometry(stamp, drive.OdomAt(drive.period * (kScans - 1)), stamp);
    after.Add(ScanOf(drive.room, truth, stamp, drive.laser, &random));
  }
  after.pipeline.Finish();
  ASSERT_GT(after.results.size(), carried + 90);
  const auto lost = std::find_if(after.results.begin() + static_cast<std::ptrdiff_t>(carried),
                                 after.results.end(), [](const auto& r) { return r.pose.lost; });
  EXPECT_NE(lost, after.results.end());
  EXPECT_NE(after.results.back().match.start_stamp, after.results.front().match.start_stamp)
      << "the matching has started over";
  const MapPose& last = after.results.back().pose;
  ASSERT_FALSE(last.lost);
  const Pose2 expected = first_.PoseAt(0.0).Inverse() * truth;
  EXPECT_LT((last.map_from_base.translation() - expected.translation()).norm(), 0.04);
}

TEST_F(MapLoading, ALostRobotCanBeToldWhereItIs) {
  // Turned by half a turn the room is the same: looking around does not help.
  TestDrive empty;
  empty.room = Rectangle(-4, -3, 4, 3);
  PipelineRun mapped;
  mapped.Drive(empty, kScans);
  PipelineRun after;
  after.pipeline.Load(SavedBy(mapped), MapUse::kLocalize);
  ForEachScan(empty, kScans, &after.pipeline, [&](double seconds, const LaserScan& scan) {
    after.Add(scan);
    if (after.results.size() == 50 && after.results.back().pose.lost) {
      const Pose2 truth = empty.PoseAt(0.0).Inverse() * empty.PoseAt(seconds);
      after.pipeline.mapper().SetPose(truth * Pose2{0.2, -0.1, 0.1});
    }
  });
  EXPECT_EQ(Lost(after), 50);
  const Pose2 truth = empty.PoseAt(0.0).Inverse() *
                      empty.PoseAt(Seconds(after.results.back().pose.stamp - kRunStart));
  const Pose2& pose = after.results.back().pose.map_from_base;
  EXPECT_LT((pose.translation() - truth.translation()).norm(), 0.04);
}

TEST_F(MapLoading, AChainOfMatchesThatGoesOnNeedsNoSearch) {
  // In a plain corridor no search would find the robot.
  const auto match_at = [](int i) {
    MatchedMotion match;
    match.start_stamp = kRunStart;
    match.stamp = kRunStart + i * 100'000'000LL;
    match.motion = {0.1 * i, 0.0, 0.0};
    match.status = MatchStatus::kMatched;
    return match;
  };
  const auto feed = [&](Mapper* mapper, int i) {
    const MatchedMotion match = match_at(i);
    const MapPose pose = mapper->AddMatch(match);
    mapper->AddModel(ModelOf(PlainCorridor(), match.motion, match.stamp, TestLaser()), match);
    return pose;
  };
  Mapper mapper{MapperOptions()};
  mapper.SetPose({2, 3, 0.5});
  for (int i = 0; i < 30; ++i) feed(&mapper, i);
  MapState state = mapper.State();
  state.graph = saved_.graph;  // any will do
  Mapper respawned{MapperOptions()};
  respawned.Load(state, MapUse::kContinue);
  const MapPose later = feed(&respawned, 40);
  ASSERT_FALSE(later.lost);
  const Pose2 expected = Pose2{2, 3, 0.5} * Pose2{4.0, 0, 0};
  EXPECT_NEAR(later.map_from_base.x, expected.x, 1e-9);
  EXPECT_NEAR(later.map_from_base.y, expected.y, 1e-9);
  // The same recording from its beginning is another matter: what was saved is its end.
  Mapper replayed{MapperOptions()};
  replayed.Load(state, MapUse::kContinue);
  EXPECT_TRUE(feed(&replayed, 5).lost);
}

TEST_F(MapLoading, AnEmptyMapIsNothingToLocaliseIn) {
  PipelineRun after;
  EXPECT_THROW(after.pipeline.Load(MapState(), MapUse::kLocalize), std::invalid_argument);
  after.pipeline.Load(MapState(), MapUse::kContinue);
  after.Drive(first_, 20);
  EXPECT_EQ(Lost(after), 0);
}

}  // namespace
}  // namespace scan_image_slam
