#include "option_fields.h"

namespace scan_image_slam {
namespace {

template <typename Options>
void ValidateFields(Options options) {
  FieldValidator validator;
  VisitFields(options, validator);
}

void Require(bool condition, const char* message) {
  if (!condition) throw std::invalid_argument(message);
}

}  // namespace

double LaserSimulatorOptions::Period() const { return 1.0 / (rate * (1.0 + rate_error)); }

double LaserSimulatorOptions::TimeIncrement() const { return Period() / steps_per_turn; }

void LaserSimulatorOptions::Validate() const {
  ValidateFields(*this);
  Require(angle_increment != 0.0, "angle_increment must not be 0");
  Require(range_min < range_max, "range_min must be below range_max");
  Require(beams <= steps_per_turn, "beams must not exceed steps_per_turn");
  Require(mount.pitch == 0.0 && mount.roll == 0.0, "mount of a laser must be level");
}

LaserSimulatorOptions Ideal(LaserSimulatorOptions options) {
  options.range_stddev = 0.0;
  options.far_range_stddev = 0.0;
  options.grazing_noise = 0.0;
  options.incidence_bias = 0.0;
  options.dark_bias = 0.0;
  options.quantum = 0.0;
  options.mixed_pixels = false;
  options.drop_rate = 0.0;
  options.grazing_drop_angle = M_PI_2;
  options.stamp_jitter = 0.0;
  options.latency_jitter = 0.0;
  return options;
}

double CameraSimulatorOptions::Period() const { return 1.0 / (rate * (1.0 + rate_error)); }

void CameraSimulatorOptions::Validate() const {
  ValidateFields(*this);
  Require(exposure < Period(), "exposure must be shorter than the time between two images");
  Require(!auto_exposure || max_exposure < Period(),
          "max_exposure must be shorter than the time between two images");
}

CameraSimulatorOptions Ideal(CameraSimulatorOptions options) {
  options.latency_jitter = 0.0;
  options.stamp_jitter = 0.0;
  options.read_noise = 0.0;
  options.shot_noise = 0.0;
  options.blur = 0.0;
  options.vignetting = 0.0;
  options.motion_blur = false;
  options.pitch_vibration = 0.0;
  return options;
}

void BaseSimulatorOptions::Validate() const { ValidateFields(*this); }

BaseSimulatorOptions Ideal(BaseSimulatorOptions options, bool ideal_encoders) {
  options.wander = 0.0;
  options.slip_noise = 0.0;
  options.slip_rate = 0.0;
  options.position_quantum = 0.0;
  options.heading_quantum = 0.0;
  options.odometry_jitter = 0.0;
  if (ideal_encoders) {
    options.left_radius_error = 0.0;
    options.right_radius_error = 0.0;
    options.wheel_base_error = 0.0;
    options.odometry_delay = 0.0;
  }
  return options;
}

}  // namespace scan_image_slam
