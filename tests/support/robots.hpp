// Scenes for Solver::newton: robots as trees, built by hand.
#pragma once

#include <vector>

#include "tests/support/scenes.hpp"

namespace manyworlds::test {

class RobotBuilder {
 public:
  explicit RobotBuilder(Scene& scene) : scene_(scene) {}

  // Bodies are given where they begin, in world axes. One without a joint is free.
  BodyId body(Geometry geometry, const Vec3& position, const SoftContact& soft = {});
  // Joints at a place of the world as the bodies begin; several on one body are a series.
  JointId hinge(BodyId a, BodyId b, const Vec3& place, const Vec3& axis, double range);
  JointId slider(BodyId a, BodyId b, const Vec3& place, const Vec3& axis);
  JointId ball(BodyId a, BodyId b, const Vec3& place);
  void motor(JointId joint, double gear);
  void servo(JointId joint, double stiffness, double most);

 private:
  JointId add(BodyId a, BodyId b, const Vec3& place, const Quat& axes, JointType type);

  Scene& scene_;
};

inline Scene robot_scene(double gravity = 9.81) {
  Scene scene = empty_scene(Space::spatial, gravity);
  scene.options.solver.method = Solver::newton;
  scene.options.dt = 0.005;
  return scene;
}

// A trunk with a head on a ball joint and two legs of three hinges in series, a knee and an ankle.
// Limits, motors, servos; feet are boxes, the rest meets itself and others, too. `drop`: of the
// feet above height 0.
BodyId add_walker(Scene& scene, double x, double drop);

// Two walkers that touch, an arm on a rail that reaches into them, a ball and a block that are
// free, over a ground with a step.
Scene robots();

// One walker and a free ball: few enough to be solved by articulated bodies, where the robots above
// are in joint space.
Scene lone_walker();

// Every number of joints, controls and shapes another one in every world.
Scene randomized(Scene scene);

// The same with options that take other ways through the step.
std::vector<Scene> robots_of_other_options();

}  // namespace manyworlds::test
