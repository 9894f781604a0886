// Names of the plan's enumerators, as people type and read them.
#include "manyworlds/plan.hpp"

namespace manyworlds {

const char* to_string(Feature feature) {
  switch (feature) {
    case Feature::orientation: return "orientation";
    case Feature::inertia: return "inertia";
    case Feature::friction: return "friction";
    case Feature::restitution: return "restitution";
    case Feature::contacts: return "contacts";
    case Feature::drag: return "drag";
    case Feature::gravity: return "gravity";
    case Feature::joints: return "joints";
  }
  return "unknown";
}

const char* to_string(BroadPhase broad_phase) {
  switch (broad_phase) {
    case BroadPhase::automatic: return "automatic";
    case BroadPhase::all_pairs: return "all-pairs";
    case BroadPhase::sort_and_sweep: return "sort-and-sweep";
    case BroadPhase::sparse: return "sparse";
  }
  return "unknown";
}

const char* to_string(Integrator integrator) {
  switch (integrator) {
    case Integrator::symplectic_euler: return "symplectic-euler";
    case Integrator::explicit_euler: return "explicit-euler";
    case Integrator::implicit_euler: return "implicit-euler";
    case Integrator::verlet: return "verlet";
    case Integrator::velocity_verlet: return "velocity-verlet";
    case Integrator::runge_kutta4: return "runge-kutta4";
  }
  return "unknown";
}

const char* to_string(Solver solver) {
  switch (solver) {
    case Solver::tgs_soft: return "tgs-soft";
    case Solver::sequential_impulse: return "sequential-impulse";
    case Solver::sor: return "sor";
    case Solver::nncg: return "nncg";
    case Solver::penalty: return "penalty";
  }
  return "unknown";
}

bool has_hard_rows(Solver solver) {
  return solver != Solver::tgs_soft && solver != Solver::penalty;
}
int iterations_of(const Options& options) {
  return options.iterations.value_or(has_hard_rows(options.solver) ? 10 : 1);
}

const char* to_string(Rotation rotation) {
  switch (rotation) {
    case Rotation::splitting: return "splitting";
    case Rotation::quaternion: return "quaternion";
    case Rotation::exponential: return "exponential";
  }
  return "unknown";
}

}  // namespace manyworlds
