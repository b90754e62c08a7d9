#include "scan_image_slam/core/matching/pose_filter.h"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include <Eigen/Eigenvalues>

namespace scan_image_slam {
namespace {

constexpr double kScaleWalk = 3e-4;        // how the scale changes: loads, floors [1/sqrt(m)]
constexpr double kGate = 3.0;              // farther off is no measurement of it [std. deviations]
constexpr std::size_t kMostEdges = 40;     // at once; more would tell nothing new
constexpr double kLeastInformation = 1.0;  // of a direction [1/m^2, 1/rad^2]
constexpr double kLeastTilt = 0.01;        // what the normals of a scan are good for [rad]
constexpr double kSmoothing = 0.1;         // share of the newest sight in an edge's precision
constexpr double kTurnNoise = 0.012;       // of what is known of a turn between two scans [rad/s]
constexpr double kPatience = 0.2;  // driven until a newcomer not seen again is forgotten [m]

/// From (forward, left, turn) of the base to (x, y, turn) of the map.
Eigen::Matrix3d MapFromBase(double heading) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(heading).toRotationMatrix();
  return rotation;
}

/// How the place of an edge on its surface changes with its bearing, in the map [m/rad].
Eigen::Vector2d AlongSurface(const ModelEdge& edge, const Eigen::Vector2d& ray) {
  return edge.range * Across(ray) + edge.range_by_bearing * ray;
}

}  // namespace

void PoseFilterOptions::Validate() const {
  edges.Validate();
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw std::invalid_argument(what);
  };
  require(max_new_slant > 0.0, "max_new_slant must be positive");
  require(edge_correlation >= 1.0, "edge_correlation must be at least 1");
  require(edge_bias >= 0.0, "edge_bias must not be negative");
  require(scale_stddev >= 0.0, "scale_stddev must not be negative");
  require(camera_yaw_stddev >= 0.0, "camera_yaw_stddev must not be negative");
  require(keep_distance > 0.0, "keep_distance must be positive");
}

PoseFilter::PoseFilter(const PoseFilterOptions& options) : options_(options) {
  options_.Validate();
  Start(Pose2());
}

void PoseFilter::Start(const Pose2& map_from_base) {
  map_from_base_ = map_from_base;
  state_ = Eigen::VectorXd::Zero(kFirstEdge);
  state_[kScale] = 1.0;
  anchor_covariance_.setZero();
  covariance_ = Eigen::MatrixXd::Zero(kFirstEdge, kFirstEdge);
  covariance_(kScale, kScale) = options_.scale_stddev * options_.scale_stddev;
  covariance_(kYaw, kYaw) = options_.camera_yaw_stddev * options_.camera_yaw_stddev;
  tracks_.clear();
  newcomers_.Clear();
}

void PoseFilter::Predict(const Pose2& map_from_last, const MotionPrediction& prediction,
                         const Eigen::Matrix3d& covariance) {
  const Pose2& motion = prediction.motion;
  const double scale = prediction.from_encoders ? this->scale() : 1.0;
  const Eigen::Matrix3d map_from_base = MapFromBase(map_from_last.theta);
  const Eigen::Vector2d way = map_from_base.topLeftCorner<2, 2>() * motion.translation();
  // The motion turns with the error of the heading and grows with that of the scale.
  Eigen::Matrix2d by_turn_and_scale = Eigen::Matrix2d::Zero();
  by_turn_and_scale.col(0) = scale * Across(way);
  if (prediction.from_encoders) by_turn_and_scale.col(1) = way;
  covariance_.topRows<2>() += (by_turn_and_scale * covariance_.middleRows<2>(2)).eval();
  covariance_.leftCols<2>() +=
      (covariance_.middleCols<2>(2) * by_turn_and_scale.transpose()).eval();
  covariance_.topLeftCorner<3, 3>() += map_from_base * covariance * map_from_base.transpose();
  const double driven = scale * way.norm();
  covariance_(kScale, kScale) += kScaleWalk * kScaleWalk * driven;
  map_from_base_ = map_from_last * Pose2{scale * motion.x, scale * motion.y, motion.theta};
  way_ += driven;
  ForgetOld();
}

