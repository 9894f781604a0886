// A torque swings up a pendulum that it cannot hold sideways, and two links by their elbow (Sutton
// 1996); numbers as in Gymnasium's classic control.
#include "scenes/tasks/makers.hpp"

namespace manyworlds::tasks {

Task pendulum() {
  constexpr double kMaxTorque = 2;  // N m
  Task task;
  task.name = "Pendulum";
  Scene& scene = task.scene = planar_scene(task, 0.05, 10);
  Body rod;  // its frame is at the hinge; upright at angle 0
  rod.name = "rod";
  rod.shapes = {ghost(Polygon::box(0.01, 0.5), 0.02, 1)};
  rod.shapes[0].position = {0, 0.5, 0};
  rod.mass_properties = MassProperties{1, {0, 0.5, 0}, Mat3::Identity() / 12};
  rod.jitter.angle = 3.141592653589793;
  const BodyId body = scene.add(rod);
  scene.add(joint_at(scene, {}, body, Frame{}, HingeJoint{}));
  scene.controls = {torque("torque", body, kMaxTorque)};
  const Expression angle = terms::angle(body), speed = terms::angular_velocity(body, 2);
  task.actions = {{"torque", -kMaxTorque, kMaxTorque}};
  task.controls = {terms::action()};
  task.observations = {{"cos", cos(angle), -1, 1}, {"sin", sin(angle), -1, 1}, {"speed", speed}};
  // Of where the step began, as Gymnasium has it.
  task.rewards = {{"angle", -square(terms::previous(angle))},
                  {"speed", -0.1 * square(terms::previous(speed))},
                  {"effort", -0.001 * square(terms::action())}};
  task.max_steps = 200;
  return task;
}

Task acrobot() {
  Task task;
  task.name = "Acrobot";
  Scene& scene = task.scene = planar_scene(task, 0.05, 9.8);
  task.frame_skip = 4;
  const auto link = [&](const char* name, double height) {
    Body body;  // its frame is at its upper end; it hangs at angle 0
    body.name = name;
    body.position = {0, height, 0};
    body.shapes = {ghost(Polygon::box(0.05, 0.5), 0.1, 1)};
    body.shapes[0].position = {0, -0.5, 0};
    body.mass_properties = MassProperties{1, {0, -0.5, 0}, Mat3::Identity()};
    body.jitter.angle = 0.1;
    return body;
  };
  const BodyId upper = scene.add(link("upper", 0));
  Body forearm = link("lower", -1);
  forearm.jitter.with = upper;
  const BodyId lower = scene.add(forearm);
  scene.add(joint_at(scene, {}, upper, Frame{}, HingeJoint{}));
  Frame elbow;
  elbow.position = {0, -1, 0};
  scene.add(joint_at(scene, upper, lower, elbow, HingeJoint{}));
  // The elbow's motor: a torque on the forearm, and what it takes on the upper arm.
  scene.controls = {torque("elbow", lower, 1), torque("reaction", upper, 1)};
  const Expression first = terms::angle(upper), second = terms::angle(lower) - terms::angle(upper);
  const Expression turn = terms::angular_velocity(upper, 2),
                   second_turn = terms::angular_velocity(lower, 2) - turn;
  task.choices = 3;
  task.controls = {terms::action() - 1, 1 - terms::action()};
  task.observations = {{"cos 1", cos(first), -1, 1},
                       {"sin 1", sin(first), -1, 1},
                       {"cos 2", cos(second), -1, 1},
                       {"sin 2", sin(second), -1, 1},
                       {"turn 1", turn},
                       {"turn 2", second_turn}};
  const Expression up = -cos(first) - cos(terms::angle(lower)) > 1;
  task.rewards = {{"time", select(up, 0, -1)}};
  task.terminated = up;
  task.max_steps = 500;
  task.solved_at = -100;
  return task;
}

}  // namespace manyworlds::tasks
