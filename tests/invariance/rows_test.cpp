// What the rows layout alone leaves out has no effect.
#include <catch2/catch.hpp>

#include <vector>

#include "tests/support/hashes.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

std::vector<std::uint64_t> run(const Plan& plan, const BatchOptions& options) {
  Batch batch(plan, options);
  batch.step(60);
  for (int w = 0; w < batch.worlds(); ++w) CHECK_FALSE(frozen(batch.status(w)));
  return hashes(batch);
}

}  // namespace

// In rows, pairs of rectangles that stay apart in the step are dropped before they are looked at
// (kernels/broad/drop_distant.cpp): not one may be missed that dense blocks have.
TEST_CASE("rows miss no contact of rectangles, however small, fast and spinning", "[fast][bits]") {
  for (const double size : {1e-3, 1.0, 100.0}) {
    for (const double speed : {0.0, 5.0, 60.0}) {  // sizes per second
      for (const double spin : {0.0, 2.0, 40.0}) {
        Scene scene = empty_scene(Space::planar);
        scene.add(ground(Space::planar, 0.5, 0.2));
        for (int i = 0; i < 24; ++i) {
          const Shape rod = shape_of(Polygon::box(0.8 * size, 0.15 * size), 0.5);
          const Shape ball = shape_of(Circle{0.4 * size}, 0.5);
          const Vec3 at = size * Vec3(1.2 * (i % 4 - 1.5), 0.8 + 0.9 * (i / 4), 0);
          Body body = body_of(i % 3 == 2 ? ball : rod, at);
          body.linear_velocity = -speed * size * Vec3(i % 4 - 1.5, 1, 0).normalized();
          body.jitter.linear_velocity = speed * size * Vec3(1, 1, 0);
          body.jitter.position = 0.1 * size * Vec3(1, 1, 0);
          body.angular_velocity = Vec3(0, 0, i % 2 == 0 ? spin : -spin);
          body.jitter.angle = 3;
          scene.add(body);
        }
        const Plan plan = compile(scene);
        for (const Table& table : widest_tables()) {
          INFO("size " << size << " m, speed " << speed << " sizes/s, spin " << spin << " rad/s, "
                       << name(table));
          BatchOptions options = options_of(table, 37);
          options.layout = ContactLayout::dense;
          const auto dense = run(plan, options);
          options.layout = ContactLayout::rows;
          CHECK(run(plan, options) == dense);
        }
      }
    }
  }
}

}  // namespace manyworlds::test
