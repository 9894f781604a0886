// Orientations that nothing depends on.
#include <catch2/catch.hpp>

#include "scenes/builders.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

TEST_CASE("orientations of balls that spin change no bits when kept", "[fast][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Vec3 up = up_of(space);
    Scene scene = empty_scene(space, 10);
    scene.add(ground(space, 0.5, 0.5));
    for (int i = 0; i < 5; ++i) {
      Body ball = body_of(shape_of(round_of(space, 0.4), 0.5, 0.5), Vec3(0.7 * i, 0, 0) + 0.5 * up);
      ball.angular_velocity =
          space == Space::planar ? Vec3(0, 0, 20 - 7 * i) : Vec3(9, 20 - 7 * i, 3);
      ball.jitter.position = Vec3(0.05, 0, 0) + 0.2 * up;
      scene.add(ball);
    }
    PlanOptions kept;
    kept.keep = {Feature::orientation};
    const Plan lean = compile(scene), full = compile(scene, kept);
    REQUIRE_FALSE(lean.has(Feature::orientation));
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch a(lean, options_of(table, 9)), b(full, options_of(table, 9));
      a.step(90);
      b.step(90);
      for (int w = 0; w < 9; ++w) {
        for (Field field : {Field::position, Field::linear_velocity, Field::angular_velocity})
          CHECK(same_bits(values(a, field, w), values(b, field, w)));
      }
    }
  }
}

}  // namespace manyworlds::test
