#include "object_loader.h"
#include "scan_image_slam/core/simulation/decorations.h"
#include "yaml_values.h"

#include <array>

namespace scan_image_slam {
namespace {

/// Draws the n-th of several decorations that one item of the file describes.
using Maker = Decoration (*)(YamlSection&, World&, double at, int n);

struct Size {
  double width;   // [m]
  double height;  // [m]
};

/// `size: A0` ... `A4` (with `landscape`), or `width` and `height`.
Size ReadPaperSize(YamlSection& section) {
  static const std::vector<std::string> kNames = {"A0", "A1", "A2", "A3", "A4"};
  static const std::array<Size, 5> kSizes = {
      {{0.841, 1.189}, {0.594, 0.841}, {0.420, 0.594}, {0.297, 0.420}, {0.210, 0.297}}};
  Size size = kSizes[section.Choice("size", kNames, 1)];
  if (section.Flag("landscape", false)) std::swap(size.width, size.height);
  size.width = section.Number("width", 0.02, 20.0, size.width);
  size.height = section.Number("height", 0.02, kMaxHeight, size.height);
  return size;
}

int ReadPicture(YamlSection& section, World& world, PictureSpec::Kind kind, int n) {
  PictureSpec picture;
  picture.kind = kind;
  picture.seed = static_cast<std::uint32_t>(section.Integer("seed", 0, 1000000, 0) + n);
  return world.AddPicture(picture);
}

Decoration ReadDoor(YamlSection& section, World&, double at, int) {
  DoorLook look;
  look.width = section.Number("width", 0.2, 10.0, look.width);
  look.height = section.Number("height", 0.5, kMaxHeight, look.height);
  look.frame = section.Number("frame", 0.0, 0.5, look.frame);
  look.leaf = ReadColour(section, "colour", look.leaf);
  look.trim = ReadColour(section, "frame_colour", look.trim);
  look.handle_at_end = section.Choice("handle", {"start", "end"}, 1) == 1;
  look.window = section.Flag("window", look.window);
  return MakeDoor(at, look);
}

Decoration ReadHanging(YamlSection& section, World& world, double at, PictureSpec::Kind kind, int n,
                       const Size& size, double default_frame) {
  const double bottom = section.Number("bottom", 0.0, kMaxHeight, 1.1);
  const double frame = section.Number("frame", 0.0, 0.5, default_frame);
  const Colour colour = ReadColour(section, "frame_colour", {60, 60, 62});
  const int picture = ReadPicture(section, world, kind, n);
  return MakePanel({at - size.width / 2.0, at + size.width / 2.0, bottom, bottom + size.height,
                    Colour{}, Material::kPlain, picture},
                   frame, colour);
}

Decoration ReadPoster(YamlSection& section, World& world, double at, int n) {
  return ReadHanging(section, world, at, PictureSpec::Kind::kPoster, n, ReadPaperSize(section),
                     0.0);
}

Decoration ReadNoticeBoard(YamlSection& section, World& world, double at, int n) {
  const double width = section.Number("width", 0.2, 20.0, 1.8);
  const double height = section.Number("height", 0.2, kMaxHeight, 1.0);
  return ReadHanging(section, world, at, PictureSpec::Kind::kNoticeBoard, n, {width, height}, 0.03);
}

Decoration ReadPanel(YamlSection& section, World&, double at, int) {
  const double width = section.Number("width", 0.005, kMaxLength);
  const double bottom = section.Number("bottom", 0.0, kMaxHeight, 0.0);
  const double top = section.Number("top", 0.0, kMaxHeight);
  if (top <= bottom) section.Fail("top", "must be above the bottom");
  const Face face = ReadFace(section, {{170, 170, 170}, Material::kPlain, {}});
  const double frame = section.Number("frame", 0.0, 0.5, 0.0);
  const Colour colour = ReadColour(section, "frame_colour", {60, 60, 62});
  return MakePanel(
      {at - width / 2.0, at + width / 2.0, bottom, top, face.colour, face.material, -1}, frame,
      colour);
}

Decoration ReadSwitch(YamlSection& section, World&, double at, int) {
  return MakeSwitch(at, section.Number("height", 0.0, kMaxHeight, 1.05));
}

Decoration ReadWindow(YamlSection& section, World& world, double at, int n) {
  const double width = section.Number("width", 0.2, 50.0, 1.6);
  const double bottom = section.Number("bottom", 0.0, kMaxHeight, 0.9);
  const double top = section.Number("top", 0.0, kMaxHeight, 2.2);
  if (top <= bottom) section.Fail("top", "must be above the bottom");
  const int panes = section.Integer("panes", 1, 50, 2);
  const int picture = ReadPicture(section, world, PictureSpec::Kind::kWindowView, n);
  return MakeWindow(at, width, bottom, top, panes, picture);
}

Decoration ReadSlats(YamlSection& section, World&, double at, int) {
  const double width = section.Number("width", 0.1, 50.0, 1.2);
  const double bottom = section.Number("bottom", 0.0, kMaxHeight, 0.15);
  const double top = section.Number("top", 0.0, kMaxHeight, 0.75);
  const int count = section.Integer("count", 1, 500, 20);
  return MakeSlats(at, width, bottom, top, count, ReadColour(section, "colour", {228, 228, 224}));
}

const NamedFace& FindFace(YamlSection& section, const NamedFaces& names) {
  const auto found = names.find(section.Text("wall"));
  if (found != names.end()) return found->second;
  std::string known;
  for (const auto& entry : names) known += (known.empty() ? "" : ", ") + entry.first;
  section.Fail("wall", "is not a wall of this world; there are: " + known);
}

/// `at`, a number or a list, each `repeat: {count, step}` times along the wall.
std::vector<double> ReadPositions(YamlSection& section) {
  std::vector<double> once = section.NumberOrNumbers("at", 0.0, kMaxLength);
  if (!section.Has("repeat")) return once;
  YamlSection repeat = section.Child("repeat");
  const int count = repeat.Integer("count", 1, 10000);
  const double step = repeat.Number("step", 0.01, kMaxLength);
  repeat.Done();
  std::vector<double> positions;
  for (int i = 0; i < count; ++i) {
    for (const double at : once) positions.push_back(at + i * step);
  }
  return positions;
}

}  // namespace

void ReadDecoration(YamlSection& section, World& world, const NamedFaces& names) {
  static const std::vector<std::string> kKinds = {"door",   "poster", "notice_board", "panel",
                                                  "switch", "window", "slats"};
  static const std::vector<Maker> kMakers = {ReadDoor,   ReadPoster, ReadNoticeBoard, ReadPanel,
                                             ReadSwitch, ReadWindow, ReadSlats};
  section.Text("kind");
  const Maker make = kMakers[section.Choice("kind", kKinds, 0)];
  const NamedFace& target = FindFace(section, names);
  int n = 0;
  for (const double at : ReadPositions(section)) {
    const Decoration decoration = make(section, world, at, n++);
    if (decoration.from < 0.0 || decoration.to > target.length) {
      section.Fail("at", "puts it beyond the ends of its wall");
    }
    world.faces[target.face].decorations.push_back(decoration);
  }
  section.Done();
}

}  // namespace scan_image_slam
