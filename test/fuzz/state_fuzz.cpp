// Any state of a map: refused, or written again it is read again, and the mapper takes it up. The
// check sum is put right, as otherwise nothing behind it would be reached.

#include "fuzz_input.h"
#include "scan_image_slam/core/mapping/mapper.h"
#include "scan_image_slam/core/mapping/state_file.h"

#include <stdexcept>

#include <zlib.h>

namespace scan_image_slam {
namespace {

template <typename Number>
void Append(Number number, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string WithHeader(const std::uint8_t* data, std::size_t size) {
  std::string bytes = "SISTATE\n";
  Append(std::uint32_t{2}, &bytes);
  Append(static_cast<std::uint32_t>(crc32(0, data, static_cast<uInt>(size))), &bytes);
  Append(static_cast<std::uint64_t>(size), &bytes);
  return bytes.append(reinterpret_cast<const char*>(data), size);
}

}  // namespace
}  // namespace scan_image_slam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  const std::string raw(reinterpret_cast<const char*>(data), size);
  try {
    DecodeState(raw);
  } catch (const std::runtime_error&) {
  }
  try {
    const std::string bytes = WithHeader(data, size);
    const MapState state = DecodeState(bytes);
    Require(EncodeState(DecodeState(EncodeState(state))) == EncodeState(state));
    Mapper mapper{MapperOptions()};
    mapper.Load(state, MapUse::kContinue);
    mapper.Redraw(10);
  } catch (const std::runtime_error&) {
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
