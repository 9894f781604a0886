#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include "bind.hpp"
#include "names.hpp"
#include "task_fields.hpp"

namespace nb = nanobind;

namespace manyworlds::python {

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
        return all_names<Space, Motion, Integrator, Rotation, Solver, JointMethod, FrictionCone,
                         ControlKind, Field, Parameter, Draw, Precision, Isa, ContactLayout,
                         Observer, Observed, Feature, BroadPhase, Every, Autoreset, Status>();
      },
      "Names of the values of every enumeration, by its name, and of fields.");
  m.def("unknown_name", &unknown_name, nb::arg("found"), nb::arg("known"),
        "Error message for an unknown name: the known names and the nearest.");
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
