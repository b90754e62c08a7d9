#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/mapping/byte_stream.h"

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace scan_image_slam {

// Each thing that is kept in a file has a Put and a Get that name the same fields in the same
// order, and the least bytes that it takes. A Get throws as ByteReader does.

constexpr int kAnyIndex = 1 << 30;       ///< greater than any
constexpr std::size_t kDoubleBytes = 8;  ///< also of a stamp
constexpr std::size_t kFloatBytes = 4;   ///< also of an index or a count
constexpr std::size_t kFlagBytes = 1;
constexpr std::size_t kPoseBytes = 3 * kDoubleBytes;
constexpr std::size_t kAttachedBytes = kFloatBytes + kPoseBytes;

inline void Put(const Pose2& pose, ByteWriter* out) {
  out->Write(pose.x);
  out->Write(pose.y);
  out->Write(pose.theta);
}

inline Pose2 GetPose(ByteReader* in) {
  Pose2 pose;
  pose.x = in->Read<double>();
  pose.y = in->Read<double>();
  pose.theta = in->Read<double>();
  return pose;
}

/// Row by row.
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

inline void PutIndex(int index, ByteWriter* out) { out->Write(static_cast<std::int32_t>(index)); }

/// Before the things of a list.
inline void PutCount(std::size_t count, ByteWriter* out) {
  out->Write(static_cast<std::uint32_t>(count));
}

inline bool GetBool(ByteReader* in) { return in->Read<std::uint8_t>() != 0; }

}  // namespace scan_image_slam
