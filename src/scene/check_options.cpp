// Checks of the options of a scene.
#include <string>
#include <utility>

#include "src/scene/checks.hpp"

namespace manyworlds::detail {
namespace {

constexpr int kMaxRestitutionSweeps = 64;
constexpr int kMaxImpactSweeps = 1000;
constexpr int kMaxIterations = 10000;
constexpr int kMaxManifolds = 1 << 16;

void check_bounds(Checker& checker, const Eigen::AlignedBox3d& bounds) {
  constexpr char kAxis[] = {'x', 'y', 'z'};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = bounds.min()[axis];
    const double high = bounds.max()[axis];
    const std::string name = std::string(".") + kAxis[axis];
    if (low > high) {  // includes the default-constructed box, whose corners are not finite
      std::string message = "are empty: min";
      message.append(name).append(" is ").append(number_text(low));
      message.append(" m, must be at most max").append(name).append(", which is ");
      message.append(number_text(high)).append(" m");
      checker.add("options.bounds", std::move(message));
      continue;
    }
    checker.finite("options.bounds.min" + name, low, "m");
    checker.finite("options.bounds.max" + name, high, "m");
  }
}

void check_integrator(Checker& checker, const Options& o) {
  bool known = checker.named("options.integrator", o.integrator);
  if (o.rotation) known &= checker.named("options.rotation", *o.rotation);
  if (!known) return;
  const bool verlet =
      o.integrator == Integrator::verlet || o.integrator == Integrator::velocity_verlet;
  const bool symplectic = o.integrator == Integrator::symplectic_euler;
  if (o.rotation) {
    const bool splits = *o.rotation == Rotation::splitting;
    if (verlet && !splits) {
      checker.add("options.rotation", std::string("is ") + to_string(*o.rotation) + ", " +
                                          to_string(o.integrator) + " supports splitting only");
    }
    if (!verlet && !symplectic && splits) {
      checker.add("options.rotation", std::string("is splitting, ") + to_string(o.integrator) +
                                          " supports quaternion or exponential");
    }
  }
  if (!o.angular_momentum) return;
  if (o.integrator == Integrator::implicit_euler) {
    checker.add("options.angular_momentum", "is set, implicit-euler integrates angular velocities");
  } else if (verlet ||
             (symplectic && o.rotation.value_or(Rotation::splitting) == Rotation::splitting)) {
    checker.add("options.angular_momentum",
                "is set, rotation by splitting does not use it: choose quaternion or exponential");
  }
}

void check_solver(Checker& checker, const SolverOptions& o) {
  checker.named("options.solver.method", o.method);
  checker.named("options.solver.cone", o.cone);
  if (o.iterations) checker.between("options.solver.iterations", *o.iterations, 1, kMaxIterations);
  if (!(o.relaxation > 0 && o.relaxation < 2)) {
    checker.add("options.solver.relaxation",
                "is " + number_text(o.relaxation) + ", must be more than 0 and less than 2");
  }
  checker.between("options.solver.push_out_share", o.push_out_share, 0, 1);
  checker.not_negative("options.solver.tolerance", o.tolerance, "");
  checker.between("options.solver.line_search_iterations", o.line_search_iterations, 1,
                  kMaxIterations);
  checker.not_negative("options.solver.line_search_tolerance", o.line_search_tolerance, "");
  checker.positive("options.solver.impedance_ratio", o.impedance_ratio, "", kMinSize, kLargestSize);
}

void check_contact(Checker& checker, const ContactOptions& o) {
  if (o.frequency) checker.not_negative("options.contact.frequency", *o.frequency, "Hz");
  if (o.fixed_frequency) {
    checker.not_negative("options.contact.fixed_frequency", *o.fixed_frequency, "Hz");
  }
  checker.not_negative("options.contact.damping_ratio", o.damping_ratio, "");
  if (o.push_out_speed) {
    checker.not_negative("options.contact.push_out_speed", *o.push_out_speed, "m/s");
  }
  if (o.slop) checker.positive("options.contact.slop", *o.slop, "m", kMinSize, kLargestSize);
  if (o.restitution_threshold) {
    checker.not_negative("options.contact.restitution_threshold", *o.restitution_threshold, "m/s");
  }
  checker.between("options.contact.restitution_sweeps", o.restitution_sweeps, 1,
                  kMaxRestitutionSweeps);
  if (o.collision_passes) {
    checker.between("options.contact.collision_passes", *o.collision_passes, 1, kMaxPasses);
  }
  if (o.impact_sweeps) {
    checker.between("options.contact.impact_sweeps", *o.impact_sweeps, 0, kMaxImpactSweeps);
  }
}

void check_joint(Checker& checker, const JointOptions& o) {
  if (o.frequency) checker.not_negative("options.joint.frequency", *o.frequency, "Hz");
  checker.not_negative("options.joint.damping_ratio", o.damping_ratio, "");
  if (!(o.pull_speed >= 0)) {
    checker.add("options.joint.pull_speed",
                "is " + number_text(o.pull_speed) + " m/s, must be >= 0");
  }
}

void check_sleep(Checker& checker, const SleepOptions& o) {
  if (o.speed) checker.not_negative("options.sleep.speed", *o.speed, "m/s");
  checker.positive("options.sleep.time", o.time, "s", kMinTime, kLargestFinite);
}

}  // namespace

void check_options(Checker checker, const Options& options) {
  checker.positive("options.dt", options.dt, "s", kMinTime, kLargestFinite);
  if (options.substeps) checker.between("options.substeps", *options.substeps, 1, kMaxSubsteps);
  checker.finite("options.gravity", options.gravity, "m/s^2");
  checker.finite("options.wind", options.wind, "m/s");
  checker.not_negative("options.medium.density", options.medium.density, "kg/m^3");
  checker.not_negative("options.medium.viscosity", options.medium.viscosity, "Pa s");
  check_integrator(checker, options);
  check_solver(checker, options.solver);
  checker.density("options.density", options.density);
  if (options.length_unit) checker.size("options.length_unit", *options.length_unit);
  check_contact(checker, options.contact);
  check_joint(checker, options.joint);
  check_sleep(checker, options.sleep);
  if (options.contact_capacity) {
    checker.between("options.contact_capacity", *options.contact_capacity, 1, kMaxManifolds);
  }
  if (options.bounds) check_bounds(checker, *options.bounds);
}

void check_impact_sweeps(Checker checker, const Scene& scene) {
  const Options& o = scene.options;
  if (o.contact.impact_sweeps.value_or(0) <= 0) return;
  const std::string is = "is " + std::to_string(*o.contact.impact_sweeps);
  if (o.solver.method != Solver::tgs_soft) {
    checker.add("options.contact.impact_sweeps",
                is + ", must be 0 with " + to_string(o.solver.method));
  } else if (!scene.joints.empty()) {
    checker.add("options.contact.impact_sweeps",
                is + ", must be 0 in scenes with joints, which do not take part in impacts yet");
  }
}

}  // namespace manyworlds::detail
