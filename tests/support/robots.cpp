#include "tests/support/robots.hpp"

#include <utility>

#include "src/scene/variations.hpp"

namespace manyworlds::test {

BodyId RobotBuilder::body(Geometry geometry, const Vec3& position, const SoftContact& soft) {
  Body body = body_of(shape_of(std::move(geometry), 0.8), position);
  body.shapes[0].material.soft = soft;
  return scene_.add(std::move(body));
}

JointId RobotBuilder::hinge(BodyId a, BodyId b, const Vec3& place, const Vec3& axis, double range) {
  return add(a, b, place, rotation_to(Vec3::UnitZ(), axis),
             HingeJoint{.limit = Limit{.low = -range, .high = range}});
}

JointId RobotBuilder::slider(BodyId a, BodyId b, const Vec3& place, const Vec3& axis) {
  return add(a, b, place, rotation_to(Vec3::UnitX(), axis), SliderJoint{});
}

JointId RobotBuilder::ball(BodyId a, BodyId b, const Vec3& place) {
  return add(a, b, place, Quat::Identity(), BallJoint{});
}

void RobotBuilder::motor(JointId joint, double gear) {
  Control control;
  control.kind = ControlKind::joint_force;
  control.joint = joint;
  control.actuator.gear = gear;
  scene_.add(std::move(control));
}

void RobotBuilder::servo(JointId joint, double stiffness, double most) {
  Control control;
  control.kind = ControlKind::joint_force;
  control.joint = joint;
  control.actuator.gain = {stiffness, 0, 0}, control.actuator.bias = {0, -stiffness, -0.05};
  control.actuator.low = -most, control.actuator.high = most;
  scene_.add(std::move(control));
}

JointId RobotBuilder::add(BodyId a, BodyId b, const Vec3& place, const Quat& axes, JointType type) {
  Joint joint;
  joint.type = std::move(type);
  joint.body_a = a, joint.body_b = b;
  joint.frame_b = {place - scene_.at(b).position, axes};
  const Vec3 of_a = a ? scene_.at(a).position : Vec3::Zero().eval();
  joint.frame_a = {place - of_a, axes};
  for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
    if (scene_.joints[i].body_b == b) joint.after = JointId(static_cast<int>(i));
  }
  if (joint.after) joint.frame_a = joint.frame_b;  // of what the joint before moves: body b
  joint.dynamics.armature = 0.01, joint.dynamics.damping = 0.1;
  return scene_.add(std::move(joint));
}

BodyId add_walker(Scene& scene, double x, double drop) {
  RobotBuilder build(scene);
  const SoftContact smooth{.dimensions = 1, .margin = 0.004};
  const auto at = [&](double y, double z) { return Vec3(x, y, z + drop); };
  const BodyId trunk = build.body(Capsule{0.1, 0.15}, at(0, 0.75));
  scene.at(trunk).jitter.position = Vec3(0.2, 0.2, 0.1), scene.at(trunk).jitter.angle = 0.5;
  const BodyId head = build.body(Sphere{0.09}, at(0, 1.12), smooth);
  Joint& neck = scene.at(build.ball(trunk, head, at(0, 1.02)));
  neck.type = BallJoint{.limit = Limit{.high = 0.3, .margin = 0.05}};
  neck.dynamics.stiffness = 2;
  for (const double side : {-0.12, 0.12}) {
    const BodyId thigh = build.body(Capsule{0.05, 0.1}, at(side, 0.45));
    const Vec3 hip = at(side, 0.6);
    build.motor(build.hinge(trunk, thigh, hip, Vec3::UnitX(), 0.4), 10);
    build.motor(build.hinge(trunk, thigh, hip, Vec3::UnitZ(), 0.6), 10);
    build.motor(build.hinge(trunk, thigh, hip, Vec3(0, 1, 0.2), 1.2), 20);
    const BodyId shin = build.body(Capsule{0.04, 0.08}, at(side, 0.2), smooth);
    const JointId knee = build.hinge(thigh, shin, at(side, 0.32), Vec3::UnitY(), 1.5);
    scene.at(knee).dynamics.stiffness = 3, scene.at(knee).dynamics.rest = 0.3;
    build.motor(knee, 8);
    const BodyId foot = build.body(Box{{0.09, 0.04, 0.02}}, at(side, 0.02));
    build.servo(build.hinge(shin, foot, at(side, 0.06), Vec3::UnitY(), 0.6), 10, 5);
  }
  return trunk;
}

