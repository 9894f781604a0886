// Observation: what a batch with observers wants to know of a group after the last step of a call,
// and where it is put down. Everything lies in lanes, in memory of the thread; src/api brings it
// into the order of worlds. What was not asked for is a null pointer.
#pragma once

#include "kernels/data/program.hpp"
#include "kernels/data/table.hpp"

namespace manyworlds::kernels {

// One point of a contact, over the whole step.
template <class Real>
struct ContactImpulse {
  std::int32_t key;  // identifies class and candidate
  std::int32_t feature;
  Real normal[3], point[3];  // world, m
  Real separation;           // m, when the step began
  Real impulse;              // N s, along the normal
  Real friction[3];          // N s, world
  Real twist;                // N m s, about the normal
};

// Rows of Observation::motion.
inline constexpr int kKinetic = 0, kPotential = 1, kMass = 2, kMomentum = 3, kAngular = 6,
                     kCentre = 9, kMotionRows = 12;

// What all worlds share of a ray.
struct RayTable {
  std::int32_t body;   // moves and turns with it; -1: world
  std::uint32_t mask;  // of the categories that it sees
};
// Rows of a ray: origin, unit direction, length. Of a body in its principal axes, from its centre
// of mass. Rows of a hit: distance (the length for a miss), normal.
inline constexpr int kRayRows = 7, kHitRows = 4;

// Rows of a coordinate: value, speed. Rows of a joint: force and torque on B.
inline constexpr int kCoordinateRows = 2, kJointRows = 6;

// Rows of a residual: m/s, rad/s.
inline constexpr int kResidualRows = 2;

template <class Real>
struct Observation {
  // Beside the slots of each list: places and features of their points, impulses of the step.
  bool slots;             // any of the next four
  Real* places[kLists];   // [slot][point][component][lane], [lane]
  Real* totals[kLists];   // [slot][point, tangent, twist][lane]; plans without restitution
  std::uint32_t* nobody;  // [body] 0

  Real* penetration;               // [lane]
  std::uint32_t* touching;         // [body] lanes
  std::int32_t* count;             // [lane] of points, also of those that there is no room for
  ContactImpulse<Real>* contacts;  // [lane][room]
  std::int32_t room;

  Real* residual;        // [row][lane]
  unsigned char* aside;  // rows and velocities while one more sweep is tried

  Real* motion;  // [row][lane]

  std::int32_t coordinates, joints;
  const JointCoordinate* coordinate;  // [coordinate]
  const std::int32_t* joint_of_part;  // [part]
  Real* coordinate_rows;              // [coordinate][row][lane]
  Real* joint_rows;                   // [joint][row][lane]

  std::int32_t rays;
  const RayTable* ray;                  // [ray]
  const std::uint32_t* fixed_category;  // [fixed shape]
  const Real* ray_rows;                 // [ray][row][lane]
  Real* placed;                         // [ray][origin, direction][lane], in the world
  Real* hit_rows;                       // [ray][row][lane]
  std::int32_t* hit_shape;  // [ray][lane]: fixed shape, or fixed shapes + collider; -1: none
};

template <class Real>
using Observe = void (*)(const WorldTables<Real>&, const GroupView<Real>&, Scratch*,
                         const Observation<Real>&);

template <class Real>
struct ObserverTable {
  // Reals that places and totals of a list need in the thread's scratch.
  std::size_t (*place_reals)(const WorldTables<Real>&, Scratch*, int list);
  std::size_t (*total_reals)(const WorldTables<Real>&, Scratch*, int list);
  // While places are given, the collide stages put down where points are; nullptr ends it.
  void (*watch)(Scratch*, Real* const* places);
  Observe<Real> accumulate[kInertiaKinds];  // after each relax pass, in plans without restitution
  Observe<Real> clear;                      // nobody touches anybody
  // Adds what the slots of the step tell of pairs that are awake, or, after collide has found them
  // again, what the stored impulses tell of pairs that are asleep.
  Observe<Real> awake[kInertiaKinds], asleep[kInertiaKinds];
  // Around one more sweep of the solver: keep what it changes; what that is, and put it back.
  std::size_t (*aside_bytes)(const WorldTables<Real>&, Scratch*);
  Observe<Real> set_aside, compare[kInertiaKinds];
  Observe<Real> motion[kInertiaKinds];
  Observe<Real> joints[kInertiaKinds], joint_loads[kInertiaKinds];
  Observe<Real> rays;            // after begin: pose rows at the current state
  RunProgram<Real> run_program;  // on what is there after these
  // One ray against one fixed pose row (64-byte aligned); whether it hits. out: a hit's rows.
  bool (*cast)(Dimension, ShapeKind, const Real* row, const Real* ray, Real* out);
};

}  // namespace manyworlds::kernels
