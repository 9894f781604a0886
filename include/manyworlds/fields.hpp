// Functions of state fields, from the table in field_table.hpp.
#pragma once

#include <string>

#include "manyworlds/field_table.hpp"
#include "manyworlds/scene.hpp"

namespace manyworlds {

const char* to_string(ItemKind kind);  // "body", "dof"

// Throws std::invalid_argument if the value is not a field.
const FieldInfo& info(Field field);
int components(Field field, Space space);
std::string component_names(Field field, Space space);  // "x y z", "w x y z", "cos sin"

}  // namespace manyworlds
