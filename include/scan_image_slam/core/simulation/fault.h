#pragma once

#include <vector>

namespace scan_image_slam {

/// Something that goes wrong for a while.
struct Fault {
  enum class Kind {
    kCameraOff,          ///< no images
    kCameraFrozen,       ///< the last image again and again, with new stamps
    kCameraBlack,        ///< no light at all
    kCameraOverexposed,  ///< white
    kCameraCovered,      ///< something dark lies on the lens
    kCameraDelayed,      ///< images arrive later by `value` [s], with right stamps
    kCameraClock,        ///< stamps are off by `value` [s]
    kLaserOff,           ///< no scans
    kEncodersOff,        ///< no odometry
    kEncodersReset,      ///< odometry jumps to zero at `from`
    kEncodersSlip,       ///< odometry turns by `value` [rad] in all, evenly, that is not there
  };
  Kind kind = Kind::kCameraOff;
  double from = 0.0;  ///< since the start of the simulation [s]
  double to = 0.0;    ///< [s]
  double value = 0.0;
};

/// All faults of a run.
class FaultSchedule {
 public:
  explicit FaultSchedule(std::vector<Fault> faults) : faults_(std::move(faults)) {}

  /// A fault of the kind lasts at `time` (from <= time < to) [s].
  bool Active(Fault::Kind kind, double time) const;

  /// Sum of the values of the active faults of the kind.
  double Value(Fault::Kind kind, double time) const;

  /// A fault of the kind begins in (before, time].
  bool Begins(Fault::Kind kind, double before, double time) const;

  /// False turn of the odometry between two times [rad].
  double FalseTurn(double before, double time) const;

 private:
  std::vector<Fault> faults_;
};

}  // namespace scan_image_slam
