// The members of options (options.hpp) by name, in addition to members.hpp.
#pragma once

#include "manyworlds/member_list.hpp"
#include "manyworlds/options.hpp"

namespace manyworlds {

template <>
struct Members<SolverOptions> {
  static constexpr const char* name = "SolverOptions";
  static void visit(auto& value, auto&& visit) {
    auto& [method, iterations, relaxation, push_out_share, split_impulse, tolerance,
           line_search_iterations, line_search_tolerance, impedance_ratio, cone, implicit_damping] =
        value;
    const Counted swept =
        counted_if(method != Solver::tgs_soft || iterations_of(value) != 1, "the default solver");
    const Counted hard = counted_if(has_hard_rows(method), "only solvers with hard rows use it");
    visit("method", method, swept), visit("iterations", iterations, swept);
    visit("relaxation", relaxation, counted_if(method == Solver::sor, "only sor uses it"));
    visit("push_out_share", push_out_share, hard), visit("split_impulse", split_impulse, hard);
    const Counted newton = counted_if(method == Solver::newton, "only newton uses it");
    visit("tolerance", tolerance, newton);
    visit("line_search_iterations", line_search_iterations, newton);
    visit("line_search_tolerance", line_search_tolerance, newton);
    visit("impedance_ratio", impedance_ratio, newton);
    visit("implicit_damping", implicit_damping, newton);
    visit("cone", cone,
          counted_if(method == Solver::newton && cone != FrictionCone::pyramidal,
                     "the default: pyramids"));
  }
};
template <>
struct Members<ContactOptions> {
  static constexpr const char* name = "ContactOptions";
  static void visit(auto& value, auto&& visit) {
    auto& [frequency, fixed_frequency, damping_ratio, push_out_speed, slop, restitution_threshold,
           restitution_sweeps, friction_in_bias_pass, cast_against_fixed, cast_between_moving,
           collision_passes, impact_sweeps] = value;
    visit("frequency", frequency), visit("damping_ratio", damping_ratio);
    visit("fixed_frequency", fixed_frequency,
          counted_if(fixed_frequency.has_value(), "the default"));
    visit("push_out_speed", push_out_speed), visit("slop", slop);
    visit("restitution_threshold", restitution_threshold);
    visit("restitution_sweeps", restitution_sweeps);
    visit("friction_in_bias_pass", friction_in_bias_pass);
    visit("cast_against_fixed", cast_against_fixed);
    visit("cast_between_moving", cast_between_moving);
    visit("collision_passes", collision_passes,
          counted_if(collision_passes.value_or(1) != 1, "contacts are found once a step"));
    visit(
        "impact_sweeps", impact_sweeps,
        counted_if(impact_sweeps.value_or(0) != 0, "impacts end with the sweeps of all contacts"));
  }
};
template <>
struct Members<JointOptions> {
  static constexpr const char* name = "JointOptions";
  static void visit(auto& value, auto&& visit) {
    auto& [method, frequency, damping_ratio, pull_speed] = value;
    visit("method", method, counted_if(method == JointMethod::tree, "the default: sweeps"));
    visit("frequency", frequency), visit("damping_ratio", damping_ratio);
    visit("pull_speed", pull_speed);
  }
};
template <>
struct Members<SleepOptions> {
  static constexpr const char* name = "SleepOptions";
  static void visit(auto& value, auto&& visit) {
    auto& [speed, time] = value;
    visit("speed", speed), visit("time", time);
  }
};
template <>
struct Members<Medium> {
  static constexpr const char* name = "Medium";
  static void visit(auto& value, auto&& visit) {
    auto& [density, viscosity] = value;
    visit("density", density), visit("viscosity", viscosity);
  }
};
template <>
struct Members<Options> {
  static constexpr const char* name = "Options";
  static void visit(auto& value, auto&& visit) {
    auto& [dt, substeps, gravity, wind, density, integrator, medium, rotation, angular_momentum,
           length_unit, solver, contact, joint, sleep, contact_capacity, bounds] = value;
    const Counted by_integrator =
        counted_if(integrator != Integrator::symplectic_euler ||
                       rotation.value_or(Rotation::splitting) != Rotation::splitting,
                   "the default integrator");
    visit("dt", dt), visit("substeps", substeps), visit("gravity", gravity), visit("wind", wind);
    visit("density", density), visit("length_unit", length_unit);
    visit("contact", contact), visit("joint", joint), visit("sleep", sleep);
    visit("contact_capacity", contact_capacity), visit("bounds", bounds);
    visit("solver", solver);
    visit("integrator", integrator, by_integrator), visit("rotation", rotation, by_integrator);
    visit("angular_momentum", angular_momentum, by_integrator);
    visit("medium", medium, counted_if(value.medium != Medium{}, "the default: no medium"));
  }
};

}  // namespace manyworlds
