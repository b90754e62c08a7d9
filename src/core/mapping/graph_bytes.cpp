#include "scan_image_slam/core/mapping/graph_bytes.h"

#include "scan_image_slam/core/mapping/map_bytes.h"

#include <string>
#include <utility>

namespace scan_image_slam {
namespace {

constexpr std::size_t kMatrixBytes = 9 * kDoubleBytes;
constexpr std::size_t kPointBytes = 5 * kFloatBytes;
constexpr std::size_t kEdgeBytes = 9 * kDoubleBytes + kFloatBytes;
constexpr std::size_t kKeyframeBytes = kFloatBytes + 2 * kDoubleBytes + kFlagBytes + kPoseBytes +
                                       kMatrixBytes + 2 * kDoubleBytes + 2 * kFloatBytes;
constexpr std::size_t kConstraintBytes =
    2 * kFloatBytes + kPoseBytes + kMatrixBytes + kFlagBytes + kDoubleBytes;
constexpr std::size_t kSubmapBytes = 3 * kFloatBytes + kDoubleBytes;

/// Without `range_by_bearing`, which is for the matching of the next scans only.
void Put(const ModelEdge& edge, ByteWriter* out) {
  PutMatrix(edge.camera, out);
  out->Write(edge.bearing);
  out->Write(edge.bearing_stddev);
  out->Write(edge.range);
  out->Write(edge.range_stddev);
  out->Write(edge.time_offset);
  out->Write(static_cast<std::int32_t>(edge.sign));
  out->Write(edge.weight);
  out->Write(edge.contrast);
}

ModelEdge GetEdge(ByteReader* in) {
  ModelEdge edge;
  edge.camera = GetMatrix<Eigen::Vector2d>(in);
  edge.bearing = in->Read<double>();
  edge.bearing_stddev = in->Read<double>();
  edge.range = in->Read<double>();
  edge.range_stddev = in->Read<double>();
  edge.time_offset = in->Read<double>();
  edge.sign = in->ReadIndex(-1, 1);
  edge.weight = in->Read<double>();
  edge.contrast = in->Read<double>();
  return edge;
}

void Put(const Keyframe& keyframe, ByteWriter* out) {
  PutIndex(keyframe.id, out);
  out->Write(keyframe.stamp);
  out->Write(keyframe.way);
  out->Write(static_cast<std::uint8_t>(keyframe.joined));
  Put(keyframe.previous_from_base, out);
  PutMatrix(keyframe.covariance, out);
  PutMatrix(keyframe.laser, out);
  PutCount(keyframe.points.size(), out);
  for (const KeptPoint& p : keyframe.points) {
    PutMatrix(p.point, out);
    PutMatrix(p.normal, out);
    out->Write(p.angle_variance);
  }
  PutCount(keyframe.edges.size(), out);
  for (const ModelEdge& edge : keyframe.edges) Put(edge, out);
}

/// Those that were let go are missing, but never the first.
std::shared_ptr<const Keyframe> GetKeyframe(ByteReader* in, const Keyframes& before) {
  auto keyframe = std::make_shared<Keyframe>();
  keyframe->id =
      before.empty() ? in->ReadIndex(0, 0) : in->ReadIndex(before.rbegin()->first + 1, kAnyIndex);
  keyframe->stamp = in->Read<Stamp>();
  keyframe->way = in->Read<double>();
  keyframe->joined = GetBool(in);
  keyframe->previous_from_base = GetPose(in);
  keyframe->covariance = GetMatrix<Eigen::Matrix3d>(in);
  keyframe->laser = GetMatrix<Eigen::Vector2d>(in);
  keyframe->points.resize(in->ReadCount(kPointBytes, "points"));
  for (KeptPoint& p : keyframe->points) {
    p.point = GetMatrix<Eigen::Vector2f>(in);
    p.normal = GetMatrix<Eigen::Vector2f>(in);
    p.angle_variance = in->Read<float>();
  }
  const std::size_t edges = in->ReadCount(kEdgeBytes, "edges");
  keyframe->edges.reserve(edges);
  for (std::size_t i = 0; i < edges; ++i) keyframe->edges.push_back(GetEdge(in));
  return keyframe;
}

void Put(const GraphConstraint& constraint, ByteWriter* out) {
  PutIndex(constraint.from, out);
  PutIndex(constraint.to, out);
  Put(constraint.from_from_to, out);
  PutMatrix(constraint.information, out);
  out->Write(static_cast<std::uint8_t>(constraint.robust));
  out->Write(constraint.overlap);
}

[[noreturn]] void NoKeyframe(const ByteReader& in, int number) {
  in.Fail("there is no keyframe " + std::to_string(number) + " to refer to here");
}

/// The number of a keyframe that there is.
int GetNumber(ByteReader* in, const Keyframes& keyframes) {
  const ByteReader before = *in;
  const int number = in->ReadIndex(0, kAnyIndex);
  if (keyframes.count(number) == 0) NoKeyframe(before, number);
  return number;
}

GraphConstraint GetConstraint(ByteReader* in, const Keyframes& keyframes) {
  GraphConstraint constraint;
  constraint.from = GetNumber(in, keyframes);
  const ByteReader before = *in;
  constraint.to = GetNumber(in, keyframes);
  if (constraint.to <= constraint.from) NoKeyframe(before, constraint.to);
  constraint.from_from_to = GetPose(in);
  constraint.information = GetMatrix<Eigen::Matrix3d>(in);
  constraint.robust = GetBool(in);
  constraint.overlap = in->Read<double>();
  return constraint;
}

void GetAnchor(ByteReader* in, GraphMemory* graph) {
  const int id = in->ReadIndex(1, kAnyIndex);
  const ByteReader before = *in;
  AttachedPose& anchor = graph->let_go[id];
  anchor.keyframe = GetNumber(in, graph->keyframes);
  if (anchor.keyframe >= id) NoKeyframe(before, anchor.keyframe);
  anchor.keyframe_from_base = GetPose(in);
}

/// At least one of the keyframes is kept.
KeyframeRange GetRange(ByteReader* in, const Keyframes& keyframes) {
  const ByteReader before = *in;
  KeyframeRange range;
  range.begin = in->ReadIndex(0, kAnyIndex);
  range.end = in->ReadIndex(range.begin + 1, kAnyIndex);
  const auto first = keyframes.lower_bound(range.begin);
  if (first == keyframes.end() || first->first >= range.end) NoKeyframe(before, range.begin);
  range.way = in->Read<double>();
  return range;
}

/// All keyframes from it on follow each other.
int GetNextToRelease(ByteReader* in, const Keyframes& keyframes) {
  if (keyframes.empty()) return in->ReadIndex(0, 0);
  const ByteReader before = *in;
  const int next = GetNumber(in, keyframes);
  for (int id = next; id < keyframes.rbegin()->first; ++id) {
    if (keyframes.count(id) == 0) NoKeyframe(before, id);
  }
  return next;
}

}  // namespace

void Put(const AttachedPose& pose, ByteWriter* out) {
  PutIndex(pose.keyframe, out);
  Put(pose.keyframe_from_base, out);
}

AttachedPose GetAttached(ByteReader* in, const GraphMemory& graph) {
  const ByteReader before = *in;
  AttachedPose pose;
  pose.keyframe = in->ReadIndex(-1, kAnyIndex);
  if (pose.keyframe >= 0 && graph.keyframes.count(pose.keyframe) == 0 &&
      graph.let_go.count(pose.keyframe) == 0) {
    NoKeyframe(before, pose.keyframe);
  }
  pose.keyframe_from_base = GetPose(in);
  return pose;
}

void Put(const GraphMemory& graph, ByteWriter* out) {
  PutCount(graph.keyframes.size(), out);
  for (const auto& [id, keyframe] : graph.keyframes) Put(*keyframe, out);
  for (const auto& [id, pose] : graph.poses) Put(pose, out);
  PutCount(graph.constraints.size(), out);
  for (const GraphConstraint& constraint : graph.constraints) Put(constraint, out);
  PutCount(graph.let_go.size(), out);
  for (const auto& [id, anchor] : graph.let_go) {
    PutIndex(id, out);
    Put(anchor, out);
  }
  PutCount(graph.submaps.size(), out);
  for (const auto& [number, range] : graph.submaps) {
    PutIndex(number, out);
    PutIndex(range.begin, out);
    PutIndex(range.end, out);
    out->Write(range.way);
  }
  PutIndex(graph.next_to_release, out);
  PutIndex(graph.closures_since_optimization, out);
}

GraphMemory GetGraph(ByteReader* in) {
  GraphMemory graph;
  const std::size_t keyframes = in->ReadCount(kKeyframeBytes + kPoseBytes, "keyframes");
  for (std::size_t i = 0; i < keyframes; ++i) {
    auto keyframe = GetKeyframe(in, graph.keyframes);
    graph.keyframes[keyframe->id] = std::move(keyframe);
  }
  for (const auto& [id, keyframe] : graph.keyframes) graph.poses[id] = GetPose(in);
  const std::size_t constraints = in->ReadCount(kConstraintBytes, "constraints");
  graph.constraints.reserve(constraints);
  for (std::size_t i = 0; i < constraints; ++i) {
    graph.constraints.push_back(GetConstraint(in, graph.keyframes));
  }
  const std::size_t let_go = in->ReadCount(kFloatBytes + kAttachedBytes, "keyframes let go");
  for (std::size_t i = 0; i < let_go; ++i) GetAnchor(in, &graph);
  const std::size_t submaps = in->ReadCount(kSubmapBytes, "submaps");
  for (std::size_t i = 0; i < submaps; ++i) {
    const int number = in->ReadIndex(0, kAnyIndex);
    graph.submaps[number] = GetRange(in, graph.keyframes);
  }
  graph.next_to_release = GetNextToRelease(in, graph.keyframes);
  graph.closures_since_optimization = in->ReadIndex(0, kAnyIndex);
  return graph;
}

}  // namespace scan_image_slam
