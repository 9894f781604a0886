// Far from the origin, very small and very large.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// A 2D pyramid of squares of this size, `base` of them below, on ground at `origin`.
Scene pyramid(int base, double size, const Vec3& origin) {
  Scene scene = empty_scene(Space::planar);
  Body floor = ground(Space::planar);
  floor.position = origin;
  scene.add(floor);
  const Geometry square = Polygon::box(size / 2, size / 2);
  for (int row = 0; row < base; ++row)
    for (int k = 0; k < base - row; ++k)
      scene.add(body_of(shape_of(square), origin + Vec3(size * 1.05 * (k - 0.5 * (base - 1 - row)),
                                                        size * (0.5 + row), 0)));
  return scene;
}

// Boxes of this size.
Scene stack(Space space, int boxes, double size, double gap) {
  Scene scene = empty_scene(space);
  scene.add(ground(space));
  for (int i = 0; i < boxes; ++i)
    scene.add(body_of(shape_of(cube_of(space, size / 2)),
                      (size * (0.5 + i) + gap * (i + 1)) * up_of(space)));
  return scene;
}

// Steps until everything sleeps; how many, or -1.
int steps_to_sleep(Batch& batch, int most) {
  for (int i = 0; i < most; ++i) {
    batch.step();
    if (batch.asleep(0)) return i + 1;
  }
  return -1;
}

}  // namespace

// B32, in float64: the same fall at the origin and 10,000 km away.
TEST_CASE("far from the origin float64 does the same", "[slow][stability]") {
  for (const Table& table : all_tables()) {
    if (table.precision != Precision::f64) continue;
    BatchOptions options = options_of(table);
    options.sleep = true;
    const Vec3 far(1e7, -8e6, 0);
    Batch here(compile(pyramid(6, 1, Vec3::Zero())), options),
        there(compile(pyramid(6, 1, far)), options);
    const int steps = steps_to_sleep(here, 1200);
    CHECK(steps > 0);
    CHECK(steps_to_sleep(there, 1200) == steps);
    double apart = 0;
    for (int b = 0; b < here.bodies(); ++b)
      apart = std::max(apart, (position(there, 0, b) - far - position(here, 0, b)).norm());
    INFO(name(table) << " steps " << steps << " apart " << apart);
    CHECK(apart < 1e-3);
  }
}

// B32, in float32: what a position can still tell is a matter of its last place.
TEST_CASE("far from the origin float32 keeps a stack within a few last places",
          "[slow][stability]") {
  struct Place {
    double x, y;
  };
  for (const Place& at : {Place{6e3, -1.5e3}, Place{4e4, -2.5e4}, Place{1e5, -8e4}}) {
    for (const Table& table : widest_tables()) {
      if (table.precision != Precision::f32) continue;
      const Vec3 origin(at.x, at.y, 0);
      Batch batch(compile(pyramid(5, 1, origin)), options_of(table));
      std::vector<Vec3> start;
      for (int b = 0; b < batch.bodies(); ++b) start.push_back(position(batch, 0, b));
      batch.step(600);
      const double place = std::ldexp(1.0, static_cast<int>(std::floor(std::log2(at.x))) - 23);
      double drift = 0;
      for (int b = 0; b < batch.bodies(); ++b)
        drift = std::max(
            drift,
            (position(batch, 0, b) - start[static_cast<std::size_t>(b)]).cwiseAbs().maxCoeff());
      INFO(name(table) << " at " << at.x << " drift " << drift << " last place " << place);
      CHECK(batch.status(0) == Status::ok);
      CHECK(drift < std::max(4 * place, 0.01));
      CHECK(max_speed(batch, 0) < 0.1);
    }
  }
}

// B33. A step of 1/60 s is long for boxes of 5 cm: the bottom row of 30 wants as many substeps as
// it would have in a step in proportion.
TEST_CASE("a pyramid of boxes of 5 cm stands", "[slow][stability]") {
  Scene scene = pyramid(30, 0.05, Vec3::Zero());
  scene.options.length_unit = 0.05;
  scene.options.substeps = 16;
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table));
    batch.step(600);
    const double top = position(batch, 0, batch.bodies() - 1).y();
    INFO(name(table) << " top " << top << " speed " << max_speed(batch, 0));
    CHECK(batch.status(0) == Status::ok);
    CHECK(top == approx(0.05 * 29.5, 0.05 * 0.5));
    CHECK(max_speed(batch, 0) < 0.05);
  }
}

TEST_CASE("cubes of a millimetre and of a kilometre fall and stack", "[slow][stability]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (double size : {1e-3, 1.0, 1e3}) {
      const double root = std::sqrt(size);
      Scene scene = stack(space, 5, size, 0.05 * size);
      scene.options.dt = root / 60;
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        batch.step(1200);
        const double top = position(batch, 0, 4).dot(up_of(space)) / size;
        INFO(name(table) << " size " << size << " top " << top << " depth "
                         << max_penetration(batch, 0) / size << " speed "
                         << max_speed(batch, 0) / root);
        CHECK(batch.status(0) == Status::ok);
        CHECK(top == approx(4.5, 0.02));
        CHECK(max_penetration(batch, 0) < 0.02 * size);
        CHECK(max_speed(batch, 0) < 0.05 * root);
      }
    }
  }
}

}  // namespace manyworlds::test
