// Surfaces of geometries, judged by mass properties and distances, which know nothing of triangles.
#include "manyworlds/surface.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include <catch2/catch.hpp>

#include "manyworlds/hull.hpp"
#include "manyworlds/query.hpp"

namespace manyworlds {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

Vec3 area_of(const Surface& s, const std::array<int, 3>& t) {
  const Vec3 &a = s.points[index(t[0])], &b = s.points[index(t[1])], &c = s.points[index(t[2])];
  return (b - a).cross(c - a) / 2;
}

double volume_of(const Surface& s) {
  double out = 0;
  for (const auto& t : s.triangles) out += area_of(s, t).dot(s.points[index(t[0])]) / 3;
  return out;
}

// Each edge as often in one direction as in the other, points in the same place being the same.
bool is_closed(const Surface& s, double size) {
  const auto place = [&](int i) {
    const Vec3& p = s.points[index(i)];
    const auto round = [&](double x) { return std::llround(x / size * 1e7); };
    return std::tuple(round(p.x()), round(p.y()), round(p.z()));
  };
  std::map<std::pair<decltype(place(0)), decltype(place(0))>, int> edges;
  for (const auto& t : s.triangles) {
    for (int k = 0; k < 3; ++k) {
      const auto from = place(t[index(k)]), to = place(t[index((k + 1) % 3)]);
      if (from < to) ++edges[{from, to}];
      if (to < from) --edges[{to, from}];
    }
  }
  return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; });
}

double mass_of(const Geometry& geometry, Space space) {
  Scene scene;
  scene.space = space;
  scene.options.density = 1;
  Body body;
  body.shapes = {{.geometry = geometry}};
  return mass_properties(scene, body).mass;
}

Hull wedge() {
  return make_hull({{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 1}, {1, 0, 1}, {0, 2, 1}});
}

void check_sound(const Surface& s) {
  REQUIRE(s.points.size() == s.normals.size());
  const int points = static_cast<int>(s.points.size());
  for (const auto& t : s.triangles) {
    for (const int i : t) REQUIRE((i >= 0 && i < points));
    const Vec3 area = area_of(s, t);
    REQUIRE(area.norm() > 0);
    for (const int i : t) CHECK(area.normalized().dot(s.normals[index(i)]) > 0);
  }
  for (const Vec3& n : s.normals) CHECK(std::abs(n.norm() - 1) < 1e-12);
  int in_faces = 0;
  for (const auto& [first, count] : s.faces) {
    REQUIRE((first >= 0 && count >= 3 && first + count <= points));
    for (int i = first; i < first + count; ++i) {
      CHECK(std::abs(s.normals[index(i)].dot(s.points[index(i)] - s.points[index(first)])) < 1e-9);
    }
    in_faces += count - 2;
  }
  CHECK(in_faces <= static_cast<int>(s.triangles.size()));
}

}  // namespace

TEST_CASE("a surface in space is closed, has the solid's volume, and lies on it",
          "[fast][scene][surface]") {
  const auto [name, geometry, flat] = GENERATE(table<const char*, Geometry, bool>({
      {"sphere", Sphere{0.7}, false},
      {"box", Box{{0.2, 0.5, 1}}, true},
      {"capsule", Capsule{0.3, 0.8}, false},
      {"cylinder", Cylinder{0.4, 0.9}, false},
      {"ellipsoid", Ellipsoid{{0.3, 0.5, 0.9}}, false},
      {"hull", wedge(), true},
  }));
  CAPTURE(name);
  for (const int around : {8, 10, 24, 96}) {
    CAPTURE(around);
    const Surface s = surface(geometry, {.around = around});
    check_sound(s);
    CHECK(is_closed(s, 1));
    const double solid = mass_of(geometry, Space::spatial), found = volume_of(s);
    // Chords stay outside of a circle of cos(a / 2) of the radius, along a ring and across it.
    const double a = 2 * std::numbers::pi / around;
    CHECK(found <= solid * (1 + 1e-12));
    CHECK(found >= solid * (flat ? 1 - 1e-12 : std::pow(std::cos(a / 2), 6)));
    // A point out along the normal is that far away.
    const Shape shape{.geometry = geometry};
    const double r = 1e-6, out = 0.01;
    for (std::size_t i = 0; i < s.points.size(); ++i) {
      Pose pose;
      pose.position = s.points[i] + out * s.normals[i];
      const double d = distance(shape, {}, {.geometry = Sphere{r}}, pose).distance;
      CHECK(std::abs(d - (out - r)) < 1e-6);
    }
  }
}

