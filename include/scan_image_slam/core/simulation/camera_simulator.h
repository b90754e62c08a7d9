#pragma once

#include "scan_image_slam/core/sensor/stamp.h"
#include "scan_image_slam/core/simulation/bearing_grid.h"
#include "scan_image_slam/core/simulation/camera_lens.h"
#include "scan_image_slam/core/simulation/image_sensor.h"
#include "scan_image_slam/core/simulation/motion_history.h"
#include "scan_image_slam/core/simulation/random_stream.h"
#include "scan_image_slam/core/simulation/scene_renderer.h"

#include <cstdint>
#include <memory>

#include <opencv2/core.hpp>

namespace scan_image_slam {

struct SimulatedImage {
  cv::Mat pixels;  ///< CV_8UC1 or CV_8UC3; not to be written to
  ImageEncoding encoding = ImageEncoding::kMono8;
  Stamp stamp = 0;         ///< middle of the exposure by the camera's clock [ns]
  Stamp mid_exposure = 0;  ///< true middle of the exposure [ns]
  Stamp arrival = 0;       ///< when the computer gets it [ns]
};

/// A camera on a moving robot.
class CameraSimulator {
 public:
  /// `world` must outlive the simulator; time 0 of the world is `start`. Throws
  /// std::invalid_argument for options out of range or a camera that cannot be drawn.
  CameraSimulator(const World& world, const CameraSimulatorOptions& options, std::uint64_t seed,
                  Stamp start);

  /// End of the next exposure: what Take() needs to know the motion up to [ns].
  Stamp NextComplete() const;

  /// Takes the next image.
  SimulatedImage Take(const MotionHistory& history);

  /// Lets the next image pass without drawing it; `pixels` stays empty.
  SimulatedImage Skip();

  /// The next image if only an even grey (0 to 255) falls on the sensor: a cap, or too much light.
  SimulatedImage TakeUniform(double level);

  /// What the camera would see from a pose, sharp and without noise; for tests and pictures.
  cv::Mat Draw(const Pose2& world_from_base, double time);

 private:
  SimulatedImage NextFrame();
  SceneView ViewAt(const MotionHistory& history, Stamp time) const;
  int SubFrames(const MotionHistory& history, const SimulatedImage& image) const;
  /// The scene in the bearing grid, averaged over the exposure.
  cv::Mat Expose(const MotionHistory& history, const SimulatedImage& image, double light,
                 double nod);
  void AdaptExposure(const cv::Mat& image);

  const World& world_;
  CameraSimulatorOptions options_;
  BearingView bearing_view_;
  std::unique_ptr<SceneRenderer> renderer_;
  ImageSensor sensor_;
  RandomStream timing_;
  RandomStream vibration_;
  Stamp start_;
  std::int64_t count_ = 0;
  double exposure_;
  double gain_;
  Stamp last_stamp_;
  Stamp last_arrival_;
  cv::Mat light_;
};

}  // namespace scan_image_slam
