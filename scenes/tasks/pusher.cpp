// A table seen from above: a disc that the policy drives pushes a puck onto a mark. Puck and mark
// are somewhere else in every episode.
#include "scenes/tasks/makers.hpp"

namespace manyworlds::tasks {

Task pusher() {
  using namespace terms;
  constexpr double kHalfTable = 2, kClose = 0.15, kMaxForce = 10;  // m, m, N
  Task task;
  task.name = "Pusher";
  Scene& scene = task.scene = planar_scene(task, 0.02, 0);
  task.frame_skip = 2;
  Body table;
  table.name = "table";
  table.motion = Motion::fixed;
  for (const Vec2& inward : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)}) {
    table.shapes.push_back(shape_of(HalfPlane{inward, -kHalfTable}));
  }
  scene.add(table);
  const auto disc = [&](const char* name, double radius, double density, const Vec3& middle,
                        const Vec3& around, double drag) {
    Body body;
    body.name = name;
    body.position = middle;
    body.jitter.position = around;
    body.shapes.push_back(shape_of(Circle{radius}));
    body.shapes[0].density = density;
    body.linear_drag = drag, body.angular_drag = drag;  // the table's friction
    return scene.add(body);
  };
  const BodyId hand = disc("hand", 0.15, 10, {-1.5, 0, 0}, {0.2, 1, 0}, 4),
               puck = disc("puck", 0.2, 5, {-0.2, 0, 0}, {0.5, 1, 0}, 3);
  Body mark;
  mark.name = "mark";
  mark.motion = Motion::kinematic;
  mark.position = {1.2, 0, 0};
  mark.jitter.position = {0.4, 1.2, 0};
  const BodyId goal = scene.add(mark);
  scene.controls = {thrust("x", hand, Vec3::Zero(), {1, 0, 0}, -kMaxForce, kMaxForce),
                    thrust("y", hand, Vec3::Zero(), {0, 1, 0}, -kMaxForce, kMaxForce)};
  task.actions = {{"x", -1, 1}, {"y", -1, 1}};
  // Thrusts are along the body's axes: turned back from the world's by where it has turned to.
  const Expression c = previous(direction(hand, 0, 0)), s = previous(direction(hand, 0, 1));
  task.controls = {kMaxForce * (c * action(0) + s * action(1)),
                   kMaxForce * (c * action(1) - s * action(0))};

  const auto apart = [](BodyId a, BodyId b) {
    return sqrt(square(position(a, 0) - position(b, 0)) + square(position(a, 1) - position(b, 1)));
  };
  for (const int axis : {0, 1}) {
    const char* const name = axis == 0 ? "x" : "y";
    const auto see = [&](const std::string& what, const Expression& e) {
      task.observations.push_back({what + " " + name, e});
    };
    see("hand", position(hand, axis));
    see("hand speed", velocity(hand, axis));
    see("puck from hand", position(puck, axis) - position(hand, axis));
    see("puck speed", velocity(puck, axis));
    see("mark from puck", position(goal, axis) - position(puck, axis));
  }
  const Expression far = apart(puck, goal), near = apart(hand, puck);
  const Expression there = held(far < kClose) >= 10;
  task.rewards = {{"puck", 5 * (previous(far) - far)},
                  {"hand", previous(near) - near},
                  {"effort", -0.01 * (square(action(0)) + square(action(1)))},
                  {"there", select(there, 10, 0)}};
  task.terminated = there;
  task.max_steps = 200;
  task.solved_at = 15;
  return task;
}

}  // namespace manyworlds::tasks
