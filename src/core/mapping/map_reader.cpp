#include "scan_image_slam/core/mapping/map_reader.h"

#include "scan_image_slam/core/config/yaml_section.h"

#include <filesystem>

#include <opencv2/imgcodecs.hpp>

namespace scan_image_slam {
namespace {

constexpr double kFar = 1e6;  // [m]

struct Thresholds {
  double occupied = 0.0;  // probability from which on a cell is a wall
  double free = 0.0;      // and up to which it is free
  bool negate = false;    // white is occupied
};

std::int8_t Occupancy(std::uint8_t grey, const Thresholds& thresholds) {
  const double probability = (thresholds.negate ? grey : 255 - grey) / 255.0;
  if (probability > thresholds.occupied) return 100;
  return static_cast<std::int8_t>(probability < thresholds.free ? 0 : -1);
}

/// The grey picture; empty if it can't be read, e.g. as it claims to be larger than OpenCV allows.
cv::Mat ReadGrey(const std::string& path) {
  try {
    return cv::imread(path, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

MapImage ReadMap(const std::string& yaml_file) {
  YamlSection yaml = YamlSection::FromFile(yaml_file);
  const std::filesystem::path image = yaml.Text("image");
  MapImage map;
  map.resolution = yaml.Number("resolution", 1e-4, 1e3);
  const std::vector<double> origin = yaml.Numbers("origin", 3, -kFar, kFar);
  map.origin_x = origin[0];
  map.origin_y = origin[1];
  if (origin[2] != 0.0) yaml.Fail("origin", "turns the map, which is not supported");
  Thresholds thresholds;
  thresholds.occupied = yaml.Number("occupied_thresh", 0.0, 1.0);
  thresholds.free = yaml.Number("free_thresh", 0.0, 1.0);
  thresholds.negate = yaml.Integer("negate", 0, 1) == 1;
  yaml.Choice("mode", {"trinary", "scale"}, 0);  // they differ in what is neither wall nor free

  const std::string path = (std::filesystem::path(yaml_file).parent_path() / image).string();
  const cv::Mat pixels = ReadGrey(path);
  if (pixels.empty()) yaml.Fail("image", "can't read the picture " + path);
  map.width = pixels.cols;
  map.height = pixels.rows;
  map.occupancy.reserve(pixels.total());
  for (int row = map.height - 1; row >= 0; --row) {  // pictures start at the top
    for (int x = 0; x < map.width; ++x) {
      map.occupancy.push_back(Occupancy(pixels.at<std::uint8_t>(row, x), thresholds));
    }
  }
  return map;
}

}  // namespace scan_image_slam
