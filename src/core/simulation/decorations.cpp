#include "scan_image_slam/core/simulation/decorations.h"

namespace scan_image_slam {
namespace {

PaintedRectangle Centred(double at, double width, double bottom, double top, const Colour& colour,
                         Material material = Material::kPlain) {
  return {at - width / 2.0, at + width / 2.0, bottom, top, colour, material, -1};
}

Colour Scaled(const Colour& colour, double factor) {
  return {factor * colour.red, factor * colour.green, factor * colour.blue};
}

}  // namespace

Decoration MakeDoor(double at, const DoorLook& look) {
  constexpr double kGap = 0.006;  // shadow between the leaf and its frame
  const double side = look.handle_at_end ? 1.0 : -1.0;
  const double outer = look.width + 2.0 * look.frame;
  Decoration door{at - outer / 2.0, at + outer / 2.0, {}};
  std::vector<PaintedRectangle>& paint = door.rectangles;
  paint.push_back(Centred(at, outer, 0.0, look.height + look.frame, look.trim));
  paint.push_back(Centred(at, look.width, 0.0, look.height, Scaled(look.trim, 0.35)));
  paint.push_back(
      Centred(at, look.width - 2.0 * kGap, 0.008, look.height - kGap, look.leaf, Material::kWood));
  const double handle = at + side * (look.width / 2.0 - 0.07);
  paint.push_back(Centred(handle, 0.035, 0.93, 1.15, {150, 152, 155}));
  paint.push_back(Centred(handle - side * 0.045, 0.11, 1.04, 1.06, {95, 96, 98}));
  if (look.window) {
    const double pane = at + side * look.width / 6.0;
    paint.push_back(Centred(pane, 0.22, 1.17, 1.86, Scaled(look.trim, 0.8)));
    paint.push_back(Centred(pane, 0.18, 1.19, 1.84, {60, 70, 78}));
  }
  return door;
}

Decoration MakePanel(const PaintedRectangle& rectangle, double frame, const Colour& frame_colour) {
  Decoration panel{rectangle.from - frame, rectangle.to + frame, {}};
  if (frame > 0.0) {
    panel.rectangles.push_back({panel.from, panel.to, rectangle.bottom - frame,
                                rectangle.top + frame, frame_colour, Material::kPlain, -1});
  }
  panel.rectangles.push_back(rectangle);
  return panel;
}

Decoration MakeSwitch(double at, double height) {
  Decoration plate{at - 0.04, at + 0.04, {}};
  plate.rectangles.push_back(Centred(at, 0.08, height - 0.04, height + 0.04, {245, 245, 240}));
  plate.rectangles.push_back(Centred(at, 0.05, height - 0.025, height + 0.025, {120, 120, 118}));
  return plate;
}

Decoration MakeWindow(double at, double width, double bottom, double top, int panes, int picture) {
  constexpr double kBar = 0.06;
  const Colour frame{205, 207, 208};
  Decoration window{at - width / 2.0, at + width / 2.0, {}};
  window.rectangles.push_back(Centred(at, width, bottom, top, frame));
  const double pane = (width - kBar) / panes;
  for (int i = 0; i < panes; ++i) {
    const double from = window.from + kBar + i * pane;
    window.rectangles.push_back(
        {from, from + pane - kBar, bottom + kBar, top - kBar, frame, Material::kPlain, picture});
  }
  return window;
}

Decoration MakeSlats(double at, double width, double bottom, double top, int count,
                     const Colour& colour) {
  Decoration slats{at - width / 2.0, at + width / 2.0, {}};
  slats.rectangles.push_back(Centred(at, width, bottom, top, Scaled(colour, 0.55)));
  const double pitch = width / count;
  for (int i = 0; i < count; ++i) {
    const double middle = slats.from + (i + 0.5) * pitch;
    slats.rectangles.push_back(Centred(middle, 0.7 * pitch, bottom, top, colour));
  }
  return slats;
}

Decoration MakeSkirting(double from, double to, double height, const Colour& colour) {
  return {from, to, {{from, to, 0.0, height, colour, Material::kPlain, -1}}};
}

}  // namespace scan_image_slam
