// Names in the file, for who writes and who reads it.
#pragma once

#include <array>
#include <string>

#include "manyworlds/batch.hpp"

namespace manyworlds::record {

inline constexpr const char* kFormat = "manyworlds recording";

// Of the components of a field: "x y z", "w x y z", "cos sin".
inline std::string component_names(Field field, Space space) {
  const bool planar = space == Space::planar;
  if (field == Field::orientation) return planar ? "cos sin" : "w x y z";
  if (field == Field::angular_velocity && planar) return "z";
  return planar ? "x y" : "x y z";
}

inline constexpr std::array kFields = {Field::position, Field::orientation, Field::linear_velocity,
                                       Field::angular_velocity};
static_assert(kFields.size() == kFieldCount);

}  // namespace manyworlds::record
