#include "core/fusion/painted_cylinder.h"
#include "scan_image_slam/core/fusion/edge_extraction.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// A line that fades away in the middle of the region, so that it has no corners: its upper run is
/// at one column, its lower one, which is half as long, at another.
class BrokenLineTest : public PaintedCylinder {
 protected:
  BrokenLineTest() { SetRegion(20, 219); }

  std::vector<ImageEdge> ExtractRuns(bool has_upper, double upper, bool has_lower, double lower,
                                     double tolerance = 1.5) const {
    EdgeExtractionOptions options = ExtractionOptions();
    options.edge_threshold = 20.0;
    options.column_tolerance = tolerance;
    const auto grey = [&](double column, double row) {
      const bool is_upper = row < 150.0;
      if (is_upper ? !has_upper : !has_lower) return 180.0;
      const double share = std::clamp((std::abs(row - 150.0) - 5.0) / 40.0, 0.0, 1.0);
      return column < (is_upper ? upper : lower) ? 180.0 : 180.0 - 120.0 * share;
    };
    return ExtractFrom(grey, options);
  }
};

TEST_F(BrokenLineTest, ItsRunsAreOneEdge) {
  const std::vector<ImageEdge> edges = ExtractRuns(true, 100.3, true, 100.3);
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_NEAR(edges[0].column, 100.3, 0.1);
  EXPECT_EQ(edges[0].top, 20 / kRow);
  EXPECT_EQ(edges[0].bottom, 219 / kRow);
}

TEST_F(BrokenLineTest, ItIsAsStrongAsItsRunsTogether) {
  const ImageEdge upper = ExtractRuns(true, 100.3, false, 0.0).at(0);
  const ImageEdge lower = ExtractRuns(false, 0.0, true, 100.3).at(0);
  const ImageEdge both = ExtractRuns(true, 100.3, true, 100.3).at(0);
  EXPECT_LT(upper.bottom, lower.top);
  EXPECT_NEAR(both.strength, upper.strength + lower.strength, 1e-9);
  EXPECT_NEAR(both.weight, upper.weight + lower.weight, 1e-9);
}

TEST_F(BrokenLineTest, ItsColumnIsBetweenThoseOfItsRuns) {
  const ImageEdge upper = ExtractRuns(true, 100.0, false, 0.0).at(0);
  const ImageEdge lower = ExtractRuns(false, 0.0, true, 101.2).at(0);
  ASSERT_GT(upper.strength, 1.5 * lower.strength);
  const std::vector<ImageEdge> edges = ExtractRuns(true, 100.0, true, 101.2);
  ASSERT_EQ(edges.size(), 1U);
  const double share = lower.strength / (upper.strength + lower.strength);
  EXPECT_NEAR(edges[0].column, (1.0 - share) * upper.column + share * lower.column, 0.15);
}

TEST_F(BrokenLineTest, RunsFartherApartThanTheToleranceAreTwoEdges) {
  const ImageEdge upper = ExtractRuns(true, 100.0, false, 0.0).at(0);
  const ImageEdge lower = ExtractRuns(false, 0.0, true, 101.2).at(0);
  const std::vector<ImageEdge> edges = ExtractRuns(true, 100.0, true, 101.2, 0.8);
  ASSERT_EQ(edges.size(), 2U);
  EXPECT_NEAR(edges[0].column, upper.column, 0.01);
  EXPECT_NEAR(edges[1].column, lower.column, 0.01);
}

}  // namespace
}  // namespace scan_image_slam
