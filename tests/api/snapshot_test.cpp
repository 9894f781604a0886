// Snapshots: worlds go on bit by bit wherever they are restored; bad ones change nothing.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

#include "manyworlds/scenes.hpp"
#include "src/base/hash.hpp"
#include "src/state/snapshot_format.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

BatchOptions with_sleep(BatchOptions options, bool sleep) {
  options.sleep = sleep;
  return options;
}

// A crowd of which some bodies are disabled and, where they may, asleep.
Scene drowsy_crowd(Space space) {
  Scene scene = crowd(space);
  scene.options.sleep.speed = 0.5;
  scene.options.sleep.time = 0.1;
  for (Body& body : scene.bodies) body.linear_drag = body.angular_drag = 1;
  return scene;
}

void disturb_batch(Batch& batch) {
  for (int w = 0; w < batch.worlds(); w += 3)
    batch.set_enabled(w, in_row(batch, w, w % batch.bodies(w)), false);
}

}  // namespace

TEST_CASE("a saved world goes on bit by bit in any batch", "[fast][snapshot][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(drowsy_crowd(space));
    for (const Table& table : all_tables()) {
      for (bool sleep : {false, true}) {
        INFO(name(table) << (space == Space::planar ? " planar" : " spatial") << " sleep "
                         << sleep);
        Batch batch(plan, with_sleep(options_of(table, 21), sleep));
        batch.step(40);
        disturb_batch(batch);
        batch.step(5);
        const Snapshot saved = batch.save();
        const auto now = hashes(batch);
        batch.step(60);
        const auto then = hashes(batch);
        CHECK(saved.worlds() == 21);
        CHECK(saved.steps() == 45);

        // Back in the same batch, whatever it has become.
        batch.step(13);
        batch.restore(saved);
        CHECK(hashes(batch) == now);
        CHECK(batch.steps() == 45);
        batch.step(60);
        CHECK(hashes(batch) == then);

        // Every world alone, elsewhere in a smaller batch, on every table of its precision.
        for (const Table& other : all_tables()) {
          if (other.precision != table.precision) continue;
          Batch small(plan, with_sleep(options_of(other, 5, 2), sleep));
          small.step(7);
          for (int w : {0, 4, 9, 18}) {
            small.restore(saved, w, 3);
            CHECK(small.hash(3) == now[static_cast<std::size_t>(w)]);
            small.step(60);
            INFO("world " << w << " on " << name(other));
            CHECK(small.hash(3) == then[static_cast<std::size_t>(w)]);
          }
        }
      }
    }
  }
}

TEST_CASE("one saved world branches into many, and worlds can be copied", "[fast][snapshot]") {
  const Plan plan = compile(drowsy_crowd(Space::spatial));
  for (const Table& table : widest_tables()) {
    for (bool sleep : {false, true}) {
      Batch batch(plan, with_sleep(options_of(table, 12), sleep));
      batch.step(30);
      const std::vector<int> chosen = {7, 2};
      const Snapshot saved = batch.save(chosen);
      CHECK(saved.worlds() == 2);
      const std::uint64_t seven = batch.hash(7), two = batch.hash(2);
      for (int w = 0; w < 12; ++w) batch.restore(saved, w % 2, w);
      for (int w = 0; w < 12; ++w) CHECK(batch.hash(w) == (w % 2 == 0 ? seven : two));
      batch.copy_world(0, 5);
      CHECK(batch.hash(5) == seven);
      batch.step(50);
      CHECK(batch.hash(5) == batch.hash(0));
      CHECK(batch.hash(3) == batch.hash(1));
      CHECK(batch.hash(0) != batch.hash(1));
      // What happens to one branch does not reach the others.
      batch.add_impulse(4, batch.body_in_row(0), Vec3(0, 0, 500));
      batch.step();
      CHECK(batch.hash(4) != batch.hash(0));
      CHECK(batch.hash(5) == batch.hash(0));
    }
  }
}

