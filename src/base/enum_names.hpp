// The names of every public enumeration: one table each, in the order of its values, which count
// from 0. to_string(), JSON, and whoever is given a value that may be none of them read it here.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include "manyworlds/environment.hpp"

namespace manyworlds {

// Specialised below: `kind`, what a value is called in an error, and `names`.
template <class Enum>
struct EnumTable;

#define MW_ENUM_TABLE(Enum, last, name_of_kind, ...)                         \
  template <>                                                                \
  struct EnumTable<Enum> {                                                   \
    static constexpr const char* kind = name_of_kind;                        \
    static constexpr std::array names = {__VA_ARGS__};                       \
    static_assert(names.size() == static_cast<std::size_t>(Enum::last) + 1); \
  }

MW_ENUM_TABLE(Space, spatial, "space", "planar", "spatial");
MW_ENUM_TABLE(Motion, fixed, "motion", "dynamic", "kinematic", "fixed");
MW_ENUM_TABLE(Integrator, implicit_fast, "integrator", "symplectic-euler", "explicit-euler",
              "implicit-euler", "verlet", "velocity-verlet", "runge-kutta4", "implicit-fast");
MW_ENUM_TABLE(Rotation, exponential, "rotation", "splitting", "quaternion", "exponential");
MW_ENUM_TABLE(Solver, newton, "solver", "tgs-soft", "sequential-impulse", "sor", "nncg", "penalty",
              "newton");
MW_ENUM_TABLE(JointMethod, tree, "method", "sweep", "tree");
MW_ENUM_TABLE(FrictionCone, elliptic, "cone", "pyramidal", "elliptic");
MW_ENUM_TABLE(ControlKind, joint_force, "kind", "target_position", "target_speed", "thrust",
              "torque", "joint_force");
MW_ENUM_TABLE(Draw, log_uniform, "draw", "none", "uniform", "log_uniform");
MW_ENUM_TABLE(Feature, resistance, "feature", "orientation", "inertia", "friction", "restitution",
              "contacts", "drag", "gravity", "joints", "resistance");
MW_ENUM_TABLE(BroadPhase, sparse, "broad_phase", "automatic", "all-pairs", "sort-and-sweep",
              "sparse");
MW_ENUM_TABLE(Precision, f64, "precision", "f32", "f64");
MW_ENUM_TABLE(Isa, avx512, "isa", "scalar", "avx2", "avx512");
MW_ENUM_TABLE(ContactLayout, rows, "layout", "automatic", "dense", "rows");
MW_ENUM_TABLE(ItemKind, particle, "item", "body", "world", "shape", "coordinate", "dof",
              "particle");
MW_ENUM_TABLE(Every, step, "every", "episode", "step");
MW_ENUM_TABLE(Autoreset, disabled, "autoreset", "next_step", "same_step", "disabled");
#define MW_WRITE_NAME(name, ...) "write_" #name,
MW_ENUM_TABLE(Input, disable_joint, "input", "force", "torque", "force_at", "impulse",
              "angular_impulse", "impulse_at", "enable", "disable", "spawn", "wake",
              MW_STATE_FIELDS(MW_WRITE_NAME) "reset", "restore", "set_controls", "enable_joint",
              "disable_joint");
#undef MW_WRITE_NAME
#undef MW_ENUM_TABLE

template <>
struct EnumTable<Field> {
  static constexpr const char* kind = "field";
#define MW_FIELD_NAME(name, ...) #name,
  static constexpr std::array names = {MW_STATE_FIELDS(MW_FIELD_NAME)};
#undef MW_FIELD_NAME
  static_assert(names.size() == kFieldCount);
};
template <>
struct EnumTable<Parameter> {
  static constexpr const char* kind = "parameter";
#define MW_PARAMETER_NAME(name, owner, numbers, unit, meaning) #name,
  static constexpr std::array names = {MW_PARAMETERS(MW_PARAMETER_NAME)};
#undef MW_PARAMETER_NAME
  static_assert(names.size() == kParameterCount);
};

template <>
struct EnumTable<Observer> {
  static constexpr const char* kind = "observer";
#define MW_OBSERVER_NAME(name, item, of, meaning) #name,
  static constexpr std::array names = {MW_OBSERVERS(MW_OBSERVER_NAME)};
#undef MW_OBSERVER_NAME
};
template <>
struct EnumTable<Observed> {
  static constexpr const char* kind = "observed";
#define MW_OBSERVED_NAME(name, observer, components, unit, meaning) #name,
  static constexpr std::array names = {MW_OBSERVED(MW_OBSERVED_NAME)};
#undef MW_OBSERVED_NAME
};

template <class Enum>
constexpr bool is_named(Enum value) {
  // Negative ones are large.
  return static_cast<std::size_t>(value) < EnumTable<Enum>::names.size();
}

template <class Enum>
constexpr const char* name_of(Enum value) {
  return is_named(value) ? EnumTable<Enum>::names[static_cast<std::size_t>(value)] : "unknown";
}

// "scalar, avx2 or avx512"
inline std::string one_of(std::span<const char* const> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + std::string(names[i]);
  }
  return text;
}

// "is 9, must be f32 or f64"
template <class Enum>
std::string unnamed(Enum value) {
  return "is " + std::to_string(static_cast<long long>(value)) + ", must be " +
         one_of(EnumTable<Enum>::names);
}

// Throws std::invalid_argument for a value that the enumeration does not have; returns it
// otherwise. `what` it is, where that says more than its kind.
template <class Enum>
Enum checked_enum(Enum value, const std::string& what = EnumTable<Enum>::kind) {
  if (!is_named(value)) throw std::invalid_argument(what + " " + unnamed(value));
  return value;
}

}  // namespace manyworlds
