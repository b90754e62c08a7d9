#include "scan_image_slam/core/simulation/world_loader.h"

#include <limits>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

struct Loaded {
  World world;
  NamedFaces names;
};

Loaded Load(const std::string& text) {
  YamlSection root = YamlSection::FromText(text, "test.yaml");
  Loaded loaded;
  ReadWorld(root, loaded.world, loaded.names);
  root.Done();
  return loaded;
}

std::string ErrorOf(const std::string& text) {
  try {
    Load(text);
  } catch (const YamlError& error) {
    return error.what();
  }
  return "no error";
}

const char kRoom[] = "walls:\n  - {id: room, points: [[0, 0], [4, 0], [4, 3]], closed: true}\n";

TEST(WorldLoader, PolylineBecomesNamedWalls) {
  const Loaded loaded = Load(kRoom);
  ASSERT_EQ(loaded.world.walls.size(), 3U);
  EXPECT_DOUBLE_EQ(loaded.names.at("room.0").length, 4.0);
  EXPECT_DOUBLE_EQ(loaded.names.at("room.2").length, 5.0);
  EXPECT_EQ(loaded.world.walls[2].to, Eigen::Vector2d(0, 0));
  EXPECT_DOUBLE_EQ(loaded.world.walls[0].top, 2.6);
}

TEST(WorldLoader, OpeningLeavesTheLintelAndKeepsTheDistanceAlong) {
  const Loaded loaded = Load(
      "walls:\n  - {id: w, from: [0, 0], to: [5, 0], openings: [{at: 2, width: 1, height: 2}]}\n");
  ASSERT_EQ(loaded.world.walls.size(), 3U);
  EXPECT_EQ(loaded.world.walls[0].to, Eigen::Vector2d(1.5, 0));
  EXPECT_DOUBLE_EQ(loaded.world.walls[1].bottom, 2.0);
  EXPECT_DOUBLE_EQ(loaded.world.walls[2].along_from, 2.5);
  EXPECT_EQ(loaded.world.walls[2].from, Eigen::Vector2d(2.5, 0));
  EXPECT_EQ(loaded.world.walls[0].face, loaded.world.walls[2].face);
}

TEST(WorldLoader, ThickWallHasTwoFacesAndEnds) {
  const Loaded loaded = Load("walls:\n  - {id: w, from: [0, 0], to: [5, 0], thickness: 0.2}\n");
  EXPECT_EQ(loaded.world.walls.size(), 4U);
  EXPECT_EQ(loaded.world.walls[loaded.names.at("w.left").face].from, Eigen::Vector2d(0, 0.1));
  EXPECT_EQ(loaded.names.count("w.right"), 1U);
  EXPECT_EQ(loaded.names.count("w"), 0U);
}

TEST(WorldLoader, RepeatsDecorationsAlongTheWall) {
  const Loaded loaded = Load(std::string(kRoom) +
                             "decorations:\n  - {kind: door, wall: room.0, at: 1.0, width: 0.5,\n"
                             "     repeat: {count: 3, step: 1.0}}\n");
  const Face& face = loaded.world.faces[loaded.names.at("room.0").face];
  ASSERT_EQ(face.decorations.size(), 3U);
  EXPECT_NEAR(face.decorations[2].from, 3.0 - 0.25 - 0.08, 1e-12);
  EXPECT_NEAR(face.decorations[2].to, 3.0 + 0.25 + 0.08, 1e-12);
}

TEST(WorldLoader, DeskIsOnlyLegsAtTheLasersHeight) {
  const Loaded loaded = Load("objects:\n  - {shape: desk, at: [2, 1], size: [1.6, 0.8]}\n");
  int at_laser = 0;
  for (const Wall& wall : loaded.world.walls) {
    if (wall.bottom > 0.3 || wall.top < 0.3) continue;
    ++at_laser;
    EXPECT_NEAR((wall.to - wall.from).norm(), 0.05, 1e-12);
  }
  EXPECT_EQ(at_laser, 16);
}

