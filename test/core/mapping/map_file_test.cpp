#include "scan_image_slam/core/mapping/map_file.h"

#include "grid_fixtures.h"
#include "scan_image_slam/core/mapping/atomic_file.h"
#include "support_folder.h"
#include "support_rooms.h"

#include <filesystem>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

namespace scan_image_slam {
namespace {

class MapFile : public ::testing::Test {
 protected:
  std::string ErrorOf(const std::string& stem) const {
    try {
      WriteMap(MapImage(), stem);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  }

  const TemporaryFolder folder_;
};

MapImage SixCells() {
  MapImage map;
  map.width = 3;
  map.height = 2;
  map.resolution = 0.05;
  map.origin_x = -1.25;
  map.origin_y = 0.5;
  map.occupancy = {-1, 0,  100,  //
                   25, 64, 65};
  return map;
}

TEST_F(MapFile, PictureStartsAtTheTop) {
  WriteMap(SixCells(), folder_.File("room"));
  const std::string pixels = {'\xFE', '\xCD', '\x00',   // free, unknown, occupied
                              '\xCD', '\xFE', '\x00'};  // unknown, free, occupied
  EXPECT_EQ(ReadWholeFile(folder_.File("room.pgm")), "P5\n3 2\n255\n" + pixels);
}

TEST_F(MapFile, YamlIsAsMapSaverWritesIt) {
  EXPECT_EQ(WriteMap(SixCells(), folder_.File("room")), folder_.File("room.yaml"));
  EXPECT_EQ(ReadWholeFile(folder_.File("room.yaml")),
            "image: 'room.pgm'\n"
            "resolution: 0.05\n"
            "origin: [-1.25, 0.5, 0.0]\n"
            "negate: 0\n"
            "occupied_thresh: 0.65\n"
            "free_thresh: 0.196\n");
}

TEST_F(MapFile, TellsOccupancyFromTheFirstPercentOn) {
  MapImage map;
  map.width = 102;
  map.height = 1;
  for (int i = -1; i <= 100; ++i) map.occupancy.push_back(static_cast<std::int8_t>(i));
  WriteMap(map, folder_.File("steps"));
  const std::string file = ReadWholeFile(folder_.File("steps.pgm"));
  const std::string pixels = file.substr(file.size() - 102);
  for (int i = -1; i <= 100; ++i) {
    const int expected = i < 0 ? 205 : (i >= 65 ? 0 : (i <= 25 ? 254 : 205));
    EXPECT_EQ(static_cast<unsigned char>(pixels[i + 1]), expected) << i;
  }
}

TEST_F(MapFile, MakesTheFolder) {
  EXPECT_EQ(WriteMap(SixCells(), folder_.File("missing/room")), folder_.File("missing/room.yaml"));
  EXPECT_TRUE(std::filesystem::exists(folder_.File("missing/room.pgm")));
}

TEST_F(MapFile, NamesTheFileInAFolderThatCannotBe) {
  folder_.Write("file", "no folder");
  const std::string error = ErrorOf(folder_.File("file/room"));
  EXPECT_NE(error.find(folder_.File("file")), std::string::npos) << error;
  EXPECT_NE(error.find("Not a directory"), std::string::npos) << error;
}

TEST_F(MapFile, NamesTheFileThatIsAFolder) {
  std::filesystem::create_directories(folder_.File("room.yaml"));
  const std::string error = ErrorOf(folder_.File("room"));
  EXPECT_NE(error.find(folder_.File("room.yaml")), std::string::npos) << error;
  EXPECT_NE(error.find("Is a directory"), std::string::npos) << error;
}

TEST_F(MapFile, AnEmptyMapIsOneUnknownCell) {
  WriteMap(MapImage(), folder_.File("empty"));
  EXPECT_EQ(ReadWholeFile(folder_.File("empty.pgm")), "P5\n1 1\n255\n\xCD");
}

TEST_F(MapFile, NamesAnyFile) {
  for (const std::string name : {"floor #2", "hall: east", "it's", "- {[&*", "%TAG"}) {
    const YAML::Node yaml = YAML::LoadFile(WriteMap(SixCells(), folder_.File(name)));
    EXPECT_EQ(yaml["image"].as<std::string>(), name + ".pgm");
    EXPECT_EQ(yaml["resolution"].as<double>(), 0.05);
  }
}

struct Picture {
  int width = 0;
  int height = 0;
  std::string pixels;
};

Picture ReadPgm(const std::string& text) {
  std::istringstream stream(text);
  std::string magic;
  int white = 0;
  Picture picture;
  stream >> magic >> picture.width >> picture.height >> white;
  EXPECT_EQ(magic, "P5");
  EXPECT_EQ(white, 255);
  stream.get();  // one white space before the pixels
  picture.pixels.resize(static_cast<std::size_t>(picture.width) * picture.height);
  stream.read(picture.pixels.data(), static_cast<std::streamsize>(picture.pixels.size()));
  EXPECT_EQ(static_cast<std::size_t>(stream.gcount()), picture.pixels.size());
  EXPECT_EQ(stream.get(), std::char_traits<char>::eof());
  return picture;
}

/// What map_server's loader makes of a pixel, in its mode "trinary".
int Loaded(unsigned char pixel, double occupied, double free) {
  const double probability = (255 - pixel) / 255.0;
  return probability > occupied ? 100 : (probability < free ? 0 : -1);
}

OccupancyGrid RandomGrid(double resolution) {
  OccupancyGridOptions options = MetreCells();
  options.resolution = resolution;
  OccupancyGrid grid(options);
  TestRandom random(3);
  for (int i = 0; i < 20; ++i) {
    GridScan scan;
    for (int beam = 0; beam < 60; ++beam) {
      const Eigen::Vector2d end(resolution * random.Uniform(-40.0, 40.0),
                                resolution * random.Uniform(-20.0, 20.0));
      scan.beams.push_back({end.cast<float>(), random.Uniform(0.0, 1.0) < 0.8});
    }
    grid.Add(scan, {-1234.5, 567.8, random.Uniform(-M_PI, M_PI)});
  }
  return grid;
}

TEST_F(MapFile, ReadBackEveryCellLiesWhereItWas) {
  for (const double resolution : {0.05, 0.0123456789, 1.0 / 3.0}) {
    const OccupancyGrid grid = RandomGrid(resolution);
    const YAML::Node yaml = YAML::LoadFile(WriteMap(ToMapImage(grid), folder_.File("map")));
    const Picture picture = ReadPgm(ReadWholeFile(folder_.File(yaml["image"].as<std::string>())));
    const double cell = yaml["resolution"].as<double>();
    EXPECT_NEAR(cell, resolution, 1e-9);
    int known = 0;
    int misplaced = 0;
    for (int row = 0; row < picture.height; ++row) {
      for (int column = 0; column < picture.width; ++column) {
        const double x = yaml["origin"][0].as<double>() + (column + 0.5) * cell;
        const double y = yaml["origin"][1].as<double>() + (picture.height - row - 0.5) * cell;
        // In the middle of the cell, to a thousandth of it.
        misplaced += std::abs(x / resolution - std::floor(x / resolution) - 0.5) > 1e-3;
        misplaced += std::abs(y / resolution - std::floor(y / resolution) - 0.5) > 1e-3;
        const int occupancy = grid.Occupancy(static_cast<int>(std::floor(x / resolution)),
                                             static_cast<int>(std::floor(y / resolution)));
        const int expected =
            occupancy < 0 ? -1 : (occupancy >= 65 ? 100 : (occupancy <= 25 ? 0 : -1));
        const int loaded =
            Loaded(picture.pixels[row * picture.width + column],
                   yaml["occupied_thresh"].as<double>(), yaml["free_thresh"].as<double>());
        misplaced += loaded != expected;
        known += loaded >= 0;
      }
    }
    EXPECT_GT(known, 100);
    EXPECT_EQ(misplaced, 0) << resolution;
  }
}

TEST(MapImage, IsTheKnownPartWithAMarginOfOneCell) {
  OccupancyGridOptions options = MetreCells();
  options.resolution = 0.5;
  OccupancyGrid grid(options);
  grid.Add(OneBeam({-1.25, 2.25}, {-0.25, 2.25}), Pose2{});  // cells -3 ... -1 in row 4
  const MapImage map = ToMapImage(grid);
  EXPECT_EQ(map.width, 5);
  EXPECT_EQ(map.height, 3);
  EXPECT_EQ(map.resolution, 0.5);
  EXPECT_EQ(map.origin_x, -2.0);
  EXPECT_EQ(map.origin_y, 1.5);
  const std::vector<std::int8_t> expected = {-1, -1, -1, -1, -1,  //
                                             -1, 40, 40, 75, -1,  //
                                             -1, -1, -1, -1, -1};
  EXPECT_EQ(map.occupancy, expected);
}

TEST(MapImage, IsEmptyIfNothingIsKnown) {
  OccupancyGrid grid(MetreCells());
  EXPECT_EQ(ToMapImage(grid).width, 0);
  grid.Add(OneBeam({0.1, 0.1}, {0.2, 0.2}, false), Pose2{});
  EXPECT_EQ(ToMapImage(grid).width, 0);
  EXPECT_TRUE(ToMapImage(grid).occupancy.empty());
}

}  // namespace
}  // namespace scan_image_slam
