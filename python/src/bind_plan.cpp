#include <nanobind/stl/pair.h>
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
  nb::list choices;
  for (const auto& c : r.choices) {
    nb::dict d;
    d["option"] = c.option, d["why"] = c.why;
    if (c.name.empty()) {
      d["value"] = c.value;
    } else {
      d["value"] = c.name;
    }
    choices.append(d);
  }
  nb::dict out;
  out["choices"] = choices;
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

int find(const Plan& p, const std::string& kind, nb::object name) {
  return find_in(p.scene(), kind, name);
}
std::pair<int, int> find_shape(const Plan& p, const std::string& name, nb::object body) {
  return find_shape_in(p.scene(), name, body);
}

int row(const Plan& p, nb::object body) {
  if (is_dataclass(body, "ShapeId")) {
    const ShapeId shape = read_shape(body, {}, Place{nullptr, "shape"});
    checked("shape.body", shape.body().index(), p.scene().bodies.size());
    checked("shape.index", shape.index(), p.scene().at(shape.body()).shapes.size());
    return p.row(shape);
  }
  return p.row(BodyId(find(p, "body", body)));
}

}  // namespace

void bind_plan(nb::module_& m) {
  nb::class_<Plan>(m, "Plan", "Stages and arrays of a step; immutable, shared by batches.")
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
      .def_prop_ro(
          "resolved", [](const Plan& p) { return to_python(p.resolved()); },
          "The options of the scene, with the values that the plan chose. A copy.")
      .def_prop_ro("bodies", &Plan::bodies, "Number of dynamic and kinematic bodies.")
      .def_prop_ro("coordinates", &Plan::coordinates, "Number of coordinates of all joints.")
      .def_prop_ro("fingerprint", &Plan::fingerprint,
                   "Plans with equal fingerprints accept each other's snapshots.")
      .def_prop_ro(
          "scene_bodies", [](const Plan& p) { return p.scene().bodies.size(); },
          "Number of bodies of the scene, including fixed ones.")
      .def_prop_ro(
          "joints", [](const Plan& p) { return p.scene().joints.size(); }, "Number of joints.")
      .def("row", &row, nb::arg("body"),
           "The row of a body (handle, name or index) in arrays (worlds, bodies, ...), or of a "
           "shape (handle) in arrays (worlds, shapes, ...). Raises ValueError for fixed bodies.")
      .def(
          "body_in_row",
          [](const Plan& p, int row) {
            checked("row", row, static_cast<std::size_t>(p.bodies()));
            return p.body_in_row(row).index();
          },
          nb::arg("row"), "Index in the scene of the body in a row.")
      .def(
          "bodies_in_rows",
          [](const Plan& p) {
            std::vector<int> out;
            for (int r = 0; r < p.bodies(); ++r) out.push_back(p.body_in_row(r).index());
            return out;
          },
          "Indices in the scene of the bodies in all rows.")
      .def("find", &find, nb::arg("kind"), nb::arg("name"),
           "Index of the body, joint, control, tendon, site or keyframe with this name, handle or "
           "index.")
      .def("find_shape", &find_shape, nb::arg("name"), nb::arg("body").none(),
           "(body, index) of the shape with this name, of one body or of all.")
      .def(
          "first_coordinate",
          [](const Plan& p, nb::object joint) {
            return p.first_coordinate(JointId(find(p, "joint", joint)));
          },
          nb::arg("joint"),
          "Index of the first coordinate of a joint (handle, name or index). With the newton "
          "solver it is an index of generalized_position.")
      .def(
          "first_observed",
          [](const Plan& p, nb::object joint) {
            return p.first_observed(JointId(find(p, "joint", joint)));
          },
          nb::arg("joint"), "Index of a joint's first value in joint_position and joint_speed.")
      .def(
          "has",
          [](const Plan& p, nb::object f) { return p.has(from_python<Feature>(f, "feature")); },
          nb::arg("feature"), "Whether the plan has this feature.")
      .def("report", &report, "What the plan contains, as a dict.");
}

}  // namespace manyworlds::python
