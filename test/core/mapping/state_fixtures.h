#pragma once

#include "scan_image_slam/core/mapping/map_state.h"
#include "support_same.h"

#include <memory>

#include <gtest/gtest.h>

namespace scan_image_slam {

/// A state of three keyframes in which every number differs from all others; a fourth was let go.
class DistinctNumbers {
 public:
  MapState State() {
    MapState state;
    for (const int id : {0, 2, 3}) {
      state.graph.keyframes[id] = NextKeyframe(id);
      state.graph.poses[id] = NextPose();
    }
    state.graph.constraints = {NextConstraint(0, 2), NextConstraint(2, 3), NextConstraint(0, 3)};
    state.graph.constraints.back().robust = true;
    state.graph.let_go = {{1, {0, NextPose()}}};
    state.graph.submaps = {{4, {0, 1, Next()}}, {6, {1, 4, Next()}}};
    state.graph.next_to_release = 2;
    state.graph.closures_since_optimization = 7;
    for (int keyframe = -1; keyframe < 2; ++keyframe) state.drawn.push_back(NextDrawn(keyframe));
    state.chain = {1'700'000'000'000'000'111LL, 1'700'000'000'000'000'222LL, NextPose()};
    return state;
  }

 private:
  double Next() { return next_ += 1.1; }
  float NextFloat() { return static_cast<float>(Next()); }
  Pose2 NextPose() {
    const double x = Next();
    const double y = Next();
    return {x, y, -Next()};
  }
  template <typename Matrix>
  Matrix NextMatrix() {
    Matrix matrix;
    for (Eigen::Index i = 0; i < matrix.size(); ++i) {
      matrix(i) = static_cast<typename Matrix::Scalar>(Next());
    }
    return matrix;
  }
  ModelEdge NextEdge(int sign) {
    ModelEdge edge;
    edge.camera = NextMatrix<Eigen::Vector2d>();
    for (double* field : {&edge.bearing, &edge.bearing_stddev, &edge.range, &edge.range_stddev,
                          &edge.time_offset, &edge.weight, &edge.contrast}) {
      *field = Next();
    }
    edge.sign = sign;
    return edge;
  }
  std::shared_ptr<const Keyframe> NextKeyframe(int id) {
    auto keyframe = std::make_shared<Keyframe>();
    keyframe->id = id;
    keyframe->stamp = 1'700'000'000'123'456'789LL + id;
    keyframe->way = Next();
    keyframe->joined = id != 2;
    keyframe->previous_from_base = NextPose();
    keyframe->covariance = NextMatrix<Eigen::Matrix3d>();
    keyframe->laser = NextMatrix<Eigen::Vector2d>();
    for (int i = 0; i <= id; ++i) {
      keyframe->points.push_back(
          {NextMatrix<Eigen::Vector2f>(), NextMatrix<Eigen::Vector2f>(), NextFloat()});
      keyframe->edges.push_back(NextEdge(i == 0 ? -1 : 1));
    }
    return keyframe;
  }
  GraphConstraint NextConstraint(int from, int to) {
    return {from, to, NextPose(), NextMatrix<Eigen::Matrix3d>(), false, Next()};
  }
  DrawnScan NextDrawn(int keyframe) {
    auto scan = std::make_shared<GridScan>();
    scan->origin = NextMatrix<Eigen::Vector2d>();
    for (int i = 0; i < 2; ++i) scan->beams.push_back({NextMatrix<Eigen::Vector2f>(), i == 0});
    return {scan, {keyframe, NextPose()}, NextPose()};
  }

