// Many hinges: a bridge with a load, a heavy ball on a chain, a net that hangs from its corner.
#include <cmath>
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {

// 16 planks between two banks, and boxes that fall on them.
Scene bridge() {
  constexpr int kPlanks = 16, kBoxes = 6;
  constexpr double kHeight = 4;  // m
  Scene scene = planar_scene("bridge");
  scene.options.density = 20;
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-20, -0.5, -1), Vec3(20, 50, 1));
  Body banks = ground(Space::planar);
  banks.name = "banks";
  for (const double side : {-1.0, 1.0}) {
    Shape bank = shape_of(Polygon::box(3, kHeight / 2));
    bank.position = {side * (kPlanks / 2.0 + 3), kHeight / 2, 0};
    banks.shapes.push_back(bank);
  }
  scene.add(banks);
  BodyId last;
  for (int i = 0; i < kPlanks; ++i) {
    const double x = i - kPlanks / 2.0;
    const BodyId plank = add_body(scene, "plank" + std::to_string(i), {x + 0.5, kHeight - 0.1, 0},
                                  Polygon::box(0.48, 0.1));
    scene.add(joint_at(scene, last, plank, frame_at(x, kHeight - 0.1), HingeJoint{}));
    last = plank;
  }
  scene.add(joint_at(scene, {}, last, frame_at(kPlanks / 2.0, kHeight - 0.1), HingeJoint{}));
  for (int i = 0; i < kBoxes; ++i) {
    const BodyId box = add_body(scene, "box" + std::to_string(i),
                                {1.5 * i - 3.75, kHeight + 1.5, 0}, Polygon::box(0.4, 0.4));
    scene.at(box).jitter = {.position = {0.2, 0.5, 0}, .angle = 1};
  }
  return scene;
}

// 20 links of 5 kg and a ball 50 times as heavy. Such ratios need more substeps.
Scene ball_and_chain() {
  constexpr int kLinks = 20;
  constexpr double kHeight = 25;  // m, of the chain's end
  Scene scene = planar_scene("ball-and-chain");
  scene.options.density = 20;
  scene.options.substeps = 12;
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-30, -0.5, -1), Vec3(30, 60, 1));
  scene.add(ground(Space::planar));
  BodyId last;
  for (int i = 0; i < kLinks; ++i) {
    const BodyId link = add_body(scene, "link" + std::to_string(i), {i + 0.5, kHeight, 0},
                                 Polygon::box(0.5, 0.125));
    scene.at(link).shapes[0].filter.mask = 0;
    scene.at(link).jitter.linear_velocity = {0, 0.1, 0};
    scene.add(joint_at(scene, last, link, frame_at(i, kHeight), HingeJoint{}));
    last = link;
  }
  const BodyId ball = add_body(scene, "ball", {kLinks + 2, kHeight, 0}, Circle{2});
  scene.at(ball).shapes[0].filter.mask = 0;
  scene.add(joint_at(scene, last, ball, frame_at(kLinks, kHeight), HingeJoint{}));
  return scene;
}

// 10 x 10 discs, each joined to its right and its lower neighbour, held at two corners.
Scene joint_grid() {
  constexpr int kSide = 10;
  Scene scene = planar_scene("joint-grid");
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-30, -30, -1), Vec3(30, 30, 1));
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const Vec3 place(column - (kSide - 1) / 2.0, -row, 0);
      const BodyId disc =
          add_body(scene, "disc" + std::to_string(row * kSide + column), place, Circle{0.4});
      Body& body = scene.bodies.back();
      body.shapes[0].filter.mask = 0;
      body.jitter.linear_velocity = {0.2, 0.2, 0};
      if (column > 0) {
        scene.add(joint_at(scene, BodyId(disc.index() - 1), disc,
                           frame_at(place.x() - 0.5, place.y()), HingeJoint{}));
      }
      if (row > 0) {
        scene.add(joint_at(scene, BodyId(disc.index() - kSide), disc,
                           frame_at(place.x(), place.y() + 0.5), HingeJoint{}));
      }
      if (row == 0 && (column == 0 || column == kSide - 1)) {
        scene.add(joint_at(scene, {}, disc, frame_at(place.x(), place.y()), HingeJoint{}));
      }
    }
  }
  return scene;
}

}  // namespace manyworlds::scenes
