#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bind.hpp"
#include "scene_fields.hpp"

namespace manyworlds::python {

namespace {

nb::list items(const std::vector<PlanReport::Item>& from) {
  nb::list out;
  for (const auto& item : from) {
    nb::dict d;
    d["name"] = item.name, d["in"] = item.in, d["why"] = item.why;
    out.append(d);
  }
  return out;
}

nb::dict report(const Plan& plan) {
  const PlanReport r = plan.report();
  nb::list pairs, arrays;
  for (const auto& p : r.pairs) {
    nb::dict d;
    d["kernel"] = p.kernel, d["kind"] = p.kind;
    d["candidates"] = p.candidates, d["culled"] = p.culled;
    pairs.append(d);
  }
  for (const auto& a : r.arrays) {
    nb::dict d;
    d["name"] = a.name, d["shape"] = a.shape, d["bytes_per_world"] = a.bytes_per_world;
    arrays.append(d);
  }
  nb::dict out;
  out["features"] = items(r.features);
  out["stages"] = items(r.stages);
  out["pairs"] = pairs;
  out["arrays"] = arrays;
  out["broad_phase"] = name_of(r.broad_phase);
  out["pair_capacity"] = r.pair_capacity;
  out["fixed_capacity"] = r.fixed_capacity;
  out["bytes_per_world"] = r.bytes_per_world;
  return out;
}

// An index of a list of the scene, or an IndexError.
int checked(const char* name, int index, std::size_t count) {
  if (index < 0 || static_cast<std::size_t>(index) >= count) {
    throw nb::index_error((std::string(name) + " is " + std::to_string(index) + ", must be 0 to " +
                           std::to_string(static_cast<std::ptrdiff_t>(count) - 1))
                              .c_str());
  }
  return index;
}

}  // namespace

void bind_plan(nb::module_& m) {
  nb::class_<Plan>(m, "Plan", "What a step of a scene needs; immutable, shared by batches.")
      .def(
          "__init__",
          [](Plan* self, nb::object scene, nb::object broad_phase, nb::object keep) {
            const Scene s = from_python<Scene>(scene, "scene");
            const PlanOptions options{from_python<BroadPhase>(broad_phase, "broad_phase"),
                                      from_python<std::vector<Feature>>(keep, "keep")};
            const nb::gil_scoped_release release;
            new (self) Plan(compile(s, options));
          },
          nb::arg("scene"), nb::arg("broad_phase") = "automatic", nb::arg("keep") = nb::tuple())
      .def_prop_ro(
          "scene", [](const Plan& p) { return to_python(p.scene()); }, "A copy of the scene.")
      .def_prop_ro("bodies", &Plan::bodies, "State bodies: dynamic and kinematic ones.")
      .def_prop_ro("coordinates", &Plan::coordinates, "Coordinates of all joints.")
      .def_prop_ro("fingerprint", &Plan::fingerprint,
                   "Equal for plans whose worlds can go on in each other.")
      .def(
          "scene_body",
          [](const Plan& p, int body) {
            return p.scene_body(checked("body", body, static_cast<std::size_t>(p.bodies())));
          },
          nb::arg("body"), "Index in the scene of a state body.")
      .def(
          "state_body",
          [](const Plan& p, int body) {
            return p.state_body(checked("body", body, p.scene().bodies.size()));
          },
          nb::arg("body"), "Index of the state body of a body of the scene, -1 for fixed ones.")
      .def(
          "first_coordinate",
          [](const Plan& p, int joint) {
            return p.first_coordinate(checked("joint", joint, p.scene().joints.size()));
          },
          nb::arg("joint"), "Where the coordinates of a joint begin.")
      .def(
          "has",
          [](const Plan& p, nb::object f) { return p.has(from_python<Feature>(f, "feature")); },
          nb::arg("feature"), "Whether the step has this feature.")
      .def("report", &report, "What the plan contains, as a dict.");
}

}  // namespace manyworlds::python
