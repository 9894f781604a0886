#include "src/api/observable.hpp"

#include "src/base/enum_names.hpp"

namespace manyworlds {

namespace {

bool is_newton(const Scene& scene) { return scene.options.solver.method == Solver::newton; }

std::string scene_text(const Scene& scene) {
  return scene.name.empty() ? "this scene" : "the scene '" + scene.name + "'";
}

// In words that are observers, terms and fields alike.
const char* instead_of(Observed what) {
  switch (what) {
    case Observed::link_inertia:
    case Observed::link_product:
    case Observed::link_moment: return "the parameter mass of the body and its link_center";
    case Observed::link_mass: return "the parameter mass of the body";
    case Observed::link_angular_velocity: return "angular_velocity of the body";
    case Observed::link_velocity: return "the linear velocity of the body";
    case Observed::actuator_force: return "drive_force of the joint";
    case Observed::constraint_force:
      return "joint_force and joint_torque of the joint, or external_force of the body";
    case Observed::tendon_length: return "joint_position of its joints";
    case Observed::tendon_velocity: return "joint_speed of its joints";
    default: return "another observer";
  }
}
const char* instead_of(Observer observer) {
  switch (observer) {
    case Observer::link_inertias: return "the parameter mass of bodies and the observer links";
    case Observer::link_velocities: return "the fields linear_velocity and angular_velocity";
    case Observer::dof_forces: return "the observers drives, joint_loads and link_forces";
    case Observer::tendons: return "the observer joints";
    default: return "another observer";
  }
}

std::string never_left(const Scene& scene) {
  return scene_text(scene) +
         " does not support it: the newton solver iterates to its tolerance and leaves no "
         "residual; use SolverOptions::tolerance instead";
}

}  // namespace

bool observable(Observer observer, const Scene& scene) {
  switch (checked_enum(observer)) {
    case Observer::residual: return !is_newton(scene);
    case Observer::link_inertias:
    case Observer::link_velocities:
    case Observer::dof_forces:
    case Observer::tendons: return is_newton(scene);
    default: return true;
  }
}

std::string needs_newton(const Scene& scene, const std::string& instead) {
  return scene_text(scene) + " does not support it: its solver is " +
         to_string(scene.options.solver.method) + ", and only newton has trees of links; use " +
         instead + " instead";
}

std::string why_not_observable(Observer observer, const Scene& scene) {
  return observer == Observer::residual ? never_left(scene)
                                        : needs_newton(scene, instead_of(observer));
}
std::string why_not_observable(Observed what, const Scene& scene) {
  return what == Observed::residual ? never_left(scene) : needs_newton(scene, instead_of(what));
}

}  // namespace manyworlds
