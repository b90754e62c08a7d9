#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include <ros/time.h>

namespace scan_image_slam {

/// Reads values of any kind from the bytes that the fuzzer makes up; zeros after their end.
class FuzzInput {
 public:
  FuzzInput(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  bool empty() const { return left_ == 0; }

  template <typename Number>
  Number Take() {
    static_assert(std::is_arithmetic_v<Number>);
    if constexpr (std::is_same_v<Number, bool>) return Take<std::uint8_t>() % 2 == 1;
    Number number{};
    const std::size_t size = std::min(sizeof number, left_);
    if (size > 0) std::memcpy(&number, data_, size);
    data_ += size;
    left_ -= size;
    return number;
  }

  /// The next value of that kind into each of the fields.
  template <typename... Fields>
  void Fill(Fields*... fields) {
    ((*fields = Take<Fields>()), ...);
  }

  /// At most 255 of them.
  template <typename Number>
  std::vector<Number> TakeVector() {
    std::vector<Number> numbers(Take<std::uint8_t>());
    for (Number& number : numbers) number = Take<Number>();
    return numbers;
  }

  /// At most 255 bytes.
  std::string TakeText() {
    const std::vector<char> text = TakeVector<char>();
    return {text.begin(), text.end()};
  }

  /// Any stamp that a message can hold.
  ros::Time TakeTime() {
    ros::Time time;
    time.sec = Take<std::uint32_t>();
    time.nsec = Take<std::uint32_t>();
    return time;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

/// Ends the program, so that the fuzzer tells of it, unless `holds`.
inline void Require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace scan_image_slam
