#include "scan_image_slam/core/simulation/encoder_simulator.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

double Quantised(double value, double quantum) {
  return quantum > 0.0 ? std::round(value / quantum) * quantum : value;
}

}  // namespace

EncoderSimulator::EncoderSimulator(const BaseSimulatorOptions& options, std::uint64_t seed,
                                   Stamp start)
    : options_(options),
      slip_(seed, "encoder slip"),
      timing_(seed, "encoder timing"),
      start_(start),
      time_(start),
      last_reading_time_(start),
      last_arrival_(start) {
  options_.Validate();
  ScheduleNext();
}

void EncoderSimulator::ScheduleNext() {
  const double late = std::min(timing_.Exponential(options_.odometry_jitter),
                               0.9 / options_.odometry_rate);  // readings keep their order
  const double due = options_.odometry_phase + static_cast<double>(count_) / options_.odometry_rate;
  ++count_;
  next_reading_ = start_ + FromSeconds(due + late);
}

void EncoderSimulator::UpdateSlip(double distance, double dt) {
  // All are drawn every time, so that one slip does not move the others.
  const double chance = slip_.Uniform();
  const double duration = slip_.Exponential(options_.slip_duration);
  const double left = slip_.Uniform(-options_.slip_speed, options_.slip_speed);
  const double right = slip_.Uniform(-options_.slip_speed, options_.slip_speed);
  slip_left_ -= dt;
  if (slip_left_ > 0.0 || chance >= options_.slip_rate * distance) return;
  slip_left_ = duration;
  false_left_ = left;
  false_right_ = right;
}

double EncoderSimulator::WheelReport(double distance, double radius_error, double false_speed,
                                     double dt) {
  const double noise = options_.slip_noise * std::sqrt(std::abs(distance)) * slip_.Normal();
  const double slip = slip_left_ > 0.0 ? false_speed * dt : 0.0;
  return (1.0 + radius_error) * distance + noise + slip;
}

void EncoderSimulator::Follow(const TrueState& state) {
  const double dt = Seconds(state.time - time_);
  time_ = state.time;
  if (dt <= 0.0) return;
  const double half_base = options_.wheel_base / 2.0;
  const double left = (state.speed - state.turn_rate * half_base) * dt;
  const double right = (state.speed + state.turn_rate * half_base) * dt;
  UpdateSlip(0.5 * (std::abs(left) + std::abs(right)), dt);
  const double left_report = WheelReport(left, options_.left_radius_error, false_left_, dt);
  const double right_report = WheelReport(right, options_.right_radius_error, false_right_, dt);
  const double assumed_base = options_.wheel_base * (1.0 + options_.wheel_base_error);
  odom_from_base_ = odom_from_base_ * Arc(0.5 * (left_report + right_report),
                                          (right_report - left_report) / assumed_base);
}

OdometryReading EncoderSimulator::Read() {
  OdometryReading reading;
  reading.odom_from_base = {
      Quantised(odom_from_base_.x, options_.position_quantum),
      Quantised(odom_from_base_.y, options_.position_quantum),
      NormalizeAngle(Quantised(NormalizeAngle(odom_from_base_.theta), options_.heading_quantum))};
  const double dt = Seconds(time_ - last_reading_time_);
  if (dt > 0.0) {
    const ArcCoordinates motion = ToArcCoordinates(last_reading_.Inverse() * odom_from_base_);
    reading.speed = motion.distance / dt;
    reading.turn_rate = motion.angle / dt;
  }
  last_reading_ = odom_from_base_;
  last_reading_time_ = time_;
  reading.stamp = time_ + FromSeconds(options_.odometry_delay);
  reading.arrival =
      std::max(reading.stamp + FromSeconds(options_.odometry_latency), last_arrival_ + 1);
  last_arrival_ = reading.arrival;
  ScheduleNext();
  return reading;
}

}  // namespace scan_image_slam
