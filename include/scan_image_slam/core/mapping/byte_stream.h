#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace scan_image_slam {

/// The unsigned integer of `kBytes` bytes.
template <std::size_t kBytes>
using UnsignedOfSize = std::conditional_t<
    kBytes == 8, std::uint64_t,
    std::conditional_t<kBytes == 4, std::uint32_t,
                       std::conditional_t<kBytes == 2, std::uint16_t, std::uint8_t>>>;

/// Puts numbers into a row of bytes, the low byte first, whatever the machine.
class ByteWriter {
 public:
  /// After these bytes.
  explicit ByteWriter(std::string begin) : bytes_(std::move(begin)) {}

  template <typename Number>
  void Write(Number number) {
    bytes_.resize(bytes_.size() + sizeof(Number));
    WriteAt(bytes_.size() - sizeof(Number), number);
  }

  /// Over bytes that are there already.
  template <typename Number>
  void WriteAt(std::size_t at, Number number) {
    static_assert(std::is_arithmetic_v<Number> && sizeof(Number) <= 8);
    UnsignedOfSize<sizeof(Number)> bits = 0;
    std::memcpy(&bits, &number, sizeof(Number));
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
      bytes_[at + i] = static_cast<char>(bits >> (8 * i));
    }
  }

  const std::string& bytes() const { return bytes_; }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Takes numbers out of a row of bytes. What does not fit is a std::runtime_error that names the
/// byte, and nothing is allocated for it.
class ByteReader {
 public:
  /// From byte `begin` on; `bytes` must outlive the reader.
  ByteReader(const std::string& bytes, std::size_t begin) : bytes_(bytes), at_(begin) {}

  template <typename Number>
  Number Read() {
    static_assert(std::is_arithmetic_v<Number> && sizeof(Number) <= 8);
    if (left() < sizeof(Number)) Fail("the data end within a number");
    UnsignedOfSize<sizeof(Number)> bits = 0;
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
      const auto byte = static_cast<std::uint8_t>(bytes_[at_ + i]);
      bits = static_cast<decltype(bits)>(bits | (static_cast<std::uint64_t>(byte) << (8 * i)));
    }
    Number number;
    std::memcpy(&number, &bits, sizeof(Number));
    if constexpr (std::is_floating_point_v<Number>) {
      if (!std::isfinite(number)) Fail("a number is not finite");
    }
    at_ += sizeof(Number);
    return number;
  }

  /// A whole number from `lowest` to `highest`.
  int ReadIndex(int lowest, int highest) {
    const std::size_t begin = at_;
    const auto index = Read<std::int32_t>();
    if (index < lowest || index > highest) {
      at_ = begin;
      Fail("the index " + std::to_string(index) + " is not between " + std::to_string(lowest) +
           " and " + std::to_string(highest));
    }
    return index;
  }

  /// How many things of at least `bytes_each` follow: never more than the data can hold.
  std::size_t ReadCount(std::size_t bytes_each, const char* what) {
    const std::size_t begin = at_;
    const std::size_t count = Read<std::uint32_t>();
    if (count > left() / bytes_each) {
      at_ = begin;
      Fail(std::to_string(count) + " " + what + " are more than the data can hold");
    }
    return count;
  }

  std::size_t at() const { return at_; }
  std::size_t left() const { return bytes_.size() - at_; }

  [[noreturn]] void Fail(const std::string& reason) const {
    throw std::runtime_error("at byte " + std::to_string(at_) + ": " + reason);
  }

 private:
  const std::string& bytes_;
  std::size_t at_;
};

}  // namespace scan_image_slam
