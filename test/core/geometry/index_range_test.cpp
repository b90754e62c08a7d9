#include "scan_image_slam/core/geometry/index_range.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

void ExpectRange(const IndexRange& range, int begin, int end) {
  EXPECT_EQ(range.begin, begin);
  EXPECT_EQ(range.end, end);
}

TEST(IndexRange, HoldsItsBeginButNotItsEnd) {
  const IndexRange range{-2, 3};
  EXPECT_EQ(range.size(), 5);
  EXPECT_FALSE(range.Contains(-3));
  EXPECT_TRUE(range.Contains(-2));
  EXPECT_TRUE(range.Contains(2));
  EXPECT_FALSE(range.Contains(3));
}

TEST(IndexRange, IsEmptyAtFirst) {
  EXPECT_EQ(IndexRange().size(), 0);
  EXPECT_FALSE(IndexRange().Contains(0));
}

TEST(IndexRange, DoesNotGrowForWhatItHolds) {
  ExpectRange(IndexRange{-2, 3}.Including(-2, 10), -2, 3);
  ExpectRange(IndexRange{-2, 3}.Including(2, 10), -2, 3);
}

TEST(IndexRange, GrowsOnTheSideOfTheNewIndexOnly) {
  ExpectRange(IndexRange{-2, 3}.Including(-5, 4), -9, 3);
  ExpectRange(IndexRange{-2, 3}.Including(3, 4), -2, 8);
  ExpectRange(IndexRange{-2, 3}.Including(7, 0), -2, 8);
  ExpectRange(IndexRange{-2, 3}.Including(-3, 0), -3, 3);
}

TEST(IndexRange, FromNothingItIsTheIndexWithMarginsOnBothSides) {
  ExpectRange(IndexRange().Including(7, 0), 7, 8);
  ExpectRange(IndexRange().Including(-7, 2), -9, -4);
  ExpectRange(IndexRange{5, 5}.Including(5, 1), 4, 7);
}

}  // namespace
}  // namespace scan_image_slam
