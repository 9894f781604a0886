// The table of state fields. It defines their layout in the state and in snapshots, the order of
// hashes, reading and writing, and inputs of listeners. Recordings, Python's fields and the table
// in docs/conventions.md use it. Kernels include it: it has no includes and defines no function.
#pragma once

namespace manyworlds {

// Owner of a field's value: a body with state, the world, a shape of the scene, a particle. Plans
// with Solver::newton also have joint coordinates, and degrees of freedom (dof) of the velocities.
enum class ItemKind { body, world, shape, coordinate, dof, particle };
inline constexpr int kItemKinds = 6;

// Plans that have a field.
enum class FieldPresence { always, with_orientation };  // with Feature::orientation

// X(name, kind of item, presence, planar components, spatial components, unit, frame and meaning,
//   written by)
#define MW_STATE_FIELDS(X)                                                                        \
  X(position, body, always, "x y", "x y z", "m", "body origin, world", "finish")                  \
  X(orientation, body, with_orientation, "cos sin", "w x y z", "1",                               \
    "body frame in world; planar (cos, sin), spatial (w, x, y, z)", "finish")                     \
  X(linear_velocity, body, always, "x y", "x y z", "m/s", "centre of mass, world",                \
    "forces, solve, restitution")                                                                 \
  X(angular_velocity, body, always, "z", "x y z", "rad/s", "world", "forces, solve, restitution") \
  X(generalized_position, coordinate, always, "q", "q", "m, rad or 1",                            \
    "MuJoCo's qpos: free x y z and w x y z, ball w x y z, hinge, slide", "tree")                  \
  X(generalized_velocity, dof, always, "v", "v", "m/s or rad/s",                                  \
    "MuJoCo's qvel: free world, then body axes; ball body axes", "tree")                          \
  X(generalized_acceleration, dof, always, "a", "a", "m/s^2 or rad/s^2",                          \
    "of the last step, where limits or contacts act before implicit dampers", "tree")

#define MW_FIELD(name, ...) name,
enum class Field { MW_STATE_FIELDS(MW_FIELD) };
#undef MW_FIELD
#define MW_FIELD(name, ...) Field::name,
inline constexpr Field kFields[] = {MW_STATE_FIELDS(MW_FIELD)};
#undef MW_FIELD
inline constexpr int kFieldCount = sizeof kFields / sizeof kFields[0];

struct FieldInfo {
  const char* name;
  ItemKind item;
  FieldPresence presence;
  const char* planar;   // names of the components, "cos sin"
  const char* spatial;  // "w x y z"
  const char* unit;
  const char* meaning;
  const char* writer;
};
#define MW_FIELD(name, item, presence, planar, spatial, unit, meaning, writer) \
  {#name, ItemKind::item, FieldPresence::presence, planar, spatial, unit, meaning, writer},
inline constexpr FieldInfo kFieldTable[kFieldCount] = {MW_STATE_FIELDS(MW_FIELD)};  // [Field]
#undef MW_FIELD

}  // namespace manyworlds
