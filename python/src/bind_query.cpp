// Queries on single shapes (query.hpp): plain tuples, of which manyworlds.query makes records.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "bind.hpp"
#include "manyworlds/query.hpp"
#include "manyworlds/surface.hpp"
#include "scene_fields.hpp"

namespace manyworlds::python {

template <>
struct Described<Pose> {
  static constexpr const char* name = "Pose";
  static void fields(auto&& visit, auto& pose) {
    visit("position", pose.position);
    visit("rotation", pose.rotation);
  }
};

namespace {

struct Query {
  Shape a, b;
  Pose pose_a, pose_b;
  std::optional<Space> space;

  Query(nb::handle one, nb::handle pose_one, nb::handle other, nb::handle pose_other, nb::handle in)
      : a(from_python<Shape>(one, "a")),
        b(from_python<Shape>(other, "b")),
        pose_a(from_python<Pose>(pose_one, "pose_a")),
        pose_b(from_python<Pose>(pose_other, "pose_b")),
        space(from_python<std::optional<Space>>(in, "space")) {}
};

// f(), whose SceneError becomes the package's with its issues.
template <class F>
auto answered(F f) {
  try {
    return f();
  } catch (const SceneError& error) {
    nb::list issues;
    const nb::object package = nb::module_::import_("manyworlds");
    for (const Issue& issue : error.issues()) {
      issues.append(package.attr("Issue")(issue.place, issue.message));
    }
    const nb::object type = package.attr("SceneError");
    PyErr_SetObject(type.ptr(), type(issues).ptr());
    throw nb::python_error();
  }
}

nb::tuple tuple_of(const Separation& s) {
  return nb::make_tuple(s.distance, to_python(s.point_a), to_python(s.point_b),
                        to_python(s.normal));
}

nb::object distance_of(nb::handle a, nb::handle pose_a, nb::handle b, nb::handle pose_b,
                       nb::handle space) {
  const Query q(a, pose_a, b, pose_b, space);
  return answered([&] { return tuple_of(distance(q.a, q.pose_a, q.b, q.pose_b, q.space)); });
}

bool overlap_of(nb::handle a, nb::handle pose_a, nb::handle b, nb::handle pose_b,
                nb::handle space) {
  const Query q(a, pose_a, b, pose_b, space);
  return answered([&] { return overlap(q.a, q.pose_a, q.b, q.pose_b, q.space); });
}

// A list of (normal, point, separation, feature).
nb::list manifold_of(nb::handle a, nb::handle pose_a, nb::handle b, nb::handle pose_b,
                     nb::handle margin, nb::handle space) {
  const Query q(a, pose_a, b, pose_b, space);
  const double near = from_python<double>(margin, "margin");
  const auto points =
      answered([&] { return manifold(q.a, q.pose_a, q.b, q.pose_b, near, q.space); });
  nb::list out;
  for (const ManifoldPoint& p : points) {
    out.append(nb::make_tuple(to_python(p.normal), to_python(p.point), p.separation, p.feature));
  }
  return out;
}

// (distance, normal), or None.
nb::object ray_cast_of(nb::handle shape, nb::handle pose, nb::handle ray, nb::handle space) {
  const Shape s = from_python<Shape>(shape, "shape");
  const Pose at = from_python<Pose>(pose, "pose");
  const Ray r = from_python<Ray>(ray, "ray");
  const auto in = from_python<std::optional<Space>>(space, "space");
  const auto hit = answered([&] { return ray_cast(s, at, r, in); });
  if (!hit) return nb::none();
  return nb::make_tuple(hit->distance, to_python(hit->normal));
}

// (n, width) of a list of n things of `width` numbers each.
template <class T, class Rows>
auto table_of(const Rows& rows, std::size_t width) {
  std::vector<T> numbers;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < width; ++c) {
      numbers.push_back(row[static_cast<decltype(row.size())>(c)]);
    }
  }
  return owned(std::move(numbers), {rows.size(), width});
}

nb::list chains_of(const std::vector<std::vector<Vec3>>& chains) {
  nb::list out;
  for (const auto& chain : chains) out.append(table_of<double>(chain, 3));
  return out;
}

// (points, normals, triangles, faces, lines, marks).
nb::tuple surface_of(nb::handle geometry, nb::handle space, nb::handle around, nb::handle low,
                     nb::handle high) {
  SurfaceOptions options;
  options.space = from_python<Space>(space, "space");
  options.around = from_python<int>(around, "around");
  options.low = from_python<Vec3>(low, "low");
  options.high = from_python<Vec3>(high, "high");
  const Surface out =
      answered([&] { return surface(from_python<Geometry>(geometry, "geometry"), options); });
  return nb::make_tuple(table_of<double>(out.points, 3), table_of<double>(out.normals, 3),
                        table_of<std::int32_t>(out.triangles, 3),
                        table_of<std::int32_t>(out.faces, 2), chains_of(out.lines),
                        chains_of(out.marks));
}

nb::object resized_of(nb::handle geometry, nb::handle size) {
  return to_python(
      resized(from_python<Geometry>(geometry, "geometry"), from_python<Vec3>(size, "size")));
}

}  // namespace

void bind_query(nb::module_& m) {
  m.def("distance", &distance_of, nb::arg("a"), nb::arg("pose_a"), nb::arg("b"), nb::arg("pose_b"),
        nb::arg("space").none(), "(distance, point of A, point of B, normal).");
  m.def("overlap", &overlap_of, nb::arg("a"), nb::arg("pose_a"), nb::arg("b"), nb::arg("pose_b"),
        nb::arg("space").none(), "Do two shapes overlap?");
  m.def("manifold", &manifold_of, nb::arg("a"), nb::arg("pose_a"), nb::arg("b"), nb::arg("pose_b"),
        nb::arg("margin"), nb::arg("space").none(),
        "[(normal, point, separation, feature)] of two shapes.");
  m.def("ray_cast", &ray_cast_of, nb::arg("shape"), nb::arg("pose"), nb::arg("ray"),
        nb::arg("space").none(), "(distance, normal), or None if the ray misses.");
  m.def("surface", &surface_of, nb::arg("geometry"), nb::arg("space"), nb::arg("around"),
        nb::arg("low"), nb::arg("high"),
        "(points, normals, triangles, faces, lines, marks) of a geometry.");
  m.def("resized", &resized_of, nb::arg("geometry"), nb::arg("size"),
        "The geometry with other values of the parameter size.");
}

}  // namespace manyworlds::python
