#pragma once

#include "scan_image_slam/core/mapping/localizer.h"
#include "scan_image_slam/core/mapping/loop_closer.h"
#include "scan_image_slam/core/mapping/map_state.h"

#include <memory>
#include <optional>

namespace scan_image_slam {

/// What looks at the whole map, while the mapper goes from scan to scan: recognises places in a map
/// that grows (LoopCloser), and the robot in one that was loaded (Localizer).
class BackEnd {
 public:
  explicit BackEnd(const LoopCloserOptions& options, const LocalizerOptions& localizer = {})
      : loop_closer_(options), localizer_options_(localizer) {}

  /// As LoopCloser::SetOptions.
  void SetOptions(const LoopCloserOptions& options) { loop_closer_.SetOptions(options); }

  /// As LoopCloser::Add.
  bool Add(std::shared_ptr<const Keyframe> keyframe);

  /// As LoopCloser::ForgetLetGo.
  void ForgetLetGo(int keyframe) { loop_closer_.ForgetLetGo(keyframe); }

  /// As Localizer::Look, in the map as it is now; nothing while there is none.
  std::optional<Location> Look(const Sighting& sighting);

  /// Takes up a graph instead of what was known.
  void Load(GraphMemory graph);

  const LoopCloser& loop_closer() const { return loop_closer_; }

 private:
  LoopCloser loop_closer_;
  LocalizerOptions localizer_options_;
  std::unique_ptr<Localizer> localizer_;  ///< made when the first sighting comes: it is large
};

}  // namespace scan_image_slam
