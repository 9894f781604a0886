// Stacks, overlaps and coincident bodies: settled, bounded, deterministic.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/approx.hpp"
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
    if ((c.body_a == BodyId(a) && c.body_b == BodyId(b)) ||
        (c.body_a == BodyId(b) && c.body_b == BodyId(a)))
      sum += c.normal_impulse;
  return sum;
}

// A tower of unit boxes stands: its top at its height and over its foot, and each level carries
// what is above.
void check_standing(const Batch& batch, int world, double sag, double lean) {
  INFO("world " << world);
  const Scene& scene = batch.plan().scene();
  const int boxes = batch.bodies(world);
  const Vec3 up = up_of(scene.space), top = position(batch, world, boxes - 1);
  CHECK(batch.status(world) == Status::ok);
  CHECK(top.dot(up) == approx(boxes - 0.5, sag));
  CHECK(Vec3(top - top.dot(up) * up).norm() < lean);
  const double weight = mass_properties(scene, scene.bodies[1]).mass * 10;
  const double h = scene.options.dt / *batch.plan().resolved().substeps;
  const auto contacts = batch.contacts(world);
  for (int i = 0; i < boxes; ++i) {
    INFO("level " << i);
    CHECK(impulse_between(contacts, i, i + 1) == Approx((boxes - i) * weight * h).epsilon(0.01));
  }
}

}  // namespace

TEST_CASE("towers of 10, 15 and 20 boxes settle, stand and carry their weight",
          "[slow][stability]") {
  constexpr int kWorlds = 8;
  for (Space space : {Space::planar, Space::spatial}) {
    for (int boxes : {10, 15, 20}) {
      Scene scene = tower(space, boxes);
      if (space == Space::spatial && boxes > 10) {
        // A column of soft contacts buckles under its own weight when it is too tall for their
        // stiffness; from 15 cubes on they need more of it than 4 substeps carry.
        scene.options.substeps = 8;
        scene.options.contact.frequency = 90;
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
        for (int w = 0; w < kWorlds; ++w) {
          check_standing(batch, w, 0.006 * boxes, 0.1);
          if (boxes == 10) CHECK(max_penetration(batch, w) < 0.006);
        }
      }
    }
  }
}

// The top of 40 leans by more than the 0.1 m of the shorter towers: by about 0.2 m, 5 mrad.
TEST_CASE("a tower of 40 boxes stands and carries its weight", "[slow][stability]") {
  constexpr int kWorlds = 8, kBoxes = 40;
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = tower(space, kBoxes);
    scene.options.substeps = 16;
    scene.options.contact.frequency = 200;
    for (const Table& table : widest_tables()) {
      INFO(name(table) << (space == Space::planar ? " squares" : " cubes"));
      Batch batch(compile(scene), options_of(table, kWorlds));
      batch.step(1200);
      for (int w = 0; w < kWorlds; ++w) {
        check_standing(batch, w, 0.02, 0.25);
        CHECK(liveliness(batch, w, 0.7) < 0.1);
      }
    }
  }
}

TEST_CASE("more contacts than a scene has room for are left out and flagged", "[fast][stability]") {
  Scene scene = empty_scene(Space::spatial, 0);
  for (int i = 0; i < 3; ++i) scene.add(body_of(shape_of(Sphere{0.5}), Vec3(0.9 * i, 0, 0)));
  const auto contacts_after_step = [&](std::optional<int> capacity, Status expected) {
    scene.options.contact_capacity = capacity;
    Batch batch(compile(scene), options_of(widest_tables().front()));
    batch.step();
    CHECK(batch.status(0) == expected);
    return batch.contacts(0).size();
  };
  CHECK(contacts_after_step(std::nullopt, Status::ok) == 2);
  CHECK(contacts_after_step(2, Status::ok) == 2);
  CHECK(contacts_after_step(1, Status::contact_overflow) == 1);
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

TEST_CASE("bodies with one common centre separate slowly and the same way each time",
          "[slow][stability]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (bool boxes : {false, true}) {
      for (int count : {2, 10, 100}) {
        Scene scene = empty_scene(space, 0);
        // A hundred bodies push each other out in one row, along which the speeds of pairs add up.
        if (count == 100) scene.options.contact.push_out_speed = 0.15;
        for (int i = 0; i < count; ++i)
          scene.add(
              body_of(shape_of(boxes ? cube_of(space, 0.5) : round_of(space, 0.5)), Vec3::Zero()));
        for (const Table& table : widest_tables()) {
          Batch batch(compile(scene), options_of(table, 2));
          INFO(name(table) << ' ' << count << (boxes ? " boxes" : " balls")
                           << (space == Space::planar ? " planar" : " spatial"));
          double fastest = 0;
          for (int i = 0; i < 60 * (count == 100 ? 40 : 10); ++i) {
            batch.step();
            fastest = std::max(fastest, max_speed(batch, 0));
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

}  // namespace manyworlds::test
