#include "scan_image_slam/core/simulation/camera_simulator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

constexpr double kNominalExposure = 0.008;  // right for brightness 1 at gain 1 [s]
constexpr int kMostSubFrames = 8;
constexpr double kTextureReserve = 1.3;  // materials darken by less than this factor
constexpr double kWalkingSpeed = 1.2;    // of a person that may blur [m/s]

BearingView MakeView(const CameraSimulatorOptions& options) {
  try {
    return MakeBearingView(TrueLens(options), options.mount);
  } catch (const std::domain_error& error) {
    throw std::invalid_argument(error.what());
  }
}

}  // namespace

CameraSimulator::CameraSimulator(const World& world, const CameraSimulatorOptions& options,
                                 std::uint64_t seed, Stamp start)
    : world_(world),
      options_((options.Validate(), options)),
      bearing_view_(MakeView(options)),
      renderer_(
          MakeSceneRenderer(world, bearing_view_.grid, options.encoding != ImageEncoding::kMono8)),
      sensor_(options, seed),
      timing_(seed, "camera timing"),
      vibration_(seed, "camera vibration"),
      start_(start),
      exposure_(options.exposure),
      gain_(options.gain),
      last_stamp_(std::numeric_limits<Stamp>::min()),
      last_arrival_(start) {}

Stamp CameraSimulator::NextComplete() const {
  return start_ +
         FromSeconds(options_.phase + static_cast<double>(count_) * options_.Period() + exposure_);
}

SimulatedImage CameraSimulator::NextFrame() {
  SimulatedImage image;
  const Stamp complete = NextComplete();
  ++count_;
  image.encoding = options_.encoding;
  image.mid_exposure = complete - FromSeconds(exposure_ / 2.0);
  const double error = options_.stamp_offset + options_.stamp_jitter * timing_.Normal();
  image.stamp = std::max(image.mid_exposure + FromSeconds(error), last_stamp_ + 1);
  last_stamp_ = image.stamp;
  const double delay = options_.latency + timing_.Exponential(options_.latency_jitter);
  image.arrival = std::max(complete + FromSeconds(delay), last_arrival_ + 1);
  last_arrival_ = image.arrival;
  return image;
}

SimulatedImage CameraSimulator::Skip() {
  vibration_.Normal();
  return NextFrame();
}

SimulatedImage CameraSimulator::TakeUniform(double level) {
  SimulatedImage image = Skip();
  light_.create(options_.height, options_.width,
                options_.encoding == ImageEncoding::kMono8 ? CV_8UC1 : CV_8UC4);
  light_.setTo(cv::Scalar::all(level));
  image.pixels = sensor_.Develop(light_, {1.0, gain_, 0.0});
  return image;
}

SceneView CameraSimulator::ViewAt(const MotionHistory& history, Stamp time) const {
  const Pose2 world_from_base = history.At(time).world_from_base;
  const Pose2 world_from_camera = world_from_base * options_.mount.Planar();
  SceneView view;
  view.position = world_from_camera.translation();
  view.heading = world_from_camera.theta;
  view.height = options_.mount.z;
  view.robot = world_from_base.translation();
  view.time = Seconds(time - start_);
  return view;
}

/// As many as the image moves by pixels during the exposure, roughly.
int CameraSimulator::SubFrames(const MotionHistory& history, const SimulatedImage& image) const {
  if (!options_.motion_blur) return 1;
  const TrueState state = history.At(image.mid_exposure);
  const SceneView view = ViewAt(history, image.mid_exposure);
  const double side = std::sin(0.5 * options_.field_of_view);
  const double near = std::max(Clearance(world_, view.position, view.height, view.time), 0.05);
  double rate = std::abs(state.turn_rate) + std::abs(state.speed) * side * side / near;
  for (const Person& person : world_.people) {
    const Posture posture = PostureAt(person, view.time);
    const double distance = (posture.position - view.position).norm();
    rate = std::max(rate, std::min(kWalkingSpeed, posture.speed) / std::max(distance, 0.5));
  }
  const double pixels = rate * exposure_ / bearing_view_.grid.tangent_step;
  return std::clamp(static_cast<int>(std::ceil(pixels)), 1, kMostSubFrames);
}

cv::Mat CameraSimulator::Expose(const MotionHistory& history, const SimulatedImage& image,
                                double light, double nod) {
  const int sub_frames = SubFrames(history, image);
  cv::Mat sum;
  for (int i = 0; i < sub_frames; ++i) {
    const double offset = exposure_ * ((i + 0.5) / sub_frames - 0.5);
    SceneView view = ViewAt(history, image.mid_exposure + FromSeconds(offset));
    view.light = light;
    view.slope_shift = nod;
    const cv::Mat& part = renderer_->Render(view);
    if (sub_frames == 1) {
      sum = part;
    } else if (i == 0) {
      part.convertTo(sum, CV_16U);
    } else {
      cv::add(sum, part, sum, cv::noArray(), CV_16U);
    }
  }
  if (sub_frames > 1) sum.convertTo(sum, CV_8U, 1.0 / sub_frames);
  return sum;
}

SimulatedImage CameraSimulator::Take(const MotionHistory& history) {
  SimulatedImage image = NextFrame();
  const double flicker =
      FlickerFactor(world_.lighting, Seconds(image.mid_exposure - start_), exposure_);
  const double light = flicker * gain_ * exposure_ / kNominalExposure;
  // Where light saturates the drawing, its texture must not show in the image either.
  const double brightening =
      std::clamp(light * PeakBrightness(world_.lighting), 1.0, kTextureReserve);
  const double speed = std::abs(history.At(image.mid_exposure).speed);
  const double nod = options_.pitch_vibration * vibration_.Normal() * std::min(speed / 0.3, 1.0);

  const cv::Mat scene = Expose(history, image, light / brightening, nod);
  cv::remap(scene, light_, bearing_view_.map, bearing_view_.map_fraction, cv::INTER_LINEAR,
            cv::BORDER_REPLICATE);

  const Eigen::Vector2d position = ViewAt(history, image.mid_exposure).position;
  const double blur = std::hypot(options_.blur, BlurAt(world_.lighting, position));
  image.pixels = sensor_.Develop(light_, {brightening, gain_, blur});
  if (options_.auto_exposure) AdaptExposure(image.pixels);
  return image;
}

void CameraSimulator::AdaptExposure(const cv::Mat& image) {
  constexpr double kTarget = 115.0;
  const cv::Scalar means = cv::mean(image);
  const double mean = std::max(1.0, image.channels() == 3 ? means[1] : means[0]);
  const double wanted =
      exposure_ * gain_ * std::sqrt(std::clamp(kTarget / mean, 0.25, 4.0));  // without overshoot
  exposure_ = std::clamp(wanted / options_.gain, 0.0002, options_.max_exposure);
  gain_ = std::clamp(wanted / exposure_, options_.gain, std::max(options_.gain, options_.max_gain));
}

cv::Mat CameraSimulator::Draw(const Pose2& world_from_base, double time) {
  MotionHistory history(1.0);
  history.Add({start_ + FromSeconds(time), world_from_base, 0.0, 0.0});
  cv::Mat image;
  cv::remap(renderer_->Render(ViewAt(history, start_ + FromSeconds(time))), image,
            bearing_view_.map, bearing_view_.map_fraction, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return image;
}

}  // namespace scan_image_slam
