// Integrators of free motion and of rotation.
//
// A step takes Options::substeps steps of an integrator, of h = dt / substeps each. Forces are
// gravity, wind and drag, attractors, forces set by Batch and controls, and springs. Springs are
// joints with only a stiffness and a damping: DistanceJoint without a limit and TargetJoint without
// max_force, both without a breaking load. Order of the error at a fixed time in float64, and force
// evaluations per h:
//
//                      forces of position   with drag or damping   free rotation   evaluations
//   symplectic_euler   2 attractors, exact  1 (implicit)           2 splitting,    1
//                      constant forces;                            1 the others
//                      1 springs
//   explicit_euler     1                    1                      1               1
//   implicit_euler     1                    1                      1               1 and a solve
//   verlet             2                    2                      2               1 or 2
//   velocity_verlet    2                    2                      2               2 or 4
//   runge_kutta4       4                    4                      4               4
//
// In a step in which contacts or other joints may act on a body, the body moves by the substeps of
// the solver (order 1), with any integrator. Its springs are then implicit rows, as by default.
// Bodies connected by springs only fall asleep with the default integrator only.
#pragma once

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

enum class Integrator {
  // Updates velocities, then positions with the new velocities. Springs are implicit soft rows of
  // the solver. The first-order error of the position under constant forces is corrected.
  symplectic_euler,
  explicit_euler,
  // One linearised solve for the velocities at the end of h. Springs, drag and the gyroscopic term
  // are implicit and therefore stable at any stiffness; attractors are explicit.
  implicit_euler,
  verlet,           // position form: drift, kick, drift
  velocity_verlet,  // kick, drift, kick
  runge_kutta4,     // the classical method
  // Solver::newton only: symplectic_euler with implicit velocity-dependent forces, except
  // centrifugal and gyroscopic forces of links that have child links.
  implicit_fast,
};
const char* to_string(Integrator integrator);

enum class Rotation {
  splitting,    // rotates about each principal axis in sequence; keeps |L| and bounds the energy
  quaternion,   // q' = 1/2 w q, normalised
  exponential,  // q = exp(u) q, u' = dexp^-1(u) w (Munthe-Kaas)
};
const char* to_string(Rotation rotation);

}  // namespace manyworlds
