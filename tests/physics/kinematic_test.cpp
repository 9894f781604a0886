// Kinematic bodies among those that tumble.
#include <catch2/catch.hpp>

#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

// Their inertia is 0, and no gyroscopic term is to be solved for them.
TEST_CASE("a kinematic body lifts bodies that tumble", "[fast][kinematic]") {
  for (const Geometry& lift :
       {Geometry(Sphere{0.5}), Geometry(Capsule{0.3, 0.4}), Geometry(Box{})}) {
    for (const Geometry& load : {Geometry(Capsule{0.4, 0.3}), Geometry(Box{{0.5, 0.6, 0.4}})}) {
      Scene scene = empty_scene(Space::spatial);
      scene.add(body_of(shape_of(load), Vec3(0.01, 0, 1.3)));
      scene.add(body_of(shape_of(lift), Vec3::Zero(), Motion::kinematic));
      scene.bodies[1].linear_velocity = Vec3(0, 0, 2);
      const Plan plan = compile(scene);
      REQUIRE(plan.has(Feature::inertia));
      for (const Table& table : all_tables()) {
        INFO(name(table) << ", lift " << lift.index() << ", load " << load.index());
        Batch batch(plan, options_of(table, 3));
        batch.step(30);
        for (int w = 0; w < 3; ++w) {
          CHECK(batch.status(w) == Status::ok);
          CHECK(velocity(batch, w, 1) == Vec3(0, 0, 2));
          CHECK(spin(batch, w, 1) == Vec3::Zero());
          CHECK(position(batch, w, 1).z() == Approx(1).epsilon(1e-5));
          CHECK(position(batch, w, 0).z() > 1.5);  // without the lift it would be at 0.05
        }
      }
    }
  }
}

}  // namespace manyworlds::test
