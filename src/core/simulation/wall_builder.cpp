#include "scan_image_slam/core/simulation/wall_builder.h"

#include <algorithm>
#include <stdexcept>

namespace scan_image_slam {
namespace {

struct Span {
  double from;
  double to;
};

Span SpanOf(const WallOpening& opening) {
  return {opening.at - opening.width / 2.0, opening.at + opening.width / 2.0};
}

/// One plan in construction: its axis, and a face at a time.
class Builder {
 public:
  Builder(World& world, const WallPlan& plan)
      : world_(world), plan_(plan), length_((plan.to - plan.from).norm()) {
    if (!(length_ > 0.0)) throw std::invalid_argument("the wall has no length");
    direction_ = (plan.to - plan.from) / length_;
    left_ = Eigen::Vector2d(-direction_.y(), direction_.x());
    openings_ = plan.openings;
    std::sort(openings_.begin(), openings_.end(),
              [](const WallOpening& a, const WallOpening& b) { return a.at < b.at; });
    CheckOpenings();
  }

  void Build(NamedFaces& names) {
    if (plan_.thickness > 0.0) {
      const double half = plan_.thickness / 2.0;
      names[plan_.id + ".left"] = AddFace(half);
      names[plan_.id + ".right"] = AddFace(-half);
      for (const double end : {0.0, length_}) AddAcross(end, -half, half, plan_.top);
    } else {
      names[plan_.id] = AddFace(0.0);
    }
    for (const WallOpening& opening : openings_) AddReveal(opening);
  }

 private:
  void CheckOpenings() const {
    double end = 0.0;
    for (const WallOpening& opening : openings_) {
      const Span span = SpanOf(opening);
      if (span.from < end || span.to > length_) {
        throw std::invalid_argument("an opening overlaps another one or the end of the wall");
      }
      end = span.to;
    }
  }

  Eigen::Vector2d At(double along, double left) const {
    return plan_.from + along * direction_ + left * left_;
  }

  Wall Piece(double from, double to, double left) const {
    Wall wall;
    wall.from = At(from, left);
    wall.to = At(to, left);
    wall.bottom = plan_.bottom;
    wall.top = plan_.top;
    wall.along_from = from;
    wall.laser = plan_.laser;
    return wall;
  }

  NamedFace AddFace(double left) {
    Face face = plan_.face;
    if (plan_.skirting > 0.0) {
      face.decorations.push_back(MakeSkirting(0.0, length_, plan_.skirting, plan_.skirting_colour));
    }
    const int index = world_.AddFace(face);
    const auto add = [&](double from, double to, double bottom) {
      if (to - from <= 0.0) return;
      Wall wall = Piece(from, to, left);
      wall.bottom = bottom;
      wall.face = index;
      world_.walls.push_back(wall);
    };
    double along = 0.0;
    for (const WallOpening& opening : openings_) {
      const Span span = SpanOf(opening);
      add(along, span.from, plan_.bottom);
      if (opening.height < plan_.top) add(span.from, span.to, opening.height);
      along = span.to;
    }
    add(along, length_, plan_.bottom);
    return {index, length_};
  }

  /// A plain wall across the axis, e.g. the end of a thick wall.
  void AddAcross(double along, double right, double left, double top) {
    Wall wall;
    wall.from = At(along, right);
    wall.to = At(along, left);
    wall.bottom = plan_.bottom;
    wall.top = top;
    wall.laser = plan_.laser;
    world_.AddWall(wall, plan_.face);
  }

  /// Sides and lintel of an opening, and its door.
  void AddReveal(const WallOpening& opening) {
    const bool thick = plan_.thickness > 0.0;
    if (!thick && !opening.door) return;
    const double left = thick ? plan_.thickness / 2.0 : 0.0;
    const double right = thick ? -left : -opening.recess;
    const Span span = SpanOf(opening);
    for (const double side : {span.from, span.to}) AddAcross(side, right, left, opening.height);
    world_.slabs.push_back(
        {{At(span.from, right), At(span.to, right), At(span.to, left), At(span.from, left)},
         opening.height,
         plan_.face.colour});
    if (opening.door) AddDoor(opening, thick ? 0.0 : right);
  }

  void AddDoor(const WallOpening& opening, double left) {
    const Span span = SpanOf(opening);
    Wall leaf = Piece(span.from, span.to, left);
    leaf.top = opening.height;
    DoorLook look = opening.look;
    look.width = opening.width - 2.0 * look.frame;
    look.height = opening.height - look.frame;
    Face face;
    face.decorations.push_back(MakeDoor(opening.at, look));
    world_.AddWall(leaf, face);
  }

  World& world_;
  const WallPlan& plan_;
  double length_;
  Eigen::Vector2d direction_;
  Eigen::Vector2d left_;
  std::vector<WallOpening> openings_;
};

}  // namespace

void AddWallPlan(World& world, const WallPlan& plan, NamedFaces& names) {
  Builder(world, plan).Build(names);
}

}  // namespace scan_image_slam
