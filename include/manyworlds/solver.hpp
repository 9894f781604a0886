// How contacts and joints are solved: what runs over their rows in every substep of h = dt /
// substeps.
//
// A sweep visits every joint, then every contact, and gives each the impulse that its own equation
// asks for, with what those before it have done (Gauss-Seidel); contact impulses stay >= 0 and
// friction within its cone. All solvers share the same rows and keep the impulses of a step to
// start the next one from, but for penalty.
//
//                        of a substep                        rows                overlap is removed
//   tgs_soft             a sweep, motion, a relaxing sweep    soft               by the soft rows,
//   the
//                                                                                 speed of it taken
//                                                                                 back
//   sequential_impulse   `iterations` sweeps, motion          hard               a share per
//   substep sor                  the same, each change times          hard               a share
//   per substep
//                        `relaxation`
//   nncg                 the same, with conjugate steps       hard               a share per
//   substep
//                        between sweeps
//   penalty              `iterations` sweeps from nothing,    soft               by the soft rows
//                        motion
//
// Hard rows of joints that have come apart by s ask for the speed Options::push_out_share s / h
// (Baumgarte), those of contacts that overlap by s for the same of s - slop, at most
// push_out_speed. That speed stays with the bodies, unless Options::split_impulse moves overlapping
// bodies apart without one.
// Soft rows are springs and dampers of Options::contact_frequency and joint_frequency, implicit
// one by one (Catto 2011). In sequential_impulse, sor and nncg joints are soft only if
// joint_frequency is given; springs, limits with springs and drives keep their equations in all.
#pragma once

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
};
const char* to_string(Solver solver);
// Whether overlaps and gaps close by a share per substep: all but tgs_soft and penalty.
bool has_hard_rows(Solver solver);

}  // namespace manyworlds
