#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace scan_image_slam {

/// Random numbers that are the same with every standard library (the distributions of <random> are
/// not). Streams of one seed with different names are independent of each other, so that one part
/// of the simulation may draw more or less without changing the others.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  double Uniform();                         ///< in [0, 1)
  double Uniform(double low, double high);  ///< in [low, high)
  double Normal();                          ///< mean 0, standard deviation 1
  double Exponential(double mean);          ///< at least 0; 0 if the mean is 0
  /// Whole number in [0, count); `count` > 0.
  std::uint32_t Index(std::uint32_t count);

 private:
  std::mt19937_64 engine_;
  double spare_normal_ = 0.0;
  bool has_spare_normal_ = false;
};

}  // namespace scan_image_slam
