// A chain of ten links under a load, swung from the horizontal: what heavy loads on joints do.
#pragma once

#include "scenes/loaded_trees.hpp"
#include "tools/report/reference.hpp"
#include "tools/report/stability.hpp"

namespace manyworlds::report {

inline constexpr double kLink = 0.5;  // m
inline constexpr int kLinks = 10;
// From the second swing back on links under light loads turn by a third of a radian a substep where
// the chain is drawn taut, which no first-order step resolves: MuJoCo's joints, which cannot open,
// lose more than a tenth in 10 s by 16 times the steps (bench/python/swung_chain.py).
inline constexpr double kLashing = 5;  // s

// Links of 1 kg; the load is the last one's mass, kg.
inline Scene swung_chain(double load, int links = kLinks) {
  Scene scene = empty(Space::planar, 10);
  scenes::add_rods(scene, links, kLink, load, HingeJoint{});
  for (Body& link : scene.bodies) link.jitter.linear_velocity = {0, 0.01, 0};
  return scene;
}
// M g L, J.
inline double fall_of_chain(double load) { return (kLinks - 1 + load) * 10 * kLinks * kLink; }
// What its energy has gained, of M g L. Velocities of symplectic Euler steps are those of the
// middle of the substep that led there (leapfrog: Hairer, Lubich and Wanner 2006, I.1.4), and so is
// the height that goes with them: with the height at the end a free fall from rest to v seems to
// lose m g v h / 2, which it has again when it comes to rest.
inline double gain_of_chain(const Seen& seen, int world, double load) {
  const Options o = seen.batch().plan().resolved();
  const double h = o.dt / *o.substeps;
  double energy = seen.energy(world) - seen.start_energy(world);
  for (int link = 0; link < kLinks; ++link) {
    const double mass = link + 1 == kLinks ? load : 1;
    energy -= mass * 10 * seen.velocity(world, link).y() * h / 2;
  }
  return energy / fall_of_chain(load);
}

}  // namespace manyworlds::report
