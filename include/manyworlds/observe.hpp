// Observers: what a Batch watches beside the step; observed.hpp lists them. They are chosen when
// the Batch is made; what is not chosen costs nothing. Each looks at the end of the last step of a
// step(n) call, on the threads that step, and changes no bit of the state. Its own bits are those
// of its world: they do not depend on lane, batch size, threads or instruction set.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "manyworlds/observed.hpp"
#include "manyworlds/scene.hpp"

namespace manyworlds {

// A ray that every world casts against all of its shapes. Shapes of its own body, disabled bodies
// and categories that are not in its mask are not there for it.
struct Ray {
  Vec3 origin = Vec3::Zero();  // m, in the world or, with a body, in that body's frame
  Vec3 direction{1, 0, 0};     // need not be unit
  double length = std::numeric_limits<double>::infinity();  // m: it sees what is nearer
  BodyId body = {};                                         // fixed to it; none: stays
  std::uint32_t mask = 0xffffffffu;                         // of Filter::category
};

// A point that is fixed to a body that can move.
struct Point {
  Vec3 position = Vec3::Zero();  // m, in the body's frame
  BodyId body = {};
};

struct Observers {
  std::vector<Observer> what = {};
  std::vector<Ray> rays = {};
  std::vector<Point> points = {};
  // Contact points that a world has room for; those beyond it are only counted. 0: for as many as
  // the plan has room for.
  int contacts_per_world = 0;
};

// Both throw std::invalid_argument for what is no value of the enumeration.
const ObserverInfo& info(Observer observer);
const ObservedInfo& info(Observed what);
int components(Observed what, Space space);
// Of what users give as a list of Observers, which chooses its observer.
inline bool is_given(ObservedItem item) {
  return item == ObservedItem::ray || item == ObservedItem::point;
}
// Whether worlds of the scene have what it sees: some observers need Solver::newton, and one needs
// another solver. A Batch refuses the others (std::invalid_argument), as a task does (validate()).
bool observable(Observer observer, const Scene& scene);
const char* to_string(Observer observer);
const char* to_string(Observed what);

// One contact point of the last step. Where it lies is what the step began with, the impulses are
// what B received in the whole step: impulse / dt is the mean force.
struct StepContact {
  BodyId body_a = {}, body_b = {};     // when one is fixed it is body_a
  ShapeId shape_a = {}, shape_b = {};  // of these bodies
  Vec3 normal = Vec3::Zero();          // unit, from A to B, world
  Vec3 point = Vec3::Zero();           // m, world, half way between the surfaces
  double separation = 0;               // m, negative when the shapes overlap
  int feature = 0;                     // which features touch; equal ids persist from step to step
  double normal_impulse = 0;           // N s, along the normal, >= 0
  // Of a manifold's points each reports the share of its friction that it has of its normal
  // impulse: what the points report adds up to what the step applied.
  Vec3 friction_impulse = Vec3::Zero();  // N s, world, across the normal
  double twist_impulse = 0;              // N m s, about the normal
};

// Where a ray ends. One that begins in a shape or on it ends there, at distance 0, with the normal
// against it. A terrain is hit from its free side only, a segment from both.
struct RayHit {
  double distance = 0;         // m; the ray's length where it hits nothing
  BodyId body = {};            // none: no hit
  ShapeId shape = {};          // of that body
  Vec3 normal = Vec3::Zero();  // unit, out of the shape, world; zero: no hit
};

}  // namespace manyworlds
