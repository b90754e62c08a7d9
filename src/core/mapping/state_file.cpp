#include "scan_image_slam/core/mapping/state_file.h"

#include "scan_image_slam/core/mapping/atomic_file.h"
#include "scan_image_slam/core/mapping/byte_stream.h"
#include "scan_image_slam/core/mapping/graph_bytes.h"
#include "scan_image_slam/core/mapping/map_bytes.h"

#include <zlib.h>

namespace scan_image_slam {
namespace {

const std::string kMagic = "SISTATE\n";
constexpr std::uint32_t kVersion = 3;
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

constexpr std::size_t kBeamBytes = 2 * kFloatBytes + kFlagBytes;
constexpr std::size_t kDrawnBytes = 2 * kDoubleBytes + kAttachedBytes + kPoseBytes + kFloatBytes;

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

DrawnScan GetDrawn(ByteReader* in, const GraphMemory& graph) {
  DrawnScan drawn;
  auto scan = std::make_shared<GridScan>();
  scan->origin = GetMatrix<Eigen::Vector2d>(in);
  drawn.pose = GetAttached(in, graph);
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
  Put(state.graph, &out);
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
  state.graph = GetGraph(&in);
  const std::size_t drawn = in.ReadCount(kDrawnBytes, "drawn scans");
  state.drawn.reserve(drawn);
  for (std::size_t i = 0; i < drawn; ++i) state.drawn.push_back(GetDrawn(&in, state.graph));
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