Scene robots() {
  Scene scene = robot_scene();
  Body floor = ground(Space::spatial, 0.9);
  floor.shapes.push_back(shape_of(Box{{0.3, 0.3, 0.05}}, 0.5));
  floor.shapes[1].position = {0.1, 0.1, 0.02};
  scene.add(std::move(floor));
  add_walker(scene, 0, 0.08);
  add_walker(scene, 0.25, 0.15);
  RobotBuilder build(scene);
  const BodyId cart = build.body(Box{{0.1, 0.1, 0.05}}, {-0.8, 0, 1.1});
  const JointId rail = build.slider({}, cart, {-0.8, 0, 1.1}, Vec3::UnitX());
  const BodyId arm = build.body(Capsule{0.05, 0.2}, {-0.6, 0, 1.1});
  const JointId shoulder = build.hinge(cart, arm, {-0.65, 0, 1.1}, Vec3(0, 1, 0.3), 1.4);
  build.motor(rail, 15), build.motor(shoulder, 10);
  build.body(Sphere{0.1}, {0.1, 0.05, 1.6}, {.compliance = {.time_constant = 0.04}});
  build.body(Box{{0.1, 0.08, 0.06}}, {-0.1, 0.2, 1.5}, {.priority = 1});
  return scene;
}

Scene lone_walker() {
  Scene scene = robot_scene();
  scene.name = "one walker";
  scene.add(ground(Space::spatial, 0.9));
  add_walker(scene, 0, 0.08);
  RobotBuilder(scene).body(Sphere{0.1}, {0.1, 0.05, 1.4});
  return scene;
}

Scene randomized(Scene scene) {
  scene.name = "randomized " + scene.name;
  scene.variations = {vary(Parameter::density, 600, 1500, Draw::log_uniform),
                      vary(Parameter::friction, 0.4, 1.2),
                      vary(Parameter::gravity_scale, 0.9, 1.1),
                      vary(Parameter::armature, 0.005, 0.02),
                      vary(Parameter::damping, 0.05, 0.3, Draw::log_uniform),
                      vary(Parameter::stiffness, 0, 4),
                      vary(Parameter::rest, -0.3, 0.3)};
  for (std::size_t i = 0; i < scene.controls.size(); ++i) {
    const bool servo = scene.controls[i].actuator.bias.y() != 0;
    std::vector<Variation> own = {vary(Parameter::gain, 0.7, 1.3)};
    if (servo) own = {vary(Parameter::kp, 5, 20), vary(Parameter::kv, 0, 0.2)};
    for (Variation& v : own) {
      v.control = ControlId(static_cast<int>(i));
      scene.variations.push_back(v);
    }
  }
  for (const NumberOwner& of : owners_of(scene, Parameter::size)) {
    if (!can_vary(scene, Parameter::size, of)) continue;
    Variation size;
    size.parameter = Parameter::size, size.shape = ShapeId(BodyId(of.body), of.shape);
    for (int c = 0; c < 3; ++c) size.low[c] = get_number(scene, Parameter::size, of, c);
    size.high = 1.15 * size.low, size.low *= 0.9;
    scene.variations.push_back(size);
  }
  return scene;
}

std::vector<Scene> robots_of_other_options() {
  Scene wet = robots();
  wet.name = "round cones in a medium";
  wet.options.solver.cone = FrictionCone::elliptic;
  wet.options.medium = {.density = 100, .viscosity = 0.2};
  wet.options.wind = {1, 0.5, 0};
  Scene stiff = robots();
  stiff.name = "round cones and implicit-fast";
  stiff.options.solver.cone = FrictionCone::elliptic;
  stiff.options.solver.impedance_ratio = 4;
  stiff.options.integrator = Integrator::implicit_fast;
  Scene lone = lone_walker(), round = lone_walker();
  round.name = "one walker with round cones";
  round.options.solver.cone = FrictionCone::elliptic;
  round.options.integrator = Integrator::implicit_fast;
  return {wet, stiff, lone, round, randomized(robots()), randomized(wet), randomized(round)};
}

}  // namespace manyworlds::test
