// Options of a scene: the step, its solver, contacts, joints and sleep. Every option has a path
// through these structs ("contact.slop"), which JSON, Python and error messages share.
//
// What is empty here the plan chooses from the step, gravity and the bodies (docs/plan.md);
// Plan::resolved says what it chose, and Plan::report why. Its speeds follow
//   V = sqrt(g L / 10), 1 m/s for bodies of 1 m
// with the gravity g, without any 10 m/s^2, and the length unit L, so that a scene in other units,
// its times and masses scaled by the laws of similarity, does the same.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "manyworlds/integrator.hpp"
#include "manyworlds/solver.hpp"

namespace manyworlds {

// What runs over the rows of contacts and joints (solver.hpp).
struct SolverOptions {
  Solver method = Solver::tgs_soft;
  // Sweeps over all rows per substep, of tgs_soft those before the motion; of newton its steps at
  // most. Default: 1 for tgs_soft and penalty, 100 for newton, 10 for the others, which are usually
  // given fewer substeps.
  std::optional<int> iterations = {};
  double relaxation = 1.3;  // of sor, in (0, 2)
  // Of sequential_impulse, sor and nncg: the share of an overlap beyond slop, or of a joint's gap,
  // that a substep removes, and whether contacts do so without leaving a speed.
  double push_out_share = 0.2;
  bool split_impulse = false;
  // Of newton: where it stops, relative to the mean inertia, and the same of its line search.
  double tolerance = 1e-8;
  int line_search_iterations = 50;
  double line_search_tolerance = 0.01;
  // Of newton: stiffness of friction against that of normal rows.
  double impedance_ratio = 1;
  FrictionCone cone = FrictionCone::pyramidal;  // of newton
  // Of newton with symplectic_euler: dampers of joints act at the end of the step.
  bool implicit_damping = true;
};
// SolverOptions::iterations, or the default of the method.
int iterations_of(const SolverOptions& solver);

struct ContactOptions {
  // Hz, of the soft contacts of tgs_soft and penalty. Default: a quarter of the rate of as many
  // substeps as the plan would take if bodies had much the same mass, whatever is taken.
  std::optional<double> frequency = {};
  // Hz, of those against fixed shapes; default: twice frequency.
  std::optional<double> fixed_frequency = {};
  double damping_ratio = 10;  // of both
  // m/s: cap on the speed at which a pair's overlap is removed, but for what its load takes. Speeds
  // of bodies add up along a row: a row of n that overlap deeply can part at n / 4 times as much.
  // tgs_soft takes up to twice as much where a fixed shape overlaps by L / 2. Default: 1.5 V.
  std::optional<double> push_out_speed = {};
  std::optional<double> slop = {};  // m: contact margin is 4 slop. Default: 0.005 L
  // m/s: slower impacts do not bounce, by the speed that gravity would bring them to in the step.
  // Default: what gravity and attractors give in two steps, the larger of both bodies', as what
  // rests has that of one. So nothing without: where other forces press together what shall rest,
  // give it.
  std::optional<double> restitution_threshold = {};
  int restitution_sweeps = 16;  // most repeats of the restitution pass
  // Of tgs_soft: much less sway of tall stacks; off is a little faster.
  bool friction_in_bias_pass = true;
  bool cast_against_fixed = true;    // stop fast bodies at thin fixed shapes
  bool cast_between_moving = false;  // and at moving ones; for bullets
};

// How joints are solved: one after the other in every substep (sweep), or those of a tree at once
// (tree), in which heavy loads on light bodies hold as well as light ones. Trees are what hangs
// together by ball joints, hinges, sliders, fixed and wheel joints; up to four of
// them without drives or limits may close loops, unless one of what hangs together may break.
// Other joints are swept over. Of tgs_soft.
enum class JointMethod { sweep, tree };
const char* to_string(JointMethod method);

// What joints hold together is pulled back as by a spring and damper. Not capped: stiffer than the
// default may ring.
struct JointOptions {
  // Default: tree where sweeps of four substeps do not hold the joints (docs/plan.md), else sweep.
  std::optional<JointMethod> method = {};
  // Hz; default a quarter per substep, and hard rows in sequential_impulse, sor and nncg. Trees are
  // hard whatever it is, and close what is apart at the rate of such a spring; by default in a
  // substep.
  std::optional<double> frequency = {};
  double damping_ratio = 2;
  // m/s per length unit, and rad/s: cap on the speed at which a joint closes what has come apart.
  // For scenes whose joints begin far apart; under heavy loads a low one lets chains stretch.
  // Unless it is given, joints of a tree's loop that begin apart by more than a hundredth of their
  // arms close what they begin apart by within 4 s.
  double pull_speed = std::numeric_limits<double>::infinity();
};

// A body is at rest while |v| + |w| radius of its bounding sphere stays below speed; an island all
// of whose bodies have been at rest for that time falls asleep (BatchOptions::sleep).
struct SleepOptions {
  std::optional<double> speed = {};  // m/s. Default: 0.06 V
  double time = 0.5;                 // s
};

// Of newton: what bodies move through. Drag acts on the box of a body's mass and moments of inertia
// (MuJoCo, "Fluid forces", inertia model).
struct Medium {
  double density = 0;    // kg/m^3
  double viscosity = 0;  // Pa s
  bool operator==(const Medium&) const = default;
};

struct Options {
  double dt = 1.0 / 60.0;  // s, one step
  // Of the solver and of the integrator, per step. Default: 4, and of tgs_soft more where sizes,
  // standing columns or ratios of mass ask for it.
  std::optional<int> substeps = {};
  Eigen::Vector3d gravity{0, 0, -10};  // m/s^2 (planar scenes: set {0, -10, 0})
  // m/s, of the air that Body::linear_drag is against, and of the medium.
  Eigen::Vector3d wind{0, 0, 0};
  double density = 1000;  // kg/m^3 or kg/m^2, for shapes that give none
  Integrator integrator = Integrator::symplectic_euler;
  Medium medium = {};
  // Default: splitting with symplectic_euler and the Verlets, which take nothing else but
  // symplectic_euler; exponential with the others.
  std::optional<Rotation> rotation = {};
  // Spins are integrated as angular momenta instead of angular velocities, without splitting and
  // not by implicit_euler.
  bool angular_momentum = false;
  // L, m. Default: the size of the smallest shape that moves, the cube root of its volume (planar:
  // the square root of its area); 1 where none does.
  std::optional<double> length_unit = {};

  SolverOptions solver = {};
  ContactOptions contact = {};
  JointOptions joint = {};
  SleepOptions sleep = {};

  // Manifolds between moving bodies that a world has room for, of each kind (of several points, of
  // one). Default: 4 per shape (planar: 3) and 8 more. What exceeds it is left out of the step and
  // flagged (Status::contact_overflow).
  std::optional<int> contact_capacity = {};

  // A world is lost when a body's position leaves this box. Default: no bounds.
  std::optional<Eigen::AlignedBox3d> bounds = {};
};

}  // namespace manyworlds
