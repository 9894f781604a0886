// A one-legged hopper in the plane: torso, thigh, leg and foot on motors, which runs as far as it
// can without falling. Sizes as in MuJoCo's hopper.
#include <cmath>
#include <string>

#include "scenes/tasks/makers.hpp"

namespace manyworlds::tasks {
namespace {

constexpr double kMaxTorque = 100;                                                         // N m
constexpr double kFootHeight = 0.06, kAnkle = 0.1, kKnee = 0.6, kHip = 1.05, kTop = 1.45;  // m

BodyId add_limb(Scene& scene, const char* name, double low, double high, double radius) {
  Body limb;
  limb.name = name;
  limb.position = {0, (low + high) / 2, 0};
  Shape shape = shape_of(Capsule{radius, (high - low) / 2});
  shape.density = 200;
  shape.filter = {2, 1};  // its own limbs do not touch each other
  limb.shapes = {shape};
  if (scene.bodies.size() > 1) limb.jitter.with = BodyId(1);  // the torso
  return scene.add(limb);
}

}  // namespace

Task hopper() {
  using namespace terms;
  Task task;
  task.name = "Hopper";
  Scene& scene = task.scene = planar_scene(task, 0.008, 9.81);
  scene.add(ground(Space::planar, {.friction = 1}));
  const BodyId torso = add_limb(scene, "torso", kHip, kTop, 0.05);
  scene.bodies.back().jitter.position = {0, 0.005, 0};
  scene.bodies.back().jitter.linear_velocity = {0.05, 0.05, 0};
  const BodyId thigh = add_limb(scene, "thigh", kKnee, kHip, 0.05);
  const BodyId leg = add_limb(scene, "leg", kAnkle, kKnee, 0.04);
  const BodyId foot = add_limb(scene, "foot", -0.13, 0.26, kFootHeight);
  Body& sole = scene.at(foot);
  sole.position = {0.065, kAnkle, 0};
  sole.rotation = Quat(std::sqrt(0.5), 0, 0, std::sqrt(0.5));
  sole.shapes[0].material.friction = 2;

  const BodyId body[] = {torso, thigh, leg, foot};
  const double height[] = {kHip, kKnee, kAnkle};
  const Limit limit[] = {{-0.2, 2.6, {}}, {-2.6, 0.2, {}}, {-0.8, 0.8, {}}};
  const char* const name[] = {"hip", "knee", "ankle"};
  for (int i = 0; i < 3; ++i) {
    Frame frame;
    frame.position = {0, height[i], 0};
    HingeJoint hinge;
    hinge.limit = limit[i];
    scene.add(joint_at(scene, body[i], body[i + 1], frame, hinge));
    // A motor turns the lower limb and bears on the upper one.
    scene.controls.push_back(torque(name[i], body[i + 1], kMaxTorque));
    scene.controls.push_back(torque(std::string(name[i]) + " reaction", body[i], kMaxTorque));
    task.actions.push_back({name[i], -1, 1});
    task.controls.push_back(kMaxTorque * action(i));
    task.controls.push_back(-kMaxTorque * action(i));
  }

  const Expression lean = angle(torso), up = position(torso, 1);
  task.observations = {{"height", up}, {"lean", lean}};
  for (int i = 0; i < 3; ++i) task.observations.push_back({name[i], joint_position(JointId(i))});
  task.observations.push_back({"vx", clamp(velocity(torso, 0), -10, 10), -10, 10});
  task.observations.push_back({"vy", clamp(velocity(torso, 1), -10, 10), -10, 10});
  task.observations.push_back({"turn", clamp(angular_velocity(torso, 2), -10, 10), -10, 10});
  for (int i = 0; i < 3; ++i) {
    task.observations.push_back(
        {std::string(name[i]) + " speed", clamp(joint_speed(JointId(i)), -10, 10), -10, 10});
  }
  task.rewards = {{"forward", velocity(torso, 0)},
                  {"alive", 1},
                  {"effort", -1e-3 * (square(action(0)) + square(action(1)) + square(action(2)))}};
  task.terminated = (up < 0.8) | (abs(lean) > 0.4);
  task.max_steps = 1000;
  return task;
}

}  // namespace manyworlds::tasks
