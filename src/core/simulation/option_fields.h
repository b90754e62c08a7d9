#pragma once

#include "scan_image_slam/core/config/yaml_section.h"
#include "scan_image_slam/core/simulation/base_options.h"
#include "scan_image_slam/core/simulation/camera_options.h"
#include "scan_image_slam/core/simulation/laser_options.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace scan_image_slam {

/// Each option's name and range once, for the yaml file and for Validate(). `field` is one of the
/// two classes below. Names that end in _deg are degrees in the file and radians in the struct.
template <typename Field>
void VisitFields(LaserSimulatorOptions& options, Field& field);
template <typename Field>
void VisitFields(CameraSimulatorOptions& options, Field& field);
template <typename Field>
void VisitFields(BaseSimulatorOptions& options, Field& field);

constexpr double kDegree = M_PI / 180.0;

/// Throws std::invalid_argument for the first value that is out of range.
class FieldValidator {
 public:
  void Number(const char* name, double value, double low, double high) const {
    if (value >= low && value <= high) return;  // false for NaN
    std::ostringstream message;
    message << name << " is " << value << ", must be in [" << low << ", " << high << "]";
    throw std::invalid_argument(message.str());
  }
  void Angle(const char* name, double value, double low_deg, double high_deg) const {
    Number(name, value / kDegree, low_deg - 1e-9, high_deg + 1e-9);
  }
  void Integer(const char* name, int value, int low, int high) const {
    Number(name, value, low, high);
  }
  void Flag(const char*, bool) const {}
  template <typename Enum>
  void Choice(const char*, Enum, const std::vector<std::string>&) const {}
};

/// Overwrites the values that the section holds.
class FieldReader {
 public:
  explicit FieldReader(YamlSection& section) : section_(section) {}
  void Number(const char* name, double& value, double low, double high) {
    value = section_.Number(name, low, high, value);
  }
  void Angle(const char* name, double& value, double low_deg, double high_deg) {
    if (section_.Has(name)) value = section_.Number(name, low_deg, high_deg) * kDegree;
  }
  void Integer(const char* name, int& value, int low, int high) {
    value = section_.Integer(name, low, high, value);
  }
  void Flag(const char* name, bool& value) { value = section_.Flag(name, value); }
  template <typename Enum>
  void Choice(const char* name, Enum& value, const std::vector<std::string>& names) {
    value = static_cast<Enum>(section_.Choice(name, names, static_cast<std::size_t>(value)));
  }

 private:
  YamlSection& section_;
};

template <typename Field>
void VisitFields(LaserSimulatorOptions& o, Field& field) {
  field.Number("x", o.mount.x, -2.0, 2.0);
  field.Number("y", o.mount.y, -2.0, 2.0);
  field.Number("z", o.mount.z, 0.0, 3.0);
  field.Angle("yaw_deg", o.mount.yaw, -180.0, 180.0);
  field.Flag("upside_down", o.upside_down);
  field.Integer("beams", o.beams, 2, 100000);
  field.Angle("angle_min_deg", o.angle_min, -360.0, 360.0);
  field.Angle("angle_increment_deg", o.angle_increment, -30.0, 30.0);
  field.Number("rate", o.rate, 0.1, 1000.0);
  field.Number("steps_per_turn", o.steps_per_turn, 2.0, 1e6);
  field.Number("range_min", o.range_min, 0.0, 10.0);
  field.Number("range_max", o.range_max, 0.1, 1000.0);
  field.Number("beam_width", o.beam_width, 0.0, 0.2);
  field.Number("range_stddev", o.range_stddev, 0.0, 1.0);
  field.Number("far_range_stddev", o.far_range_stddev, 0.0, 1.0);
  field.Number("grazing_noise", o.grazing_noise, 0.0, 1.0);
  field.Number("incidence_bias", o.incidence_bias, -0.2, 0.2);
  field.Number("dark_bias", o.dark_bias, -0.2, 0.2);
  field.Number("quantum", o.quantum, 0.0, 0.1);
  field.Flag("mixed_pixels", o.mixed_pixels);
  field.Number("mixed_depth", o.mixed_depth, 0.0, 10.0);
  field.Number("drop_rate", o.drop_rate, 0.0, 1.0);
  field.Angle("grazing_drop_angle_deg", o.grazing_drop_angle, 0.0, 90.0);
  field.Number("dark_range", o.dark_range, 0.0, 1000.0);
  field.Angle("glass_angle_deg", o.glass_angle, 0.0, 90.0);
  field.Choice("no_return", o.no_return, {"nan", "infinity", "one_millimetre", "zero"});
  field.Number("stamp_offset", o.stamp_offset, -1000.0, 1000.0);
  field.Number("stamp_jitter", o.stamp_jitter, 0.0, 1.0);
  field.Number("rate_error", o.rate_error, -0.5, 0.5);
  field.Number("phase", o.phase, 0.0, 10.0);
  field.Number("latency", o.latency, 0.0, 5.0);
  field.Number("latency_jitter", o.latency_jitter, 0.0, 1.0);
}

