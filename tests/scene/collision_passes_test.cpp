// How often a step finds contacts: the plan's choice, and what it holds.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "manyworlds/scenes.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

int passes_of(const Scene& scene) { return *compile(scene).resolved().contact.collision_passes; }

Scene drop(const Geometry& geometry, double height) {
  Scene scene = empty_scene(Space::spatial);
  scene.add(ground(Space::spatial));
  scene.add(body_of(shape_of(geometry), height * Vec3::UnitZ()));
  return scene;
}

// A flat ellipsoid, rotated out of its resting pose.
Scene pebble(double size) {
  Scene scene = drop(Ellipsoid{Vec3(size, 0.6 * size, 0.1 * size)}, size);
  scene.bodies[1].rotation = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 0).normalized()));
  return scene;
}

double lowest_height(const Scene& scene, int steps) {
  Batch batch(compile(scene));
  double least = 1e300, x[3];
  for (int i = 0; i < steps; ++i) {
    batch.step();
    batch.read(Field::position, 0, x);
    least = std::min(least, x[2]);
  }
  return least;
}

}  // namespace

TEST_CASE("a step of bodies of ordinary size finds contacts once", "[fast][plan]") {
  for (const auto& entry : scenes::all()) {
    if (!entry.standard) continue;
    INFO(entry.name);
    CHECK(passes_of(entry.make()) == 1);
  }
  CHECK(passes_of(drop(Box{Vec3(0.1, 0.05, 0.03)}, 1)) == 1);
  CHECK(passes_of(drop(Sphere{1e-3}, 1)) == 1);
  CHECK(passes_of(drop(Box{Vec3(0.01, 0.01, 1e-3)}, 1)) == 1);
  CHECK(passes_of(drop(Ellipsoid{Vec3(0.2, 0.15, 0.1)}, 1)) == 1);
}

TEST_CASE("flat bodies that fall by much of their thickness have more passes", "[fast][plan]") {
  // n^2 = 5 (g dt^2 / c) (a^2 - c^2) / (a c) with a = 10 c.
  const double fall = 10 / 3600.0, c = 1e-3;
  CHECK(passes_of(pebble(0.01)) == std::ceil(std::sqrt(5 * fall / c * 9.9)));
  CHECK(passes_of(pebble(1e-4)) == 32);
  for (const auto& choice : compile(pebble(1e-4)).report().choices) {
    if (choice.option != "contact.collision_passes") continue;
    CHECK(choice.why.find("the maximum is 32") != std::string::npos);
  }
  // In other units, with times scaled to match.
  Scene large = pebble(64);
  large.options.dt = 80 / 60.0;
  CHECK(passes_of(large) == passes_of(pebble(0.01)));
  Scene without = pebble(0.01);
  without.options.gravity.setZero();
  CHECK(passes_of(without) == 1);
}

TEST_CASE("bodies that can touch nothing need no passes", "[fast][plan]") {
  Scene alone = pebble(0.01);
  alone.bodies.erase(alone.bodies.begin());
  CHECK(passes_of(alone) == 1);
  Scene filtered = pebble(0.01);
  filtered.bodies[1].shapes[0].filter.mask = 2;
  CHECK(passes_of(filtered) == 1);
}

TEST_CASE("resolved substeps are valid whatever the passes", "[fast][plan]") {
  for (const int substeps : {1, 4, 63, 64}) {
    for (const int passes : {1, 7, 9, 33, 63, 64}) {
      Scene scene = drop(Box{Vec3(0.5, 0.5, 0.5)}, 1);
      scene.options.substeps = substeps, scene.options.contact.collision_passes = passes;
      scene.options = compile(scene).resolved();
      INFO(substeps << " substeps, " << passes << " passes");
      CHECK(*scene.options.substeps % passes == 0);
      CHECK(*scene.options.substeps <= 64);
      CHECK(*compile(scene).resolved().substeps == *scene.options.substeps);
    }
  }
}

TEST_CASE("substeps are a multiple of the passes", "[fast][plan]") {
  Scene scene = drop(Box{Vec3(0.5, 0.5, 0.5)}, 1);
  scene.options.contact.collision_passes = 3;
  CHECK(*compile(scene).resolved().substeps == 6);
  scene.options.substeps = 4;
  CHECK(*compile(scene).resolved().substeps == 6);
  scene.options.substeps = 9;
  CHECK(*compile(scene).resolved().substeps == 9);
}

TEST_CASE("small flat bodies stay above the floor", "[fast][physics]") {
  const Scene scene = pebble(0.02);
  CHECK(lowest_height(scene, 120) > 0.5 * 0.002);
  Scene once = scene;
  once.options.contact.collision_passes = 1;
  CHECK(lowest_height(once, 120) < 0);
}

// The sum over the points carries the weight: also in the step in which the body falls asleep, and
// while it sleeps; and passes do not count points again.
TEST_CASE("contacts observed in several passes carry the weight once", "[fast][physics]") {
  Scene scene = drop(Box{Vec3(0.5, 0.4, 0.3)}, 0.3);
  scene.options.contact.collision_passes = 4;
  BatchOptions options;
  options.observe.what = {Observer::contacts}, options.sleep = true;
  Batch batch(compile(scene), options);
  const double weight = 1000 * 8 * 0.5 * 0.4 * 0.3 * 10 * scene.options.dt;
  int slept = 0;
  for (int i = 0; i < 120; ++i) {
    batch.step();
    if (i < 15) continue;
    double up = 0;
    const auto contacts = batch.step_contacts(0);
    for (const StepContact& c : contacts) up += c.normal_impulse;
    INFO("step " << i << (batch.asleep(0) ? ", asleep" : ""));
    CHECK(contacts.size() == 4);
    CHECK(up == Approx(weight).epsilon(0.01));
    slept += batch.asleep(0) ? 1 : 0;
  }
  CHECK(slept > 0);
  CHECK(slept < 105);
}

TEST_CASE("a step of passes is as many steps of one pass", "[fast][physics]") {
  Scene whole = drop(Box{Vec3(0.5, 0.4, 0.3)}, 0.8), parts = whole;
  whole.bodies[1].rotation = parts.bodies[1].rotation =
      Quat(Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()));
  whole.options.contact.collision_passes = 4, whole.options.substeps = 8;
  parts.options.contact.collision_passes = 1, parts.options.substeps = 2;
  parts.options.dt /= 4;
  whole.options.contact.frequency = parts.options.contact.frequency = 100;
  BatchOptions options;
  options.observe.what = {Observer::contacts};
  Batch a(compile(whole), options), b(compile(parts), options);
  double up_a = 0, up_b = 0;
  for (int i = 0; i < 100; ++i) {
    a.step();
    for (int k = 0; k < 4; ++k) {
      b.step();
      for (const StepContact& c : b.step_contacts(0)) up_b += c.normal_impulse;
    }
    for (const StepContact& c : a.step_contacts(0)) up_a += c.normal_impulse;
  }
  double x[3], y[3];
  a.read(Field::position, 0, x), b.read(Field::position, 0, y);
  for (int k = 0; k < 3; ++k) CHECK(x[k] == y[k]);
  CHECK(up_a == Approx(up_b).epsilon(1e-5));
  CHECK(a.time() == Approx(b.time()));
}

}  // namespace manyworlds::test
