#include "pose_filter_fixtures.h"

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(PoseFilter, FollowsTheEncodersAlone) {
  PoseFilter filter(Options());
  filter.Start({1.0, 2.0, M_PI_2});
  filter.Predict({1.0, 2.0, M_PI_2}, Forward(0.5), Noise(0.01, 0.002, 0.003));
  EXPECT_NEAR(filter.map_from_base().x, 1.0, 1e-12);
  EXPECT_NEAR(filter.map_from_base().y, 2.5, 1e-12);
  // Forward is uncertain by the noise and by the scale of the encoders.
  const Eigen::Matrix3d covariance = filter.PoseCovariance();
  EXPECT_NEAR(covariance(0, 0), 0.01 * 0.01 + std::pow(0.5 * Options().scale_stddev, 2), 1e-9);
  EXPECT_NEAR(covariance(1, 1), 0.002 * 0.002, 1e-9);
  EXPECT_NEAR(covariance(2, 2), 0.003 * 0.003, 1e-9);
}

TEST(PoseFilter, AHeadingThatIsOffCarriesTheNextMotionAside) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  filter.Predict(Pose2(), Forward(0.0), Noise(0.0, 0.0, 0.01));
  filter.Predict(filter.map_from_base(), Forward(2.0), Noise(0.0, 0.0, 0.0));
  EXPECT_NEAR(filter.PoseCovariance()(1, 1), std::pow(2.0 * 0.01, 2), 1e-9);
  EXPECT_NEAR(filter.PoseCovariance()(1, 2), 2.0 * 0.01 * 0.01, 1e-9);
}

/// Against the product of two Gaussians, written down: information adds up.
TEST(PoseFilter, WeighsPredictionAndScanByTheirInformation) {
  PoseFilter filter(Options());
  const Pose2 start{3.0, -1.0, 0.7};
  filter.Start(start);
  filter.Predict(start, Forward(0.0), Noise(0.02, 0.01, 0.01));
  const Pose2 scan_pose = start * Pose2{0.03, -0.01, 0.004};
  const Eigen::Matrix3d information = Noise(0.01, 0.02, 0.005).inverse();
  filter.AddScan(scan_pose, information, Eigen::Vector3d::Zero());
  const Eigen::Matrix3d prior = Noise(0.02, 0.01, 0.01).inverse();
  const Eigen::Vector3d by_scan(0.03, -0.01, 0.004);
  const Eigen::Vector3d expected = (prior + information).inverse() * information * by_scan;
  const Pose2 moved = start.Inverse() * filter.map_from_base();
  EXPECT_NEAR(moved.x, expected.x(), 1e-4);
  EXPECT_NEAR(moved.y, expected.y(), 1e-4);
  EXPECT_NEAR(moved.theta, expected.z(), 1e-4);
  EXPECT_TRUE(filter.PoseCovariance().isApprox((prior + information).inverse(), 1e-2));
}

TEST(PoseFilter, TheGradientOfAScanPointsToItsBestPose) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  filter.Predict(Pose2(), Forward(0.0), Noise(1.0, 1.0, 1.0));
  const Eigen::Matrix3d information = Noise(1e-3, 1e-3, 1e-3).inverse();
  const Eigen::Vector3d best(0.02, 0.01, 0.0);
  filter.AddScan(Pose2(), information, -information * best);
  EXPECT_NEAR(filter.map_from_base().x, 0.02, 1e-6);
  EXPECT_NEAR(filter.map_from_base().y, 0.01, 1e-6);
}

TEST(PoseFilter, ADirectionWithoutInformationIsLeftToTheEncoders) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  filter.Predict(Pose2(), Forward(1.0), Noise(0.02, 0.02, 0.01));
  Eigen::Matrix3d information = Noise(1.0, 0.001, 0.001).inverse();
  information(0, 0) = 0.0;
  filter.AddScan({1.3, 0.004, 0.0}, information, Eigen::Vector3d::Zero());
  EXPECT_NEAR(filter.map_from_base().x, 1.0, 1e-9);
  EXPECT_NEAR(filter.map_from_base().y, 0.004, 1e-4);
  const Eigen::Matrix3d covariance = filter.PoseCovariance();
  EXPECT_GT(std::sqrt(covariance(0, 0) / covariance(1, 1)), 10.0);
}

