// Bodies of three different moments of inertia that spin by several radians in a step, and touch.
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

TEST_CASE("what spins by radians in a step gains nothing when it touches", "[fast][physics]") {
  Random random(479);
  for (const Solver method : {Solver::tgs_soft, Solver::sequential_impulse, Solver::nncg}) {
    for (int k = 0; k < 12; ++k) {
      Scene scene = empty_scene(Space::spatial);
      scene.options.gravity.setZero();
      scene.options.solver.method = method;
      scene.add(body_of(shape_of(ground_of(Space::spatial)), Vec3::Zero(), Motion::fixed));
      const Vec3 half(random.uniform(0.005, 0.02), random.uniform(0.02, 0.05),
                      random.uniform(0.05, 0.1));
      Body plate = body_of(shape_of(Box{half}), up_of(Space::spatial) * (half.norm() + 0.02));
      plate.rotation = random.rotation();
      plate.linear_velocity = -up_of(Space::spatial) * random.uniform(0.5, 3);
      plate.angular_velocity = random.rotation() * Vec3(random.uniform(60, 900), 0, 0);
      scene.add(plate);
      for (const Table& table : all_tables()) {
        Batch batch(compile(scene), options_of(table));
        double least = batch.energy(0).kinetic;
        for (int i = 0; i < 30; ++i) {
          batch.step();
          const double now = batch.energy(0).kinetic;
          INFO(name(table) << ' ' << to_string(method) << " box " << half.transpose() << " step "
                           << i << " kinetic energy " << least << " -> " << now);
          CHECK(now <= 1.1 * least);
          least = std::min(least, now);
        }
      }
    }
  }
}

}  // namespace manyworlds::test
