// Observers: what a Batch watches beside the step. They are chosen when the Batch is made; what is
// not chosen costs nothing. Each looks at the end of the last step of a step(n) call, on the
// threads that step, and changes no bit of the state. Its own bits are those of its world: they do
// not depend on lane, batch size, threads or instruction set.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

enum class Observer {
  contacts,     // every contact point with the impulses of the last step
  touching,     // which bodies a contact pushed in the last step
  penetration,  // the deepest overlap that the last step began with
  motion,       // energies, momenta, mass centre
  joints,       // their coordinates and speeds
  joint_loads,  // the forces and torques in them
  residual,     // how far the solver was from done
};

// A ray that every world casts against all of its shapes. Shapes of its own body, disabled bodies
// and categories that are not in its mask are not there for it.
struct Ray {
  Vec3 origin = Vec3::Zero();  // m, in the world or, with a body, in that body's frame
  Vec3 direction{1, 0, 0};     // need not be unit
  double length = std::numeric_limits<double>::infinity();  // m: it sees what is nearer
  BodyId body = {};                                         // moves and turns with it; none: stays
  std::uint32_t mask = 0xffffffffu;                         // of Filter::category
};

struct Observers {
  std::vector<Observer> what = {};
  std::vector<Ray> rays = {};
  // Contact points that a world has room for; those beyond it are only counted. 0: for as many as
  // the plan has room for.
  int contacts_per_world = 0;
};

// What can be read of them, [world] and then as given. Angular momentum is about the world's
// origin. A plan without orientation (every moving body a centred ball) never turns a ray.
//   kinetic_energy, potential_energy  J                     Observer::motion
//   mass                              kg, of dynamic bodies Observer::motion
//   momentum                          [2 or 3] N s          Observer::motion
//   angular_momentum                  [1 or 3] N m s        Observer::motion
//   mass_center                       [2 or 3] m            Observer::motion
//   penetration                       m, 0 if none          Observer::penetration
//   contact_count                     points, all of them   Observer::contacts
//   touching                          [body] 0 or 1         Observer::touching
//   joint_position, joint_speed       [coordinate]          Observer::joints
//   joint_force                       [joint][2 or 3] N     Observer::joint_loads
//   joint_torque                      [joint][1 or 3] N m   Observer::joint_loads
//   residual                          [2] m/s, rad/s        Observer::residual
//   ray_distance                      [ray] m               Observers::rays
//   ray_normal                        [ray][2 or 3]         Observers::rays
//   ray_body, ray_shape               [ray] scene body and index in Body::shapes, -1: no hit
//
// The coordinates of a joint follow one another, the joints are in their order
// (Plan::first_coordinate):
//   ball      cone and twist, rad        hinge  angle, rad      slider  travel, m
//   distance  length, m                  wheel  travel, m, and angle, rad
//   pulley    |rope at A| + ratio |rope at B|, m                fixed, target  none
// with angles in (-pi, pi], and their speeds in m/s and rad/s. Force and torque are what B gets
// from the joint, the torque about B's anchor, world axes; those of the last substep.
//
// The residual is the largest change of a component of any body's velocity, and of its spin, that
// one more sweep of the solver over all rows would make after those of the last substep (of
// tgs_soft: one more relaxing sweep); restitution comes after it. It is 0 where the velocities
// solve the rows' complementarity problem, and where nothing is awake.
enum class Observed {
  kinetic_energy,
  potential_energy,
  mass,
  momentum,
  angular_momentum,
  mass_center,
  penetration,
  contact_count,
  touching,
  joint_position,
  joint_speed,
  joint_force,
  joint_torque,
  residual,
  ray_distance,
  ray_normal,
  ray_body,
  ray_shape,
};
inline constexpr int kObservedCount = 18;
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