void PoseFilter::Anchor() {
  const Eigen::Vector2d along = LeastKnownDirection();
  const Eigen::Matrix2d project = along * along.transpose();
  anchor_covariance_ += project * covariance_.topLeftCorner<2, 2>() * project;
  Eigen::MatrixXd change = Eigen::MatrixXd::Identity(state_.size(), state_.size());
  change.topLeftCorner<2, 2>() -= project;
  for (int i = 0; i < edges(); ++i) change.block<2, 2>(IndexOf(i), 0) = -project;
  covariance_ = change * covariance_ * change.transpose();
}

void PoseFilter::AddScan(const Pose2& map_from_base, const Eigen::Matrix3d& information,
                         const Eigen::Vector3d& gradient) {
  // In its own directions the scan measures three numbers that have nothing to do with each other.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  const Eigen::Matrix3d rotation = MapFromBase(map_from_base.theta);
  const Eigen::Vector2d least_known =
      rotation.topLeftCorner<2, 2>().transpose() * LeastKnownDirection();
  for (int i = 0; i < 3; ++i) {
    const double amount = eigen.eigenvalues()[i];
    if (amount < kLeastInformation) continue;
    Eigen::Vector3d direction = eigen.eigenvectors().col(i);
    // Walls of a corridor that seem to be tilted say nothing of the way along it, or thousands of
    // scans would together.
    const double part = least_known.dot(direction.head<2>());
    if (std::abs(part) < kLeastTilt * direction.head<2>().norm()) {
      direction.head<2>() -= part * least_known;
    }
    const Pose2 off = map_from_base.Inverse() * map_from_base_;
    const double here = direction.dot(off.coordinates());
    const double best = -direction.dot(gradient) / amount;
    Eigen::VectorXd jacobian = Eigen::VectorXd::Zero(state_.size());
    jacobian.head<3>() = rotation * direction;
    Update(best - here, 1.0 / amount, jacobian);
  }
}

bool PoseFilter::Contradicts(const std::vector<ModelEdge>& edges, double slip) const {
  int known = 0;
  int off = 0;
  for (const ModelEdge& edge : edges) {
    const int track = Nearest(edge, options_.edges.gate + slip);
    if (track < 0) continue;
    const Sight sight = SightOf(edge, track);
    ++known;
    if (std::abs(sight.innovation) > kGate * std::sqrt(VarianceOf(sight))) ++off;
  }
  return known >= 2 && 2 * off > known;
}

/// The way along is uncertain by so much more [m].
void PoseFilter::DoubtWay(double stddev) {
  const Eigen::Vector2d along = Direction(map_from_base_.theta);
  covariance_.topLeftCorner<2, 2>() += stddev * stddev * along * along.transpose();
}

std::vector<EdgeMatch> PoseFilter::AddEdges(const std::vector<ModelEdge>& edges,
                                            double farthest_slip) {
  const bool slipped = farthest_slip > 0.0 && Contradicts(edges, farthest_slip);
  if (slipped) DoubtWay(farthest_slip / 3.0);
  const double reach = options_.edges.gate + (slipped ? farthest_slip : 0.0);
  std::vector<EdgeMatch> matches(edges.size());
  if (!edges.empty()) BeginImage(edges.front().time_offset);
  // All are assigned before the first moves the pose.
  std::vector<std::pair<std::size_t, int>> known;
  std::vector<const ModelEdge*> unknown;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const int track = Nearest(edges[i], reach);
    if (track >= 0) {
      known.emplace_back(i, track);
    } else if (Nearest(edges[i], options_.edges.min_separation) < 0) {
      unknown.push_back(&edges[i]);
      matches[i].use = EdgeUse::kNew;
    }
  }
  for (const auto& [i, track] : known) {
    LetShift(edges[i], track);
    const Sight sight = SightOf(edges[i], track);
    matches[i] = {EdgeUse::kRefused, sight.innovation};
    if (std::abs(sight.innovation) > kGate * std::sqrt(VarianceOf(sight))) continue;
    matches[i].use = EdgeUse::kMatched;
    Update(sight.innovation, sight.variance, sight.jacobian);
    tracks_[track].last_seen = way_;
  }
  Welcome(unknown);
  return matches;
}

/// How the base has turned between image and scan is not known exactly, and what is wrong of it is
/// wrong of all edges of the image alike.
void PoseFilter::BeginImage(double time_offset) {
  state_[kImageTurn] = 0.0;
  covariance_.row(kImageTurn).setZero();
  covariance_.col(kImageTurn).setZero();
  covariance_(kImageTurn, kImageTurn) = std::pow(kTurnNoise * time_offset, 2);
}

