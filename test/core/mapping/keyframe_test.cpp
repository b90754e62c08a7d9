#include "scan_image_slam/core/mapping/keyframe.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// Encoders are wrong by one velocity between image and scan, and by another while the laser
/// turned.
TEST(MakeKeyframe, TurnsItsEdgesAsTheMatchHasFound) {
  FusedModel model;
  ModelEdge edge;
  edge.bearing = 0.3;
  edge.range = 3.0;
  edge.time_offset = -0.02;
  model.edges = {edge};
  MatchedMotion match;
  match.edge_correction = {0.0, 0.0, 0.5};
  match.sweep_correction = {0.0, 0.0, 4.0};
  const Keyframe keyframe = MakeKeyframe(model, match, KeyframeOptions());
  ASSERT_EQ(keyframe.edges.size(), 1U);
  EXPECT_NEAR(keyframe.edges[0].bearing, 0.29, 1e-12);  // 0.5 rad/s for 20 ms
}

}  // namespace
}  // namespace scan_image_slam
