// What the rows layout alone leaves out has no effect.
#include <catch2/catch.hpp>

#include <algorithm>
#include <vector>

#include "tests/support/hashes.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

std::vector<std::uint64_t> run_rows(const Plan& plan, const BatchOptions& options) {
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
          const auto dense = run_rows(plan, options);
          options.layout = ContactLayout::rows;
          CHECK(run_rows(plan, options) == dense);
        }
      }
    }
  }
}

// Rows are packed from what each world has for itself (kernels/broad/candidates.cpp): next to one
// in which all balls touch all others may be one in which none do. The largest crowds have more
// pairs than contacts are kept of.
TEST_CASE("rows hold from none to all of the pairs of a world, next to each other",
          "[fast][bits]") {
  constexpr int kWorlds = 37;
  for (const Space space : {Space::planar, Space::spatial}) {
    for (const int balls : {2, 6, 7, 17, 33, 64}) {
      Scene scene = empty_scene(space, 0);
      const Shape ball =
          space == Space::planar ? shape_of(Circle{0.5}, 0.5) : shape_of(Sphere{0.5}, 0.5);
      for (int i = 0; i < balls; ++i) scene.add(body_of(ball, Vec3(2.0 * i, 0, 0)));
      const Plan plan = compile(scene);
      std::vector<std::uint64_t> reference;
      for (const Table& table : all_tables()) {
        if (table.precision != Precision::f32) continue;
        BatchOptions options = options_of(table, kWorlds);
        for (const auto layout : {ContactLayout::dense, ContactLayout::rows}) {
          options.layout = layout;
          Batch batch(plan, options);
          for (int w = 0; w < kWorlds; ++w) {
            // As many as w, or the rest, are a heap; the others stay where they are.
            const int heap = w % 3 == 0 ? balls : std::min(w, balls);
            std::vector<double> positions(batch.size(Field::position) / kWorlds);
            batch.read(Field::position, w, positions);
            const std::size_t row = positions.size() / static_cast<std::size_t>(balls);
            for (int i = 0; i < heap; ++i) {
              positions[static_cast<std::size_t>(i) * row] = 0.004 * i;
              positions[static_cast<std::size_t>(i) * row + 1] = 0.003 * (i % 5);
            }
            batch.write(Field::position, w, positions);
          }
          batch.step(3);
          const auto found = hashes(batch);
          if (reference.empty()) reference = found;
          INFO(balls << " balls, " << name(table) << ", layout " << static_cast<int>(layout));
          CHECK(found == reference);
        }
      }
    }
  }
}

}  // namespace manyworlds::test