template <typename Field>
void VisitFields(CameraSimulatorOptions& o, Field& field) {
  field.Number("x", o.mount.x, -2.0, 2.0);
  field.Number("y", o.mount.y, -2.0, 2.0);
  field.Number("z", o.mount.z, 0.05, 3.0);
  field.Angle("yaw_deg", o.mount.yaw, -180.0, 180.0);
  field.Angle("pitch_deg", o.mount.pitch, -60.0, 60.0);
  field.Angle("roll_deg", o.mount.roll, -180.0, 180.0);
  field.Integer("width", o.width, 32, 4096);
  field.Integer("height", o.height, 32, 4096);
  field.Angle("field_of_view_deg", o.field_of_view, 20.0, 130.0);
  field.Number("centre_x", o.centre_x, -500.0, 500.0);
  field.Number("centre_y", o.centre_y, -500.0, 500.0);
  field.Number("k1", o.k1, -2.0, 2.0);
  field.Number("k2", o.k2, -2.0, 2.0);
  field.Number("p1", o.p1, -0.5, 0.5);
  field.Number("p2", o.p2, -0.5, 0.5);
  field.Number("k3", o.k3, -2.0, 2.0);
  field.Choice("encoding", o.encoding, {"mono8", "bgr8", "bayer_rggb8"});
  field.Number("rate", o.rate, 0.1, 1000.0);
  field.Number("rate_error", o.rate_error, -0.5, 0.5);
  field.Number("phase", o.phase, 0.0, 10.0);
  field.Number("latency", o.latency, 0.0, 5.0);
  field.Number("latency_jitter", o.latency_jitter, 0.0, 1.0);
  field.Number("stamp_offset", o.stamp_offset, -1000.0, 1000.0);
  field.Number("stamp_jitter", o.stamp_jitter, 0.0, 1.0);
  field.Number("exposure", o.exposure, 0.00001, 0.5);
  field.Number("gain", o.gain, 0.0, 100.0);
  field.Flag("auto_exposure", o.auto_exposure);
  field.Number("max_exposure", o.max_exposure, 0.0001, 0.5);
  field.Number("max_gain", o.max_gain, 0.01, 100.0);
  field.Number("read_noise", o.read_noise, 0.0, 50.0);
  field.Number("shot_noise", o.shot_noise, 0.0, 5.0);
  field.Number("blur", o.blur, 0.0, 20.0);
  field.Number("vignetting", o.vignetting, 0.0, 1.0);
  field.Flag("motion_blur", o.motion_blur);
  field.Angle("pitch_vibration_deg", o.pitch_vibration, 0.0, 2.0);
  field.Angle("calibration_yaw_error_deg", o.calibration_yaw_error, -20.0, 20.0);
  field.Angle("calibration_pitch_error_deg", o.calibration_pitch_error, -20.0, 20.0);
  field.Angle("calibration_roll_error_deg", o.calibration_roll_error, -20.0, 20.0);
  field.Number("calibration_focal_error", o.calibration_focal_error, -0.5, 0.5);
}

template <typename Field>
void VisitFields(BaseSimulatorOptions& o, Field& field) {
  field.Number("wheel_base", o.wheel_base, 0.05, 5.0);
  field.Number("max_speed", o.max_speed, 0.01, 20.0);
  field.Angle("max_turn_rate_deg", o.max_turn_rate, 0.1, 720.0);
  field.Number("acceleration", o.acceleration, 0.01, 50.0);
  field.Angle("turn_acceleration_deg", o.turn_acceleration, 1.0, 3600.0);
  field.Angle("wander_deg", o.wander, 0.0, 90.0);
  field.Number("left_radius_error", o.left_radius_error, -0.5, 0.5);
  field.Number("right_radius_error", o.right_radius_error, -0.5, 0.5);
  field.Number("wheel_base_error", o.wheel_base_error, -0.5, 0.5);
  field.Number("slip_noise", o.slip_noise, 0.0, 1.0);
  field.Number("slip_rate", o.slip_rate, 0.0, 10.0);
  field.Number("slip_duration", o.slip_duration, 0.001, 60.0);
  field.Number("slip_speed", o.slip_speed, 0.0, 10.0);
  field.Number("position_quantum", o.position_quantum, 0.0, 1.0);
  field.Angle("heading_quantum_deg", o.heading_quantum, 0.0, 45.0);
  field.Number("odometry_rate", o.odometry_rate, 0.1, 1000.0);
  field.Number("odometry_phase", o.odometry_phase, 0.0, 10.0);
  field.Number("odometry_delay", o.odometry_delay, 0.0, 1.0);
  field.Number("odometry_latency", o.odometry_latency, 0.0, 1.0);
  field.Number("odometry_jitter", o.odometry_jitter, 0.0, 1.0);
}

}  // namespace scan_image_slam