TEST_CASE("resets after a restore repeat the same draws", "[fast][snapshot]") {
  const Plan plan = compile(crowd(Space::planar));
  Batch batch(plan, options_of(widest_tables().front(), 6));
  std::vector<std::uint8_t> some = {0, 1, 0, 1, 1, 0};
  batch.reset(some);
  batch.step(5);
  const Snapshot saved = batch.save();
  batch.reset(some);
  const auto first = hashes(batch);
  batch.reset(some);
  CHECK(hashes(batch) != first);
  batch.restore(saved);
  batch.reset(some);
  CHECK(hashes(batch) == first);
}

// What a whole batch draws after it was restored does not depend on what was drawn between, nor on
// the batch that it is restored into.
TEST_CASE("a snapshot holds the seeds that later resets draw from", "[fast][snapshot][seeds]") {
  const Plan plan = compile(crowd(Space::planar));
  const BatchOptions options = options_of(widest_tables().front(), 4);
  const std::vector<std::uint8_t> all(4, 1), some = {0, 1, 1, 0};
  const auto draws = [&](Batch& batch) {
    batch.reset(some);
    std::vector<std::uint64_t> out = hashes(batch);
    batch.reset();
    const auto again = hashes(batch);
    out.insert(out.end(), again.begin(), again.end());
    return out;
  };
  Batch batch(plan, options);
  const auto reset_with = [&](Batch& to, std::uint64_t seed) {
    to.reset(all, std::vector<std::uint64_t>{seed, seed + 7, seed + 100, seed + 3});
  };

  SECTION("the seeds of reset(mask, seeds)") { reset_with(batch, 1000); }
  SECTION("the seed of the batch") {}
  batch.step(3);
  const Snapshot saved = batch.save();
  const auto expected = draws(batch);

  reset_with(batch, 77);  // reseeded between
  CHECK(draws(batch) != expected);
  batch.restore(saved);
  CHECK(draws(batch) == expected);

  BatchOptions elsewhere = options;
  elsewhere.seed = options.seed + 12345;
  Batch other(plan, elsewhere);
  CHECK(draws(other) != expected);
  other.restore(Snapshot::from_bytes(saved.bytes()));
  CHECK(draws(other) == expected);

  // One world of it is a branch, which draws for itself.
  Batch branch(plan, elsewhere);
  Batch twin(plan, elsewhere);
  branch.restore(saved, 1, 1);
  CHECK(branch.hash(1) != twin.hash(1));
  branch.reset(some);
  twin.reset(some);
  CHECK(hashes(branch) == hashes(twin));
}

TEST_CASE("a snapshot that is cut anywhere is refused", "[fast][snapshot]") {
  Scene scene = empty_scene(Space::planar);
  scene.add(ground(Space::planar));
  scene.add(body_of(shape_of(Circle{0.5}), Vec3(0, 0.5, 0)));
  Batch batch(compile(scene), options_of(widest_tables().front(), 2));
  batch.step(3);
  const std::vector<std::byte> whole = batch.save().bytes();
  for (std::size_t n = 0; n < whole.size(); ++n) {
    CHECK_THROWS_AS(Snapshot::from_bytes({whole.begin(), whole.begin() + static_cast<long>(n)}),
                    SnapshotError);
  }
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::vector<std::byte> bad = whole;
    bad[i] ^= std::byte{0x10};
    CHECK_THROWS_AS(Snapshot::from_bytes(bad), SnapshotError);
  }
  std::vector<std::byte> longer = whole;
  longer.push_back(std::byte{0});
  CHECK_THROWS_WITH(Snapshot::from_bytes(longer), Catch::Contains("its header says"));
  CHECK_NOTHROW(Snapshot::from_bytes(whole));
}

