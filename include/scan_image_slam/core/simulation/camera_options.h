#pragma once

#include "scan_image_slam/core/simulation/mount_pose.h"

namespace scan_image_slam {

enum class ImageEncoding { kMono8, kBgr8, kBayerRggb8 };

/// A camera that runs freely, not triggered by the laser.
struct CameraSimulatorOptions {
  MountPose mount{0.12, 0.0, 0.55, 0.0, 0.07, 0.015};
  int width = 640;                            ///< [px]
  int height = 480;                           ///< [px]
  double field_of_view = 1.3089969389957472;  ///< horizontal, without distortion [rad]
  double centre_x = 2.3;   ///< principal point minus the middle of the image [px]
  double centre_y = -1.7;  ///< [px]
  double k1 = -0.11;       ///< distortion, plumb_bob
  double k2 = 0.05;
  double p1 = 0.0004;
  double p2 = -0.0003;
  double k3 = 0.0;
  ImageEncoding encoding = ImageEncoding::kBgr8;

  double rate = 30.0;             ///< [Hz]
  double rate_error = 0.0007;     ///< fraction by which the camera runs too fast
  double phase = 0.011;           ///< of the first image [s]
  double latency = 0.028;         ///< from the end of the exposure to the arrival [s]
  double latency_jitter = 0.003;  ///< mean of an exponential delay on top [s]
  double stamp_offset = 0.0;      ///< clock of the camera minus that of the robot [s]
  double stamp_jitter = 0.0002;   ///< standard deviation of the stamps [s]

  double exposure = 0.008;      ///< [s]
  double gain = 1.0;            ///< on top of what makes 8 ms right for brightness 1
  bool auto_exposure = false;   ///< follows the brightness: first the exposure, then the gain
  double max_exposure = 0.030;  ///< of the automatic [s]
  double max_gain = 8.0;        ///< of the automatic
  double read_noise = 1.2;      ///< standard deviation at gain 1, in grey levels
  double shot_noise = 0.025;    ///< variance per grey level at gain 1
  double blur = 0.5;            ///< defocus, standard deviation [px]
  double vignetting = 0.15;     ///< loss of light in the farthest corner, fraction
  bool motion_blur = true;
  double pitch_vibration = 0.0003;  ///< standard deviation while driving [rad]

  /// Errors of the calibration: what camera_info and the transform say minus what is true.
  double calibration_yaw_error = 0.0;    ///< [rad]
  double calibration_pitch_error = 0.0;  ///< [rad]
  double calibration_roll_error = 0.0;   ///< [rad]
  double calibration_focal_error = 0.0;  ///< fraction

  double Period() const;  ///< between two images [s]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// The same camera without noise, blur, vignetting, vibration and jitter.
CameraSimulatorOptions Ideal(CameraSimulatorOptions options);

}  // namespace scan_image_slam
