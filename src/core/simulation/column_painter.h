#pragma once

#include "ripmap.h"
#include "scan_image_slam/core/simulation/scene_view.h"
#include "span_fill.h"
#include "textures.h"

#include <array>
#include <memory>
#include <vector>

namespace scan_image_slam {

/// All textures of a world, made once.
template <typename Pixel>
struct TextureSet {
  explicit TextureSet(const World& world);
  std::array<std::unique_ptr<Ripmap<std::uint8_t>>, 8> materials;  ///< by Material; kPlain: none
  std::vector<Ripmap<Pixel>> pictures;
};

/// A column of the grid or a part of it, as directions in the frame of the view.
struct Strip {
  Eigen::Vector2d left;
  Eigen::Vector2d middle;
  Eigen::Vector2d right;
};

/// Paints one surface after the other into a column.
template <typename Pixel>
class ColumnPainter {
 public:
  ColumnPainter(const World& world, const BearingGrid& grid, const TextureSet<Pixel>& textures);

  /// To be called before the columns of a new image.
  void Begin(const SceneView& view);

  /// Floor and ceiling up to a wall at a horizontal distance [m].
  void PaintPlanes(const Strip& strip, double distance, Pixel* column) const;
  void PaintWall(const Strip& strip, const ViewedWall& wall, double distance, Pixel* column) const;
  /// The part of a slab between two horizontal distances [m].
  void PaintSlab(const Strip& strip, const ViewedSlab& slab, double near, double far,
                 Pixel* column) const;

 private:
  using Ops = PixelOps<Pixel>;

  /// What a row of the floor or the ceiling shows.
  struct PlaneRow {
    double distance = 0.0;
    double reach = 0.0;  // `distance` in units of the texture's coordinates
    double u = 0.0;      // of the place under the camera
    double v = 0.0;
    const Ripmap<std::uint8_t>::Level* level = nullptr;
  };
  struct Plane {
    const Face* face = nullptr;
    std::vector<PlaneRow> rows;
    std::vector<int> blocks;  // first rows of blocks that lie close together, and the end
  };
  /// Where a wall lies in a strip.
  struct Patch {
    double distance;
    double from;  // along the face
    double to;
    RowSpan rows;
    double light;
  };

  double RowOf(double height, double distance) const;
  double SlopeOf(double row) const { return slope_min_ + row * grid_.slope_step; }
  RowSpan AllRows() const { return {0.0, static_cast<double>(grid_.rows)}; }
  Eigen::Vector2d ToWorld(const Eigen::Vector2d& in_view) const;
  double LightAt(const Strip& strip, double distance) const;
  void PreparePlane(const Face& face, double height, Plane& plane) const;
  void PaintPlane(const Strip& strip, const Plane& plane, const RowSpan& span, Pixel* column) const;
  void PaintPlaneRows(const Strip& strip, const Plane& plane, Pixel lit, const FactorRamp& fade,
                      int begin, int end, Pixel* column) const;
  void PaintSurface(const Patch& patch, const RowSpan& rows, double coverage, const Colour& colour,
                    Material material, Pixel* column) const;
  void PaintRectangle(const Patch& patch, const PaintedRectangle& rectangle, Pixel* column) const;
  void PaintPicture(const Patch& patch, const RowSpan& rows, double coverage,
                    const PaintedRectangle& rectangle, Pixel* column) const;
  void PaintSpot(const Patch& patch, const Spot& spot, Pixel* column) const;

  const World& world_;
  const BearingGrid& grid_;
  const TextureSet<Pixel>& textures_;
  SceneView view_;
  Eigen::Rotation2Dd world_from_view_{0.0};
  double slope_min_ = 0.0;
  Plane floor_;
  Plane ceiling_;
};

extern template class ColumnPainter<std::uint8_t>;
extern template class ColumnPainter<std::uint32_t>;
extern template struct TextureSet<std::uint8_t>;
extern template struct TextureSet<std::uint32_t>;

}  // namespace scan_image_slam