/// Where an edge comes nearer, the first image that shows it near enough is one whose noise shows
/// it too near: it only announces the edge, which begins with the next image. Else all edges would
/// begin too near, and the way along a corridor be too short by thousandths.
void PoseFilter::Welcome(const std::vector<const ModelEdge*>& unknown) {
  std::vector<const ModelEdge*> announced;
  for (const ModelEdge* edge : unknown) {
    if (tracks_.size() >= kMostEdges) break;
    if (newcomers_.Take(PlaceOf(*edge), edge->sign, options_.edges.gate)) {
      Begin(*edge);
    } else if (std::hypot(edge->range, edge->range_by_bearing) <= options_.max_new_slant) {
      announced.push_back(edge);
    }
  }
  for (const ModelEdge* edge : announced) newcomers_.Add(PlaceOf(*edge), edge->sign, way_);
}

Eigen::Matrix3d PoseFilter::PoseCovariance() const {
  Eigen::Matrix3d covariance = CovarianceFromAnchor();
  const Eigen::Rotation2Dd rotation(map_from_base_.theta);
  covariance.topLeftCorner<2, 2>() +=
      rotation.inverse() * anchor_covariance_ * rotation.toRotationMatrix();
  return covariance;
}

Eigen::Matrix3d PoseFilter::CovarianceFromAnchor() const {
  const Eigen::Matrix3d rotation = MapFromBase(map_from_base_.theta);
  return rotation.transpose() * covariance_.topLeftCorner<3, 3>() * rotation;
}

LearnedCalibration PoseFilter::learned() const {
  return {scale(), camera_yaw(), std::sqrt(covariance_(kYaw, kYaw))};
}

Eigen::Vector2d PoseFilter::LeastKnownDirection() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance_.topLeftCorner<2, 2>());
  return eigen.eigenvectors().col(1);
}

/// Where an edge is in the map: on the surface that the laser sees at its bearing.
Eigen::Vector2d PoseFilter::PlaceOf(const ModelEdge& edge) const {
  return map_from_base_ *
         Eigen::Vector2d(edge.camera + (edge.range + edge.range_by_bearing * view_yaw()) *
                                           Direction(edge.bearing + view_yaw()));
}

int PoseFilter::Nearest(const ModelEdge& edge, double reach) const {
  const Eigen::Vector2d place = PlaceOf(edge);
  int nearest = -1;
  for (int i = 0; i < static_cast<int>(tracks_.size()); ++i) {
    const double distance = (PlaceOf(i) - place).norm();
    if (tracks_[i].sign != edge.sign || distance >= reach) continue;
    reach = distance;
    nearest = i;
  }
  return nearest;
}

/// The image measures the bearing of the edge from the camera.
PoseFilter::Sight PoseFilter::SightOf(const ModelEdge& edge, int track) const {
  const Eigen::Vector2d camera = map_from_base_ * edge.camera;
  const Eigen::Vector2d ray = PlaceOf(track) - camera;
  const double range = ray.norm();
  const Eigen::Vector2d across = Across(ray / range);
  const Eigen::Vector2d arm = camera - map_from_base_.translation();
  Sight sight;
  sight.innovation = NormalizeAngle(edge.bearing + view_yaw() + map_from_base_.theta -
                                    std::atan2(ray.y(), ray.x()));
  sight.variance = options_.edge_correlation * edge.bearing_stddev * edge.bearing_stddev;
  sight.jacobian = Eigen::VectorXd::Zero(state_.size());
  sight.jacobian.head<2>() = -across / range;
  sight.jacobian[2] = -across.dot(Across(arm)) / range - 1.0;
  sight.jacobian[kYaw] = sight.jacobian[kImageTurn] = -1.0;
  sight.jacobian.segment<2>(IndexOf(track)) = across / range;
  return sight;
}

double PoseFilter::VarianceOf(const Sight& sight) const {
  return sight.jacobian.dot(covariance_ * sight.jacobian) + sight.variance;
}

