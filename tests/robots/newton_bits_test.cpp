// Robots and the laws: the same bits whatever the lane, batch, threads and instruction set, after
// snapshots, in steps of some worlds, and beside worlds that go wrong.
#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

#include "tests/support/hashes.hpp"
#include "tests/support/random.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr int kWorlds = 35;

// Controls that depend on the world's number and the step alone.
std::vector<double> controls_of(int world, int step, std::size_t count) {
  Random random(static_cast<std::uint64_t>(1000 * world + step));
  std::vector<double> u(count);
  for (double& x : u) x = random.uniform(-1.2, 1.2);
  return u;
}
// World 0 of the batch is world `first`.
void control(Batch& batch, int first, int step) {
  const std::size_t count = batch.plan().scene().controls.size();
  std::vector<double> all;
  for (int w = 0; w < batch.worlds(); ++w) {
    const std::vector<double> u = controls_of(first + w, step, count);
    all.insert(all.end(), u.begin(), u.end());
  }
  batch.set_controls(std::span<const double>(all));
}
void walk(Batch& batch, int first, int from, int steps) {
  for (int s = from; s < from + steps; s += 10) {
    control(batch, first, s);
    batch.step(std::min(10, from + steps - s));
  }
}
std::vector<std::uint64_t> walked(const Plan& plan, BatchOptions options, int first, int steps) {
  options.seed = static_cast<std::uint64_t>(first);
  Batch batch(plan, options);
  walk(batch, first, 0, steps);
  for (int w = 0; w < batch.worlds(); ++w) {
    INFO("world " << w << ' ' << to_string(batch.status(w)));
    CHECK_FALSE(frozen(batch.status(w)));
  }
  return hashes(batch);
}

}  // namespace

TEST_CASE("robots have the same bits on every instruction set and thread count",
          "[fast][bits][robots]") {
  const Plan plan = compile(robots());
  for (const Precision precision : {Precision::f32, Precision::f64}) {
    std::vector<std::uint64_t> reference;
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      for (const int threads : {1, 3}) {
        INFO(name(table) << " threads " << threads);
        const auto result = walked(plan, options_of(table, kWorlds, threads), 0, 120);
        if (reference.empty()) reference = result;
        CHECK(result == reference);
      }
    }
    std::sort(reference.begin(), reference.end());
    CHECK(std::unique(reference.begin(), reference.end()) == reference.end());  // worlds differ
  }
}

// What makes the other tests worth something: robots touch the ground, each other and themselves.
TEST_CASE("the robots of these tests touch in every way", "[fast][robots][one_thread]") {
  const Plan plan = compile(robots());
  Batch batch(plan, options_of(widest_tables().front(), kWorlds));
  std::vector<std::vector<int>> met(batch.plan().scene().bodies.size(),
                                    std::vector<int>(batch.plan().scene().bodies.size()));
  int most = 0;
  for (int s = 0; s < 200; s += 10) {
    walk(batch, 0, s, 10);
    for (int w = 0; w < kWorlds; ++w) {
      const std::vector<Contact> contacts = batch.contacts(w);
      most = std::max(most, static_cast<int>(contacts.size()));
      for (const Contact& c : contacts) {
        ++met[static_cast<std::size_t>(c.body_a.index())]
             [static_cast<std::size_t>(c.body_b.index())];
      }
    }
  }
  // Bodies 1 to 8 are a walker's, 9 to 16 the other's, then the cart, the arm, ball and block.
  const auto between = [&](int a, int a_end, int b, int b_end) {
    int sum = 0;
    for (int i = a; i < a_end; ++i) {
      for (int j = b; j < b_end; ++j) {
        const auto x = static_cast<std::size_t>(i), y = static_cast<std::size_t>(j);
        sum += met[x][y] + met[y][x];
      }
    }
    return sum;
  };
  CHECK(between(0, 1, 1, 17) > 100);
  CHECK(between(1, 9, 1, 9) > 10);
  CHECK(between(1, 9, 9, 17) > 50);
  CHECK(between(1, 17, 17, 21) > 10);
  CHECK(most > 12);
}

