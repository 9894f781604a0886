// How contacts and joints are solved: what runs over their rows in every substep of h = dt /
// substeps.
//
// A sweep visits every joint, then every contact, and gives each the impulse that its own equation
// asks for, with what those before it have done (Gauss-Seidel); contact impulses stay >= 0 and
// friction within its cone. All solvers share the same rows. What each does in a substep:
//
//   tgs_soft:            `iterations` sweeps with soft rows, motion, and a relaxing sweep with hard
//                        ones, which takes back the speed that removes overlap
//   sequential_impulse:  `iterations` sweeps with hard rows, motion
//   sor:                 the same, each change of an impulse times `relaxation`
//   nncg:                the same as sequential_impulse, with conjugate steps between sweeps
//   penalty:             `iterations` sweeps with soft rows, from impulses of 0, motion
//
// All but penalty begin a step with the impulses of the last one.
//
// newton is another method altogether: bodies are links of trees that move in the coordinates of
// their joints (free bodies in their own), and each of the `substeps` steps of dt / substeps finds
// the accelerations a that minimise
//   1/2 (a - a0)' M (a - a0) + sum of s(J a - r),
// with the joint-space inertia M, the accelerations a0 without constraints, and the cost s of
// limits and contacts that ask for the acceleration r (Compliance). It has one minimum, which
// Newton's method finds exactly (Todorov 2014). Models move in it as in MuJoCo.
//
// Hard rows of joints that have come apart by s ask for the speed SolverOptions::push_out_share
// s / h (Baumgarte 1972), those of contacts that overlap by s for the same of s - slop, at most
// ContactOptions::push_out_speed. That speed stays with the bodies, and its impulses count as loads
// (Observer, Joint::break_force), unless SolverOptions::split_impulse moves overlapping bodies
// apart without one. Soft rows are springs and dampers of ContactOptions::frequency and
// JointOptions::frequency, implicit one by one (Catto 2011); friction is hard in all. In
// sequential_impulse, sor and nncg joints are soft only if JointOptions::frequency is given.
// Springs, limits with springs and drives keep their equations in all.
#pragma once

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

enum class Solver {
  tgs_soft,
  sequential_impulse,  // projected Gauss-Seidel
  // Successive over-relaxation. Rows that may be bounded, of joints, are not over-relaxed.
  sor,
  // Nonsmooth nonlinear conjugate gradients, Fletcher-Reeves with a restart whenever the step grows
  // (Silcowitz-Hansen, Niebe, Erleben 2010). Ends with a sweep.
  nncg,
  penalty,  // implicit spring-dampers without memory
  newton,   // trees in joint coordinates, MuJoCo's soft constraints
};
const char* to_string(Solver solver);

// What friction of newton may do: stay within the four edges of a pyramid, or within a round cone.
enum class FrictionCone { pyramidal, elliptic };
const char* to_string(FrictionCone cone);

// Whether overlaps and gaps close by a share per substep: all but tgs_soft, penalty and newton.
bool has_hard_rows(Solver solver);

}  // namespace manyworlds
