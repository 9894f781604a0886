// The library's enumerations as strings: one table per enumeration, both ways.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "manyworlds/batch.hpp"
#include "manyworlds/plan.hpp"
#include "manyworlds/scene.hpp"

namespace manyworlds::python {

template <class Enum>
struct Named {
  Enum value;
  const char* name;
};

// Specialised for every enumeration that Python sees: what it is called, and its names.
template <class Enum>
struct Names;

#define MW_NAMES(Enum, ...)                             \
  template <>                                           \
  struct Names<Enum> {                                  \
    using E = Enum;                                     \
    static constexpr const char* kind = #Enum;          \
    static constexpr Named<Enum> all[] = {__VA_ARGS__}; \
  }
#define MW_NAME(x) \
  { E::x, #x }

MW_NAMES(Space, MW_NAME(planar), MW_NAME(spatial));
MW_NAMES(Motion, MW_NAME(dynamic), MW_NAME(kinematic), MW_NAME(fixed));
MW_NAMES(Integrator, MW_NAME(symplectic_euler), MW_NAME(explicit_euler), MW_NAME(implicit_euler),
         MW_NAME(verlet), MW_NAME(velocity_verlet), MW_NAME(runge_kutta4), MW_NAME(implicit_fast));
MW_NAMES(Rotation, MW_NAME(splitting), MW_NAME(quaternion), MW_NAME(exponential));
MW_NAMES(Solver, MW_NAME(tgs_soft), MW_NAME(sequential_impulse), MW_NAME(sor), MW_NAME(nncg),
         MW_NAME(penalty), MW_NAME(newton));
MW_NAMES(JointMethod, MW_NAME(sweep), MW_NAME(tree));
MW_NAMES(FrictionCone, MW_NAME(pyramidal), MW_NAME(elliptic));
MW_NAMES(Field, MW_NAME(position), MW_NAME(orientation), MW_NAME(linear_velocity),
         MW_NAME(angular_velocity), MW_NAME(generalized_position), MW_NAME(generalized_velocity),
         MW_NAME(generalized_acceleration));
MW_NAMES(ControlKind, MW_NAME(target_position), MW_NAME(target_speed), MW_NAME(thrust),
         MW_NAME(torque), MW_NAME(joint_force));
MW_NAMES(Parameter, MW_NAME(size), MW_NAME(density), MW_NAME(shape_position),
         MW_NAME(shape_rotation), MW_NAME(mass), MW_NAME(friction), MW_NAME(restitution),
         MW_NAME(rolling_resistance), MW_NAME(torsional_resistance), MW_NAME(gravity),
         MW_NAME(gravity_scale), MW_NAME(linear_drag), MW_NAME(angular_drag), MW_NAME(armature),
         MW_NAME(damping), MW_NAME(stiffness), MW_NAME(rest), MW_NAME(gain), MW_NAME(bias),
         MW_NAME(kp), MW_NAME(kv), MW_NAME(gear), MW_NAME(force_low), MW_NAME(force_high),
         MW_NAME(limit_solref), MW_NAME(limit_solimp), MW_NAME(contact_solref),
         MW_NAME(contact_solimp), MW_NAME(limit_low), MW_NAME(limit_high), MW_NAME(motor_speed),
         MW_NAME(motor_force), MW_NAME(drive_stiffness), MW_NAME(drive_damping),
         MW_NAME(drive_frequency), MW_NAME(drive_damping_ratio), MW_NAME(motor_position),
         MW_NAME(limit_stiffness), MW_NAME(limit_damping), MW_NAME(limit_frequency),
         MW_NAME(limit_damping_ratio), MW_NAME(spring_stiffness), MW_NAME(spring_damping),
         MW_NAME(spring_frequency), MW_NAME(spring_damping_ratio), MW_NAME(length), MW_NAME(cone),
         MW_NAME(pulley_ratio), MW_NAME(control_point), MW_NAME(control_direction),
         MW_NAME(break_force), MW_NAME(break_torque), MW_NAME(anchor_a), MW_NAME(anchor_b),
         MW_NAME(axes_a), MW_NAME(axes_b), MW_NAME(initial_position), MW_NAME(initial_rotation),
         MW_NAME(initial_linear_velocity), MW_NAME(initial_angular_velocity),
         MW_NAME(center_of_mass), MW_NAME(inertia_scale), MW_NAME(wind),
         MW_NAME(attractor_position), MW_NAME(attractor_strength), MW_NAME(control_low),
         MW_NAME(control_high));
MW_NAMES(Draw, MW_NAME(none), MW_NAME(uniform), MW_NAME(log_uniform));
MW_NAMES(Precision, MW_NAME(f32), MW_NAME(f64));
MW_NAMES(Isa, MW_NAME(scalar), MW_NAME(avx2), MW_NAME(avx512));
MW_NAMES(ContactLayout, MW_NAME(automatic), MW_NAME(dense), MW_NAME(rows));
MW_NAMES(Feature, MW_NAME(orientation), MW_NAME(inertia), MW_NAME(friction), MW_NAME(restitution),
         MW_NAME(contacts), MW_NAME(drag), MW_NAME(gravity), MW_NAME(joints), MW_NAME(resistance));
MW_NAMES(BroadPhase, MW_NAME(automatic), MW_NAME(all_pairs), MW_NAME(sort_and_sweep),
         MW_NAME(sparse));
MW_NAMES(Status, MW_NAME(ok), MW_NAME(non_finite), MW_NAME(out_of_range), MW_NAME(out_of_bounds),
         MW_NAME(contact_overflow), MW_NAME(joint_broken), MW_NAME(diverged));
#undef MW_NAME
#undef MW_NAMES

template <>
struct Names<Observer> {
  static constexpr const char* kind = "Observer";
  static constexpr Named<Observer> all[] = {
#define MW_NAME(name, item, of, meaning) {Observer::name, #name},
      MW_OBSERVERS(MW_NAME)
#undef MW_NAME
  };
};

template <>
struct Names<Observed> {
  static constexpr const char* kind = "Observed";
  static constexpr Named<Observed> all[] = {
#define MW_NAME(name, observer, components, unit, meaning) {Observed::name, #name},
      MW_OBSERVED(MW_NAME)
#undef MW_NAME
  };
};

template <class Enum>
const char* name_of(Enum value) {
  for (const auto& n : Names<Enum>::all) {
    if (n.value == value) return n.name;
  }
  return "?";
}

// "is 'dynamc'; expected one of 'dynamic', 'kinematic', 'fixed' (nearest: 'dynamic')"
std::string unknown_name(std::string_view found, const std::vector<std::string>& known);

template <class Enum>
std::vector<std::string> known_names() {
  std::vector<std::string> out;
  for (const auto& n : Names<Enum>::all) out.emplace_back(n.name);
  return out;
}

// The value of that name, or nullptr; hyphens count as underscores.
template <class Enum>
const Enum* find_name(std::string text) {
  std::replace(text.begin(), text.end(), '-', '_');
  for (const auto& n : Names<Enum>::all) {
    if (text == n.name) return &n.value;
  }
  return nullptr;
}

}  // namespace manyworlds::python
