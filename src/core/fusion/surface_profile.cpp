#include "scan_image_slam/core/fusion/surface_profile.h"

#include "scan_image_slam/core/fusion/beam_spacing.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scan_image_slam {
namespace {

/// Beams without a hit that a surface may bridge.
constexpr int kMaxMissingBeams = 2;
/// Tangent of the steepest incidence at which two neighbouring hits are still one surface.
constexpr double kMaxRangeSlope = 14.0;
/// Columns by which a surface reaches over its last beam into a farther one.
constexpr int kReachOver = 2;
/// Surfaces whose distances differ by less are the same [m].
constexpr double kSameSurface = 0.1;

bool Connected(const ModelBeam& a, const ModelBeam& b) {
  return std::abs(b.range - a.range) <=
         kMaxRangeSlope * std::min(a.range, b.range) * AngleBetween(a, b);
}

class ProfileBuilder {
 public:
  ProfileBuilder(const std::vector<Eigen::Vector2d>& points, const BearingImage& image)
      : points_(points), image_(image), centre_(image.centre().head<2>()) {
    profile_.columns.resize(image.columns());
  }

  /// The piece of surface between the hits of two beams.
  void AddSegment(int a, int b) {
    const Eigen::Vector2d pa = points_[a] - centre_;
    const Eigen::Vector2d pb = points_[b] - centre_;
    const double ca = ColumnOf(pa);
    const double cb = ColumnOf(pb);
    if (std::abs(ca - cb) > 0.5 * image_.columns()) return;  // behind the camera
    const int begin = std::max(0, static_cast<int>(std::ceil(std::min(ca, cb))));
    const int end = std::min(image_.columns() - 1, static_cast<int>(std::floor(std::max(ca, cb))));
    const Eigen::Vector2d along = pb - pa;
    const double cross = Cross(pa, along);
    for (int c = begin; c <= end; ++c) {
      const double bearing = image_.Bearing(c);
      const Eigen::Vector2d ray(std::cos(bearing), std::sin(bearing));
      const double denominator = Cross(ray, along);
      if (denominator == 0.0) continue;
      Offer(c, cross / denominator, std::abs(c - ca) < std::abs(c - cb) ? a : b);
    }
  }

  /// Between the hits of two beams on different surfaces the nearer one ends, nobody knows where:
  /// an edge there is its border. Seen from aside the gap may be wider than `max_angle` [rad], and
  /// then there may be anything in it.
  void AddGap(int a, int b, double max_angle) {
    if ((points_[b] - centre_).norm() < (points_[a] - centre_).norm()) std::swap(a, b);
    const Eigen::Vector2d near = points_[a] - centre_;
    const double ca = ColumnOf(near);
    const double cb = ColumnOf(points_[b] - centre_);
    if (std::abs(ca - cb) * image_.step() > max_angle) return;
    const int begin = std::max(0, static_cast<int>(std::ceil(std::min(ca, cb))));
    const int end = std::min(image_.columns() - 1, static_cast<int>(std::floor(std::max(ca, cb))));
    for (int c = begin; c <= end; ++c) Offer(c, near.norm(), a);
  }

  /// A hit that stands alone covers its own column.
  void AddPoint(int a) {
    const Eigen::Vector2d p = points_[a] - centre_;
    const int column = static_cast<int>(std::lround(ColumnOf(p)));
    if (column >= 0 && column < image_.columns()) Offer(column, p.norm(), a);
  }

  /// Lets near surfaces reach over farther ones: an edge at their border is theirs.
  SurfaceProfile Finish() const {
    SurfaceProfile result = profile_;
    const int last = image_.columns() - 1;
    for (int c = 0; c <= last; ++c) {
      SurfaceProfile::Column& column = result.columns[c];
      for (int n = std::max(0, c - kReachOver); n <= std::min(last, c + kReachOver); ++n) {
        const SurfaceProfile::Column& neighbour = profile_.columns[n];
        if (neighbour.distance <= 0.0) continue;
        if (column.distance <= 0.0 || neighbour.distance < column.distance - kSameSurface) {
          column = neighbour;
        }
      }
    }
    return result;
  }

 private:
  double ColumnOf(const Eigen::Vector2d& p) const {
    const double middle = image_.Bearing(0.5 * image_.columns());
    return image_.Column(middle + NormalizeAngle(std::atan2(p.y(), p.x()) - middle));
  }

  void Offer(int column, double distance, int beam) {
    SurfaceProfile::Column& c = profile_.columns[column];
    if (distance > 0.0 && (c.distance <= 0.0 || distance < c.distance)) c = {distance, beam};
  }

  const std::vector<Eigen::Vector2d>& points_;
  const BearingImage& image_;
  Eigen::Vector2d centre_;
  SurfaceProfile profile_;
};

}  // namespace

SurfaceProfile MakeSurfaceProfile(const FusedModel& model,
                                  const std::vector<Eigen::Vector2d>& points,
                                  const BearingImage& image) {
  ProfileBuilder builder(points, image);
  const double max_angle = (kMaxMissingBeams + 1.5) * BeamSpacing(model.beams);
  const auto join = [&](int a, int b) {
    if (AngleBetween(model.beams[a], model.beams[b]) > max_angle) return;
    if (Connected(model.beams[a], model.beams[b])) {
      builder.AddSegment(a, b);
    } else {
      builder.AddGap(a, b, max_angle);
    }
  };
  int first = -1;
  int previous = -1;
  for (int i = 0; i < static_cast<int>(model.beams.size()); ++i) {
    if (!model.beams[i].hit()) continue;
    builder.AddPoint(i);
    if (previous >= 0) join(previous, i);
    if (first < 0) first = i;
    previous = i;
  }
  if (previous > first) join(previous, first);  // a full turn has no seam
  return builder.Finish();
}

}  // namespace scan_image_slam
