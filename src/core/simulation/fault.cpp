#include "scan_image_slam/core/simulation/fault.h"

#include <algorithm>

namespace scan_image_slam {

bool FaultSchedule::Active(Fault::Kind kind, double time) const {
  return std::any_of(faults_.begin(), faults_.end(), [&](const Fault& fault) {
    return fault.kind == kind && fault.from <= time && time < fault.to;
  });
}

double FaultSchedule::Value(Fault::Kind kind, double time) const {
  double sum = 0.0;
  for (const Fault& fault : faults_) {
    if (fault.kind == kind && fault.from <= time && time < fault.to) sum += fault.value;
  }
  return sum;
}

bool FaultSchedule::Begins(Fault::Kind kind, double before, double time) const {
  return std::any_of(faults_.begin(), faults_.end(), [&](const Fault& fault) {
    return fault.kind == kind && before < fault.from && fault.from <= time;
  });
}

double FaultSchedule::FalseTurn(double before, double time) const {
  double sum = 0.0;
  for (const Fault& fault : faults_) {
    if (fault.kind != Fault::Kind::kEncodersSlip) continue;
    const double overlap = std::min(time, fault.to) - std::max(before, fault.from);
    sum += fault.value * std::max(overlap, 0.0) / (fault.to - fault.from);
  }
  return sum;
}

}  // namespace scan_image_slam