TEST_CASE("a world of robots has its bits wherever it is in a batch",
          "[fast][bits][robots][one_thread]") {
  const Plan plan = compile(robots());
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    const auto reference = walked(plan, options_of(table, kWorlds), 0, 60);
    for (int first = 0; first < kWorlds; first += 4) {
      const int worlds = std::min(1 + first % 7, kWorlds - first);
      const auto part = walked(plan, options_of(table, worlds), first, 60);
      CHECK(std::equal(part.begin(), part.end(), reference.begin() + first));
    }
  }
}

TEST_CASE("robots have their bits under other options, too", "[fast][bits][robots]") {
  constexpr int kFew = 19;
  for (const Scene& scene : robots_of_other_options()) {
    const Plan plan = compile(scene);
    for (const Precision precision : {Precision::f32, Precision::f64}) {
      std::vector<std::uint64_t> reference;
      for (const Table& table : all_tables()) {
        if (table.precision != precision) continue;
        INFO(scene.name << ", " << name(table));
        const auto result = walked(plan, options_of(table, kFew, 2), 0, 60);
        if (reference.empty()) reference = result;
        CHECK(result == reference);
        for (const int first : {1, 9, 18}) {
          const int worlds = std::min(6, kFew - first);
          const auto part = walked(plan, options_of(table, worlds), first, 60);
          CHECK(std::equal(part.begin(), part.end(), reference.begin() + first));
        }
      }
      std::sort(reference.begin(), reference.end());
      CHECK(std::unique(reference.begin(), reference.end()) == reference.end());
    }
  }
}

TEST_CASE("these tests have robots in both spaces of the solver", "[fast][robots]") {
  const auto space_of = [](const Scene& scene) {
    std::string why;
    for (const auto& stage : compile(scene).report().stages) {
      if (stage.name == "tree") why = stage.why;
    }
    return why;
  };
  CHECK_THAT(space_of(robots()), Catch::Contains("by the joint-space inertia"));
  CHECK_THAT(space_of(lone_walker()), Catch::Contains("by articulated bodies"));
}

// A ball on which nothing acts, above a block that falls to the ground, which it touches in some
// worlds of a group: rows between the two are there for those alone.
TEST_CASE("a body at rest has its bits beside worlds in which it is touched",
          "[fast][bits][robots]") {
  constexpr int kMany = 40;
  Scene scene = robot_scene();
  scene.add(ground(Space::spatial, 0.9));
  RobotBuilder build(scene);
  build.body(Box{{0.1, 0.1, 0.1}}, {0, 0, 0.1003});
  Body& still = scene.at(build.body(Sphere{0.1}, {0, 0, 0.31}));
  still.gravity_scale = 0;
  still.jitter.position = {0, 0, 0.1}, still.jitter.any_orientation = true;
  const Plan plan = compile(scene);
  const auto stepped = [&](const Table& table, int first, int worlds) {
    BatchOptions options = options_of(table, worlds);
    options.seed = static_cast<std::uint64_t>(first);
    Batch batch(plan, options);
    batch.step(8);
    return hashes(batch);
  };
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    const auto reference = stepped(table, 0, kMany);
    for (int w = 0; w < kMany; ++w)
      CHECK(stepped(table, w, 1).front() == reference[static_cast<std::size_t>(w)]);
  }
}

TEST_CASE("robots beside other kinds of worlds keep their bits",
          "[fast][bits][robots][one_thread]") {
  Scene lone = robot_scene();
  lone.add(ground(Space::spatial, 0.7));
  add_walker(lone, 0, 0.02);
  const Plan many = compile(robots()), one = compile(lone);
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch alone(one, options_of(table, 5)), crowd(many, options_of(table, 6));
    Batch mixed({{one, 5}, {many, 6}}, options_of(table, 1));
    alone.step(80), crowd.step(80), mixed.step(80);
    for (int w = 0; w < 5; ++w) CHECK(mixed.hash(w) == alone.hash(w));
  }
}

