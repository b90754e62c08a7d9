#include "scan_image_slam/core/fusion/edge_filter.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// Edge pixels as drawn: + and - are their signs.
cv::Mat Drawn(const std::vector<std::string>& rows) {
  cv::Mat sign =
      cv::Mat::zeros(static_cast<int>(rows.size()), static_cast<int>(rows[0].size()), CV_8S);
  for (int y = 0; y < sign.rows; ++y) {
    for (int x = 0; x < sign.cols; ++x) {
      if (rows[y][x] == '+') sign.at<std::int8_t>(y, x) = 1;
      if (rows[y][x] == '-') sign.at<std::int8_t>(y, x) = -1;
    }
  }
  return sign;
}

std::vector<EdgeChain> Follow(const std::vector<std::string>& rows) {
  EdgePixels edges;
  edges.sign = Drawn(rows);
  edges.gradient = cv::Mat(edges.sign.size(), CV_16S, cv::Scalar(50));
  return FollowChains(edges, /*threshold=*/20.0);
}

EdgeChain FollowOne(const std::vector<std::string>& rows) {
  const std::vector<EdgeChain> chains = Follow(rows);
  EXPECT_EQ(chains.size(), 1U);
  return chains.empty() ? EdgeChain() : chains.front();
}

TEST(NeighbourHistogram, HasABinForEachDirection) {
  const std::vector<std::vector<std::string>> drawn{
      {"...", ".++", "..."}, {"..+", ".+.", "..."}, {".+.", ".+.", "..."}, {"+..", ".+.", "..."},
      {"...", "++.", "..."}, {"...", ".+.", "+.."}, {"...", ".+.", ".+."}, {"...", ".+.", "..+"}};
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const DirectionHistogram h = NeighbourHistogram(Drawn(drawn[k]), 1, 1);
    EXPECT_EQ(h.bins[k], 1.0) << "direction " << 45 * k;
    EXPECT_EQ(h.Total(), 1.0) << "direction " << 45 * k;
  }
}

TEST(NeighbourHistogram, CountsNeighboursOfTheSameSignOnly) {
  const DirectionHistogram h = NeighbourHistogram(Drawn({"+-+", "-+-", "+-+"}), 1, 1);
  EXPECT_EQ(h.Total(), 4.0);
  EXPECT_EQ(h.Vertical(), 0.0);
}

TEST(NeighbourHistogram, EndsAtTheBorderOfThePicture) {
  const cv::Mat full = Drawn({"++", "++"});
  for (const int x : {0, 1}) {
    for (const int y : {0, 1}) EXPECT_EQ(NeighbourHistogram(full, x, y).Total(), 3.0);
  }
}

TEST(VerticalWeight, IsTheShareOfTheVerticalEntries) {
  EXPECT_EQ(VerticalWeight(NeighbourHistogram(Drawn({".+.", ".+.", ".+."}), 1, 1)), 1.0);
  EXPECT_EQ(VerticalWeight(NeighbourHistogram(Drawn({".+.", "++.", "..+"}), 1, 1)), 1.0 / 3.0);
  EXPECT_EQ(VerticalWeight(NeighbourHistogram(Drawn({"...", "+++", "..."}), 1, 1)), 0.0);
  EXPECT_EQ(VerticalWeight(DirectionHistogram()), 0.0);
}

TEST(FollowChains, AVerticalLineOfNPixelsHasTwiceNMinusOne) {
  const EdgeChain chain = FollowOne({"..+..", "..+..", "..+..", "..+..", "..+.."});
  EXPECT_EQ(chain.Strength(), 8.0);
  EXPECT_EQ(chain.accumulated.bins[2], 4.0);
  EXPECT_EQ(chain.accumulated.bins[6], 4.0);
  EXPECT_EQ(chain.accumulated.Total(), 8.0);
  EXPECT_EQ(chain.pixels.size(), 5U);
  EXPECT_EQ(chain.sign, 1);
}

