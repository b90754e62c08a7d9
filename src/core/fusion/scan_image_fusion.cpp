#include "scan_image_slam/core/fusion/scan_image_fusion.h"

#include "scan_image_slam/core/geometry/line_fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace scan_image_slam {
namespace {

/// The surface around a beam: a line through the hits beside it.
struct LocalSurface {
  Line line;
  bool valid = false;
};
LocalSurface SurfaceAround(const FusedModel& model, const std::vector<Eigen::Vector2d>& points,
                           int beam) {
  constexpr double kRadius = 0.15;        // [m]
  constexpr int kMinNeighbours = 2;       // on each side, where beams are far apart
  constexpr double kMaxDeviation = 0.04;  // of the points from the line [m]
  const auto fit = [&](int left, int right) {
    PointSums sums;
    const auto add_towards = [&](int step, int count) {
      int taken = 0;
      for (int i = beam + step; count != 0 && i >= 0 && i < static_cast<int>(points.size());
           i += step) {
        if (!model.beams[i].hit()) break;
        const double distance = (points[i] - points[beam]).norm();
        if (distance > kRadius && ++taken > kMinNeighbours) break;
        if (std::abs(model.beams[i].range - model.beams[i - step].range) > kRadius) break;
        sums = sums.Plus(points[i]);
      }
    };
    sums = sums.Plus(points[beam]);
    add_towards(-1, left);
    add_towards(1, right);
    LocalSurface surface;
    if (sums.n < 3.0) return surface;
    surface.line = FitLine(sums);
    surface.valid = std::sqrt(surface.line.variance) < kMaxDeviation;
    return surface;
  };
  LocalSurface best = fit(1, 1);
  for (const LocalSurface& one_sided : {fit(1, 0), fit(0, 1)}) {
    if (!one_sided.valid) continue;
    if (!best.valid || one_sided.line.variance < 0.25 * best.line.variance) best = one_sided;
  }
  return best;
}

}  // namespace

void ScanImageFusionOptions::Validate() const {
  scan.Validate();
  edges.Validate();
  odometry.Validate();
  if (!(max_image_age > 0.0)) throw std::invalid_argument("max_image_age must be positive");
  if (!std::isfinite(camera_time_offset)) {
    throw std::invalid_argument("camera_time_offset must be finite");
  }
  if (!(max_edge_slant > 0.0)) {
    throw std::invalid_argument("max_edge_slant must be positive");
  }
  if (!(edge_bearing_stddev > 0.0)) {
    throw std::invalid_argument("edge_bearing_stddev must be positive");
  }
}

ScanImageFusion::ScanImageFusion(const ScanImageFusionOptions& options)
    : options_(options), odometry_(options.odometry) {
  options_.Validate();
}

void ScanImageFusion::SetOptions(const ScanImageFusionOptions& options) {
  options.Validate();
  options_ = options;
}

void ScanImageFusion::SetCamera(const CameraIntrinsics& intrinsics,
                                const Eigen::Isometry3d& base_from_camera) {
  auto camera = std::make_unique<CameraModel>(intrinsics);
  bearing_image_ = std::make_unique<BearingImage>(*camera, base_from_camera);
  camera_ = std::move(camera);
  camera_from_base_ = base_from_camera.inverse();
  if (pending_image_ && !Fits(*pending_image_)) pending_image_.reset();
}

void ScanImageFusion::RemoveCamera() {
  bearing_image_.reset();
  camera_.reset();
  pending_image_.reset();
}

void ScanImageFusion::AddImage(const CameraImage& image) {
  if (has_camera() && !Fits(image)) {
    const CameraIntrinsics& intrinsics = camera_->intrinsics();
    throw std::invalid_argument("the image has " + std::to_string(image.grey.cols) + " x " +
                                std::to_string(image.grey.rows) + " pixels, but camera_info says " +
                                std::to_string(intrinsics.width) + " x " +
                                std::to_string(intrinsics.height));
  }
  pending_image_ = image;
  pending_image_->stamp += FromSeconds(options_.camera_time_offset);
}

bool ScanImageFusion::Fits(const CameraImage& image) const {
  const CameraIntrinsics& intrinsics = camera_->intrinsics();
  return image.grey.cols == intrinsics.width && image.grey.rows == intrinsics.height;
}

void ScanImageFusion::Reset() {
  odometry_.Clear();
  pending_image_.reset();
  evidence_ = FusionEvidence();
}

FusedModel ScanImageFusion::Fuse(const LaserScan& scan) {
  FusedModel model = MakeScanModel(scan, laser_, SweepVelocity(scan), options_.scan);
  if (pending_image_ && has_camera()) {
    const CameraImage image = *std::exchange(pending_image_, std::nullopt);
    if (std::abs(Seconds(image.stamp - scan.stamp)) <= options_.max_image_age) {
      FuseImage(image, &model);
    }
  }
  return model;
}

/// What the encoders say of the motion while the laser turned.
Velocity2 ScanImageFusion::SweepVelocity(const LaserScan& scan) const {
  const double sweep = scan.time_increment * static_cast<double>(scan.ranges.size());
  if (sweep <= 0.0) return {};
  const std::optional<Pose2> begin = odometry_.ContinuousPose(scan.stamp);
  const std::optional<Pose2> end = odometry_.ContinuousPose(scan.stamp + FromSeconds(sweep));
  if (!begin || !end) return {};
  return VelocityOf(begin->Inverse() * *end, sweep);
}