TEST(WorldLoader, ErrorsNameFileLineAndKey) {
  EXPECT_EQ(ErrorOf("walls:\n  - {from: [0, 0], to: [1, 0], colur: [1, 2, 3]}\n"),
            "test.yaml:2: key 'walls[0].colur': is not known");
  EXPECT_EQ(ErrorOf("walls:\n  - {from: [0, 0]}\n"), "test.yaml:2: key 'walls[0].to': is missing");
  EXPECT_EQ(ErrorOf("walls:\n  - {from: [0, 0], to: [0, 0]}\n"),
            "test.yaml:2: key 'walls[0]': the wall has no length");
  EXPECT_EQ(ErrorOf("ceiling_height: low\n"),
            "test.yaml:1: key 'ceiling_height': must be a number");
  EXPECT_EQ(ErrorOf(std::string(kRoom) + "decorations:\n  - {kind: door, wall: nowhere, at: 1}\n"),
            "test.yaml:4: key 'decorations[0].wall': is not a wall of this world; there are: "
            "room.0, room.1, room.2");
  EXPECT_EQ(ErrorOf(std::string(kRoom) + "decorations:\n  - {kind: door, wall: room.0, at: 3.8}\n"),
            "test.yaml:4: key 'decorations[0].at': puts it beyond the ends of its wall");
  EXPECT_EQ(ErrorOf("objects:\n  - {shape: sofa, at: [0, 0]}\n").substr(0, 39),
            "test.yaml:2: key 'objects[0].shape': is");
  EXPECT_EQ(ErrorOf("people:\n  - {path: [[0, 0, 5], [1, 0, 5]]}\n"),
            "test.yaml:2: key 'people[0].path': must have increasing times");
  EXPECT_EQ(ErrorOf("walls:\n  - {from: [0, 0], to: [3, 0], openings: [{at: 2.9}]}\n"),
            "test.yaml:2: key 'walls[0]': an opening overlaps another one or the end of the wall");
  EXPECT_EQ(ErrorOf(std::string(kRoom) + "  - {id: room, from: [0, 0], to: [3, 0]}\n"),
            "test.yaml:3: key 'walls[1].id': 'room' is used already");
}

TEST(World, ClearanceIsTheDistanceToTheNearestThing) {
  Loaded loaded = Load(kRoom);
  EXPECT_NEAR(Clearance(loaded.world, {3.5, 0.4}, 1.0, 0.0), 0.4, 1e-12);
  loaded.world.walls.clear();
  EXPECT_EQ(Clearance(loaded.world, {3.5, 0.4}, 1.0, 0.0), std::numeric_limits<double>::infinity());
}

TEST(World, ClearanceLeavesOutWhatIsAboveTheRobot) {
  const Loaded loaded = Load("walls:\n  - {from: [0, 0], to: [4, 0], bottom: 1.5}\n");
  EXPECT_GT(Clearance(loaded.world, {2.0, 0.1}, 1.0, 0.0), 1e6);
  EXPECT_NEAR(Clearance(loaded.world, {2.0, 0.1}, 1.6, 0.0), 0.1, 1e-12);
}

TEST(Person, WalksItsPathInTime) {
  const Loaded loaded =
      Load("people:\n  - {path: [[0, 0, 1], [2, 0, 3], [2, 1, 4]], loop: true}\n");
  const Person& person = loaded.world.people[0];
  EXPECT_EQ(PostureAt(person, 0.0).position, Eigen::Vector2d(0, 0));
  EXPECT_NEAR((PostureAt(person, 2.0).position - Eigen::Vector2d(1, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((PostureAt(person, 3.5).position - Eigen::Vector2d(2, 0.5)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(PostureAt(person, 3.5).heading, M_PI_2, 1e-12);
  EXPECT_NEAR((PostureAt(person, 5.0).position - Eigen::Vector2d(1, 0)).norm(), 0.0, 1e-12);
}

TEST(Person, LegsSwingWithinItsRadiusAndOppositeToEachOther) {
  const Loaded loaded = Load("people:\n  - {path: [[0, 0, 0], [10, 0, 10]]}\n");
  double largest = 0.0;
  for (double t = 0.0; t < 10.0; t += 0.01) {
    const Posture posture = PostureAt(loaded.world.people[0], t);
    const Eigen::Vector2d middle = 0.5 * (posture.legs[0] + posture.legs[1]);
    EXPECT_NEAR((middle - posture.position).norm(), 0.0, 1e-9);
    largest = std::max(largest, (posture.legs[0] - posture.position).norm());
  }
  EXPECT_GT(largest, 0.2);
  EXPECT_LT(largest, kPersonRadius);
}

}  // namespace
}  // namespace scan_image_slam
