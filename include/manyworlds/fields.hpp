// The list of state fields: the one place that names them. Storage, reading and writing, hashes
// and the docs are made from it.
#pragma once

#include "manyworlds/scene.hpp"

namespace manyworlds {

// X(name, planar components, spatial components, unit, frame and meaning, written by)
#define MW_STATE_FIELDS(X)                                                                  \
  X(position, 2, 3, "m", "body origin, world", "finish")                                    \
  X(orientation, 2, 4, "1", "body frame in world; planar (cos, sin), spatial (w, x, y, z)", \
    "finish")                                                                               \
  X(linear_velocity, 2, 3, "m/s", "centre of mass, world", "forces, solve, restitution")    \
  X(angular_velocity, 1, 3, "rad/s", "world", "forces, solve, restitution")

enum class Field {
#define MW_FIELD_ENUM(name, planar, spatial, unit, meaning, writer) name,
  MW_STATE_FIELDS(MW_FIELD_ENUM)
#undef MW_FIELD_ENUM
};
inline constexpr int kFieldCount = 4;

struct FieldInfo {
  const char* name;
  int planar_components;
  int spatial_components;
  const char* unit;
  const char* meaning;
  const char* writer;
};
const FieldInfo& info(Field field);
inline int components(Field field, Space space) {
  return space == Space::planar ? info(field).planar_components : info(field).spatial_components;
}

}  // namespace manyworlds
