#include "scan_image_slam/core/mapping/state_file.h"

#include "scan_image_slam/core/mapping/atomic_file.h"
#include "scan_image_slam/core/mapping/byte_stream.h"

#include <zlib.h>

namespace scan_image_slam {
namespace {

const std::string kMagic = "SISTATE\n";
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kCheckSumAt = 12;  // after magic and version [bytes]
constexpr std::size_t kSizeAt = 16;
constexpr std::size_t kHeader = 24;

std::uint32_t CheckSum(const std::string& bytes, std::size_t begin) {
  // zlib takes 32 bits of size at once.
  constexpr std::size_t kPart = 1U << 30;
  uLong sum = crc32(0, nullptr, 0);
  for (std::size_t at = begin; at < bytes.size(); at += kPart) {
    const std::size_t size = std::min(kPart, bytes.size() - at);
    sum = crc32(sum, reinterpret_cast<const Bytef*>(bytes.data() + at), static_cast<uInt>(size));
  }
  return static_cast<std::uint32_t>(sum);
}

// Each thing that is kept has a Put and a Get that name the same fields in the same order, and the
// least bytes that it takes.

constexpr std::size_t kDouble = 8;  // also a stamp
constexpr std::size_t kFloat = 4;   // also an index or a count
constexpr std::size_t kFlag = 1;
constexpr std::size_t kPoseBytes = 3 * kDouble;
constexpr std::size_t kMatrixBytes = 9 * kDouble;
constexpr std::size_t kPointBytes = 5 * kFloat;
constexpr std::size_t kEdgeBytes = 9 * kDouble + kFloat;
constexpr std::size_t kKeyframeBytes =
    2 * kDouble + kFlag + kPoseBytes + kMatrixBytes + 2 * kDouble + 2 * kFloat;
constexpr std::size_t kConstraintBytes = 2 * kFloat + kPoseBytes + kMatrixBytes + kFlag + kDouble;
constexpr std::size_t kBeamBytes = 2 * kFloat + kFlag;
constexpr std::size_t kAttachedBytes = kFloat + kPoseBytes;
constexpr std::size_t kDrawnBytes = 2 * kDouble + kAttachedBytes + kPoseBytes + kFloat;

void Put(const Pose2& pose, ByteWriter* out) {
  out->Write(pose.x);
  out->Write(pose.y);
  out->Write(pose.theta);
}

Pose2 GetPose(ByteReader* in) {
  Pose2 pose;
  pose.x = in->Read<double>();
  pose.y = in->Read<double>();
  pose.theta = in->Read<double>();
  return pose;
}

template <typename Derived>
void PutMatrix(const Eigen::MatrixBase<Derived>& matrix, ByteWriter* out) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i)
    out->Write(matrix(i / matrix.cols(), i % matrix.cols()));
}

template <typename Matrix>
Matrix GetMatrix(ByteReader* in) {
  Matrix matrix;
  for (Eigen::Index i = 0; i < matrix.size(); ++i) {
    matrix(i / matrix.cols(), i % matrix.cols()) = in->Read<typename Matrix::Scalar>();
  }
  return matrix;
}

void PutCount(std::size_t count, ByteWriter* out) { out->Write(static_cast<std::uint32_t>(count)); }

bool GetBool(ByteReader* in) { return in->Read<std::uint8_t>() != 0; }

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

std::shared_ptr<const Keyframe> GetKeyframe(ByteReader* in, int id) {
  auto keyframe = std::make_shared<Keyframe>();
  keyframe->id = id;
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
  out->Write(static_cast<std::int32_t>(constraint.from));
  out->Write(static_cast<std::int32_t>(constraint.to));
  Put(constraint.from_from_to, out);
  PutMatrix(constraint.information, out);
  out->Write(static_cast<std::uint8_t>(constraint.robust));
  out->Write(constraint.overlap);
}

GraphConstraint GetConstraint(ByteReader* in, int keyframes) {
  GraphConstraint constraint;
  constraint.from = in->ReadIndex(0, keyframes - 1);
  constraint.to = in->ReadIndex(constraint.from + 1, keyframes - 1);
  constraint.from_from_to = GetPose(in);
  constraint.information = GetMatrix<Eigen::Matrix3d>(in);
  constraint.robust = GetBool(in);
  constraint.overlap = in->Read<double>();
  return constraint;
}

void Put(const AttachedPose& pose, ByteWriter* out) {
  out->Write(static_cast<std::int32_t>(pose.keyframe));
  Put(pose.keyframe_from_base, out);
}

/// Hangs on one of the first `keyframes` keyframes, or on the map.
AttachedPose GetAttached(ByteReader* in, int keyframes) {
  AttachedPose pose;
  pose.keyframe = in->ReadIndex(-1, keyframes - 1);
  pose.keyframe_from_base = GetPose(in);
  return pose;
}

void Put(const DrawnScan& drawn, ByteWriter* out) {
  PutMatrix(drawn.scan->origin, out);
  Put(drawn.pose, out);
  Put(drawn.map_from_base, out);
  PutCount(drawn.scan->beams.size(), out);
  for (const GridBeam& beam : drawn.scan->beams) {
    PutMatrix(beam.end, out);
    out->Write(static_cast<std::uint8_t>(beam.hit));
  }
}

