// Solvers of the contact and joint rows, which run in every substep of h = dt / substeps.
//
// A sweep visits every joint, then every contact, and applies the impulse that solves its own
// equation with the current velocities (Gauss-Seidel). Contact impulses stay >= 0 and friction
// stays within its cone. All solvers use the same rows. In a substep:
//
//   tgs_soft:            `iterations` sweeps with soft rows, motion, and a relaxing sweep with hard
//                        ones, which takes back the speed that removes overlap
//   sequential_impulse:  `iterations` sweeps with hard rows, motion
//   sor:                 the same, each change of an impulse times `relaxation`
//   nncg:                the same as sequential_impulse, with conjugate steps between sweeps
//   penalty:             `iterations` sweeps with soft rows, from impulses of 0, motion
//
// All solvers but penalty start a step with the impulses of the previous step.
//
// newton uses another formulation. Bodies are links of trees in joint coordinates, and each of the
// `substeps` steps of dt / substeps computes the accelerations a that minimise
//   1/2 (a - a0)' M (a - a0) + sum of s(J a - r),
// where M is the joint-space inertia, a0 the acceleration without constraints, and s the cost of
// limits and contacts whose reference acceleration is r (Compliance). The problem is convex, and
// Newton's method finds its minimum (Todorov 2014). Models move as in MuJoCo.
//
// Hard rows of joints with a gap s have the target speed SolverOptions::push_out_share s / h
// (Baumgarte 1972). Contacts with a penetration s have the same with s - slop, at most
// ContactOptions::push_out_speed. The bodies keep that speed, and its impulses count as loads
// (Observer, Joint::break_force), unless SolverOptions::split_impulse separates bodies without
// changing velocities. Soft rows are springs and dampers of ContactOptions::frequency and
// JointOptions::frequency, each integrated implicitly (Catto 2011). Friction is hard in all
// solvers. Joints of sequential_impulse, sor and nncg are soft only if JointOptions::frequency is
// set. Springs, limits with springs and drives have the same equations in all solvers.
#pragma once

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

enum class Solver {
  tgs_soft,
  sequential_impulse,  // projected Gauss-Seidel
  // Successive over-relaxation. Bounded rows of joints are not over-relaxed.
  sor,
  // Nonsmooth nonlinear conjugate gradients, Fletcher-Reeves with a restart whenever the step grows
  // (Silcowitz-Hansen, Niebe, Erleben 2010). The last iteration is a plain sweep.
  nncg,
  penalty,  // implicit spring-dampers without memory
  newton,   // trees in joint coordinates, MuJoCo's soft constraints
};
const char* to_string(Solver solver);

// Friction cone of newton: a pyramid of four edges, or a round cone.
enum class FrictionCone { pyramidal, elliptic };
const char* to_string(FrictionCone cone);

// True if a share of each penetration and gap is removed per substep: all solvers but tgs_soft,
// penalty and newton.
bool has_hard_rows(Solver solver);

}  // namespace manyworlds
