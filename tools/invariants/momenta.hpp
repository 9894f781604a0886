// Momentum and energy of a system of bodies.
#pragma once

#include <vector>

#include "tools/invariants/draw.hpp"

namespace manyworlds::invariants {

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  // N s; N m s about the centre of mass
  double linear_sum = 0, angular_sum = 0;              // of magnitudes
  double kinetic = 0;                                  // J
};

std::vector<MassProperties> masses_of(const Scene& scene);
Momenta momenta_of(const std::vector<MassProperties>& masses, const std::vector<BodyNow>& bodies);

}  // namespace manyworlds::invariants
