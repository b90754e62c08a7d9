#include "scan_image_slam/core/simulation/random_stream.h"
#include "textures.h"

#include <cmath>
#include <functional>

namespace scan_image_slam {
namespace {

constexpr int kSize = kMaterialSize;

using Tile = std::vector<float>;  // kSize x kSize, column by column, 1 = the colour itself

float& At(Tile& tile, int u, int v) { return tile[static_cast<std::size_t>(u) * kSize + v]; }

/// Smooth noise with `cells_u` by `cells_v` independent values over the tile, between -1 and 1.
void AddNoise(Tile& tile, int cells_u, int cells_v, double amplitude, RandomStream& random) {
  std::vector<double> values(static_cast<std::size_t>(cells_u) * cells_v);
  for (double& value : values) value = random.Uniform(-1.0, 1.0);
  const auto value = [&](int i, int j) {
    return values[static_cast<std::size_t>(i % cells_u) * cells_v + j % cells_v];
  };
  const auto smooth = [](double f) { return f * f * (3.0 - 2.0 * f); };
  for (int u = 0; u < kSize; ++u) {
    const double x = static_cast<double>(u) * cells_u / kSize;
    const int i = static_cast<int>(x);
    const double fx = smooth(x - i);
    for (int v = 0; v < kSize; ++v) {
      const double y = static_cast<double>(v) * cells_v / kSize;
      const int j = static_cast<int>(y);
      const double fy = smooth(y - j);
      const double low = value(i, j) + fx * (value(i + 1, j) - value(i, j));
      const double high = value(i, j + 1) + fx * (value(i + 1, j + 1) - value(i, j + 1));
      At(tile, u, v) += static_cast<float>(amplitude * (low + fy * (high - low)));
    }
  }
}

/// Multiplies by factor(u, v).
void Multiply(Tile& tile, const std::function<double(int, int)>& factor) {
  for (int u = 0; u < kSize; ++u) {
    for (int v = 0; v < kSize; ++v) At(tile, u, v) *= static_cast<float>(factor(u, v));
  }
}

void Mottle(Tile& tile, double coarse, double fine, RandomStream& random) {
  for (const int cells : {4, 8, 16, 32}) AddNoise(tile, cells, cells, coarse / 4.0, random);
  for (const int cells : {128, 256, 512}) AddNoise(tile, cells, cells, fine / 3.0, random);
}

/// Joints of `width` texels around fields of `field_u` by `field_v` texels, each a little
/// different; every other row is shifted by `shift` texels.
void Joints(Tile& tile, int field_u, int field_v, int shift, int width, double joint, double vary,
            RandomStream& random) {
  std::vector<double> shades(static_cast<std::size_t>(kSize / field_u) * (kSize / field_v));
  for (double& shade : shades) shade = 1.0 - vary * random.Uniform();
  Multiply(tile, [&](int u, int v) {
    const int row = v / field_v;
    const int x = (u + (row % 2) * shift) % kSize;
    if (x % field_u < width || v % field_v < width) return joint;
    return shades[static_cast<std::size_t>(row) * (kSize / field_u) + x / field_u];
  });
}

/// Panels of about half a metre; one in eight is a lamp.
void CeilingPanels(Tile& tile, RandomStream& random) {
  constexpr int kPanel = kSize / 4;
  Joints(tile, kPanel, kPanel, 0, 4, 0.8, 0.02, random);
  Multiply(tile, [&](int u, int v) {
    const bool lamp = (u / kPanel) % 4 == 1 && (v / kPanel) % 2 == 0;
    return lamp && u % kPanel >= 4 && v % kPanel >= 4 ? 1.0 : 0.84;
  });
}

Tile DrawTile(Material material) {
  RandomStream random(static_cast<std::uint64_t>(material), "material");
  Tile tile(static_cast<std::size_t>(kSize) * kSize, 0.95F);
  switch (material) {
    case Material::kPlain:
      break;
    case Material::kPlaster:
      Mottle(tile, 0.035, 0.035, random);
      break;
    case Material::kConcrete:
      Mottle(tile, 0.12, 0.05, random);
      break;
    case Material::kWood:
      for (const int cells : {16, 64, 256}) AddNoise(tile, cells, cells / 16, 0.035, random);
      break;
    case Material::kBrick:
      Mottle(tile, 0.06, 0.06, random);
      Joints(tile, 64, 16, 32, 2, 1.1, 0.25, random);
      break;
    case Material::kCarpet:
      Mottle(tile, 0.05, 0.16, random);
      break;
    case Material::kTiles:
      Mottle(tile, 0.03, 0.02, random);
      Joints(tile, 128, 128, 0, 2, 0.72, 0.05, random);
      break;
    case Material::kCeiling:
      Mottle(tile, 0.02, 0.04, random);
      CeilingPanels(tile, random);
      break;
  }
  return tile;
}

}  // namespace

Ripmap<std::uint8_t> MakeMaterial(Material material) {
  const Tile tile = DrawTile(material);
  std::vector<std::uint8_t> texels;
  texels.reserve(tile.size());
  for (const float factor : tile)
    texels.push_back(static_cast<std::uint8_t>(ToByte(256.0 * factor)));
  return Ripmap<std::uint8_t>(kSize, kSize, std::move(texels));
}

}  // namespace scan_image_slam