TEST_CASE("a surface in the plane has the solid's area and outline", "[fast][scene][surface]") {
  const auto [name, geometry, flat] = GENERATE(table<const char*, Geometry, bool>({
      {"circle", Circle{0.7}, false},
      {"capsule", Capsule{0.3, 0.8}, false},
      {"box", Polygon::box(0.5, 0.2), true},
      {"triangle", Polygon{{{1, 0}, {0, 1}, {-1, 0}}}, true},
      {"rounded", Polygon{{{1, 0}, {0, 1}, {-1, 0}}, 0.25}, false},
  }));
  CAPTURE(name);
  for (const int around : {8, 24, 96}) {
    const Surface s = surface(geometry, {.space = Space::planar, .around = around});
    check_sound(s);
    double area = 0;
    for (const auto& t : s.triangles) area += area_of(s, t).z();
    const double solid = mass_of(geometry, Space::planar), a = 2 * std::numbers::pi / around;
    CHECK(area <= solid * (1 + 1e-12));
    CHECK(area >= solid * (flat ? 1 : std::sin(a) / a) * (1 - 1e-12));
    REQUIRE(s.lines.size() == 1);
    const std::vector<Vec3>& line = s.lines[0];
    CHECK(line.front() == line.back());
    double enclosed = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
      enclosed += line[i].cross(line[i + 1]).z() / 2;
    CHECK(enclosed == Approx(area).epsilon(1e-12));
  }
}

TEST_CASE("ground without end is cut to a box", "[fast][scene][surface]") {
  const SurfaceOptions box{.low = {-1, -2, -3}, .high = {2, 3, 4}};
  const Vec3 n = Vec3(0.2, 0.3, 0.9).normalized();
  const Surface plane = surface(Plane{n, 0.4}, box);
  check_sound(plane);
  REQUIRE(plane.faces.size() == 1);
  for (const Vec3& p : plane.points) {
    CHECK(std::abs(n.dot(p) - 0.4) < 1e-12);
    CHECK(((p - box.low).minCoeff() > -1e-12 && (box.high - p).minCoeff() > -1e-12));
  }
  double area = 0;
  for (const auto& t : plane.triangles) area += area_of(plane, t).dot(n);
  CHECK(area == Approx(3 * 5 / n.z()));  // it leaves the box through its four sides alone
  CHECK(surface(Plane{{0, 0, 1}, 5}, box).points.empty());
  CHECK(surface(Plane{{0, 0, 1}, 0}, box).points.size() == 4);

  const Surface half = surface(HalfPlane{{0, 1}, 0.5}, box);
  check_sound(half);
  area = 0;
  for (const auto& t : half.triangles) area += area_of(half, t).z();
  CHECK(area == Approx(3 * 2.5));
  REQUIRE(half.lines.size() == 1);
  CHECK(half.lines[0].front() == Vec3(-1, 0.5, 0));
  CHECK(half.lines[0].back() == Vec3(2, 0.5, 0));
}

TEST_CASE("lines and height fields have their own points", "[fast][scene][surface]") {
  const Surface segment = surface(Segment{{0, 1}, {2, 3}});
  CHECK(segment.triangles.empty());
  CHECK(segment.lines == std::vector<std::vector<Vec3>>{{{0, 1, 0}, {2, 3, 0}}});
  const Surface loop = surface(Terrain{{{0, 0}, {1, 0}, {0, 1}}, true});
  CHECK(loop.lines == std::vector<std::vector<Vec3>>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}});

  const HeightField field{{0, 1, 0, 0, 2, 0}, 3, {1, 2}};
  const Surface ground = surface(field);
  check_sound(ground);
  REQUIRE(ground.points.size() == 6);
  CHECK(ground.triangles.size() == 4);
  CHECK(ground.points[1] == Vec3(0, -1, 1));
  CHECK(ground.points[4] == Vec3(0, 1, 2));
  for (const Vec3& normal : ground.normals) CHECK(normal.z() > 0);
  REQUIRE(ground.lines.size() == 1);
  CHECK(ground.lines[0].size() == 7);
}

TEST_CASE("surfaces refuse what they cannot draw", "[fast][scene][surface]") {
  CHECK_THROWS_WITH(surface(Sphere{}, {.around = 7}), "surface: around is 7, must be 8 to 1024");
  CHECK_THROWS_WITH(surface(Plane{}, {.low = {0, 0, 0}, .high = {1, 0, 1}}),
                    "surface: low.y is 0 m and high.y is 0 m, must be finite, the low one less");
  CHECK_THROWS_AS(surface(Sphere{-1}), SceneError);
  CHECK_THROWS_WITH(surface(Sphere{-1}), Catch::Contains("radius is -1 m, must be"));
}

}  // namespace manyworlds
