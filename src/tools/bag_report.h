#pragma once

#include "bag_plan.h"

#include <string>

namespace scan_image_slam {

/// What the bag holds, in plain words: one paragraph for each sensor.
std::string DescribeContents(const BagContents& contents, const BagPlan& plan);

/// What is odd in the topics that are used and in the frames, most serious first.
Findings CheckContents(const BagContents& contents, const BagPlan& plan);

/// Findings as text, each with what to do.
std::string FindingsText(const Findings& findings);

}  // namespace scan_image_slam