/// How the base has moved from the image to the scan, by the encoders.
Pose2 ScanImageFusion::ScanFromImage(Stamp scan, Stamp image) const {
  const std::optional<Pose2> at_scan = odometry_.ContinuousPose(scan);
  const std::optional<Pose2> at_image = odometry_.ContinuousPose(image);
  return at_scan && at_image ? at_scan->Inverse() * *at_image : Pose2();
}

/// The hits of a model in the base frame at the time of the image, one for each beam.
std::vector<Eigen::Vector2d> ScanImageFusion::PointsAtImage(const FusedModel& model,
                                                            Stamp image) const {
  const RigidTransform2 image_from_scan(ScanFromImage(model.stamp, image).Inverse());
  std::vector<Eigen::Vector2d> points;
  points.reserve(model.beams.size());
  for (const ModelBeam& beam : model.beams) points.push_back(image_from_scan * beam.point);
  return points;
}

void ScanImageFusion::FuseImage(const CameraImage& image, FusedModel* model) {
  model->has_image = true;
  const std::vector<Eigen::Vector2d> points = PointsAtImage(*model, image.stamp);
  evidence_.image = image;
  evidence_.profile = MakeSurfaceProfile(*model, points, *bearing_image_);
  evidence_.region =
      MakeRegionOfInterest(evidence_.profile, *bearing_image_, laser_.height, options_.edges);
  evidence_.edges = ExtractEdges(image.grey, *bearing_image_, evidence_.profile, evidence_.region,
                                 options_.edges);
  evidence_.in_model.clear();
  for (const ImageEdge& image_edge : evidence_.edges) {
    const int column = static_cast<int>(std::lround(image_edge.column));
    const int beam_index = evidence_.profile.columns[column].beam;
    ModelBeam& beam = model->beams[beam_index];
    if (image_edge.weight > beam.edge_weight) {
      beam.edge_weight = image_edge.weight;
      beam.edge_sign = image_edge.sign;
    }
    const std::optional<ModelEdge> edge =
        ToModelEdge(image_edge, *model, points, image.stamp, beam_index);
    evidence_.in_model.push_back(edge ? static_cast<int>(model->edges.size()) : -1);
    if (edge) model->edges.push_back(*edge);
  }
}

/// The edge where its ray meets the surface around a beam, or nothing if there is no clear surface.
std::optional<ModelEdge> ScanImageFusion::ToModelEdge(const ImageEdge& image_edge,
                                                      const FusedModel& model,
                                                      const std::vector<Eigen::Vector2d>& points,
                                                      Stamp image, int beam) const {
  constexpr double kMinCosine = 0.02;  // more grazing rays say nothing of the range
  // As measured on doors and posters: what makes a fit uncertain shifts the edge in one image like
  // in the next, and so do details that a column can't show.
  constexpr double kShiftByFit = 4.0;         // standard deviations of the fit [-]
  constexpr double kShiftByFootprint = 10.0;  // [px/m]
  constexpr double kMaxShift = 0.3;           // [px]
  const LocalSurface surface = SurfaceAround(model, points, beam);
  if (!surface.valid) return std::nullopt;
  const Eigen::Vector2d camera = bearing_image_->centre().head<2>();
  const double bearing = bearing_image_->Bearing(image_edge.column);
  const Eigen::Vector2d ray(std::cos(bearing), std::sin(bearing));
  const double cosine = surface.line.normal.dot(ray);
  if (std::abs(cosine) < kMinCosine) return std::nullopt;
  ModelEdge edge;
  edge.range = surface.line.normal.dot(surface.line.centre - camera) / cosine;
  if (edge.range <= 0.0) return std::nullopt;
  const double slant = edge.range / std::abs(cosine);
  if (slant > options_.max_edge_slant) return std::nullopt;
  // How much of the wall a column shows: what is finer runs into one, and shifts the edge.
  const double footprint = bearing_image_->step() * slant;
  edge.range_stddev = std::sqrt(surface.line.variance) / std::abs(cosine);
  const Eigen::Vector2d left(-ray.y(), ray.x());
  edge.range_by_bearing = -edge.range * surface.line.normal.dot(left) / cosine;
  const Pose2 scan_from_image = ScanFromImage(model.stamp, image);
  edge.camera = scan_from_image * camera;
  edge.bearing = NormalizeAngle(bearing + scan_from_image.theta);
  edge.bearing_stddev =
      bearing_image_->step() * std::hypot(kShiftByFit * image_edge.column_stddev,
                                          options_.edge_bearing_stddev,
                                          std::min(kMaxShift, kShiftByFootprint * footprint));
  edge.time_offset = Seconds(image - model.stamp);
  edge.sign = image_edge.sign;
  edge.weight = image_edge.weight;
  edge.contrast = image_edge.contrast;
  return edge;
}

std::vector<cv::Point2f> ScanImageFusion::BeamPixels(const FusedModel& model) const {
  const std::vector<Eigen::Vector2d> points = PointsAtImage(model, evidence_.image.stamp);
  std::vector<cv::Point3d> in_camera;
  in_camera.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p =
        camera_from_base_ * Eigen::Vector3d(points[i].x(), points[i].y(), laser_.height);
    in_camera.emplace_back(p.x(), p.y(), model.beams[i].hit() ? p.z() : -1.0);
  }
  return camera_->Project(in_camera);
}

}  // namespace scan_image_slam
