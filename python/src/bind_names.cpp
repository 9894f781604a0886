#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <numeric>

#include "bind.hpp"
#include "names.hpp"

namespace nb = nanobind;

namespace manyworlds::python {

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    int corner = row[0];
    row[0] = static_cast<int>(i) + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int changed = corner + (a[i] == b[j] ? 0 : 1);
      corner = row[j + 1];
      row[j + 1] = std::min({changed, corner + 1, row[j] + 1});
    }
  }
  return row.back();
}

std::string unknown_name(std::string_view found, const std::vector<std::string>& known) {
  std::string text = "is '" + std::string(found) + "'; expected one of ";
  const auto nearest =
      std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
        return edit_distance(found, a) < edit_distance(found, b);
      });
  for (std::size_t i = 0; i < known.size(); ++i) text += (i > 0 ? ", '" : "'") + known[i] + "'";
  return nearest == known.end() ? text : text + " (nearest: '" + *nearest + "')";
}

namespace {

template <class... Enums>
nb::dict all_names() {
  nb::dict out;
  (..., [&] {
    nb::list names;
    for (const auto& name : known_names<Enums>()) names.append(nb::str(name.c_str()));
    out[Names<Enums>::kind] = nb::tuple(names);
  }());
  return out;
}

}  // namespace

void bind_names(nb::module_& m) {
  m.def(
      "names",
      [] {
        return all_names<Space, Motion, Integrator, Rotation, Solver, ControlKind, Parameter, Draw,
                         Precision, Isa, ContactLayout, Observer, Feature, BroadPhase, Status>();
      },
      "Names of the values of every enumeration, by its name.");
  m.def("unknown_name", &unknown_name, nb::arg("found"), nb::arg("known"),
        "What is wrong with a name, for an error: the known names and the nearest.");
  m.def(
      "available_isas",
      [] {
        std::vector<std::string> out;
        for (const Isa isa : available_isas()) out.emplace_back(name_of(isa));
        return out;
      },
      "Instruction sets that this CPU and this build can run, narrowest first.");
  m.attr("__version__") = MW_VERSION;
}

}  // namespace manyworlds::python
