#include "scan_image_slam/core/mapping/back_end.h"

#include <utility>

namespace scan_image_slam {

bool BackEnd::Add(std::shared_ptr<const Keyframe> keyframe) {
  localizer_.reset();  // of a map that grows from here on
  return loop_closer_.Add(std::move(keyframe));
}

std::optional<Location> BackEnd::Look(const Sighting& sighting) {
  if (!localizer_) {
    if (loop_closer_.poses().empty()) return std::nullopt;
    localizer_ = std::make_unique<Localizer>(loop_closer_.memory(), localizer_options_);
  }
  return localizer_->Look(sighting);
}

void BackEnd::Load(GraphMemory graph) {
  localizer_.reset();
  loop_closer_.Load(std::move(graph));
}

}  // namespace scan_image_slam
