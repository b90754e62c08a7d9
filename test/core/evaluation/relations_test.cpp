#include "scan_image_slam/core/evaluation/relations.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kTolerance = 1e-9;

/// Positions (0,0), (1,0), (1,2) with headings 0, 90 and 90 degrees at 1 s, 2 s and 3 s.
const Trajectory kEstimate{{FromSeconds(1), {0.0, 0.0, 0.0}},
                           {FromSeconds(2), {1.0, 0.0, M_PI / 2.0}},
                           {FromSeconds(3), {1.0, 2.0, M_PI / 2.0}}};

Relation Between(double first, double second, const Pose2& first_from_second) {
  return {FromSeconds(first), FromSeconds(second), first_from_second};
}

std::vector<Relation> Read(const std::string& text) {
  std::istringstream input(text);
  return ReadRelations(input, "true.relations");
}

std::string ErrorOf(const std::string& text) {
  try {
    Read(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(ReadRelations, ReadsTheColumns) {
  const std::vector<Relation> relations = Read(
      "# time1 time2 x y z roll pitch yaw\n"
      "976052905.567653 976052896.784509 -0.05699 -0.12843 9 8 7 -1.68221\n"
      "1 2 3 4 0 0 0 4\n");
  ASSERT_EQ(relations.size(), 2u);
  EXPECT_EQ(relations[0].first, 976052905567653000);
  EXPECT_EQ(relations[0].second, 976052896784509000);
  EXPECT_DOUBLE_EQ(relations[0].first_from_second.x, -0.05699);
  EXPECT_DOUBLE_EQ(relations[0].first_from_second.y, -0.12843);
  EXPECT_DOUBLE_EQ(relations[0].first_from_second.theta, -1.68221);
  EXPECT_NEAR(relations[1].first_from_second.theta, 4.0 - 2.0 * M_PI, kTolerance);
}

TEST(ReadRelations, NamesTheLineAndTheError) {
  EXPECT_EQ(ErrorOf("1 2 3 4 0 0 0 0\n\n1 2 3 4 0 0 0\n"),
            "true.relations:3: 7 columns instead of 8 (time1 time2 x y z roll pitch yaw)");
  EXPECT_EQ(ErrorOf("1 x 3 4 0 0 0 0\n"), "true.relations:1: time2 'x' is not a time in seconds");
  EXPECT_EQ(ErrorOf("1 2 3 4 0 nan 0 0\n"), "true.relations:1: roll 'nan' is not finite");
  EXPECT_EQ(ErrorOf("#\n"), "true.relations: holds no relations");
  EXPECT_THROW(ReadRelationsFile("/no/such/file"), std::runtime_error);
}

TEST(EvaluateRelations, FindsNoErrorInTrueMotions) {
  const RelationErrors errors =
      EvaluateRelations({Between(1, 2, {1.0, 0.0, M_PI / 2.0}), Between(2, 3, {2.0, 0.0, 0.0}),
                         Between(3, 1, {-2.0, 1.0, -M_PI / 2.0})},
                        kEstimate, {});
  EXPECT_EQ(errors.relations, 3u);
  EXPECT_EQ(errors.used, 3u);
  EXPECT_NEAR(errors.translation.max, 0.0, kTolerance);
  EXPECT_NEAR(errors.rotation.max, 0.0, kTolerance);
}

TEST(EvaluateRelations, ComputesByHand) {
  // Translations wrong by 0.5 (3-4-5), 0 and 1 m, headings by 0, 0.2 and 0.1 rad.
  const RelationErrors errors =
      EvaluateRelations({Between(1, 2, {1.3, 0.4, M_PI / 2.0}), Between(2, 3, {2.0, 0.0, -0.2}),
                         Between(3, 1, {-2.0, 0.0, -M_PI / 2.0 + 0.1})},
                        kEstimate, {});
  EXPECT_NEAR(errors.translation.mean, 0.5, kTolerance);
  EXPECT_NEAR(errors.translation.median, 0.5, kTolerance);
  EXPECT_NEAR(errors.translation.max, 1.0, kTolerance);
  EXPECT_NEAR(errors.translation.standard_deviation, std::sqrt(0.5 / 3.0), kTolerance);
  EXPECT_NEAR(errors.translation.rms * errors.translation.rms, 1.25 / 3.0, kTolerance);
  EXPECT_NEAR(errors.rotation.mean, 0.1, kTolerance);
  EXPECT_NEAR(errors.rotation.max, 0.2, kTolerance);
}

TEST(EvaluateRelations, DoesNotDependOnTheFrame) {
  Trajectory moved = kEstimate;
  for (StampedPose& pose : moved) pose.pose = Pose2{10.0, -4.0, 2.0} * pose.pose;
  const std::vector<Relation> relations{Between(1, 2, {1.3, 0.4, 1.0}),
                                        Between(2, 3, {2.0, 0.1, 0.3})};
  const RelationErrors a = EvaluateRelations(relations, kEstimate, {});
  const RelationErrors b = EvaluateRelations(relations, moved, {});
  EXPECT_NEAR(a.translation.mean, b.translation.mean, kTolerance);
  EXPECT_NEAR(a.rotation.mean, b.rotation.mean, kTolerance);
  EXPECT_GT(a.translation.mean, 0.1);
}

TEST(EvaluateRelations, CountsWhatItCannotUse) {
  const RelationErrors errors =
      EvaluateRelations({Between(2.00001, 2.99999, {2.0, 0.0, 0.0}),  // as files round
                         Between(1, 2.5, {0.0, 0.0, 0.0}),            // no pose at 2.5 s
                         Between(3, 4, {0.0, 0.0, 0.0})},             // the estimate has ended
                        kEstimate, {});
  EXPECT_EQ(errors.relations, 3u);
  EXPECT_EQ(errors.used, 1u);
  EXPECT_NEAR(errors.translation.max, 0.0, kTolerance);
}

TEST(EvaluateRelations, InterpolatesBetweenPosesThatAreClose) {
  RelationErrorOptions options;
  options.lookup.max_gap = 1.0;
  const RelationErrors errors =
      EvaluateRelations({Between(2, 2.5, {1.0, 0.0, 0.0})}, kEstimate, options);
  EXPECT_EQ(errors.used, 1u);
  EXPECT_NEAR(errors.translation.max, 0.0, kTolerance);
}

TEST(EvaluateRelations, SaysWhenTheTimesDoNotMeet) {
  try {
    EvaluateRelations({Between(11, 10, {})}, kEstimate, {});
    FAIL() << "times that do not meet";
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("from 10.000000000 to 11.000000000"), std::string::npos) << message;
    EXPECT_NE(message.find("from 1.000000000 to 3.000000000"), std::string::npos) << message;
  }
}

TEST(RelationErrorsToKeyValues, GivesMetresAndDegrees) {
  const RelationErrors errors = EvaluateRelations(
      {Between(1, 2, {1.3, 0.4, M_PI / 2.0}), Between(2, 3, {2.0, 0.0, M_PI / 18.0})}, kEstimate,
      {});
  EXPECT_EQ(ToKeyValues(errors),
            "relations=2 used=2 trans_mean_m=0.250000 trans_std_m=0.250000 trans_median_m=0.250000 "
            "trans_max_m=0.500000 trans_sqr_mean_m2=0.125000 rot_mean_deg=5.000000 "
            "rot_std_deg=5.000000 rot_median_deg=5.000000 rot_max_deg=10.000000 "
            "rot_sqr_mean_deg2=50.000000");
}

}  // namespace
}  // namespace scan_image_slam
