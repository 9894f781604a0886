// Options of a scene: step, solver, contacts, joints and sleep. Every option has a path through
// these structs ("contact.slop"), which JSON, Python and error messages use.
//
// The plan chooses the options that are empty, from the step, gravity and the bodies
// (docs/plan.md). Plan::resolved returns the chosen values and Plan::report the reasons. Default
// speeds scale with
//   V = sqrt(g L / 10), 1 m/s for bodies of 1 m
// where g is gravity (10 m/s^2 in scenes without) and L the length unit. A scene in other units,
// with times and masses scaled by similarity, therefore moves in the same way.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "manyworlds/integrator.hpp"
#include "manyworlds/solver.hpp"

namespace manyworlds {

// The solver of contact and joint rows (solver.hpp).
struct SolverOptions {
  Solver method = Solver::tgs_soft;
  // Sweeps over all rows per substep; tgs_soft counts those before the motion. newton: maximum
  // number of Newton steps. Default: 1 for tgs_soft and penalty, 100 for newton, 10 for the others.
  std::optional<int> iterations = {};
  double relaxation = 1.3;  // sor only, in (0, 2)
  // sequential_impulse, sor and nncg: the share of a penetration beyond slop, or of a joint's gap,
  // that a substep removes; and whether contacts remove it without changing velocities.
  double push_out_share = 0.2;
  bool split_impulse = false;
  // newton: stopping tolerance relative to the mean inertia, and limits of its line search.
  double tolerance = 1e-8;
  int line_search_iterations = 50;
  double line_search_tolerance = 0.01;
  // newton: ratio of the stiffness of friction rows to that of normal rows.
  double impedance_ratio = 1;
  FrictionCone cone = FrictionCone::pyramidal;  // newton only
  // newton with symplectic_euler: joint damping uses the velocity at the end of the step.
  bool implicit_damping = true;
};
// SolverOptions::iterations, or the default of the method.
int iterations_of(const SolverOptions& solver);

struct ContactOptions {
  // Hz, natural frequency of the soft contacts of tgs_soft and penalty. Default: a quarter of the
  // rate of the substeps that the plan would choose for bodies of similar mass; less if bodies
  // stand more than 15 deep.
  std::optional<double> frequency = {};
  // Hz, contacts with fixed shapes; default: twice frequency.
  std::optional<double> fixed_frequency = {};
  double damping_ratio = 10;  // for both frequencies
  // m/s, cap on the speed at which the penetration of a pair is removed, in addition to what its
  // load requires. Speeds add up along a row of bodies: n deeply overlapping bodies can separate at
  // n / 4 times the cap. tgs_soft uses up to twice the cap where a fixed shape is penetrated by
  // L / 2. Default: 1.5 V.
  std::optional<double> push_out_speed = {};
  std::optional<double> slop = {};  // m: contact margin is 4 slop. Default: 0.005 L
  // m/s, impacts slower than this do not bounce. The speed is the one that gravity would give by
  // the end of the step. Default: the speed that gravity and attractors give in two collision
  // passes, the larger of the two bodies'; a resting body reaches half of it. Without gravity the
  // default is 0: set a threshold if other forces press bodies together that should rest.
  std::optional<double> restitution_threshold = {};
  int restitution_sweeps = 16;  // maximum number of restitution passes
  // tgs_soft: reduces the sway of tall stacks; the step is slightly faster without.
  bool friction_in_bias_pass = true;
  bool cast_against_fixed = true;    // stop fast bodies at thin fixed shapes
  bool cast_between_moving = false;  // also at moving shapes, for bullets
  // Number of equal passes of a step. Each pass finds contacts and takes its share of the
  // substeps. Default: 1; the plan chooses more for bodies that gravity moves by much of their
  // thickness in a step (docs/plan.md). newton finds contacts in every substep and has one pass.
  std::optional<int> collision_passes = {};
  // tgs_soft: maximum number of additional sweeps over the contacts that an impact reaches, in each
  // pass of a substep. They share a plastic impact out among several bodies, such as a ball that
  // falls on two others, whatever the order of the contacts. 0: none. Default: 64 in scenes of up
  // to 12 moving bodies without joints, else 0. Scenes with joints have none.
  std::optional<int> impact_sweeps = {};
};

// How tgs_soft solves joints. `sweep` solves them one after the other in every substep. `tree`
// solves all joints of a tree as one system, so that light bodies hold heavy loads. A tree consists
// of bodies connected by ball, hinge, slider, fixed and wheel joints. Up to four joints without
// drives or limits may close loops, unless a joint of the tree can break. Distance joints, pulleys
// and targets attached to a tree are solved after it, with the effective mass of the whole tree.
// Other joints are swept. `manyworlds plan` prints how many joints are solved in which way.
enum class JointMethod { sweep, tree };
const char* to_string(JointMethod method);

// Correction of joint gaps, which acts as a spring and damper. Its force has no cap: values stiffer
// than the default may oscillate.
struct JointOptions {
  // Default: tree if sweeps with four substeps do not hold the joints (docs/plan.md), else sweep.
  std::optional<JointMethod> method = {};
  // Hz. Default: a quarter of the substep rate; sequential_impulse, sor and nncg use hard rows.
  // Trees are always hard and close gaps at the rate of such a spring, by default within a substep.
  std::optional<double> frequency = {};
  double damping_ratio = 2;
  // m/s per length unit, and rad/s: cap on the speed at which a gap closes, for scenes whose joints
  // start far apart. A low cap lets chains stretch under heavy loads. By default, a loop of a tree
  // whose joints start apart by more than a hundredth of their arms closes within 4 s.
  double pull_speed = std::numeric_limits<double>::infinity();
};

// A body is at rest while |v| + |w| r is below `speed`, where r is the radius of its bounding
// sphere. An island falls asleep when all its bodies have been at rest for `time`
// (BatchOptions::sleep).
struct SleepOptions {
  std::optional<double> speed = {};  // m/s. Default: 0.06 V
  double time = 0.5;                 // s
};

// newton: the fluid around the bodies. Drag acts on the box that has a body's mass and moments of
// inertia (MuJoCo, "Fluid forces", inertia model).
struct Medium {
  double density = 0;    // kg/m^3
  double viscosity = 0;  // Pa s
  bool operator==(const Medium&) const = default;
};

struct Options {
  double dt = 1.0 / 60.0;  // s, one step
  // Substeps of the solver and the integrator per step. Default: 4; the plan chooses more for
  // tgs_soft if sizes, standing columns or mass ratios need them.
  std::optional<int> substeps = {};
  Eigen::Vector3d gravity{0, 0, -10};  // m/s^2 (planar scenes: set {0, -10, 0})
  // m/s, velocity of the air (Body::linear_drag) and of the medium.
  Eigen::Vector3d wind{0, 0, 0};
  double density = 1000;  // kg/m^3 or kg/m^2, for shapes without a density
  Integrator integrator = Integrator::symplectic_euler;
  Medium medium = {};
  // Default: splitting with symplectic_euler, verlet and velocity_verlet, else exponential. verlet
  // and velocity_verlet support splitting only; the other integrators do not support it.
  std::optional<Rotation> rotation = {};
  // Integrate angular momentum instead of angular velocity. Not with splitting or implicit_euler.
  bool angular_momentum = false;
  // L, m. Default: the size of the smallest moving shape, which is the cube root of its volume
  // (planar: the square root of its area); 1 in scenes without one.
  std::optional<double> length_unit = {};

  SolverOptions solver = {};
  ContactOptions contact = {};
  JointOptions joint = {};
  SleepOptions sleep = {};

  // Capacity for manifolds between moving bodies in a world, for manifolds of several points and of
  // one point each. Default: 4 per shape (planar: 3) and 8 more. The step omits manifolds beyond it
  // and sets Status::contact_overflow.
  std::optional<int> contact_capacity = {};

  // A world is lost if a body's position leaves this box. Default: no bounds.
  std::optional<Eigen::AlignedBox3d> bounds = {};
};

}  // namespace manyworlds
