// What the lists of fields and of observed numbers say.
#include <algorithm>
#include <cstddef>
#include <string>

#include "manyworlds/fields.hpp"
#include "manyworlds/observe.hpp"
#include "src/base/enum_names.hpp"

namespace manyworlds {

const char* to_string(ItemKind kind) { return name_of(kind); }

const FieldInfo& info(Field field) { return kFieldTable[static_cast<int>(checked_enum(field))]; }

std::string component_names(Field field, Space space) {
  return space == Space::planar ? info(field).planar : info(field).spatial;
}
int components(Field field, Space space) {
  const std::string names = component_names(field, space);
  return 1 + static_cast<int>(std::count(names.begin(), names.end(), ' '));
}

const ObserverInfo& info(Observer observer) {
  return kObserverInfo[static_cast<std::size_t>(checked_enum(observer))];
}
const ObservedInfo& info(Observed what) {
  return kObservedInfo[static_cast<std::size_t>(checked_enum(what))];
}
int components(Observed what, Space space) {
  const bool planar = space == Space::planar;
  switch (info(what).components) {
    case ObservedComponents::one: return 1;
    case ObservedComponents::two: return 2;
    case ObservedComponents::vector: return planar ? 2 : 3;
    case ObservedComponents::spin: return planar ? 1 : 3;
  }
  return 0;
}

}  // namespace manyworlds
