// The policy flies a box by thrust and torque, and is to set it down on a tower of two, so that it
// stands there with its engines off.
#include "scenes/tasks/makers.hpp"

namespace manyworlds::tasks {

Task stacking() {
  using namespace terms;
  constexpr double kSide = 0.5, kGravity = 9.81;  // m, m/s^2
  Task task;
  task.name = "Stacking";
  Scene& scene = task.scene = planar_scene(task, 1.0 / 60, kGravity);
  scene.options.length_unit = kSide;
  task.frame_skip = 2;
  scene.add(ground(Space::planar));
  const auto box = [&](const char* name, const Vec3& place) {
    Body body;
    body.name = name;
    body.position = place;
    body.shapes.push_back(shape_of(Polygon::box(kSide / 2, kSide / 2)));
    body.shapes[0].density = 4;
    body.shapes[0].material.friction = 0.8;
    return body;
  };
  Body foot = box("lower", {0, kSide / 2, 0});
  foot.jitter.position = {0.5, 0, 0};
  const BodyId lower = scene.add(foot);
  Body middle = box("upper", {0, 1.5 * kSide, 0});
  middle.jitter.with = lower;
  middle.jitter.position = {0.03, 0, 0};
  const BodyId upper = scene.add(middle);
  Body third = box("flown", {0, 4 * kSide, 0});
  third.jitter.position = {1.5, 0.5, 0};
  third.jitter.angle = 0.3;
  third.linear_drag = 0.5, third.angular_drag = 1;
  const BodyId carried = scene.add(third);
  const double mass = mass_properties(scene, third).mass, most = 2.5 * mass * kGravity;
  scene.controls = {thrust("x", carried, Vec3::Zero(), {1, 0, 0}, -most, most),
                    thrust("y", carried, Vec3::Zero(), {0, 1, 0}, -most, most),
                    torque("turn", carried, 0.2 * mass * kGravity * kSide)};
  task.actions = {{"x", -1, 1}, {"y", -1, 1}, {"turn", -1, 1}};
  // In the world's axes, whatever way the box has turned.
  const Expression c = previous(direction(carried, 0, 0)), s = previous(direction(carried, 0, 1));
  task.controls = {most * (c * action(0) + s * action(1)), most * (c * action(1) - s * action(0)),
                   scene.controls[2].high * action(2)};

  const Expression dx = position(carried, 0) - position(upper, 0),
                   dy = position(carried, 1) - (position(upper, 1) + kSide), lean = angle(carried);
  task.observations = {{"x off", dx},
                       {"y off", dy},
                       {"vx", velocity(carried, 0)},
                       {"vy", velocity(carried, 1)},
                       {"cos", cos(lean), -1, 1},
                       {"sin", sin(lean), -1, 1},
                       {"turn", angular_velocity(carried, 2)},
                       {"touching", touching(carried), 0, 1},
                       {"tower lean", angle(upper)},
                       {"tower x off", position(upper, 0) - position(lower, 0)}};
  const Expression effort = square(action(0)) + square(action(1)) + square(action(2));
  const Expression near = sqrt(square(dx) + square(dy));
  const Expression on_top = touching(carried) & (abs(dx) < 0.6 * kSide) & (abs(dy) < 0.1 * kSide);
  const Expression still = square(velocity(carried, 0)) + square(velocity(carried, 1)) < 0.01;
  const Expression stands = held(on_top & still & (effort < 0.03)) >= 15;
  const Expression fallen = position(upper, 1) < 1.2 * kSide;
  task.rewards = {{"near", 2 * (previous(near) - near)},
                  {"on top", select(on_top, 0.1, 0)},
                  {"effort", -0.01 * effort},
                  {"stands", select(stands, 10, 0)},
                  {"fallen", select(fallen, -5, 0)}};
  task.terminated = stands | fallen | (abs(position(carried, 0)) > 6) | (position(carried, 1) > 8);
  task.max_steps = 300;
  task.solved_at = 10;
  return task;
}

}  // namespace manyworlds::tasks
