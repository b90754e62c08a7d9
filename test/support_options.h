#pragma once

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace scan_image_slam {

/// Options with one wrong value are refused by a message that begins with the field's name.
template <typename Options>
void ExpectRefused(double Options::*field, double value, const std::string& name,
                   Options options = Options()) {
  options.*field = value;
  try {
    options.Validate();
    ADD_FAILURE() << name << " = " << value << " was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()).find(name), 0U) << error.what();
  }
}

}  // namespace scan_image_slam