/// Moves as told, and lets an exact laser tell the true way.
void DriveInARoom(PoseFilter* filter, double* true_way, double distance, double told_by_true) {
  const double step = 0.05;
  const Eigen::Matrix3d information = Noise(0.001, 0.001, 0.001).inverse();
  for (double way = 0.0; way < distance; way += step) {
    *true_way += step;
    filter->Predict(filter->map_from_base(), Forward(step * told_by_true), Noise(1e-3, 1e-3, 1e-3));
    filter->AddScan({*true_way, 0.0, 0.0}, information, Eigen::Vector3d::Zero());
  }
}

TEST(PoseFilter, FollowsAScaleThatChanges) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  double way = 0.0;
  DriveInARoom(&filter, &way, 200.0, 1.0);
  EXPECT_NEAR(filter.learned().encoder_scale, 1.0, 0.001);
  DriveInARoom(&filter, &way, 150.0, 1.0 / 0.98);
  EXPECT_NEAR(filter.learned().encoder_scale, 0.98, 0.004);
}

TEST(PoseFilter, AMotionThatTheEncodersDoNotTellTeachesNothingOfThem) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  MotionPrediction kept = Forward(1.0);
  kept.from_encoders = false;
  filter.Predict(Pose2(), kept, Noise(0.1, 0.1, 0.1));
  filter.AddScan({1.2, 0.0, 0.0}, Noise(1e-3, 1e-3, 1e-3).inverse(), Eigen::Vector3d::Zero());
  EXPECT_NEAR(filter.map_from_base().x, 1.2, 1e-3);
  EXPECT_EQ(filter.learned().encoder_scale, 1.0);
}

/// Drives along a corridor with edges every half metre on both walls; heading and the distance to
/// the walls come from the laser, the way along from the camera alone.
class CorridorDrive {
 public:
  explicit CorridorDrive(PoseFilter* filter) : filter_(filter) { filter_->Start(Pose2()); }

  double encoder_scale = 1.0;  // told by true
  double camera_yaw = 0.0;     // [rad]
  double bearing_noise = 0.0;  // [rad]
  Pose2 truth;

  void Drive(double distance, double slip = 0.0) {
    const double step = 0.02;
    for (double way = 0.0; way < distance; way += step) {
      truth.x += step;
      Step(step * encoder_scale + (way == 0.0 ? slip : 0.0));
    }
  }

  void Step(double told) {
    filter_->Predict(filter_->map_from_base(), Forward(told), Noise(0.001, 0.001, 0.002));
    Eigen::Matrix3d information = Noise(1.0, 0.002, 0.001).inverse();
    information(0, 0) = 0.0;
    filter_->AddScan({filter_->map_from_base().x, truth.y, truth.theta}, information,
                     Eigen::Vector3d::Zero());
    std::vector<ModelEdge> edges;
    for (double x = -1.0; x < 30.0; x += 0.5) {
      for (const double y : {-1.2, 1.2}) {
        const Eigen::Vector2d place(x + 0.1 * y, y);
        if (x - truth.x < 1.5 || x - truth.x > 4.0) continue;
        edges.push_back(EdgeTo(place, truth, camera_yaw));
        edges.back().bearing += bearing_noise * normal_(random_);
        PutOnWall(y, truth, &edges.back());
      }
    }
    filter_->AddEdges(edges, kFarthestSlip);
  }

 private:
  static constexpr double kFarthestSlip = 0.05;  // [m]
  PoseFilter* filter_;
  std::mt19937 random_{5};
  std::normal_distribution<double> normal_;
};

TEST(PoseFilter, EdgesTellTheWayAlongACorridorAndTheScaleOfTheEncoders) {
  PoseFilter filter(Options());
  CorridorDrive drive(&filter);
  drive.encoder_scale = 1.03;
  drive.bearing_noise = 0.0005;
  drive.Drive(20.0);
  EXPECT_NEAR(filter.map_from_base().x, drive.truth.x, 0.03);  // the encoders: 0.6 m
  EXPECT_NEAR(filter.learned().encoder_scale, 1.0 / 1.03, 0.003);
}