TEST(FollowChains, AHorizontalLineHasNothing) {
  const EdgeChain chain = FollowOne({".....", "-----", "....."});
  EXPECT_EQ(chain.accumulated.Total(), 0.0);
  EXPECT_EQ(chain.pixels.size(), 5U);
  EXPECT_EQ(chain.sign, -1);
}

TEST(FollowChains, ADiagonalLineHasNothing) {
  EXPECT_EQ(FollowOne({"+...", ".+..", "..+.", "...+"}).accumulated.Total(), 0.0);
  EXPECT_EQ(FollowOne({"...+", "..+.", ".+..", "+..."}).accumulated.Total(), 0.0);
}

TEST(FollowChains, ASinglePixelHasNothing) {
  const EdgeChain chain = FollowOne({"...", ".+.", "..."});
  EXPECT_EQ(chain.accumulated.Total(), 0.0);
  EXPECT_EQ(chain.pixels.size(), 1U);
}

TEST(FollowChains, ALineWithAStepIsFollowedOverIt) {
  // The two pixels at the step see one vertical neighbour of two: 1+2+2+0.5 and the same again.
  const EdgeChain chain = FollowOne({"+.", "+.", "+.", "+.", ".+", ".+", ".+", ".+"});
  EXPECT_EQ(chain.Strength(), 11.0);
  EXPECT_EQ(chain.pixels.size(), 8U);
}

TEST(FollowChains, AtACrossingTheVerticalGoesOn) {
  const std::vector<EdgeChain> chains = Follow({"..+..", "..+..", "+++++", "..+..", "..+.."});
  ASSERT_EQ(chains.size(), 3U);
  // Ends: 1 each. The three in the middle: two vertical neighbours of four, so 0.5 * 2 each.
  EXPECT_EQ(chains[0].Strength(), 5.0);
  EXPECT_EQ(chains[0].pixels.back(), cv::Point(2, 4));
  EXPECT_EQ(chains[1].Strength(), 0.0);
  EXPECT_EQ(chains[2].Strength(), 0.0);
}

TEST(FollowChains, ABlockIsClutter) {
  // Every pixel sees three neighbours, one of them vertical: 4 * (1/3 * 1).
  const EdgeChain chain = FollowOne({"++", "++"});
  EXPECT_NEAR(chain.Strength(), 4.0 / 3.0, 1e-15);
  // After the step down the direction to the right has been seen twice, up-right once.
  const std::vector<cv::Point> way{{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  EXPECT_EQ(chain.pixels, way);
}

TEST(FollowChains, ABrokenLineIsTwoChains) {
  const std::vector<EdgeChain> chains = Follow({".+.", ".+.", ".+.", "...", ".+.", ".+."});
  ASSERT_EQ(chains.size(), 2U);
  EXPECT_EQ(chains[0].Strength(), 4.0);
  EXPECT_EQ(chains[1].Strength(), 2.0);
}

TEST(FollowChains, SignsAreKeptApart) {
  const std::vector<EdgeChain> beside = Follow({"+-", "+-", "+-"});
  ASSERT_EQ(beside.size(), 2U);
  EXPECT_EQ(beside[0].sign, 1);
  EXPECT_EQ(beside[1].sign, -1);
  for (const EdgeChain& chain : beside) EXPECT_EQ(chain.Strength(), 4.0);

  const std::vector<EdgeChain> above = Follow({"+", "+", "-", "-", "-"});
  ASSERT_EQ(above.size(), 2U);
  EXPECT_EQ(above[0].Strength(), 2.0);
  EXPECT_EQ(above[1].Strength(), 4.0);
}

TEST(FollowChains, ScatteredNoiseHasNothing) {
  const std::vector<EdgeChain> chains = Follow({"+..-..", "......", ".+..+.", "......", "-..+.."});
  EXPECT_EQ(chains.size(), 6U);
  for (const EdgeChain& chain : chains) EXPECT_EQ(chain.Strength(), 0.0);
}

TEST(FollowChains, WithoutEdgePixelsThereAreNoChains) {
  EXPECT_TRUE(Follow({"...", "..."}).empty());
}

}  // namespace
}  // namespace scan_image_slam
