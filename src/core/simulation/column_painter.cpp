#include "column_painter.h"

#include <cmath>

#include <opencv2/core/fast_math.hpp>

namespace scan_image_slam {
namespace {

constexpr double kFarthestPlane = 200.0;  // floor and ceiling beyond are drawn as if here [m]

std::uint32_t Weight256(double part) {
  return static_cast<std::uint32_t>(cvRound(256.0 * std::clamp(part, 0.0, 1.0)));
}

/// Texture coordinates of the floor have 8 bits of fraction.
constexpr double kTexelUnits = 256.0;

/// The coordinate of a place [m], moved by whole tiles so that what is added cannot make it
/// negative.
double PositiveUnits(double position, double units_per_metre) {
  constexpr double kTile = kMaterialSize * kMaterialTexel;
  constexpr double kOffset = 1 << 30;
  return kOffset + std::fmod(position, kTile) * units_per_metre;
}

/// Bilinear interpolation.
std::uint32_t Sample(const Ripmap<std::uint8_t>::Level& level, std::uint32_t u, std::uint32_t v) {
  const std::uint32_t u_mask = level.width - 1;
  const std::uint32_t v_mask = level.height - 1;
  const std::uint8_t* left = level.Column(static_cast<int>(u >> 8 & u_mask));
  const std::uint8_t* right = level.Column(static_cast<int>(((u >> 8) + 1) & u_mask));
  const std::uint32_t low = v >> 8 & v_mask;
  const std::uint32_t high = ((v >> 8) + 1) & v_mask;
  const std::uint32_t fu = u & 255;
  const std::uint32_t fv = v & 255;
  const std::uint32_t a = left[low] * (256 - fu) + right[low] * fu;
  const std::uint32_t b = left[high] * (256 - fu) + right[high] * fu;
  return (a * (256 - fv) + b * fv) >> 16;
}

bool Uses(const Face& face, Material material) {
  if (face.material == material) return true;
  for (const Decoration& decoration : face.decorations) {
    for (const PaintedRectangle& rectangle : decoration.rectangles) {
      if (rectangle.material == material) return true;
    }
  }
  return false;
}

bool Uses(const World& world, Material material) {
  if (Uses(world.floor, material) || Uses(world.ceiling, material)) return true;
  return std::any_of(world.faces.begin(), world.faces.end(),
                     [material](const Face& face) { return Uses(face, material); });
}

}  // namespace

template <typename Pixel>
TextureSet<Pixel>::TextureSet(const World& world) {
  for (std::size_t i = 1; i < materials.size(); ++i) {
    const auto material = static_cast<Material>(i);
    if (!Uses(world, material)) continue;
    materials[i] = std::make_unique<Ripmap<std::uint8_t>>(MakeMaterial(material));
  }
  for (const PictureSpec& picture : world.pictures) {
    pictures.push_back(MakePicture<Pixel>(picture));
  }
}

template <typename Pixel>
ColumnPainter<Pixel>::ColumnPainter(const World& world, const BearingGrid& grid,
                                    const TextureSet<Pixel>& textures)
    : world_(world), grid_(grid), textures_(textures) {
  floor_.rows.resize(grid.rows);
  ceiling_.rows.resize(grid.rows);
}

template <typename Pixel>
void ColumnPainter<Pixel>::Begin(const SceneView& view) {
  view_ = view;
  world_from_view_ = Eigen::Rotation2Dd(view.heading);
  slope_min_ = grid_.slope_min + view.slope_shift;
  PreparePlane(world_.floor, 0.0, floor_);
  PreparePlane(world_.ceiling, world_.ceiling_height, ceiling_);
}

template <typename Pixel>
double ColumnPainter<Pixel>::RowOf(double height, double distance) const {
  return ((height - view_.height) / distance - slope_min_) / grid_.slope_step;
}

template <typename Pixel>
Eigen::Vector2d ColumnPainter<Pixel>::ToWorld(const Eigen::Vector2d& in_view) const {
  return view_.position + world_from_view_ * in_view;
}

template <typename Pixel>
double ColumnPainter<Pixel>::LightAt(const Strip& strip, double distance) const {
  if (world_.lighting.regions.empty()) return view_.light * world_.lighting.brightness;
  return view_.light * BrightnessAt(world_.lighting, ToWorld(distance * strip.middle));
}

template <typename Pixel>
void ColumnPainter<Pixel>::PreparePlane(const Face& face, double height, Plane& plane) const {
  const auto& material = textures_.materials[static_cast<std::size_t>(face.material)];
  const double above = height - view_.height;
  plane.face = &face;
  plane.blocks = {0};
  for (int row = 0; row < grid_.rows; ++row) {
    PlaneRow& here = plane.rows[row];
    const double distance = above / SlopeOf(row + 0.5);
    here.distance = distance > 0.0 ? std::min(distance, kFarthestPlane) : kFarthestPlane;
    const double ratio = here.distance / plane.rows[plane.blocks.back()].distance;
    if (row - plane.blocks.back() >= 16 || ratio > 1.15 || ratio < 1.0 / 1.15) {
      plane.blocks.push_back(row);
    }
    if (!material) continue;
    const double across = here.distance * grid_.tangent_step;
    const double deep = here.distance * here.distance * grid_.slope_step / std::abs(above);
    const int shift = LevelFor(std::max(across, 0.5 * deep), kMaterialTexel);
    here.level = &material->At(shift, shift);
    const double units =
        kTexelUnits * here.level->width / (kMaterialSize * kMaterialTexel);  // per metre
    here.reach = here.distance * units;
    // Texel 0 lies between 0 and 1, its middle is at 0.5.
    here.u = PositiveUnits(view_.position.x(), units) - 0.5 * kTexelUnits;
    here.v = PositiveUnits(view_.position.y(), units) - 0.5 * kTexelUnits;
  }
  plane.blocks.push_back(grid_.rows);
}

template <typename Pixel>
void ColumnPainter<Pixel>::PaintPlanes(const Strip& strip, double distance, Pixel* column) const {
  const double horizon = -slope_min_ / grid_.slope_step;
  const bool open = !std::isfinite(distance);
  const double floor_end = open ? horizon : RowOf(0.0, distance);
  const double ceiling_begin = open ? horizon : RowOf(world_.ceiling_height, distance);
  const RowSpan floor{0.0, std::ceil(floor_end)};
  const RowSpan ceiling{std::floor(ceiling_begin), AllRows().high};
  PaintPlane(strip, floor_, floor.Clip(AllRows()), column);
  PaintPlane(strip, ceiling_, ceiling.Clip(AllRows()), column);
}

template <typename Pixel>
void ColumnPainter<Pixel>::PaintPlane(const Strip& strip, const Plane& plane, const RowSpan& span,
                                      Pixel* column) const {
  const int first = static_cast<int>(span.low);
  const int last = static_cast<int>(span.high);
  for (std::size_t i = 0; i + 1 < plane.blocks.size(); ++i) {
    const int begin = plane.blocks[i];
    const int end = plane.blocks[i + 1];
    if (end <= first || begin >= last) continue;
    // The light changes evenly over a block.
    const double light = LightAt(strip, plane.rows[begin].distance);
    const double next_light = LightAt(strip, plane.rows[end - 1].distance);
    const Colour& colour = plane.face->colour;
    const double saturated = 255.0 / std::max({colour.red, colour.green, colour.blue, 1.0});
    const double most = std::clamp(std::max(light, next_light), 1e-6, saturated);
    const Pixel lit = Ops::Make(colour, most);
    const double change = 256.0 * (next_light - light) / most / std::max(end - 1 - begin, 1);
    const FactorRamp fade(256.0 * light / most - begin * change, change);
    PaintPlaneRows(strip, plane, lit, fade, std::max(begin, first), std::min(end, last), column);
  }
}

template <typename Pixel>
void ColumnPainter<Pixel>::PaintPlaneRows(const Strip& strip, const Plane& plane, Pixel lit,
                                          const FactorRamp& fade, int begin, int end,
                                          Pixel* column) const {
  const Eigen::Vector2d direction = world_from_view_ * strip.middle;
  for (int row = begin; row < end; ++row) {
    const PlaneRow& here = plane.rows[row];
    std::uint32_t factor = fade.At(row);
    if (here.level != nullptr) {
      const auto u = static_cast<std::int32_t>(here.u + here.reach * direction.x());
      const auto v = static_cast<std::int32_t>(here.v + here.reach * direction.y());
      factor = factor * Sample(*here.level, u, v) >> 8;
    }
    column[row] = Ops::Scale(lit, factor);
  }
}

template <typename Pixel>
void ColumnPainter<Pixel>::PaintWall(const Strip& strip, const ViewedWall& wall, double distance,
                                     Pixel* column) const {
  const RowSpan rows =
      RowSpan{RowOf(wall.bottom, distance), RowOf(wall.top, distance)}.Clip(AllRows());
  if (rows.empty()) return;
  const auto along = [&](const Eigen::Vector2d& ray) {
    const double reached = wall.offset / wall.normal.dot(ray);
    return (reached > 0.0 ? reached : distance) * wall.edge.dot(ray) + wall.along;
  };
  const double a = along(strip.left);
  const double b = along(strip.right);
  const Patch patch{distance, std::min(a, b), std::max({a, b, std::min(a, b) + 1e-6}), rows,
                    wall.shade * LightAt(strip, distance)};
  const Face& face = world_.faces[wall.face];
  PaintSurface(patch, rows, 1.0, face.colour, face.material, column);
  for (const Decoration& decoration : face.decorations) {
    if (decoration.from >= patch.to || decoration.to <= patch.from) continue;
    for (const PaintedRectangle& rectangle : decoration.rectangles) {
      PaintRectangle(patch, rectangle, column);
    }
  }
  for (const Spot& spot : wall.spots) PaintSpot(patch, spot, column);
}

template <typename Pixel>
void ColumnPainter<Pixel>::PaintRectangle(const Patch& patch, const PaintedRectangle& rectangle,
                                          Pixel* column) const {
  const double overlap = std::min(rectangle.to, patch.to) - std::max(rectangle.from, patch.from);
  if (overlap <= 0.0) return;
  const RowSpan rows =
      RowSpan{RowOf(rectangle.bottom, patch.distance), RowOf(rectangle.top, patch.distance)}.Clip(
          patch.rows);
  if (rows.empty()) return;
  const double coverage = overlap / (patch.to - patch.from);
  if (rectangle.picture >= 0) {
    PaintPicture(patch, rows, coverage, rectangle, column);
  } else {
    PaintSurface(patch, rows, coverage, rectangle.colour, rectangle.material, column);
  }
}

template <typename Pixel>
void ColumnPainter<Pixel>::PaintSurface(const Patch& patch, const RowSpan& rows, double coverage,
                                        const Colour& colour, Material material,
                                        Pixel* column) const {
  const Pixel lit = Ops::Make(colour, patch.light);
  const auto& texture = textures_.materials[static_cast<std::size_t>(material)];
  if (!texture) {
    FillSpan(column, rows, coverage, [lit](int) { return lit; });
    return;
  }
  const double row_height = patch.distance * grid_.slope_step;
  const auto& level = texture->At(LevelFor(patch.to - patch.from, kMaterialTexel),
                                  LevelFor(row_height, kMaterialTexel));
  const double middle = 0.5 * (patch.from + patch.to);
  const double u = middle / kMaterialTexel * level.width / kMaterialSize;
  const auto column_index = static_cast<std::int64_t>(std::floor(u)) & (level.width - 1);
  const std::uint8_t* texels = level.Column(static_cast<int>(column_index));
  const std::uint32_t mask = level.height - 1;
  const double per_metre = static_cast<double>(level.height) / kMaterialSize / kMaterialTexel;
  const TexelRamp v((view_.height + patch.distance * SlopeOf(0.5)) * per_metre,
                    row_height * per_metre);
  FillSpan(column, rows, coverage,
           [&](int row) { return Ops::Scale(lit, texels[v.At(row) & mask]); });
}

template <typename Pixel>
void ColumnPainter<Pixel>::PaintPicture(const Patch& patch, const RowSpan& rows, double coverage,
                                        const PaintedRectangle& rectangle, Pixel* column) const {
  constexpr int kMostColumns = 6;
  const Ripmap<Pixel>& picture = textures_.pictures[rectangle.picture];
  const double length = rectangle.to - rectangle.from;
  const double height = rectangle.top - rectangle.bottom;
  const double from = std::max(rectangle.from, patch.from) - rectangle.from;
  const double to = std::min(rectangle.to, patch.to) - rectangle.from;
  // A level fine enough that a cell covers two to three texels, whose mean is taken exactly.
  const double texel = length / kPictureSize;
  const double row_height = patch.distance * grid_.slope_step;
  const auto& level =
      picture.At(LevelFor((to - from) / 2.0, texel), LevelFor(row_height, height / kPictureSize));
  const double u0 = from / length * level.width;
  const double u1 = to / length * level.width;
  const int first = std::clamp(static_cast<int>(u0), 0, level.width - 1);
  const int last = std::clamp(static_cast<int>(std::ceil(u1)) - 1, first,
                              std::min(level.width - 1, first + kMostColumns - 1));
  std::array<const Pixel*, kMostColumns> columns{};
  std::array<std::uint32_t, kMostColumns> weights{};
  std::uint32_t left = 256;
  for (int u = first; u <= last; ++u) {
    const double part = std::min<double>(u + 1, u1) - std::max<double>(u, u0);
    columns[u - first] = level.Column(u);
    weights[u - first] =
        u == last ? left : std::min(left, Weight256(part / std::max(u1 - u0, 1e-9)));
    left -= weights[u - first];
  }
  const double per_metre = level.height / height;
  const double v0 = (view_.height - rectangle.bottom + patch.distance * SlopeOf(0.5)) * per_metre;
  const double dv = row_height * per_metre;
  const auto light = static_cast<std::uint32_t>(cvRound(256.0 * std::min(patch.light, 1e4)));
  FillSpan(column, rows, coverage, [&](int row) {
    const int v = std::clamp(static_cast<int>(v0 + row * dv), 0, level.height - 1);
    const Pixel colour = Ops::Sum(columns.data(), weights.data(), last - first + 1, v);
    return light <= 256 ? Ops::Scale(colour, light) : Ops::ScaleSaturated(colour, light);
  });
}

template <typename Pixel>
void ColumnPainter<Pixel>::PaintSpot(const Patch& patch, const Spot& spot, Pixel* column) const {
  constexpr double kReach = 2.5;     // standard deviations
  constexpr double kFaintest = 1.5;  // of 256
  const double offset = (0.5 * (patch.from + patch.to) - spot.along) / spot.sigma_along;
  if (std::abs(offset) > kReach) return;
  const double strength = 256.0 * spot.strength * std::exp(-0.5 * offset * offset);
  if (strength < kFaintest) return;
  const double reach = kReach * spot.sigma_height;
  const RowSpan rows = RowSpan{RowOf(spot.height - reach, patch.distance),
                               RowOf(spot.height + reach, patch.distance)}
                           .Clip(patch.rows);
  const Pixel white = Ops::Make({255, 255, 255}, std::min(patch.light, 1.0));
  // The distance from the middle grows evenly from row to row; the light fades like (1 - t^2)^3.
  const auto step = static_cast<float>(patch.distance * grid_.slope_step / reach);
  const auto start =
      static_cast<float>((view_.height + patch.distance * SlopeOf(0.5) - spot.height) / reach);
  const auto peak = static_cast<float>(std::min(strength, 256.0));
  for (int row = static_cast<int>(rows.low); row < rows.high; ++row) {
    const float t = start + step * static_cast<float>(row);
    const float fade = std::max(1.0F - t * t, 0.0F);
    const auto weight = static_cast<std::uint32_t>(static_cast<int>(peak * fade * fade * fade));
    column[row] = spot.bright ? Ops::Blend(column[row], white, weight)
                              : Ops::Scale(column[row], 256 - weight);
  }
}

template <typename Pixel>
void ColumnPainter<Pixel>::PaintSlab(const Strip& strip, const ViewedSlab& slab, double near,
                                     double far, Pixel* column) const {
  const double a = RowOf(slab.height, near);
  const double b = RowOf(slab.height, far);
  const Pixel lit = Ops::Make(slab.colour, LightAt(strip, 0.5 * (near + far)));
  FillSpan(column, RowSpan{std::min(a, b), std::max(a, b)}.Clip(AllRows()), 1.0,
           [lit](int) { return lit; });
}

template struct TextureSet<std::uint8_t>;
template struct TextureSet<std::uint32_t>;
template class ColumnPainter<std::uint8_t>;
template class ColumnPainter<std::uint32_t>;

}  // namespace scan_image_slam
