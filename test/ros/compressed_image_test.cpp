// Compressed images that lie about their size, or are damaged, are refused before they cost much.
#include "scan_image_slam/ros/image_conversion.h"
#include "scan_image_slam/ros/picture_size.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace scan_image_slam {
namespace {

constexpr int kWidth = 48;
constexpr int kHeight = 32;

std::vector<std::uint8_t> Packed(const std::string& ending, const std::vector<int>& options = {}) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(ending, cv::Mat(kHeight, kWidth, CV_8U, cv::Scalar(90)), bytes, options);
  return bytes;
}

std::string Refusal(const std::vector<std::uint8_t>& bytes) {
  sensor_msgs::CompressedImage message;
  message.format = "some";
  message.data = bytes;
  try {
    ToGrey(message);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

/// Most significant byte first.
void Put(std::uint32_t number, std::size_t at, std::size_t size, std::vector<std::uint8_t>* bytes) {
  for (std::size_t i = 0; i < size; ++i) {
    bytes->at(at + i) = static_cast<std::uint8_t>(number >> 8 * (size - 1 - i));
  }
}

/// Where a JPEG without fill bytes has its size: behind marker, length and bits of the frame.
std::size_t SizeInJpeg(const std::vector<std::uint8_t>& jpeg, std::uint8_t frame) {
  for (std::size_t i = 0; i + 9 < jpeg.size(); ++i) {
    if (jpeg[i] == 0xFF && jpeg[i + 1] == frame) return i + 5;
  }
  throw std::logic_error("no frame");
}

TEST(CompressedImage, OfBothKindsSaysItsSize) {
  const cv::Size size(kWidth, kHeight);
  EXPECT_EQ(DeclaredSize(Packed(".png")), size);
  EXPECT_EQ(DeclaredSize(Packed(".jpg")), size);
  EXPECT_EQ(DeclaredSize(Packed(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1})), size);
  EXPECT_EQ(Refusal(Packed(".png")), "");
  EXPECT_EQ(Refusal(Packed(".jpg")), "");
  EXPECT_EQ(Refusal(Packed(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1})), "");
}

TEST(CompressedImage, ThatClaimsAHugeSizeIsRefused) {
  std::vector<std::uint8_t> png = Packed(".png");
  constexpr std::size_t kPngWidth = 16;
  for (const std::uint32_t side : {60000U, 0x7FFFFFFFU}) {
    Put(side, kPngWidth, 4, &png);
    Put(side, kPngWidth + 4, 4, &png);
    EXPECT_EQ(Refusal(png), "image size " + std::to_string(side) + " x " + std::to_string(side));
  }
  for (const int progressive : {0, 1}) {
    std::vector<std::uint8_t> jpeg = Packed(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, progressive});
    const std::size_t size = SizeInJpeg(jpeg, progressive == 1 ? 0xC2 : 0xC0);
    Put(50000, size, 2, &jpeg);
    Put(60000, size + 2, 2, &jpeg);
    EXPECT_EQ(Refusal(jpeg), "image size 60000 x 50000");
  }
}

TEST(CompressedImage, FillBytesHideNoSize) {
  std::vector<std::uint8_t> jpeg = Packed(".jpg");
  const std::size_t frame = SizeInJpeg(jpeg, 0xC0) - 5;
  jpeg.insert(jpeg.begin() + static_cast<std::ptrdiff_t>(frame), {0xFF, 0xFF, 0xFF});
  EXPECT_EQ(DeclaredSize(jpeg), cv::Size(kWidth, kHeight));
}

TEST(CompressedImage, OfAnotherKindOrCutIsRefused) {
  EXPECT_NE(Refusal({}), "");
  EXPECT_NE(Refusal(Packed(".bmp")).find("no JPEG or PNG"), std::string::npos);
  for (const char* kind : {".png", ".jpg"}) {
    std::vector<std::uint8_t> bytes = Packed(kind);
    for (std::size_t size = 0; size < 20; ++size) {
      EXPECT_NE(Refusal({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}), "");
    }
  }
}

}  // namespace
}  // namespace scan_image_slam
