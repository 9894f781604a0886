// Names of the public enumerations of batch.hpp, observe.hpp and listener.hpp.
#include <string>

#include "manyworlds/batch.hpp"
#include "src/base/enum_names.hpp"

namespace manyworlds {

const char* to_string(Precision precision) { return name_of(precision); }
const char* to_string(ContactLayout layout) { return name_of(layout); }
const char* to_string(Observer observer) { return name_of(observer); }
const char* to_string(Observed what) { return name_of(what); }
const char* to_string(Input input) { return name_of(input); }

std::string to_string(Status status) {
  std::string out;
  const auto add = [&](Status bit, const char* name) {
    if (has(status, bit)) out += std::string(out.empty() ? "" : "|") + name;
  };
  add(Status::non_finite, "non_finite");
  add(Status::out_of_range, "out_of_range");
  add(Status::out_of_bounds, "out_of_bounds");
  add(Status::contact_overflow, "contact_overflow");
  add(Status::joint_broken, "joint_broken");
  add(Status::diverged, "diverged");
  return out.empty() ? "ok" : out;
}

}  // namespace manyworlds
