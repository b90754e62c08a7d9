#include "scan_image_slam/core/mapping/map_reader.h"

#include "support_folder.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace scan_image_slam {
namespace {

class MapReader : public ::testing::Test {
 protected:
  /// Three pixels in a row, and the yaml with some lines of its own.
  std::string Write(const std::string& lines) const {
    cv::imwrite(folder_.File("room.png"), cv::Mat(std::vector<std::uint8_t>{0, 205, 254}).t());
    return folder_.Write("room.yaml", lines);
  }

  std::string ErrorOf(const std::string& path) const {
    try {
      ReadMap(path);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  }

  const TemporaryFolder folder_;
};

using Occupancy = std::vector<std::int8_t>;

const std::string kUsual =
    "image: room.png\nresolution: 0.1\norigin: [-1.0, 2.0, 0.0]\nnegate: 0\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.196\n";

std::string Replaced(const std::string& from, const std::string& to) {
  std::string text = kUsual;
  return text.replace(text.find(from), from.size(), to);
}

TEST_F(MapReader, ReadsWhatWriteMapWrote) {
  MapImage map;
  map.width = 3;
  map.height = 2;
  map.resolution = 0.05;
  map.origin_x = -1.25;
  map.origin_y = 0.5;
  map.occupancy = {-1, 0, 100, 25, 64, 65};
  const MapImage read = ReadMap(WriteMap(map, folder_.File("it's a #room")));
  EXPECT_EQ(read.width, 3);
  EXPECT_EQ(read.height, 2);
  EXPECT_EQ(read.resolution, 0.05);
  EXPECT_EQ(read.origin_x, -1.25);
  EXPECT_EQ(read.origin_y, 0.5);
  EXPECT_EQ(read.occupancy, (Occupancy{-1, 0, 100, 0, -1, 100}));
}

TEST_F(MapReader, FollowsTheThresholdsOfTheFile) {
  EXPECT_EQ(ReadMap(Write(kUsual)).occupancy, (Occupancy{100, -1, 0}));
  // 205 stands for 50 / 255 = 0.1961.
  EXPECT_EQ(ReadMap(Write(Replaced("free_thresh: 0.196", "free_thresh: 0.197"))).occupancy,
            (Occupancy{100, 0, 0}));
  EXPECT_EQ(ReadMap(Write(Replaced("0.65", "0.196"))).occupancy, (Occupancy{100, 100, 0}));
  EXPECT_EQ(ReadMap(Write(Replaced("0.65", "1.0"))).occupancy, (Occupancy{-1, -1, 0}));
}

TEST_F(MapReader, WhiteIsOccupiedIfNegated) {
  EXPECT_EQ(ReadMap(Write(Replaced("negate: 0", "negate: 1"))).occupancy, (Occupancy{0, 100, 100}));
}

TEST_F(MapReader, FindsThePictureByItsFullPath) {
  EXPECT_EQ(ReadMap(Write(Replaced("room.png", folder_.File("room.png")))).width, 3);
}

TEST_F(MapReader, NamesTheKeyThatIsMissingOrWrong) {
  for (const std::string key :
       {"image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"}) {
    const std::string error = ErrorOf(Write(Replaced(key + ":", "another:")));
    EXPECT_NE(error.find("room.yaml"), std::string::npos) << error;
    EXPECT_NE(error.find("'" + key + "'"), std::string::npos) << error;
  }
  EXPECT_NE(ErrorOf(Write(Replaced("0.1", "-0.1"))).find("resolution"), std::string::npos);
  EXPECT_NE(ErrorOf(Write(Replaced("0.0]", "0.5]"))).find("turns"), std::string::npos);
  EXPECT_NE(ErrorOf(Write(kUsual + "mode: raw\n")).find("mode"), std::string::npos);
  EXPECT_EQ(ErrorOf(Write(kUsual + "mode: scale\n")), "no error");
}

TEST_F(MapReader, NamesTheFileThatIsNotThere) {
  EXPECT_NE(ErrorOf(folder_.File("none.yaml")).find(folder_.File("none.yaml")), std::string::npos);
  const std::string error = ErrorOf(Write(Replaced("room.png", "none.png")));
  EXPECT_NE(error.find(folder_.File("none.png")), std::string::npos) << error;
}

TEST_F(MapReader, RefusesPicturesThatClaimToBeHuge) {
  folder_.Write("huge.pgm", "P5\n3 2999999\n255\n0");
  const std::string error = ErrorOf(Write(Replaced("room.png", "huge.pgm")));
  EXPECT_NE(error.find(folder_.File("huge.pgm")), std::string::npos) << error;
}

}  // namespace
}  // namespace scan_image_slam
