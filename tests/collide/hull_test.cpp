// Hulls: made of clouds of points, checked, and what they weigh.
#include <catch2/catch.hpp>

#include <cmath>

#include "manyworlds/hull.hpp"
#include "manyworlds/plan.hpp"
#include "src/scene/convex_hull.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/mass.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scene_cases.hpp"

namespace manyworlds::test {
namespace {

std::vector<Vec3> corners_of_box(const Vec3& half) {
  std::vector<Vec3> out;
  for (int i = 0; i < 8; ++i)
    out.push_back(half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  return out;
}

std::string message_of(const std::vector<Vec3>& points) {
  try {
    make_hull(points);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

MassProperties mass_of_solid(Geometry geometry) {
  Scene scene;
  return mass_properties(scene, body_of({shape(std::move(geometry))}));
}

}  // namespace

TEST_CASE("a cloud of points becomes the corners of its hull", "[fast][scene]") {
  std::vector<Vec3> points = corners_of_box({1, 2, 3});
  Random random(1);
  for (int i = 0; i < 200; ++i) points.push_back(random.in_cube(1).cwiseProduct(Vec3(1, 2, 3)));
  points.emplace_back(1, 0.3, 0.2);  // on a face
  points.emplace_back(1, 2, 0.5);    // on an edge
  points.push_back(points[3]);       // twice
  const Hull hull = make_hull(points);
  REQUIRE(hull.vertices.size() == 8);
  for (const Vec3& v : hull.vertices) CHECK(v.cwiseAbs() == Vec3(1, 2, 3));
}

TEST_CASE("coplanar faces of a hull are one, counter-clockwise from outside", "[fast][scene]") {
  const Vec3 far(1e4, -2e4, 5e3);
  std::vector<Vec3> box = corners_of_box({1, 2, 3});
  for (Vec3& v : box) v += far;
  const detail::ConvexHull hull = *detail::convex_hull(box);
  REQUIRE(hull.faces.size() == 6);
  for (const detail::HullFace& f : hull.faces) {
    REQUIRE(f.outline.size() == 4);
    CHECK(f.normal.cwiseAbs().maxCoeff() == approx(1, 1e-9));
    for (std::size_t i = 0; i < 4; ++i) {
      const auto at = [&](std::size_t k) {
        return hull.vertices[static_cast<std::size_t>(f.outline[k % 4])];
      };
      CHECK((at(i + 1) - at(i)).cross(at(i + 2) - at(i + 1)).dot(f.normal) > 0);
    }
  }
  // A prism of 32 sides.
  std::vector<Vec3> prism;
  for (int i = 0; i < 64; ++i) {
    const double angle = 2 * 3.14159265358979323846 * (i / 2) / 32;
    prism.emplace_back(std::cos(angle), std::sin(angle), i % 2 ? 0.5 : -0.5);
  }
  CHECK(detail::convex_hull(prism)->faces.size() == 34);
  CHECK(make_hull(prism).vertices.size() == 64);
}

TEST_CASE("what is no hull is an error that says why", "[fast][scene]") {
  CHECK_THAT(message_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
             Catch::Contains("points are 3, must be at least 4"));
  CHECK_THAT(message_of({{0, 0, 0}, {1, kNan, 0}, {0, 1, 0}, {0, 0, 1}}),
             Catch::Contains("points[1].y is nan m"));
  const std::string flat = "points lie in a plane, must enclose a volume";
  CHECK_THAT(message_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {3, 2, 0}}),
             Catch::Contains(flat));
  CHECK_THAT(message_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}), Catch::Contains(flat));
  CHECK_THAT(message_of(std::vector<Vec3>(7, Vec3(1, 2, 3))), Catch::Contains(flat));
}

TEST_CASE("a hull of too many corners is an error that says how many", "[slow][scene]") {
  std::vector<Vec3> ball;
  Random random(2);
  for (int i = 0; i < 9000; ++i) ball.push_back(random.direction());
  CHECK_THAT(message_of(ball), Catch::Contains(", must be at most 8192"));
}

TEST_CASE("bad cylinders and hulls are named with their value", "[fast][scene]") {
  const auto cylinder = [](Scene& s) -> Cylinder& {
    return std::get<Cylinder>(s.bodies[1].shapes[0].geometry);
  };
  const char* const place = "body 1 'crate', shape 0 'hull': ";
  check_each(spatial_scene_with(Cylinder{0.5, 1}), place,
             {{"radius", "is 0 m, must be > 0", [&](Scene& s) { cylinder(s).radius = 0; }},
              {"half_length", "is nan m", [&](Scene& s) { cylinder(s).half_length = kNan; }}});
  const auto vertices = [](Scene& s) -> std::vector<Vec3>& {
    return std::get<Hull>(s.bodies[1].shapes[0].geometry).vertices;
  };
  check_each(spatial_scene_with(Hull{corners_of_box({1, 2, 3})}), place,
             {{"vertices", "are 3, must be 4 to 8192", [&](Scene& s) { vertices(s).resize(3); }},
              {"vertices", "are 8193, must be 4 to 8192",
               [&](Scene& s) { vertices(s).resize(8193, Vec3::Zero()); }},
              {"vertices[2].z", "is nan m", [&](Scene& s) { vertices(s)[2].z() = kNan; }},
              {"vertices[5]", "the same as vertices[1]",
               [&](Scene& s) { vertices(s)[5] = vertices(s)[1]; }},
              {"vertices", "lie in a plane", [&](Scene& s) {
                 for (Vec3& v : vertices(s)) v.x() *= v.z() > 0 ? 2 : 1, v.z() = 0.3 * v.x();
               }}});
  Scene planar = planar_scene_with(Circle{0.5});
  planar.bodies[1].shapes[0].geometry = Hull{corners_of_box({1, 2, 3})};
  CHECK(places(planar) == std::vector<std::string>{std::string(place) + "geometry"});
  planar.bodies[1].shapes[0].geometry = Cylinder{};
  CHECK(places(planar) == std::vector<std::string>{std::string(place) + "geometry"});
}

TEST_CASE("hulls and cylinders weigh what their solids do", "[fast][scene]") {
  const Vec3 half(0.3, 0.5, 0.7);
  check_equal(mass_of_solid(Hull{corners_of_box(half)}), mass_of_solid(Box{half}));
  const MassProperties corner = mass_of_solid(Hull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  CHECK(corner.mass == Approx(1000.0 / 6));
  CHECK((corner.center - Vec3::Constant(0.25)).norm() < 1e-15);
  CHECK(corner.inertia(0, 0) == Approx(corner.mass * 3.0 / 40));
  CHECK(corner.inertia(0, 1) == Approx(corner.mass / 80));
  const MassProperties rod = mass_of_solid(Cylinder{0.2, 1.5});
  CHECK(rod.mass == Approx(1000 * 3.14159265358979 * 0.04 * 3));
  CHECK(rod.inertia(2, 2) == Approx(rod.mass * 0.02));
  CHECK(rod.inertia(0, 0) == Approx(rod.mass * (0.01 + 0.75)));
}

}  // namespace manyworlds::test
