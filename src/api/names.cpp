// Names of the public enumerations of batch.hpp.
#include <string>

#include "manyworlds/batch.hpp"

namespace manyworlds {

const char* to_string(Precision precision) { return precision == Precision::f32 ? "f32" : "f64"; }

const char* to_string(ContactLayout layout) {
  switch (layout) {
    case ContactLayout::automatic: return "automatic";
    case ContactLayout::dense: return "dense";
    case ContactLayout::rows: return "rows";
  }
  return "?";
}

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
  return out.empty() ? "ok" : out;
}

}  // namespace manyworlds
