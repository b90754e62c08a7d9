#include "scan_image_slam/core/matching/bounded_icp.h"
#include "support_rooms.h"

#include <limits>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr Stamp kStart = 1'000'000'000;

/// A robot that stands in a furnished room and scans it at 40 Hz.
class MatchModeTest : public testing::TestWithParam<Reference> {
 protected:
  MatchModeTest() : bounded_icp_(Options()) {}

  MatchedMotion Match(double seconds, bool with_encoders, bool has_image) {
    const Stamp stamp = kStart + FromSeconds(seconds);
    if (with_encoders) bounded_icp_.AddOdometry(stamp, Pose2());
    FusedModel model = ModelOf(FurnishedRoom(), Pose2(), stamp, TestLaser());
    model.has_image = has_image;
    return bounded_icp_.Match(model);
  }

  MatchedMotion MatchWithoutHits(double seconds) {
    FusedModel model =
        ModelOf(FurnishedRoom(), Pose2(), kStart + FromSeconds(seconds), TestLaser());
    for (ModelBeam& beam : model.beams) beam.range = std::numeric_limits<double>::quiet_NaN();
    return bounded_icp_.Match(model);
  }

 private:
  static BoundedIcpOptions Options() {
    BoundedIcpOptions options;
    options.reference = GetParam();
    return options;
  }
  BoundedIcp bounded_icp_;
};

INSTANTIATE_TEST_SUITE_P(References, MatchModeTest,
                         testing::Values(Reference::kLocalMap, Reference::kPreviousFrame));

TEST_P(MatchModeTest, IsFullWhileImagesAreFused) {
  EXPECT_EQ(Match(0.000, true, true).mode, MatchMode::kFull);
  EXPECT_EQ(Match(0.025, true, false).mode, MatchMode::kFull)
      << "images come less often than scans";
  EXPECT_EQ(Match(0.050, true, true).mode, MatchMode::kFull);
}

TEST_P(MatchModeTest, IsNoCameraFromTwoTenthsOfASecondAfterTheLastImage) {
  Match(0.0, true, true);
  EXPECT_EQ(Match(0.200, true, false).mode, MatchMode::kFull);
  EXPECT_EQ(Match(0.225, true, false).mode, MatchMode::kNoCamera);
  EXPECT_EQ(Match(0.250, true, true).mode, MatchMode::kFull) << "the camera is back";
}

TEST_P(MatchModeTest, IsNoCameraBeforeTheFirstImage) {
  EXPECT_EQ(Match(0.0, true, false).mode, MatchMode::kNoCamera);
  EXPECT_EQ(Match(0.025, true, false).mode, MatchMode::kNoCamera);
}

TEST_P(MatchModeTest, NamesMissingEncoders) {
  EXPECT_EQ(Match(0.0, false, false).mode, MatchMode::kLaserOnly);
  EXPECT_EQ(Match(0.025, false, true).mode, MatchMode::kNoEncoders);
}

TEST_P(MatchModeTest, IsCoastingWhileTheScanShowsNothing) {
  Match(0.000, true, true);
  Match(0.025, true, true);
  const MatchedMotion blind = MatchWithoutHits(0.050);
  EXPECT_EQ(blind.mode, MatchMode::kCoasting);
  EXPECT_EQ(blind.status, MatchStatus::kTooFewPoints);
  EXPECT_EQ(blind.matched, 0);
  Match(0.075, true, true);  // from frame to frame, this one has nothing to be matched with either
  EXPECT_EQ(Match(0.100, true, true).mode, MatchMode::kFull);
}

TEST_P(MatchModeTest, ForgetsTheImagesWithEverythingElse) {
  BoundedIcp bounded_icp(BoundedIcpOptions{});
  FusedModel model = ModelOf(FurnishedRoom(), Pose2(), kStart, TestLaser());
  model.has_image = true;
  bounded_icp.Match(model);
  bounded_icp.Reset();
  model.stamp -= FromSeconds(0.1);
  model.has_image = false;
  EXPECT_EQ(bounded_icp.Match(model).mode, MatchMode::kLaserOnly);
}

}  // namespace
}  // namespace scan_image_slam
