// Small machines in the plane: weights over a pulley, an elevator, a windmill, a four-bar linkage.
#include <cmath>
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {
// Atwood's machine: 1 kg and 1.2 kg on a rope over two wheels.
Scene pulley() {
  Scene scene = planar_scene("pulley");
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-10, -0.5, -1), Vec3(10, 20, 1));
  scene.add(ground(Space::planar));
  const BodyId light = add_body(scene, "light", {-1, 4, 0}, Polygon::box(0.5, 0.5));
  const BodyId heavy = add_body(scene, "heavy", {1, 4, 0}, Polygon::box(0.5, 0.6));
  for (const BodyId body : {light, heavy}) {
    scene.at(body).jitter.linear_velocity = {0.1, 0, 0};
  }
  Joint rope;
  rope.name = "rope";
  rope.type = PulleyJoint{{-1, 8, 0}, {1, 8, 0}, 1, std::nullopt};
  rope.body_a = light, rope.body_b = heavy;
  rope.frame_a.position = {0, 0.5, 0}, rope.frame_b.position = {0, 0.6, 0};
  scene.add(rope);
  return scene;
}

// A platform on a rail, which lifts boxes to where its control says.
Scene elevator() {
  Scene scene = planar_scene("elevator");
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-10, -0.5, -1), Vec3(10, 30, 1));
  scene.add(ground(Space::planar));
  const BodyId platform = add_body(scene, "platform", {0, 0.2, 0}, Polygon::box(2, 0.15));
  const double half = std::sqrt(0.5);
  const Frame rail{Vec3(0, 0.2, 0), Quat(half, 0, 0, half)};  // its x points up
  const SliderJoint slider{Limit{0, 6, std::nullopt}, Drive{0, 0, Spring{0, 0, 1, 1}, 200}};
  const JointId joint = scene.add(joint_at(scene, {}, platform, rail, slider));
  Control height = speed_of("height", joint, 6, 4);
  height.kind = ControlKind::target_position;
  height.low = 0;
  scene.controls.push_back(height);
  for (int i = 0; i < 3; ++i) {
    const BodyId box =
        add_body(scene, "box" + std::to_string(i), {1.2 * (i - 1), 0.8, 0}, Polygon::box(0.4, 0.4));
    scene.at(box).jitter.position = {0.1, 0.05, 0};
  }
  return scene;
}

// A cross turned by a motor throws balls about a box.
Scene windmill() {
  Scene scene = planar_scene("windmill");
  scene.options.bounds = bounds_of(Space::planar, 4);
  scene.add(bin(Space::planar, 4));
  const BodyId sails = add_body(scene, "sails", {0, 2.5, 0}, Polygon::box(2, 0.1));
  scene.at(sails).shapes.push_back(shape_of(Polygon::box(0.1, 2)));
  const Drive motor{0, 2, std::nullopt, 20};
  const JointId joint =
      scene.add(joint_at(scene, {}, sails, frame_at(0, 2.5), HingeJoint{std::nullopt, motor}));
  scene.controls.push_back(speed_of("speed", joint, 6, 2));
  for (int i = 0; i < 16; ++i) {
    const BodyId ball = add_body(scene, "ball" + std::to_string(i),
                                 {1.5 * (i % 4) - 2.25, 6 + 0.8 * (i / 4), 0}, Circle{0.3});
    scene.at(ball).jitter.position = {0.3, 0.05, 0};
  }
  return scene;
}

// A crank that goes round, a coupler and a rocker: a closed loop.
Scene four_bar() {
  Scene scene = planar_scene("four-bar");
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-10, -10, -1), Vec3(10, 10, 1));
  const double pi = 3.14159265358979323846;
  const auto bar = [&](const char* name, const Vec2& from, const Vec2& to) {
    const Vec2 along = to - from, middle = (from + to) / 2;
    const BodyId body =
        add_body(scene, name, {middle.x(), middle.y(), 0}, Capsule{0.05, along.norm() / 2});
    Shape& shape = scene.bodies.back().shapes[0];
    shape.filter.mask = 0;
    const double angle = std::atan2(along.y(), along.x()) - pi / 2;  // capsules lie along y
    shape.rotation = Quat(std::cos(angle / 2), 0, 0, std::sin(angle / 2));
    return body;
  };
  const Vec2 a(0, 0), b(0, 1), c(3, 2.4), d(4, 0);
  const BodyId crank = bar("crank", a, b), coupler = bar("coupler", b, c),
               rocker = bar("rocker", c, d);
  scene.at(crank).jitter.linear_velocity = {0.1, 0.1, 0};
  const Drive motor{0, 3, std::nullopt, 100};
  const JointId joint =
      scene.add(joint_at(scene, {}, crank, frame_at(a.x(), a.y()), HingeJoint{{}, motor}));
  scene.add(joint_at(scene, crank, coupler, frame_at(b.x(), b.y()), HingeJoint{}));
  scene.add(joint_at(scene, coupler, rocker, frame_at(c.x(), c.y()), HingeJoint{}));
  scene.add(joint_at(scene, {}, rocker, frame_at(d.x(), d.y()), HingeJoint{}));
  scene.controls.push_back(speed_of("speed", joint, 10, 3));
  return scene;
}

}  // namespace manyworlds::scenes