void PoseFilter::Update(double innovation, double variance, const Eigen::VectorXd& jacobian) {
  const Eigen::VectorXd cross = covariance_ * jacobian;
  const Eigen::VectorXd gain = cross / (jacobian.dot(cross) + variance);
  covariance_ -= gain * cross.transpose();
  state_ += innovation * gain;
  map_from_base_ = Pose2{map_from_base_.x + state_[0], map_from_base_.y + state_[1],
                         NormalizeAngle(map_from_base_.theta + state_[2])};
  state_.head<3>().setZero();
}

/// What is finer than a column of the image runs into the edge and shifts it, in one image like in
/// the next; the shift changes as the edge comes nearer.
void PoseFilter::LetShift(const ModelEdge& edge, int id) {
  Track& track = tracks_[id];
  track.bearing_stddev += kSmoothing * (edge.bearing_stddev - track.bearing_stddev);
  const Eigen::Vector2d along =
      AlongSurface(edge, Direction(edge.bearing + view_yaw() + map_from_base_.theta));
  const double variance = ShiftVariance(track.bearing_stddev, along);
  const int i = IndexOf(id);
  covariance_.block<2, 2>(i, i) += std::abs(variance - track.shift_variance) * along.normalized() *
                                   along.normalized().transpose();
  track.shift_variance = variance;
}

double PoseFilter::ShiftVariance(double bearing_stddev, const Eigen::Vector2d& along) const {
  return std::pow(options_.edge_bias * bearing_stddev, 2) * along.squaredNorm();
}

/// A new edge is where the laser's range puts it, and as wrong as the pose and the camera's yaw.
void PoseFilter::Begin(const ModelEdge& edge) {
  const int size = static_cast<int>(state_.size());
  const Eigen::Vector2d place = PlaceOf(edge);
  const Eigen::Vector2d ray = (place - map_from_base_ * edge.camera).normalized();
  const Eigen::Vector2d across = Across(ray);
  const Eigen::Vector2d arm = place - map_from_base_.translation();
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(2, size);
  jacobian.leftCols<2>().setIdentity();
  jacobian(0, 2) = -arm.y();
  jacobian(1, 2) = arm.x();
  jacobian.col(kYaw) = jacobian.col(kImageTurn) = edge.range * across + edge.range_by_bearing * ray;
  const double along_variance =
      std::pow(edge.range_stddev, 2) + std::pow(options_.edges.surface_stddev, 2);
  const double across_variance =
      options_.edge_correlation * std::pow(edge.bearing_stddev * edge.range, 2);

  Eigen::MatrixXd covariance(size + 2, size + 2);
  covariance.topLeftCorner(size, size) = covariance_;
  covariance.bottomLeftCorner(2, size) = jacobian * covariance_;
  covariance.topRightCorner(size, 2) = covariance.bottomLeftCorner(2, size).transpose();
  covariance.bottomRightCorner<2, 2>() = jacobian * covariance_ * jacobian.transpose() +
                                         along_variance * ray * ray.transpose() +
                                         across_variance * across * across.transpose();
  covariance_ = covariance;
  state_.conservativeResize(size + 2);
  state_.tail<2>() = place;
  tracks_.push_back({edge.sign, way_, edge.bearing_stddev,
                     ShiftVariance(edge.bearing_stddev, AlongSurface(edge, ray))});
}

/// What has been out of view for a while leaves the filter.
void PoseFilter::ForgetOld() {
  newcomers_.ForgetBefore(way_ - kPatience);
  std::vector<int> kept(kFirstEdge);
  std::iota(kept.begin(), kept.end(), 0);
  std::vector<Track> tracks;
  for (int i = 0; i < static_cast<int>(tracks_.size()); ++i) {
    if (tracks_[i].last_seen < way_ - options_.keep_distance) continue;
    kept.push_back(IndexOf(i));
    kept.push_back(IndexOf(i) + 1);
    tracks.push_back(tracks_[i]);
  }
  if (tracks.size() == tracks_.size()) return;
  const int size = static_cast<int>(kept.size());
  Eigen::VectorXd state(size);
  Eigen::MatrixXd covariance(size, size);
  for (int i = 0; i < size; ++i) {
    state[i] = state_[kept[i]];
    for (int j = 0; j < size; ++j) covariance(i, j) = covariance_(kept[i], kept[j]);
  }
  state_ = state;
  covariance_ = covariance;
  tracks_ = tracks;
}

}  // namespace scan_image_slam
