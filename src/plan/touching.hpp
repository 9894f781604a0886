// The bodies that touch where a scene starts, from the geometry of their shapes. Used inside
// src/plan only.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

// A dynamic body without joints.
struct StandingBody {
  int body = -1;
  double mass = 0, gravity_scale = 1;              // kg
  double size = 0;                                 // m, cube (planar: square) root of its volume
  Vec3 center = Vec3::Zero(), top = Vec3::Zero();  // m, world: centre of mass, highest point
  Mat3 inertia = Mat3::Zero();                     // kg m^2, world
};

struct TouchingPoint {
  Vec3 place = Vec3::Zero();  // m, world
  double mass = 0;            // kg, effective mass of its row along the normal
};

struct Touching {
  int a = -1, b = -1;  // of TouchingBodies::bodies; a is -1 if it is fixed or on joints
  bool fixed = false;  // a is no dynamic body
  double friction = 0;
  Vec3 normal = Vec3::Zero();  // from a to b
  // m, radii of round surfaces, which move under the contact when their bodies rotate
  double round_a = 0, round_b = 0;
  std::vector<TouchingPoint> points = {};  // at most four
};

struct TouchingBodies {
  std::vector<StandingBody> bodies;
  std::vector<Touching> touchings;
};

TouchingBodies touching_bodies(const Scene& scene);

}  // namespace manyworlds
