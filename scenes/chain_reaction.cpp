// A chain reaction: a ball rolls down a ramp and fells dominoes, the last of which knocks a second
// ball off the shelf into the cup of a see-saw. Its other arm, a gate, lets a marble roll into a
// bucket, which goes down and hoists a flag over two pulleys.
#include <cmath>
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {
namespace {

constexpr double kShelf = 6;   // m, its height
constexpr double kPivot = 4;   // m, height of the see-saw's hinge
constexpr double kPulley = 8;  // m, height of the pulleys

Shape block_at(double x, double y, double half_x, double half_y) {
  Shape shape = shape_of(Polygon::box(half_x, half_y));
  shape.position = {x, y, 0};
  return shape;
}

// A ramp and a shelf; the notch in which the second ball waits and a slope down from it; a wall
// beside the cup; the marble's slope.
void add_fixed_parts(Scene& scene) {
  Body frame = ground(Space::planar);
  frame.shapes.push_back(shape_of(Polygon{{{-7, kShelf}, {-4, kShelf}, {-7, kShelf + 2}}}));
  frame.shapes.push_back(block_at(-2.785, kShelf - 0.1, 4.215, 0.1));
  frame.shapes.push_back(shape_of(
      Polygon{{{1.49, kShelf - 0.3}, {2.2, kShelf - 0.3}, {2.2, kShelf - 0.1}, {1.49, kShelf}}}));
  frame.shapes.push_back(block_at(3.5, kPivot + 1.9, 0.05, 1.2));
  frame.shapes.push_back(shape_of(Polygon{{{5.2, 2.7}, {7.5, 2.7}, {7.5, 2.825}, {5.2, 3.4}}}));
  scene.add(frame);
}

// The hinge's limit holds the gate down by its own weight.
void add_gate(Scene& scene) {
  Body seesaw;
  seesaw.name = "see-saw";
  seesaw.position = {4.2, kPivot, 0};
  seesaw.shapes = {block_at(0, 0, 1.9, 0.06), block_at(-1.85, 0.26, 0.05, 0.2),
                   block_at(-0.75, 0.26, 0.05, 0.2), block_at(1.8, -0.34, 0.1, 0.28)};
  const BodyId gate = scene.add(seesaw);
  scene.add(joint_at(scene, {}, gate, frame_at(4.2, kPivot),
                     HingeJoint{Limit{0, 0.4, std::nullopt}, std::nullopt}));
}

void add_bucket_and_flag(Scene& scene) {
  Body bucket;
  bucket.name = "bucket";
  bucket.position = {8.2, 2, 0};
  bucket.linear_drag = bucket.angular_drag = 0.5;
  bucket.shapes = {block_at(0, 0, 0.5, 0.05), block_at(-0.45, 0.4, 0.05, 0.35),
                   block_at(0.45, 0.4, 0.05, 0.35)};
  const BodyId light = scene.add(bucket);
  const BodyId heavy = add_body(scene, "flag", {10.5, 0.3, 0}, Polygon::box(0.3, 0.3));
  Joint rope;
  rope.name = "rope";
  rope.type = PulleyJoint{{8.2, kPulley, 0}, {10.5, kPulley, 0}, 1, std::nullopt};
  rope.body_a = light, rope.body_b = heavy;
  rope.frame_a.position = {0, 1.2, 0}, rope.frame_b.position = {0, 0.3, 0};
  scene.add(rope);
}

}  // namespace

Scene chain_reaction() {
  Scene scene = planar_scene("chain-reaction");
  scene.options.density = 10;
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-30, -0.5, -1), Vec3(40, 20, 1));
  add_fixed_parts(scene);
  add_body(scene, "ball", {-6, kShelf + 1.72, 0}, Circle{0.25});
  scene.bodies.back().jitter.position = {0.08, 0.02, 0};
  for (int i = 0; i < 9; ++i) {
    add_body(scene, "domino" + std::to_string(i), {-2.5 + 0.45 * i, kShelf + 0.4, 0},
             Polygon::box(0.06, 0.4));
    scene.bodies.back().jitter.position = {0.03, 0, 0};
  }
  add_body(scene, "second ball", {1.46, kShelf + 0.25, 0}, Circle{0.25});
  scene.bodies.back().shapes[0].material.friction = 0.05;  // else it wedges under the domino
  add_gate(scene);
  add_body(scene, "marble", {5.68, 3.5, 0}, Circle{0.2});
  scene.bodies.back().shapes[0].density = 20;
  add_bucket_and_flag(scene);
  return scene;
}

}  // namespace manyworlds::scenes
