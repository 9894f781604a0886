// A chain of ten links under a load, swung from the horizontal: what heavy loads on joints do.
#pragma once

#include "scenes/loaded_trees.hpp"
#include "tools/report/reference.hpp"

namespace manyworlds::report {

inline constexpr double kLink = 0.5;  // m
inline constexpr int kLinks = 10;

// Links of 1 kg; the load is the last one's mass, kg.
inline Scene swung_chain(double load, int links = kLinks) {
  Scene scene = empty(Space::planar, 10);
  scenes::add_rods(scene, links, kLink, load, HingeJoint{});
  for (Body& link : scene.bodies) link.jitter.linear_velocity = {0, 0.01, 0};
  return scene;
}
// M g L, J.
inline double fall_of_chain(double load) { return (kLinks - 1 + load) * 10 * kLinks * kLink; }

}  // namespace manyworlds::report
