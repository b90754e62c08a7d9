#pragma once

#include "scan_image_slam/core/simulation/world.h"

namespace scan_image_slam {

/// Things painted flush on a wall, invisible to the laser. `at` is the middle along the face [m].

struct DoorLook {
  double width = 0.90;   ///< of the leaf [m]
  double height = 2.05;  ///< of the leaf [m]
  double frame = 0.08;   ///< width of the frame around it [m]
  Colour leaf{168, 130, 88};
  Colour trim{92, 94, 96};    ///< of the frame
  bool handle_at_end = true;  ///< on the side of growing `along`, else on the other
  bool window = false;        ///< a narrow pane above the handle
};
Decoration MakeDoor(double at, const DoorLook& look);

/// A rectangle with a frame around it (width 0: none). With a picture, `rectangle.colour` is
/// unused.
Decoration MakePanel(const PaintedRectangle& rectangle, double frame, const Colour& frame_colour);

/// A light switch, 8 cm wide, with a dark rocker.
Decoration MakeSwitch(double at, double height);

/// A window with a frame, a view in each of `panes` panes, and bars between them.
Decoration MakeWindow(double at, double width, double bottom, double top, int panes, int picture);

/// Upright slats, e.g. a radiator: `count` light ones with dark gaps, all alike.
Decoration MakeSlats(double at, double width, double bottom, double top, int count,
                     const Colour& colour);

/// Skirting board along [from, to].
Decoration MakeSkirting(double from, double to, double height, const Colour& colour);

}  // namespace scan_image_slam
