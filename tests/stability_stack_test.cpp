// Stacks, overlaps and coincident bodies: settled, bounded, deterministic.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// At rest by the usual sleep threshold: 0.05 m/s, for corners too.
double liveliness(const Batch& batch, int world, double extent) {
  double most = max_speed(batch, world);
  for (int i = 0; i < batch.bodies(world); ++i)
    most = std::max(most, spin(batch, world, i).norm() * extent);
  return most;
}

Scene tower(Space space, int boxes) {
  Scene scene = empty_scene(space);
  scene.add(ground(space, 0.3));
  for (int i = 0; i < boxes; ++i) {
    const Vec3 at = Vec3(i % 2 == 0 ? 0.01 : -0.01, 0, 0) + (0.5 + 1.1 * i) * up_of(space);
    Body box = body_of(shape_of(cube_of(space, 0.5), 0.3), at);
    box.jitter.position = space == Space::planar ? Vec3(1e-3, 0, 0) : Vec3(1e-3, 1e-3, 0);
    scene.add(box);
  }
  return scene;
}

// Sum of the normal impulses between two scene bodies, N s.
double impulse_between(const std::vector<Contact>& contacts, int a, int b) {
  double sum = 0;
  for (const Contact& c : contacts)
    if ((c.body_a == a && c.body_b == b) || (c.body_a == b && c.body_b == a))
      sum += c.normal_impulse;
  return sum;
}

}  // namespace

TEST_CASE("towers of 10 and 20 boxes settle, stand and carry their weight", "[slow][stability]") {
  constexpr int kWorlds = 8;
  for (Space space : {Space::planar, Space::spatial}) {
    for (int boxes : {10, 20}) {
      Scene scene = tower(space, boxes);
      if (space == Space::spatial && boxes == 20) {
        // A column of soft contacts buckles under its own weight when it is too tall for their
        // stiffness; 20 cubes need more of it than 4 substeps carry.
        scene.options.substeps = 8;
        scene.options.contact_frequency = 90;
      }
      const Plan plan = compile(scene);
      for (const Table& table : widest_tables()) {
        Batch batch(plan, options_of(table, kWorlds));
        INFO(name(table) << ' ' << boxes << (space == Space::planar ? " squares" : " cubes"));
        batch.step(600);
        double restless = 0;
        for (int i = 0; i < 10; ++i) {
          batch.step(60);
          for (int w = 0; w < kWorlds; ++w)
            restless = std::max(restless, liveliness(batch, w, 0.7));
        }
        CHECK(restless < 0.05);  // settled by 10 s and ever after
        const double weight = mass_properties(scene, scene.bodies[1]).mass * 10;
        const double h = scene.options.dt / scene.options.substeps;
        for (int w = 0; w < kWorlds; ++w) {
          INFO("world " << w);
          CHECK(batch.status(w) == Status::ok);
          const Vec3 top = position(batch, w, boxes - 1);
          CHECK(top.dot(up_of(space)) == Approx(boxes - 0.5).margin(0.006 * boxes));
          CHECK(Vec3(top - top.dot(up_of(space)) * up_of(space)).norm() < 0.1);
          if (boxes == 10) CHECK(max_penetration(batch, w) < 0.006);
          const auto contacts = batch.contacts(w);
          for (int i = 0; i < boxes; ++i) {
            INFO("level " << i);
            CHECK(impulse_between(contacts, i, i + 1) ==
                  Approx((boxes - i) * weight * h).epsilon(0.01));
          }
        }
      }
    }
  }
}

TEST_CASE("a pyramid spawned with overlap is pushed apart gently", "[slow][stability]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space);
    scene.add(ground(space));
    constexpr double kStep = 0.75;  // of squares of size 1: they overlap by a quarter
    for (int row = 0; row < 4; ++row)
      for (int k = 0; k < 4 - row; ++k)
        scene.add(body_of(shape_of(cube_of(space, 0.5)), Vec3(kStep * (k - 0.5 * (3 - row)), 0, 0) +
                                                             (0.5 + kStep * row) * up_of(space)));
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      INFO(name(table) << (space == Space::planar ? " squares" : " cubes"));
      double fastest = 0;
      for (int i = 0; i < 300; ++i) {
        batch.step();
        fastest = std::max(fastest, max_speed(batch, 0));
      }
      CHECK(fastest < 3.5);
      double restless = 0;
      for (int i = 0; i < 60; ++i) {
        batch.step();
        restless = std::max(restless, liveliness(batch, 0, 0.7));
      }
      CHECK(restless < 0.05);
      CHECK(max_penetration(batch, 0) < 0.01);
      CHECK(batch.status(0) == Status::ok);
    }
  }
}

namespace {

void check_separation(const std::vector<int>& counts) {
  for (Space space : {Space::planar, Space::spatial}) {
    for (bool boxes : {false, true}) {
      for (int count : counts) {
        Scene scene = empty_scene(space, 0);
        for (int i = 0; i < count; ++i)
          scene.add(
              body_of(shape_of(boxes ? cube_of(space, 0.5) : round_of(space, 0.5)), Vec3::Zero()));
        for (const Table& table : widest_tables()) {
          Batch batch(compile(scene), options_of(table, 2));
          INFO(name(table) << ' ' << count << (boxes ? " boxes" : " balls")
                           << (space == Space::planar ? " planar" : " spatial"));
          double fastest = 0;
          const int seconds = count == 100 ? 40 : 10;
          for (int i = 0; i < 60 * seconds; ++i) {
            batch.step();
            if (i % 4 != 0) continue;
            if (count <= 10) {
              fastest = std::max(fastest, max_speed(batch, 0));
            } else {
              // A hundred bodies in one place push each other out in rows, and the speeds of a row
              // add up: what is bounded is the speed of each pair.
              for (const Contact& c : batch.contacts(0))
                fastest = std::max(
                    fastest,
                    (velocity(batch, 0, c.body_b) - velocity(batch, 0, c.body_a)).dot(c.normal));
            }
          }
          CHECK(fastest < 4);
          CHECK_FALSE(lost(batch.status(0)));
          CHECK(batch.hash(0) == batch.hash(1));
          CHECK(max_penetration(batch, 0) < 0.01);
        }
      }
    }
  }
}

}  // namespace

TEST_CASE("bodies with one common centre separate slowly and the same way each time",
          "[slow][stability]") {
  check_separation({2, 10});
}

// A gate that is not met yet: more pairs overlap than a plan has room for, and pairs of a hundred
// bodies part at 5 to 7 m/s.
TEST_CASE("a hundred bodies with one common centre separate slowly",
          "[slow][stability][!mayfail]") {
  check_separation({100});
}

}  // namespace manyworlds::test
