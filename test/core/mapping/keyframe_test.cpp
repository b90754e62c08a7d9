#include "scan_image_slam/core/mapping/keyframe.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// What the encoders were wrong by while the laser turned, they were wrong by since the image, too.
TEST(MakeKeyframe, TurnsItsEdgesAsTheMatchHasFound) {
  FusedModel model;
  ModelEdge edge;
  edge.bearing = 0.3;
  edge.range = 3.0;
  edge.time_offset = -0.02;
  model.edges = {edge};
  MatchedMotion match;
  match.sweep_correction = {0.0, 0.0, 0.5};
  const Keyframe keyframe = MakeKeyframe(model, match, KeyframeOptions());
  ASSERT_EQ(keyframe.edges.size(), 1U);
  EXPECT_NEAR(keyframe.edges[0].bearing, 0.29, 1e-12);  // 0.5 rad/s for 20 ms
}

}  // namespace
}  // namespace scan_image_slam
