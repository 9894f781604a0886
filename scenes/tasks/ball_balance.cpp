// A ball on a plate that two motors tilt: it is to be kept in the middle.
#include "scenes/tasks/makers.hpp"

namespace manyworlds::tasks {

Task ball_balance() {
  using namespace terms;
  constexpr double kHalfPlate = 0.5, kRadius = 0.05, kMaxTorque = 4;  // m, m, N m
  Task task;
  task.name = "BallBalance";
  Scene& scene = task.scene = scenes::spatial_scene(task.name);
  scene.options.dt = 1.0 / 60;
  scene.options.gravity = {0, 0, -9.81};
  scene.options.length_unit = 0.2;
  Body plate;
  plate.name = "plate";
  plate.shapes.push_back(shape_of(Box{{kHalfPlate, kHalfPlate, 0.02}}));
  plate.shapes[0].density = 50;
  plate.angular_drag = 2;
  const BodyId tilted = scene.add(plate);
  Body ball;
  ball.name = "ball";
  ball.position = {0, 0, 0.02 + kRadius};
  ball.jitter.position = {0.2, 0.2, 0};
  ball.jitter.linear_velocity = {0.2, 0.2, 0};
  ball.shapes.push_back(shape_of(Sphere{kRadius}));
  ball.shapes[0].density = 1000;
  const BodyId rolling = scene.add(ball);
  BallJoint gimbal;
  gimbal.cone = 0.4;
  gimbal.twist = Limit{-0.01, 0.01, {}};
  scene.add(joint_at(scene, {}, tilted, Frame{}, gimbal));
  scene.controls = {torque("x", tilted, kMaxTorque, {1, 0, 0}),
                    torque("y", tilted, kMaxTorque, {0, 1, 0})};
  task.actions = {{"x", -1, 1}, {"y", -1, 1}};
  task.controls = {kMaxTorque * action(0), kMaxTorque * action(1)};
  const Expression x = position(rolling, 0), y = position(rolling, 1);
  const Expression off = sqrt(square(x) + square(y));
  task.observations = {{"x", x, -1, 1},
                       {"y", y, -1, 1},
                       {"vx", velocity(rolling, 0)},
                       {"vy", velocity(rolling, 1)},
                       {"tilt x", direction(tilted, 2, 0), -1, 1},
                       {"tilt y", direction(tilted, 2, 1), -1, 1},
                       {"turn x", angular_velocity(tilted, 0)},
                       {"turn y", angular_velocity(tilted, 1)}};
  task.rewards = {{"middle", 1 - off / kHalfPlate},
                  {"effort", -0.02 * (square(action(0)) + square(action(1)))}};
  // Down from the plate: below where it could be on the most tilted one.
  task.terminated = (off > 1.4143 * kHalfPlate) | (position(rolling, 2) < -0.3);
  task.max_steps = 500;
  task.solved_at = 400;
  return task;
}

}  // namespace manyworlds::tasks