TEST(PoseFilter, FindsTheYawOfTheCamera) {
  PoseFilter filter(Options());
  CorridorDrive drive(&filter);
  drive.camera_yaw = 0.01;
  drive.bearing_noise = 0.0005;
  drive.Drive(10.0);
  EXPECT_NEAR(filter.learned().camera_yaw, 0.01, 0.001);
  EXPECT_LT(filter.learned().camera_yaw_stddev, 0.001);
}

TEST(PoseFilter, WithoutEdgesTheYawOfTheCameraStaysAsItIs) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  for (int i = 0; i < 100; ++i) {
    filter.Predict(filter.map_from_base(), Forward(0.02), Noise(0.001, 0.001, 0.001));
  }
  EXPECT_EQ(filter.learned().camera_yaw, 0.0);
  EXPECT_NEAR(filter.learned().camera_yaw_stddev, Options().camera_yaw_stddev, 1e-12);
}

TEST(PoseFilter, WheelsThatSlipAreFoundOutByTheEdges) {
  PoseFilter filter(Options());
  CorridorDrive drive(&filter);
  drive.Drive(5.0);
  drive.Drive(5.0, /*slip=*/0.07);  // many standard deviations of a step, and beyond the gate
  EXPECT_NEAR(filter.map_from_base().x, drive.truth.x, 0.005);
}

TEST(PoseFilter, ContradictsOnlyIfMostOfTheEdgesAreElsewhere) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  const std::vector<Eigen::Vector2d> places = {{2.0, 1.0}, {3.0, 1.0}, {2.5, -1.0}};
  std::vector<ModelEdge> edges;
  edges.reserve(places.size());
  for (const auto& place : places) edges.push_back(EdgeTo(place, Pose2()));
  Show(edges, &filter);
  EXPECT_FALSE(filter.Contradicts(edges, 0.05));
  edges[0].bearing += 0.02;
  EXPECT_FALSE(filter.Contradicts(edges, 0.05));
  edges[1].bearing += 0.02;
  EXPECT_TRUE(filter.Contradicts(edges, 0.05));
  EXPECT_FALSE(filter.Contradicts({}, 0.05));
}

TEST(PoseFilter, AnEdgeOfTheOtherSignIsAnotherOne) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  Show({EdgeTo({2.0, 1.0}, Pose2(), 0.0, 1)}, &filter);
  EXPECT_EQ(CountMatched(filter.AddEdges({EdgeTo({2.0, 1.0}, Pose2(), 0.0, -1)})), 0);
  EXPECT_EQ(CountMatched(filter.AddEdges({EdgeTo({2.0, 1.0}, Pose2(), 0.0, -1)})), 0);
  EXPECT_EQ(filter.edges(), 2);
  EXPECT_EQ(CountMatched(filter.AddEdges({EdgeTo({2.0, 1.0}, Pose2(), 0.0, 1)})), 1);
  EXPECT_EQ(filter.edges(), 2);
}

TEST(PoseFilter, TellsOfEachEdgeWhatItWasGoodFor) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  const ModelEdge edge = EdgeTo({2.0, 0.0}, Pose2());
  EXPECT_EQ(filter.AddEdges({edge}).front().use, EdgeUse::kNew) << "announced";
  EXPECT_EQ(filter.AddEdges({edge}).front().use, EdgeUse::kNew) << "begun";
  ModelEdge off = edge;
  off.bearing += 0.02;  // 4 cm: within the gate, but not as wrong as anything can be
  const std::vector<EdgeMatch> matches =
      filter.AddEdges({EdgeTo({2.0, 3.0}, Pose2()), off, EdgeTo({2.0, 0.12}, Pose2())});
  ASSERT_EQ(matches.size(), 3U);
  EXPECT_EQ(matches[0].use, EdgeUse::kNew);
  EXPECT_EQ(matches[1].use, EdgeUse::kRefused);
  EXPECT_NEAR(matches[1].residual, 0.02, 1e-3);
  EXPECT_EQ(matches[2].use, EdgeUse::kLeftOut) << "too near to the known one to be told from it";
  EXPECT_EQ(filter.AddEdges({edge}).front().use, EdgeUse::kMatched);
}

