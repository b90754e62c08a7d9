#include "scan_image_slam/core/config/text_similarity.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

// Each time the other word needs two edits.

TEST(MostSimilar, AMissingLetterIsOneEdit) {
  EXPECT_EQ(MostSimilar("rage", {"ra", "range"}), "range");
}

TEST(MostSimilar, ALetterTooMuchIsOneEdit) {
  EXPECT_EQ(MostSimilar("rangge", {"rang", "range"}), "range");
}

TEST(MostSimilar, AWrongLetterIsOneEdit) {
  EXPECT_EQ(MostSimilar("ronge", {"ron", "range"}), "range");
}

TEST(MostSimilar, SwappedNeighboursAreOneEdit) {
  // Without swaps "rnage" needs two edits to become either, and "rnagers" came first.
  EXPECT_EQ(MostSimilar("rnage", {"rnagers", "range"}), "range");
}

TEST(MostSimilar, LettersSwappedAcrossAnotherAreTwoEdits) {
  EXPECT_EQ(MostSimilar("egnar", {"egnarxxx", "range"}), "egnarxxx");  // 3 edits and 4
}

TEST(MostSimilar, AnExactMatchWins) {
  EXPECT_EQ(MostSimilar("max_range", {"min_range", "max_range", "max_ranges"}), "max_range");
}

TEST(MostSimilar, TheFirstOfSeveralWins) {
  EXPECT_EQ(MostSimilar("x_range", {"a_range", "b_range"}), "a_range");
  EXPECT_EQ(MostSimilar("x_range", {"b_range", "a_range"}), "b_range");
}

TEST(MostSimilar, EmptyWordsAreWords) {
  EXPECT_EQ(MostSimilar("", {"abc", "ab"}), "ab");
  EXPECT_EQ(MostSimilar("a", {"", "bcd"}), "");
}

TEST(IsSimilar, IsTrueForNamesThatMayBeMeant) {
  EXPECT_TRUE(IsSimilar("lazer", "laser"));
  EXPECT_TRUE(IsSimilar("laser", "laser_link"));
  EXPECT_TRUE(IsSimilar("base_link", "base_footprint"));
  EXPECT_FALSE(IsSimilar("camera_optical_frame", "base_link"));
}

}  // namespace
}  // namespace scan_image_slam
