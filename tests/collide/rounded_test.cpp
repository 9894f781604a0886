// Polygons with a radius: mass, rays, checks, and at rest.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "manyworlds/query.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/mass.hpp"
#include "tests/support/scene_cases.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/solid.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

MassProperties mass_of_rounded(const Polygon& polygon) {
  Scene scene;
  scene.space = Space::planar;
  return mass_properties(scene, body_of({shape(polygon)}));
}

}  // namespace

TEST_CASE("a rounded polygon weighs what its solid does", "[fast][scene]") {
  Polygon bar = Polygon::box(0.5, 1e-7);  // a capsule, but for a hair
  bar.radius = 0.2;
  Scene scene;
  scene.space = Space::planar;
  Capsule capsule{0.2, 0.5};
  check_equal(
      mass_of_rounded(bar),
      mass_properties(scene,
                      body_of({shape(capsule, Vec3::Zero(), rotation_of(kPi / 2, Vec3::UnitZ()))})),
      1, 1e-5);

  // Any: summed over a grid.
  Polygon any{{{0.1, 0}, {1, 0.2}, {1.1, 0.9}, {0.3, 1}}, 0.15};
  const Solid solid = make_solid(shape(any), {}, Space::planar);
  constexpr int kCells = 1400;
  constexpr double kCell = 1.8 / kCells;
  double area = 0, second = 0;
  Vec2 first = Vec2::Zero();
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const Vec2 x(-0.3 + (i + 0.5) * kCell, -0.4 + (j + 0.5) * kCell);
      if (signed_distance(solid, {x.x(), x.y(), 0}) > 0) continue;
      area += kCell * kCell, first += kCell * kCell * x, second += kCell * kCell * x.squaredNorm();
    }
  }
  const MassProperties m = mass_of_rounded(any);
  CHECK(m.mass == Approx(1000 * area).epsilon(1e-4));
  CHECK(m.center.x() == Approx(first.x() / area).epsilon(1e-4));
  CHECK(m.center.y() == Approx(first.y() / area).epsilon(1e-4));
  CHECK(m.inertia(2, 2) == Approx(1000 * (second - first.squaredNorm() / area)).epsilon(1e-3));
}

TEST_CASE("bad radii of polygons are named with their value", "[fast][scene]") {
  const auto radius = [](Scene& s) -> double& {
    return std::get<Polygon>(s.bodies[1].shapes[0].geometry).radius;
  };
  check_each(planar_scene_with(Polygon::box(1, 1)), "body 1 'crate', shape 0 'hull': ",
             {{"radius", "is -1 m, must be > 0", [&](Scene& s) { radius(s) = -1; }},
              {"radius", "is nan m",
               [&](Scene& s) { radius(s) = std::numeric_limits<double>::quiet_NaN(); }}});
}

TEST_CASE("rays and distances see the rounding", "[fast][query][observe]") {
  Polygon square = Polygon::box(0.5, 0.3);
  square.radius = 0.1;
  const Shape s = shape(square);
  const auto cast = [&](const Vec3& from, const Vec3& way) {
    Ray ray;
    ray.origin = from, ray.direction = way;
    return ray_cast(s, {}, ray, Space::planar);
  };
  const double near = has_table({Isa::scalar, Precision::f64}) ? 1e-12 : 1e-5;
  CHECK(cast({-2, 0, 0}, Vec3::UnitX())->distance == approx(1.4, near));
  CHECK(cast({-2, 0.36, 0}, Vec3::UnitX())->distance == approx(1.42, near));
  CHECK((cast({-2, 0.36, 0}, Vec3::UnitX())->normal - Vec3(-0.8, 0.6, 0)).norm() < 1e-5);
  CHECK_FALSE(cast({-2, 0.41, 0}, Vec3::UnitX()));
  CHECK(cast({0.55, 0.2, 0}, Vec3::UnitX())->distance == 0);
  CHECK(cast({0.57, 0.37, 0}, Vec3::UnitX())->distance == 0);
  CHECK(cast({0.58, 0.38, 0}, Vec3(-1, -1, 0))->distance ==
        approx(0.08 * std::sqrt(2.0) - 0.1, 1e-5));
  const auto d = distance(s, {}, shape(Circle{0.2}), {Vec3(0.8, 0.7, 0), Quat::Identity()});
  CHECK(d.distance == Approx(0.2));
  CHECK((d.normal - Vec3(0.6, 0.8, 0)).norm() < 1e-9);
}

TEST_CASE("rounded squares stack and rest on terrain, with bits of their own",
          "[fast][stability]") {
  Polygon square = Polygon::box(0.4, 0.4);
  square.radius = 0.1;
  Scene scene = empty_scene(Space::planar);
  scene.add(test::body_of(shape_of(Terrain{{{-5, 0}, {-1.3, 0}, {-0.2, 0}, {1.7, 0}, {5, 0}}}),
                          Vec3::Zero(), Motion::fixed));
  for (int i = 0; i < 5; ++i)
    scene.add(test::body_of(shape_of(square), Vec3(0.01 * i, 0.5 + i, 0)));
  scene.add(test::body_of(shape_of(Polygon::box(0.3, 0.2)), Vec3(3, 0.2, 0)));
  scene.add(test::body_of(shape_of(Circle{0.3}), Vec3(-3, 0.3, 0)));
  scene.add(test::body_of(shape_of(Capsule{0.2, 0.3}), Vec3(-2, 0.5, 0)));
  for (Precision precision : {Precision::f32, Precision::f64}) {
    std::vector<std::uint64_t> expected;
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      Batch batch(compile(scene), options_of(table, 5));
      batch.step(600);
      INFO(name(table));
      for (int i = 0; i < 5; ++i) CHECK(position(batch, 2, i).y() == approx(0.5 + i, 0.02));
      CHECK(position(batch, 2, 5).y() == approx(0.2, 2e-3));
      CHECK(max_speed(batch, 2) < 0.02);
      std::vector<std::uint64_t> hashes;
      for (int w = 0; w < 5; ++w) hashes.push_back(batch.hash(w));
      if (expected.empty()) expected = hashes;
      CHECK(hashes == expected);
    }
  }
}

}  // namespace manyworlds::test