/// The frame of a poster has two edges of a sign a few centimetres apart, and images that miss one.
TEST(PoseFilter, IsNotMistakenForTheOneBesideItInAnImageThatMissesIt) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  Show({EdgeTo({2.0, 0.0}, Pose2())}, &filter);
  ModelEdge beside = EdgeTo({2.0, 0.06}, Pose2());
  beside.bearing_stddev = 0.02;  // poor enough to be the known one by its noise
  EXPECT_EQ(filter.AddEdges({beside}).front().use, EdgeUse::kLeftOut);
  EXPECT_EQ(filter.map_from_base().y, 0.0);
  EXPECT_EQ(filter.map_from_base().theta, 0.0);
}

TEST(PoseFilter, BetweenGateAndSeparationItIsNeitherKnownNorNew) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  Show({EdgeTo({2.0, 0.0}, Pose2())}, &filter);
  Show({EdgeTo({2.0, 0.12}, Pose2())}, &filter);  // gate 0.05, separation 0.15
  EXPECT_EQ(filter.edges(), 1);
  Show({EdgeTo({2.0, 0.2}, Pose2())}, &filter);
  EXPECT_EQ(filter.edges(), 2);
}

TEST(PoseFilter, AnEdgeOutOfViewIsForgotten) {
  PoseFilterOptions options = Options();
  options.keep_distance = 1.0;
  PoseFilter filter(options);
  filter.Start(Pose2());
  Show({EdgeTo({2.0, 1.0}, Pose2())}, &filter);
  filter.Predict(Pose2(), Forward(0.9), kNothing * Eigen::Matrix3d::Identity());
  EXPECT_EQ(filter.edges(), 1);
  filter.Predict(filter.map_from_base(), Forward(0.2), kNothing * Eigen::Matrix3d::Identity());
  EXPECT_EQ(filter.edges(), 0);
  EXPECT_EQ(filter.PoseCovariance().rows(), 3);
}

/// What it says of its error, over many corridors: the normalised squared error of the way.
TEST(PoseFilter, IsAsWrongAsItSays) {
  double sum = 0.0;
  constexpr int kRuns = 40;
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (int i = 0; i < kRuns; ++i) {
    PoseFilter filter(Options());
    CorridorDrive drive(&filter);
    drive.encoder_scale = 1.0 + Options().scale_stddev * normal(random);
    drive.camera_yaw = Options().camera_yaw_stddev * normal(random);
    drive.bearing_noise = 0.0005;
    drive.truth.y = 0.05 * normal(random);
    filter.Start(drive.truth);
    drive.Drive(4.0);
    const double error = filter.map_from_base().x - drive.truth.x;
    sum += error * error / filter.PoseCovariance()(0, 0) / kRuns;
  }
  // Chi-square with 40 degrees of freedom, over 40: 95 % lie in 0.61 to 1.48. The noise of the
  // motion is not drawn, so it may be less.
  EXPECT_LT(sum, 1.48);
  EXPECT_GT(sum, 0.05);
}

TEST(PoseFilter, RefusesWrongOptions) {
  PoseFilterOptions options;
  options.edge_correlation = 0.5;
  EXPECT_THROW(PoseFilter{options}, std::invalid_argument);
  options = PoseFilterOptions();
  options.edge_bias = -0.1;
  EXPECT_THROW(PoseFilter{options}, std::invalid_argument);
  options = PoseFilterOptions();
  options.scale_stddev = -1.0;
  EXPECT_THROW(PoseFilter{options}, std::invalid_argument);
  options = PoseFilterOptions();
  options.keep_distance = 0.0;
  EXPECT_THROW(PoseFilter{options}, std::invalid_argument);
}

}  // namespace
}  // namespace scan_image_slam
