// Scenes of Solver::newton, and a world's coordinates as numbers.
#pragma once

#include "tests/support/joints.hpp"

namespace manyworlds::test {

using Numbers = std::vector<double>;

inline constexpr double kMass = 2, kLength = 0.8, kAcross = 0.3;            // kg, m, kg m^2
inline constexpr double kAboutHinge = kAcross + kMass * kLength * kLength;  // kg m^2

inline Scene newton_scene(double gravity = 10) {
  Scene scene = empty_scene(Space::spatial, gravity);
  scene.options.solver.method = Solver::newton;
  scene.options.dt = 0.01, scene.options.substeps = 1;
  return scene;
}
// A body on a hinge about y through the world's origin, at first along x: with the angle q it is at
// (cos q, 0, -sin q) kLength.
inline Scene newton_pendulum(double gravity = 10) {
  Scene scene = newton_scene(gravity);
  scene.add(lump(Space::spatial, kMass, {0.1, kAcross, 0.3}, {kLength, 0, 0}));
  scene.add(joint_at(scene, BodyId(), BodyId(0), at(Vec3::Zero(), z_to_y()), HingeJoint{}));
  return scene;
}
// A free torso that draws where it begins, an arm on a hinge and a hand on a ball joint, over a
// ground; and a free ball.
Scene newton_robot();
// Of the robot's tree and of the ball.
inline constexpr int kCoordinates = 7 + 1 + 4 + 7, kDofs = 6 + 1 + 3 + 6;

inline Numbers of(const Batch& batch, Field field, int world = 0) {
  return values(batch, field, world);
}
inline void put(Batch& batch, Field field, const Numbers& values, int world = 0) {
  batch.write(field, world, values);
}
inline void put_angle(Batch& batch, double angle, double speed = 0) {
  put(batch, Field::generalized_position, {angle});
  put(batch, Field::generalized_velocity, {speed});
}

}  // namespace manyworlds::test