  double next_ = 0.0;
};

inline void ExpectSame(const ModelEdge& a, const ModelEdge& b) {
  EXPECT_EQ(a.camera, b.camera);
  EXPECT_EQ(a.bearing, b.bearing);
  EXPECT_EQ(a.bearing_stddev, b.bearing_stddev);
  EXPECT_EQ(a.range, b.range);
  EXPECT_EQ(a.range_stddev, b.range_stddev);
  EXPECT_EQ(a.time_offset, b.time_offset);
  EXPECT_EQ(a.sign, b.sign);
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_EQ(a.contrast, b.contrast);
}

inline void ExpectSame(const Keyframe& a, const Keyframe& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.way, b.way);
  EXPECT_EQ(a.joined, b.joined);
  ExpectSame(a.previous_from_base, b.previous_from_base);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.laser, b.laser);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].point, b.points[i].point);
    EXPECT_EQ(a.points[i].normal, b.points[i].normal);
    EXPECT_EQ(a.points[i].angle_variance, b.points[i].angle_variance);
  }
  ASSERT_EQ(a.edges.size(), b.edges.size());
  for (std::size_t i = 0; i < a.edges.size(); ++i) ExpectSame(a.edges[i], b.edges[i]);
}

inline void ExpectSame(const GraphMemory& a, const GraphMemory& b) {
  ASSERT_EQ(a.keyframes.size(), b.keyframes.size());
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (const auto& [id, keyframe] : a.keyframes) {
    ASSERT_EQ(b.keyframes.count(id), 1U);
    ExpectSame(*keyframe, *b.keyframes.at(id));
    ExpectSame(a.poses.at(id), b.poses.at(id));
  }
  ASSERT_EQ(a.constraints.size(), b.constraints.size());
  for (std::size_t i = 0; i < a.constraints.size(); ++i) {
    EXPECT_EQ(a.constraints[i].from, b.constraints[i].from);
    EXPECT_EQ(a.constraints[i].to, b.constraints[i].to);
    ExpectSame(a.constraints[i].from_from_to, b.constraints[i].from_from_to);
    EXPECT_EQ(a.constraints[i].information, b.constraints[i].information);
    EXPECT_EQ(a.constraints[i].robust, b.constraints[i].robust);
    EXPECT_EQ(a.constraints[i].overlap, b.constraints[i].overlap);
  }
  ASSERT_EQ(a.let_go.size(), b.let_go.size());
  for (const auto& [id, pose] : a.let_go) {
    EXPECT_EQ(b.let_go.at(id).keyframe, pose.keyframe);
    ExpectSame(b.let_go.at(id).keyframe_from_base, pose.keyframe_from_base);
  }
  ASSERT_EQ(a.submaps.size(), b.submaps.size());
  for (const auto& [number, range] : a.submaps) {
    EXPECT_EQ(b.submaps.at(number).begin, range.begin);
    EXPECT_EQ(b.submaps.at(number).end, range.end);
    EXPECT_EQ(b.submaps.at(number).way, range.way);
  }
  EXPECT_EQ(a.next_to_release, b.next_to_release);
  EXPECT_EQ(a.closures_since_optimization, b.closures_since_optimization);
}

inline void ExpectSame(const MapState& a, const MapState& b) {
  ExpectSame(a.graph, b.graph);
  EXPECT_EQ(a.chain.start_stamp, b.chain.start_stamp);
  EXPECT_EQ(a.chain.stamp, b.chain.stamp);
  ExpectSame(a.chain.map_from_start, b.chain.map_from_start);
  ASSERT_EQ(a.drawn.size(), b.drawn.size());
  for (std::size_t i = 0; i < a.drawn.size(); ++i) {
    EXPECT_EQ(a.drawn[i].pose.keyframe, b.drawn[i].pose.keyframe);
    ExpectSame(a.drawn[i].pose.keyframe_from_base, b.drawn[i].pose.keyframe_from_base);
    ExpectSame(a.drawn[i].map_from_base, b.drawn[i].map_from_base);
    const GridScan& scan = *a.drawn[i].scan;
    const GridScan& other = *b.drawn[i].scan;
    EXPECT_EQ(scan.origin, other.origin);
    ASSERT_EQ(scan.beams.size(), other.beams.size());
    for (std::size_t k = 0; k < scan.beams.size(); ++k) {
      EXPECT_EQ(scan.beams[k].end, other.beams[k].end);
      EXPECT_EQ(scan.beams[k].hit, other.beams[k].hit);
    }
  }
}

}  // namespace scan_image_slam
