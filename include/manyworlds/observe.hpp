// Observers: measurements of the worlds of a Batch; observed.hpp lists them. They are chosen when
// the Batch is made. Other observers cost nothing. An observer runs on the stepping threads, at the
// end of the last step of a step(n) call. It does not change the state. Its bits depend on the
// world only, not on lane, batch size, threads or instruction set.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "manyworlds/observed.hpp"
#include "manyworlds/scene.hpp"

namespace manyworlds {

// A ray that every world casts against all its shapes. The ray ignores shapes of its own body,
// disabled bodies, and categories outside its mask.
struct Ray {
  Vec3 origin = Vec3::Zero();  // m, in the world, or in the frame of `body`
  Vec3 direction{1, 0, 0};     // need not be unit
  double length = std::numeric_limits<double>::infinity();  // m, maximum distance of a hit
  BodyId body = {};                  // the ray moves with it; none: fixed in the world
  std::uint32_t mask = 0xffffffffu;  // mask of Filter::category
};

// A point on a dynamic or kinematic body.
struct Point {
  Vec3 position = Vec3::Zero();  // m, in the body's frame
  BodyId body = {};
};

struct Observers {
  std::vector<Observer> what = {};
  std::vector<Ray> rays = {};
  std::vector<Point> points = {};
  // Capacity for contact points per world. Points beyond it are only counted. 0: the plan's
  // capacity.
  int contacts_per_world = 0;
};

// Throw std::invalid_argument for a value that is not in the enumeration.
const ObserverInfo& info(Observer observer);
const ObservedInfo& info(Observed what);
int components(Observed what, Space space);
// True for items that callers list in Observers. A non-empty list chooses its observer.
inline bool is_given(ObservedItem item) {
  return item == ObservedItem::ray || item == ObservedItem::point;
}
// True if worlds of the scene support the observer. Some observers need Solver::newton, and one
// needs another solver. Batch (std::invalid_argument) and validate() of a task reject the others.
bool observable(Observer observer, const Scene& scene);
const char* to_string(Observer observer);
const char* to_string(Observed what);

// One contact point of the last step. Position and separation are those at the start of the step.
// Impulses are those on B in the whole step: impulse / dt is the mean force.
struct StepContact {
  BodyId body_a = {}, body_b = {};     // if one is fixed, it is body_a
  ShapeId shape_a = {}, shape_b = {};  // of these bodies
  Vec3 normal = Vec3::Zero();          // unit, from A to B, world
  Vec3 point = Vec3::Zero();           // m, world, half way between the surfaces
  double separation = 0;               // m, negative when the shapes overlap
  int feature = 0;                     // which features touch; equal ids persist from step to step
  double normal_impulse = 0;           // N s, along the normal, >= 0
  // A manifold has one friction impulse. Each point reports a share of it in proportion to its
  // normal impulse. The sum over the points is the impulse that the step applied.
  Vec3 friction_impulse = Vec3::Zero();  // N s, world, perpendicular to the normal
  double twist_impulse = 0;              // N m s, about the normal
};

// The hit of a ray. A ray that starts in or on a shape hits it at distance 0, with the normal
// opposite to the ray. Rays hit terrains from the free side only, segments from both sides.
struct RayHit {
  double distance = 0;         // m; the ray's length if it hits nothing
  BodyId body = {};            // none: no hit
  ShapeId shape = {};          // of that body
  Vec3 normal = Vec3::Zero();  // unit, out of the shape, world; zero: no hit
};

}  // namespace manyworlds
