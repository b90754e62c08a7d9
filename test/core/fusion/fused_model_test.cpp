#include "scan_image_slam/core/fusion/fused_model.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(ModelBeam, IsAHitIfItsRangeIsANumber) {
  ModelBeam beam;
  beam.range = 2.0;
  EXPECT_TRUE(beam.hit());
  beam.range = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(beam.hit());
  beam.range = std::nan("");
  EXPECT_FALSE(beam.hit());
}

TEST(ModelEdge, LiesAtItsRangeFromTheCamera) {
  ModelEdge edge;
  edge.camera = {1.0, 2.0};
  edge.bearing = M_PI / 6.0;
  edge.range = 4.0;
  EXPECT_NEAR(edge.point().x(), 1.0 + 2.0 * std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(edge.point().y(), 2.0 + 2.0, 1e-14);
}

TEST(FusedModel, TheHeadingOfABeamIsItsBearingOnTheBase) {
  FusedModel model;
  model.base_from_laser.theta = 1.0;
  ModelBeam beam;
  beam.bearing = 0.25;
  EXPECT_DOUBLE_EQ(model.HeadingOf(beam), 1.25);
  model.upside_down = true;
  EXPECT_DOUBLE_EQ(model.HeadingOf(beam), 0.75);
}

}  // namespace
}  // namespace scan_image_slam
