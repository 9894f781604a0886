#include "src/base/enum_names.hpp"

namespace manyworlds {

const char* to_string(Isa isa) { return name_of(isa); }

}  // namespace manyworlds