TEST_CASE("a snapshot of something else is refused and changes nothing", "[fast][snapshot]") {
  const Table table = widest_tables().front();
  const Plan plan = compile(crowd(Space::planar));
  Batch batch(plan, options_of(table, 4));
  batch.step(10);
  const auto before = hashes(batch);
  const auto refused = [&](const Snapshot& snapshot, const char* why) {
    CHECK_THROWS_WITH(batch.restore(snapshot), Catch::Contains(why));
    CHECK(hashes(batch) == before);
    CHECK(batch.steps() == 10);
  };
  refused(Batch(plan, options_of(table, 3)).save(), "has 3 worlds, the batch has 4");
  Scene heavier = crowd(Space::planar);
  heavier.bodies[3].shapes[0].density = 77;
  refused(Batch(compile(heavier), options_of(table, 4)).save(), "world 0 belongs to another plan");
  Scene elsewhere = crowd(Space::planar);  // where bodies begin and what they are called is free
  elsewhere.bodies[3].position.x() += 1;
  elsewhere.bodies[3].name = "other";
  CHECK_NOTHROW(Batch(compile(elsewhere), options_of(table, 4)).restore(batch.save()));
  refused(Snapshot(), "is empty");
  if (has_table({table.isa, Precision::f64})) {
    BatchOptions options = options_of(table, 4);
    options.precision = Precision::f64;
    refused(Batch(plan, options).save(), "has f64 values, the batch is f32");
  }
  const Snapshot saved = batch.save();
  CHECK_THROWS_WITH(batch.restore(saved, 4, 0), Catch::Contains("it has no world 4"));
  CHECK_THROWS_WITH(batch.restore(saved, 0, 4), Catch::Contains("world is 4, must be 0 to 3"));
  CHECK_THROWS_WITH(batch.copy_world(0, 4), Catch::Contains("world is 4"));
}

// A right checksum over wrong numbers: what the step would use as an index is looked at, too.
TEST_CASE("a forged snapshot is refused and changes nothing", "[fast][snapshot]") {
  Scene scene = empty_scene(Space::planar);
  scene.add(ground(Space::planar));
  scene.add(body_of(shape_of(Circle{0.5}), Vec3(0, 0.5, 0)));
  const Table table = widest_tables().front();
  BatchOptions options = options_of(table);
  options.precision = Precision::f32;
  Batch batch(compile(scene), options);
  batch.step(3);
  const std::vector<std::byte> honest = batch.save().bytes();
  const std::uint64_t hash = batch.hash();
  const auto forged = [&](std::size_t at, auto value) {
    std::vector<std::byte> bytes = honest;
    std::memcpy(bytes.data() + at, &value, sizeof value);
    const std::size_t end = bytes.size() - sizeof(std::uint64_t);
    Hasher hasher;
    std::size_t i = 0;
    for (; i + 8 <= end; i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + i, 8);
      hasher.add(word);
    }
    for (; i < end; ++i) hasher.add(static_cast<std::uint64_t>(bytes[i]));
    const std::uint64_t sum = hasher.value();
    std::memcpy(bytes.data() + end, &sum, sizeof sum);
    return Snapshot::from_bytes(bytes);
  };
  // Header and entry, 5 numbers of state, status; then the one key and the end of the list.
  constexpr std::size_t kKeys = sizeof(SnapshotHeader) + sizeof(SnapshotEntry) + 5 * 4 + 4;
  CHECK_NOTHROW(batch.restore(forged(kKeys, 0)));  // it is where this test thinks it is
  for (const std::int32_t key : {1, -1, 1 << 20}) {
    CHECK_THROWS_WITH(batch.restore(forged(kKeys, key)),
                      Catch::Contains("world 0: a contact is not one of the plan's"));
  }
  CHECK_THROWS_WITH(batch.restore(forged(kKeys + 4, 5)), Catch::Contains("world 0: a"));
  constexpr std::size_t kSteps = offsetof(SnapshotHeader, steps);
  for (const std::int64_t steps : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::max()}) {
    CHECK_THROWS_WITH(forged(kSteps, steps), Catch::Contains("steps, must be 0 to"));
  }
  constexpr std::size_t kClock = offsetof(SnapshotHeader, clock);
  for (const double clock : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_WITH(forged(kClock, clock), Catch::Contains("clock that is not finite"));
  }
  CHECK(batch.hash() == hash);
}

}  // namespace manyworlds::test