TEST_CASE("robots take many steps in one call as they take them one by one",
          "[fast][bits][robots][one_thread]") {
  const Plan plan = compile(robots());
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch one(plan, options_of(table, 20)), many(plan, options_of(table, 20));
    control(one, 0, 0), control(many, 0, 0);
    for (int s = 0; s < 60; ++s) one.step();
    many.step(60);
    CHECK(hashes(one) == hashes(many));
  }
}

TEST_CASE("robots go on from snapshots and copies bit by bit", "[fast][bits][robots][one_thread]") {
  const Plan plan = compile(GENERATE(robots(), randomized(lone_walker())));
  for (const Table& table : all_tables()) {
    INFO(name(table));
    Batch batch(plan, options_of(table, 19));
    walk(batch, 0, 0, 40);
    const Snapshot saved = batch.save();
    walk(batch, 0, 40, 40);
    const auto expected = hashes(batch);
    batch.restore(saved);
    walk(batch, 0, 40, 40);
    CHECK(hashes(batch) == expected);
    Batch other(plan, options_of({widest_of(table.precision), table.precision}, 19));
    other.restore(saved);
    walk(other, 0, 40, 40);
    CHECK(hashes(other) == expected);
    batch.copy_world(3, 12);
    batch.step(30);
    CHECK(batch.hash(3) == batch.hash(12));
  }
}

TEST_CASE("robots whose neighbours rest keep their bits, and so do those that rest",
          "[fast][bits][robots][one_thread]") {
  const Plan plan = compile(robots());
  for (const Table& table : all_tables()) {
    INFO(name(table));
    Batch all(plan, options_of(table, 19)), some(plan, options_of(table, 19));
    control(all, 0, 0), control(some, 0, 0);
    all.step(30), some.step(30);
    const auto before = hashes(some);
    std::vector<std::uint8_t> mask(19);
    for (std::size_t w = 0; w < mask.size(); ++w) mask[w] = w % 3 == 1 ? 1 : 0;
    all.step(40), some.step(mask, 40);
    for (int w = 0; w < 19; ++w) {
      const bool steps = w % 3 == 1;
      CHECK(some.hash(w) == (steps ? all.hash(w) : before[static_cast<std::size_t>(w)]));
    }
    for (std::size_t w = 0; w < mask.size(); ++w) mask[w] = mask[w] == 1 ? 0 : 1;
    some.step(mask, 40);
    CHECK(hashes(some) == hashes(all));
  }
}

TEST_CASE("a world of robots that goes wrong leaves its neighbours alone",
          "[fast][bits][robots][one_thread]") {
  const Plan plan = compile(robots());
  for (const Table& table : all_tables()) {
    for (const Field field : {Field::generalized_position, Field::generalized_velocity,
                              Field::generalized_acceleration}) {
      INFO(name(table) << ' ' << info(field).name);
      Batch spoilt(plan, options_of(table, 18)), sound(plan, options_of(table, 18));
      spoilt.step(30), sound.step(30);
      std::vector<double> v(spoilt.size(field) / 18);
      spoilt.read(field, 5, v);
      v[9] = std::numeric_limits<double>::quiet_NaN();
      spoilt.write(field, 5, v);
      spoilt.step(20), sound.step(20);
      CHECK(frozen(spoilt.status(5)));
      CHECK(spoilt.lost_worlds() == 1);
      for (int w = 0; w < 18; ++w) {
        if (w != 5) CHECK((spoilt.hash(w) == sound.hash(w) && spoilt.status(w) == sound.status(w)));
      }
    }
  }
}

}  // namespace manyworlds::test
