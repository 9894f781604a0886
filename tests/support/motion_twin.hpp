// The slow twin of an integrator: bodies under forces and torques of any kind, in double, by
// Runge-Kutta 4 with small steps, orientations as rotation matrices that are made orthonormal again
// after every step. Shares nothing with the library but Eigen.
#pragma once

#include <functional>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds::test {

struct MovingBody {
  double mass = 1;
  Mat3 inertia = Mat3::Identity();  // body axes
  Vec3 x = Vec3::Zero(), v = Vec3::Zero(), w = Vec3::Zero();
  Mat3 r = Mat3::Identity();  // body axes in the world
};
struct Wrench {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // about the centre of mass, world
};
using Forces = std::function<std::vector<Wrench>(const std::vector<MovingBody>&)>;

void advance(std::vector<MovingBody>& bodies, const Forces& forces, double time, int steps);

}  // namespace manyworlds::test
