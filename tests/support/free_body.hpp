// The slow twin of free motion: one body under gravity, in double, with steps so small that their
// error does not matter.
#pragma once

#include "manyworlds/scene.hpp"

namespace manyworlds::test {

struct FreeBody {
  Vec3 center = Vec3::Zero();            // m, centre of mass, world
  Quat rotation = Quat::Identity();      // body frame in world
  Vec3 linear_velocity = Vec3::Zero();   // m/s, of the centre
  Vec3 angular_momentum = Vec3::Zero();  // kg m^2/s about the centre, world
  MassProperties mass;

  Vec3 origin() const { return center - rotation * mass.center; }  // of the body frame
  Vec3 angular_velocity() const;
};

FreeBody start_of(const Scene& scene, const Body& body);

// Moves the body by `time` s: the exact parabola, and dq/dt = w q / 2 with w = I^-1 L at constant
// world L by classical Runge-Kutta.
void advance(FreeBody& body, const Vec3& gravity, double time, int steps);

}  // namespace manyworlds::test
