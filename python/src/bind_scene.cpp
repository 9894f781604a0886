#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bind.hpp"
#include "manyworlds/hull.hpp"
#include "manyworlds/mesh.hpp"
#include "manyworlds/scenes.hpp"
#include "scene_fields.hpp"

namespace manyworlds::python {

namespace {

template <class... Structs>
nb::dict default_values() {
  nb::dict out;
  ((out[Described<Structs>::name] = to_python(Structs{})), ...);
  return out;
}

template <class Variant>
void add_alternatives(nb::dict& out) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    out.update(default_values<std::variant_alternative_t<I, Variant>...>());
  }
  (std::make_index_sequence<std::variant_size_v<Variant>>());
}

std::vector<std::pair<std::string, std::string>> issues_of(const std::vector<Issue>& issues) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const Issue& issue : issues) out.emplace_back(issue.place, issue.message);
  return out;
}

nb::object load_scene(const std::string& name) {
  if (const scenes::Entry* entry = scenes::find(name)) return to_python(entry->make());
  if (const auto scene = scenes::sized(name)) return to_python(*scene);
  throw nb::value_error(("there is no scene '" + name + "' (nearest: '" + scenes::nearest(name) +
                         "'); scenes.names() lists them")
                            .c_str());
}

// A body of the scene; the world, too, where `world` is allowed.
BodyId body_of(const Scene& scene, const char* name, nb::handle body, bool world) {
  const BodyId id = read_body(body, Place{nullptr, name, -1, &scene});
  if (world && id == BodyId()) return id;
  return BodyId(checked(name, id.index(), scene.bodies.size(), world ? -1 : 0));
}

// Masses and frames are derived from scenes that have no issue.
Scene sound_scene(nb::handle value) {
  Scene scene = from_python<Scene>(value, "scene");
  if (auto issues = validate(scene); !issues.empty()) throw SceneError(std::move(issues));
  return scene;
}

}  // namespace

void bind_scene(nb::module_& m) {
  m.def(
      "default_values",
      [] {
        nb::dict out =
            default_values<Compliance, SoftContact, Material, Filter, Shape, MassProperties, Jitter,
                           Body, Frame, Spring, Limit, Drive, JointDynamics, Joint, Actuator,
                           Control, Attractor, Variation, Exclusion, TendonTerm, Tendon, Keyframe,
                           CoordinateDraw, Site, SolverOptions, ContactOptions, JointOptions,
                           SleepOptions, Medium, Options, Scene, Ray, Point>();
        add_alternatives<Geometry>(out), add_alternatives<JointType>(out);
        return out;
      },
      "The library's default value of every dataclass, by its name.");
  m.def(
      "validate",
      [](nb::object scene) { return issues_of(validate(from_python<Scene>(scene, "scene"))); },
      nb::arg("scene"), "All issues of a scene as (place, message).");
  m.def(
      "round_trip", [](nb::object scene) { return to_python(from_python<Scene>(scene, "scene")); },
      nb::arg("scene"), "The scene as the library understands it.");
  m.def(
      "find_in_scene",
      [](nb::object scene, const std::string& kind, nb::object name) {
        return find_in(names_of_scene(scene), kind, name);
      },
      nb::arg("scene"), nb::arg("kind"), nb::arg("name"),
      "Index of the body, joint, control, tendon, site or keyframe with this name, handle or "
      "index.");
  m.def(
      "find_shape_in_scene",
      [](nb::object scene, const std::string& name, nb::object body) {
        return find_shape_in(names_of_scene(scene), name, body);
      },
      nb::arg("scene"), nb::arg("name"), nb::arg("body").none(),
      "(body, index) of the shape with this name, of one body or of all.");
  m.def("load_scene", &load_scene, nb::arg("name"), "The scene with this name.");
  m.def(
      "scene_names",
      [] {
        std::vector<std::pair<std::string, std::string>> out;
        for (const scenes::Entry& entry : scenes::all())
          out.emplace_back(entry.name, entry.summary);
        return out;
      },
      "(name, summary) of every named scene.");
  m.def(
      "joint_at",
      [](nb::object scene, nb::object body_a, nb::object body_b, nb::object frame,
         nb::object type) {
        const Scene s = sound_scene(scene);
        return to_python(
            joint_at(s, body_of(s, "body_a", body_a, true), body_of(s, "body_b", body_b, true),
                     from_python<Frame>(frame, "frame"), from_python<JointType>(type, "type")));
      },
      nb::arg("scene"), nb::arg("body_a"), nb::arg("body_b"), nb::arg("frame"), nb::arg("type"),
      "A joint of two bodies whose frames coincide with `frame` in the world.");
  m.def(
      "mass_properties",
      [](nb::object scene, nb::object body) {
        const Scene s = sound_scene(scene);
        return to_python(mass_properties(s, s.at(body_of(s, "body", body, false))));
      },
      nb::arg("scene"), nb::arg("body"), "Mass, centre and inertia of a body of a scene.");
  m.def(
      "mesh_mass_properties",
      [](nb::object vertices, nb::object triangles, double density) {
        TriangleMesh mesh{from_python<std::vector<Vec3>>(vertices, "vertices"), {}};
        const Place place{nullptr, "triangles", -1};
        const auto rows = read_elements(triangles, place, -1, "a list of triangles");
        for (std::size_t i = 0; i < rows.size(); ++i) {
          const Place row = place.element(i);
          const auto corners = read_elements(rows[i], row, 3, "indices");
          auto& triangle = mesh.triangles.emplace_back();
          for (std::size_t k = 0; k < 3; ++k) {
            triangle[k] = Converter<int>::read(corners[k], row.element(k));
          }
        }
        return to_python(mass_properties(mesh, density));
      },
      nb::arg("vertices"), nb::arg("triangles"), nb::arg("density"),
      "Mass, centre and inertia of the solid inside a closed mesh.");
  m.def(
      "make_hull",
      [](nb::object points) {
        return to_python(make_hull(from_python<std::vector<Vec3>>(points, "points")));
      },
      nb::arg("points"), "The convex hull of points.");
}

}  // namespace manyworlds::python