DrawnScan GetDrawn(ByteReader* in, int keyframes) {
  DrawnScan drawn;
  auto scan = std::make_shared<GridScan>();
  scan->origin = GetMatrix<Eigen::Vector2d>(in);
  drawn.pose = GetAttached(in, keyframes);
  drawn.map_from_base = GetPose(in);
  scan->beams.resize(in->ReadCount(kBeamBytes, "beams"));
  for (GridBeam& beam : scan->beams) {
    beam.end = GetMatrix<Eigen::Vector2f>(in);
    beam.hit = GetBool(in);
  }
  drawn.scan = std::move(scan);
  return drawn;
}

void CheckHeader(const std::string& bytes) {
  if (bytes.compare(0, kMagic.size(), kMagic) != 0) {
    throw std::runtime_error("at byte 0: this is no state of a map");
  }
  ByteReader in(bytes, kMagic.size());
  const auto version = in.Read<std::uint32_t>();
  if (version != kVersion) {
    throw std::runtime_error("at byte 8: its version is " + std::to_string(version) +
                             ", this program reads version " + std::to_string(kVersion));
  }
  const auto sum = in.Read<std::uint32_t>();
  const auto size = in.Read<std::uint64_t>();
  const std::size_t there = in.left();
  if (size > there) {
    throw std::runtime_error("at byte " + std::to_string(bytes.size()) + ": it ends here, " +
                             std::to_string(size - there) + " bytes too early");
  }
  if (size < there) {
    throw std::runtime_error("at byte " + std::to_string(kHeader + size) + ": " +
                             std::to_string(there - size) + " bytes too many");
  }
  if (sum != CheckSum(bytes, kHeader)) {
    throw std::runtime_error("between bytes " + std::to_string(kHeader) + " and " +
                             std::to_string(bytes.size()) +
                             ": it is damaged, the check sum does not fit");
  }
}

}  // namespace

std::string EncodeState(const MapState& state) {
  ByteWriter out(kMagic);
  out.Write(kVersion);
  out.Write(std::uint32_t{0});  // check sum and size are written over in the end
  out.Write(std::uint64_t{0});
  PutCount(state.graph.keyframes.size(), &out);
  for (const auto& keyframe : state.graph.keyframes) Put(*keyframe, &out);
  for (const Pose2& pose : state.graph.poses) Put(pose, &out);
  PutCount(state.graph.constraints.size(), &out);
  for (const GraphConstraint& constraint : state.graph.constraints) Put(constraint, &out);
  PutCount(state.graph.anchors.size(), &out);
  for (const auto& [id, pose] : state.graph.anchors) {
    out.Write(static_cast<std::int32_t>(id));
    Put(pose, &out);
  }
  out.Write(static_cast<std::int32_t>(state.graph.closures_since_optimization));
  PutCount(state.drawn.size(), &out);
  for (const DrawnScan& drawn : state.drawn) Put(drawn, &out);
  out.Write(state.chain.start_stamp);
  out.Write(state.chain.stamp);
  Put(state.chain.map_from_start, &out);
  out.WriteAt(kCheckSumAt, CheckSum(out.bytes(), kHeader));
  out.WriteAt(kSizeAt, static_cast<std::uint64_t>(out.bytes().size() - kHeader));
  return out.Take();
}

MapState DecodeState(const std::string& bytes) {
  CheckHeader(bytes);
  ByteReader in(bytes, kHeader);
  MapState state;
  const std::size_t keyframes = in.ReadCount(kKeyframeBytes + kPoseBytes, "keyframes");
  const int count = static_cast<int>(keyframes);
  state.graph.keyframes.reserve(keyframes);
  for (int id = 0; id < count; ++id) state.graph.keyframes.push_back(GetKeyframe(&in, id));
  state.graph.poses.reserve(keyframes);
  for (int id = 0; id < count; ++id) state.graph.poses.push_back(GetPose(&in));
  const std::size_t constraints = in.ReadCount(kConstraintBytes, "constraints");
  state.graph.constraints.reserve(constraints);
  for (std::size_t i = 0; i < constraints; ++i) {
    state.graph.constraints.push_back(GetConstraint(&in, count));
  }
  const std::size_t anchors = in.ReadCount(kFloat + kAttachedBytes, "anchors");
  for (std::size_t i = 0; i < anchors; ++i) {
    const int id = in.ReadIndex(0, count - 1);
    state.graph.anchors[id] = GetAttached(&in, id);
  }
  constexpr int kAny = 1 << 30;
  state.graph.closures_since_optimization = in.ReadIndex(0, kAny);
  const std::size_t drawn = in.ReadCount(kDrawnBytes, "drawn scans");
  state.drawn.reserve(drawn);
  for (std::size_t i = 0; i < drawn; ++i) state.drawn.push_back(GetDrawn(&in, count));
  state.chain.start_stamp = in.Read<Stamp>();
  state.chain.stamp = in.Read<Stamp>();
  state.chain.map_from_start = GetPose(&in);
  if (in.left() > 0) in.Fail("something follows that does not belong to it");
  return state;
}

void WriteState(const MapState& state, const std::string& path) {
  ReplaceFile(path, EncodeState(state));
}

MapState ReadState(const std::string& path) {
  const std::string bytes = ReadWholeFile(path);
  try {
    return DecodeState(bytes);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

}  // namespace scan_image_slam
