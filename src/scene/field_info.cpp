#include <array>
#include <cstddef>

#include "manyworlds/fields.hpp"
#include "src/base/enum_names.hpp"

namespace manyworlds {

const FieldInfo& info(Field field) {
  static constexpr std::array kInfo = {
#define MW_FIELD_INFO(name, planar, spatial, unit, meaning, writer) \
  FieldInfo{#name, planar, spatial, unit, meaning, writer},
      MW_STATE_FIELDS(MW_FIELD_INFO)
#undef MW_FIELD_INFO
  };
  static_assert(kInfo.size() == kFieldCount);
  return kInfo[static_cast<std::size_t>(checked_enum(field))];
}

}  // namespace manyworlds
