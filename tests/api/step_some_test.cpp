// Steps of some worlds alone: each goes the way that it goes in a batch where all step, however far
// its lane neighbours are, and those that are left out keep every bit.
#include <catch2/catch.hpp>

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "manyworlds/scenes.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr int kMaskedWorlds = 21, kSteps = 70;

using Kinds = std::vector<Batch::Kind>;
using Mask = std::vector<std::uint8_t>;
using NumbersOfWorlds = std::vector<std::vector<double>>;  // [world]

BatchOptions watched(const Table& table, int threads) {
  BatchOptions options = options_of(table, kMaskedWorlds, threads);
  options.seed = 11;
  options.observe.what = {Observer::touching, Observer::motion, Observer::residual};
  return options;
}

// What can be asked of a world after a step.
std::vector<double> numbers_of(const Batch& batch, int world) {
  const std::uint64_t hash = batch.hash(world);
  std::vector<double> all = {
      static_cast<double>(hash >> 32), static_cast<double>(hash & 0xffffffffu),
      static_cast<double>(batch.status(world)), static_cast<double>(batch.asleep(world))};
  for (int b = 0; b < batch.bodies(world); ++b)
    all.push_back(batch.touching(world, batch.body_in_row(b)));
  for (const Observed what : {Observed::momentum, Observed::residual}) {
    if (batch.kinds() > 1) break;
    std::vector<double> seen(batch.size(what) / static_cast<std::size_t>(batch.worlds()));
    batch.read(what, world, seen);
    all.insert(all.end(), seen.begin(), seen.end());
  }
  return all;
}
NumbersOfWorlds numbers_of(const Batch& batch) {
  NumbersOfWorlds all;
  for (int w = 0; w < batch.worlds(); ++w) all.push_back(numbers_of(batch, w));
  return all;
}

// What a world is given before its next step depends on it and on how many it has taken.
void apply_force(Batch& batch, int world, int taken) {
  if ((taken + world) % 7 == 0)
    batch.add_force(world, batch.body_in_row(world % 3), Vec3(800, 0, 0));
  if ((taken + world) % 11 == 0)
    batch.add_impulse(world, batch.body_in_row(world % 3), Vec3(0, 200, 0));
}

void check_against_steps_of_all(const Kinds& kinds, const BatchOptions& options) {
  Batch all(kinds, options);
  std::vector<NumbersOfWorlds> path;  // [steps taken]
  for (int step = 0; step <= kSteps; ++step) {
    path.push_back(numbers_of(all));
    for (int w = 0; w < all.worlds(); ++w) apply_force(all, w, step);
    all.step();
  }

  Batch some(kinds, options);
  for (int w = 0; w < some.worlds(); ++w) apply_force(some, w, 0);
  std::vector<int> taken(static_cast<std::size_t>(some.worlds()), 0);
  Mask mask(taken.size());
  Random random(5);
  int differ = 0, touched = 0, steps = 0;
  for (int turn = 0; turn < 3 * kSteps; ++turn) {
    for (std::size_t w = 0; w < taken.size(); ++w) {
      // Some turns are of one world alone, and one world never moves.
      const bool chosen =
          turn % 9 == 8 ? w == static_cast<std::size_t>(turn) % taken.size() : random.chance(0.4);
      mask[w] = w != 3 && chosen && taken[w] < kSteps;
    }
    const NumbersOfWorlds before = numbers_of(some);
    some.step(mask);
    const NumbersOfWorlds after = numbers_of(some);
    for (std::size_t w = 0; w < taken.size(); ++w) {
      if (mask[w] == 0) {
        touched += after[w] != before[w];
        continue;
      }
      ++steps;
      ++taken[w];
      differ += after[w] != path[static_cast<std::size_t>(taken[w])][w];
      apply_force(some, static_cast<int>(w), taken[w]);
    }
  }
  CHECK(differ == 0);
  CHECK(touched == 0);
  CHECK(steps > 40 * (some.worlds() - 1));
  CHECK(taken[3] == 0);
  CHECK(some.steps() == 0);

  // They catch up, several steps a call, and go on together.
  for (std::size_t w = 0; w < taken.size(); ++w) {
    while (taken[w] < kSteps) {
      mask.assign(mask.size(), 0);
      mask[w] = 1;
      some.step(mask);
      apply_force(some, static_cast<int>(w), ++taken[w]);
    }
  }
  some.step();
  CHECK(numbers_of(some) == numbers_of(all));
}

}  // namespace

TEST_CASE("worlds that step alone go the way that they go when all step", "[batch][fast][bits]") {
  for (const Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(capsule_crowd(space));
    for (const Table& table : widest_tables()) {
      for (const int threads : {1, 3}) {
        CAPTURE(name(table), threads, space == Space::planar);
        check_against_steps_of_all({{plan, kMaskedWorlds}}, watched(table, threads));
      }
    }
  }
}

TEST_CASE("worlds that step alone may sleep, and be of several kinds", "[batch][fast][bits]") {
  Scene drowsy = crowd(Space::planar);
  drowsy.options.sleep.time = 0.05;
  drowsy.options.sleep.speed = 1;
  drowsy.options.contact.restitution_threshold = 1;  // some come to rest soon
  for (Body& body : drowsy.bodies) body.linear_drag = body.angular_drag = 5;
  Scene small = crowd(Space::planar, 4);
  small.options.sleep.time = 0.05;
  for (const Table& table : widest_tables()) {
    CAPTURE(name(table));
    BatchOptions options = watched(table, 2);
    options.sleep = true;
    check_against_steps_of_all({{compile(drowsy), kMaskedWorlds}}, options);
    check_against_steps_of_all({{compile(drowsy), 9}, {compile(small), 12}}, options);
    Batch probe(compile(drowsy), options);
    probe.step(kSteps);
    CHECK(probe.awake_fraction() < 1);  // the test is about a mix
    CHECK(probe.awake_fraction() > 0);
  }
}

TEST_CASE("joints and controls step alone, too", "[batch][fast][bits]") {
  const Plan plan = compile(scenes::find("lunar-lander")->make());
  for (const Table& table : widest_tables()) {
    CAPTURE(name(table));
    check_against_steps_of_all({{plan, kMaskedWorlds}}, watched(table, 1));
  }
}

TEST_CASE("many steps of some worlds are as many single ones", "[batch][fast]") {
  const Plan plan = compile(crowd(Space::spatial));
  Batch once(plan, options_of(widest_tables().front(), 6));
  Batch often(plan, options_of(widest_tables().front(), 6));
  const Mask mask = {1, 0, 0, 1, 0, 1};
  once.step(mask, 30);
  for (int i = 0; i < 30; ++i) often.step(mask);
  CHECK(once.hash() == often.hash());
  once.step(mask, 0);
  once.step(Mask(6, 0), 5);
  CHECK(once.hash() == often.hash());
  CHECK_THROWS_WITH(once.step(Mask(5, 1)),
                    Catch::Contains("the mask has 5 entries, the batch has 6 worlds"));
  CHECK_THROWS_AS(once.step(Mask(7, 1), 0), std::invalid_argument);
}

}  // namespace manyworlds::test
