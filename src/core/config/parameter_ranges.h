#pragma once

#include "scan_image_slam/core/config/parameter_set.h"

namespace scan_image_slam {

/// Of the values that most parameters may have.
constexpr ParameterRange kPositive{1e-9, kUnlimited};
constexpr ParameterRange kNotNegative{0.0, kUnlimited};
constexpr ParameterRange kAny{-kUnlimited, kUnlimited};
constexpr ParameterRange kFraction{0.0, 1.0};
constexpr ParameterRange kAngle{-360.0, 360.0};

}  // namespace scan_image_slam
