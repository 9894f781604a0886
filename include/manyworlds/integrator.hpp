// How bodies move: integrators of free flight, and of rotation.
//
// A step takes Options::substeps steps of an integrator of h = dt / substeps each. Forces are
// gravity, wind and drag, attractors, what Batch and controls give, and springs: joints that are
// nothing but a spring of given stiffness and damping (DistanceJoint without a limit, TargetJoint
// without max_force, neither with a breaking load). Order of the error at a fixed time, float64,
// and evaluations of the forces per h:
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
// In a step in which contacts or joints other than springs may act on a body, it moves by the
// substeps of the solver (order 1), whatever the integrator. Its springs are then implicit rows, as
// by default. Bodies that hang on nothing but springs never fall asleep with another integrator
// than the default, since nothing touches them.
#pragma once

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

enum class Integrator {
  // Velocities first, positions by the new ones. Springs are soft rows of the solver, implicit;
  // what the substeps fall too far under constant forces is taken back ("exact drift").
  symplectic_euler,
  explicit_euler,
  // One linearised solve for the velocities at the end of h: springs, drag and gyroscopic term are
  // implicit, so that it is stable however stiff they are; attractors are explicit.
  implicit_euler,
  verlet,           // position form: drift, kick, drift
  velocity_verlet,  // kick, drift, kick
  runge_kutta4,     // the classical one
  // Of Solver::newton alone: symplectic_euler in which all that depends on velocities is implicit,
  // but centrifugal and gyroscopic forces of links that others are jointed to.
  implicit_fast,
};
const char* to_string(Integrator integrator);

enum class Rotation {
  splitting,    // rotates about one principal axis after the other; keeps |L| and bounds energy
  quaternion,   // q' = 1/2 w q, normalised
  exponential,  // q = exp(u) q, u' = dexp^-1(u) w (Munthe-Kaas)
};
const char* to_string(Rotation rotation);

}  // namespace manyworlds
