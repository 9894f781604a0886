// Shapes that touch at exactly no distance, with their faces deep inside one another.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

TEST_CASE("sides that cross and just touch are not taken for faces", "[fast][collide]") {
  // Distances are powers of two, so that the gap is 0 in any precision.
  for (const Geometry& upper : {Geometry(Cylinder{0.25, 0.5}), Geometry(Capsule{0.25, 0.5}),
                                Geometry(Box{{0.25, 0.25, 0.5}})}) {
    Scene scene = empty_scene(Space::spatial);
    scene.add(body_of(shape_of(Cylinder{0.25, 0.5}), Vec3::Zero()));
    Body crossed = body_of(shape_of(upper), Vec3(0, 0.5, 0));
    crossed.rotation = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()));
    scene.add(crossed);
    for (const Table& table : widest_tables()) {
      const Batch batch(compile(scene), options_of(table));
      const auto contacts = batch.contacts(0);
      INFO(name(table) << " upper " << upper.index());
      REQUIRE(!contacts.empty());
      for (const Contact& c : contacts) {
        CHECK(std::abs(c.separation) < 1e-6);
        CHECK(c.normal.cross(Vec3::UnitY()).norm() < 1e-6);
      }
    }
  }
}

}  // namespace manyworlds::test
