#pragma once

#include "support_rooms.h"

namespace scan_image_slam {

/// A room in which one look around tells the place and the direction: turned by any angle it is
/// another one. 8 m x 6 m, without a quarter and a corner.
inline Room AngledRoom() {
  return {{{-4, -3}, {4, -3}}, {{4, -3}, {4, 0}},  {{4, 0}, {1, 0}},   {{1, 0}, {1, 3}},
          {{1, 3}, {-2, 3}},   {{-2, 3}, {-4, 1}}, {{-4, 1}, {-4, -3}}};
}

}  // namespace scan_image_slam
