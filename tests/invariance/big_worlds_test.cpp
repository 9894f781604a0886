// Worlds of hundreds and thousands of bodies: memory grows with the number of bodies, pyramids
// stand, piles come to rest, and snapshots work as in small ones.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "manyworlds/scenes.hpp"
#include "scenes/sized.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// A pyramid stands: at rest, and the middle of every row within a tenth of a box of where it was.
// The higher, the stiffer its contacts have to be. It may sag by `most_sag` meters.
void check_pyramid(Scene scene, int base, bool sleep, double most_sag) {
  for (const Table& table : widest_tables()) {
    if (table.precision == Precision::f64) continue;
    BatchOptions options = options_of(table);
    options.sleep = sleep;
    Batch batch(compile(scene), options);
    const std::vector<double> start = values(batch, Field::position);
    batch.step(1200);
    CHECK(batch.status(0) == Status::ok);
    const std::vector<double> end = values(batch, Field::position);
    double drift = 0, sag = 0;
    std::size_t at = 0;
    for (int row = 0; row < base; ++row) {
      double x = 0, y = 0;
      const int boxes = base - row;
      for (int k = 0; k < boxes; ++k, ++at) {
        x += (end[2 * at] - start[2 * at]) / boxes;
        y += (end[2 * at + 1] - start[2 * at + 1]) / boxes;
      }
      drift = std::max(drift, std::abs(x));
      sag = std::max(sag, std::abs(y));
    }
    INFO(name(table) << " base " << base << " drift " << drift << " sag " << sag << " speed "
                     << max_speed(batch, 0) << " asleep " << batch.asleep(0));
    CHECK(drift < 0.1);
    CHECK(sag < most_sag);
    CHECK(max_speed(batch, 0) < 0.05);
    CHECK(batch.asleep(0) == sleep);
  }
}
void check_pyramid(int base, int substeps, double frequency, bool sleep) {
  Scene scene = scenes::pyramid(base);
  scene.options.substeps = substeps;
  scene.options.contact.frequency = frequency;
  check_pyramid(scene, base, sleep, 0.1);
}

}  // namespace

TEST_CASE("memory of a world and of the scratch grow with the number of bodies", "[fast][big]") {
  const auto bytes = [](const Scene& scene) {
    BatchOptions options;
    options.threads = 1;
    options.sleep = true;
    Batch batch(compile(scene), options);
    return std::pair(static_cast<double>(batch.bytes_per_world()),
                     static_cast<double>(batch.scratch_bytes()));
  };
  const auto [world1, scratch1] = bytes(scenes::bin_of_boxes(500));
  const auto [world2, scratch2] = bytes(scenes::bin_of_boxes(1000));
  INFO("world " << world1 << ' ' << world2 << " scratch " << scratch1 << ' ' << scratch2);
  CHECK(world2 / world1 < 2.1);
  CHECK(scratch2 / scratch1 < 2.1);
}

TEST_CASE("a plan of 5,050 bodies is made without tables and says so shortly", "[fast][big]") {
  const Plan plan = compile(scenes::pyramid(100));
  CHECK(plan.bodies() == 5050);
  const PlanReport report = plan.report();
  CHECK(report.broad_phase == BroadPhase::sparse);
  CHECK(report.pairs.size() == 2);
  CHECK(report.pairs[0].candidates == 5050 * 5049 / 2);
  CHECK(report.pair_capacity == 3 * 5050 + 8);
  CHECK(report.bytes_per_world < 2'000'000);
}

TEST_CASE("pyramids stand still as the plan takes them", "[slow][big]") {
  for (const int base : {12, 21, 30, 45, 60}) {
    // As loads add up from row to row; contacts are the softer the deeper piles over 15 rows are.
    const double most_sag = 1.6e-6 * base * base * std::max(base, 15);
    check_pyramid(scenes::pyramid(base), base, true, most_sag);
  }
}

TEST_CASE("a pyramid of 465 boxes stands for 20 s", "[slow][big]") {
  check_pyramid(30, 8, 90, false);
  check_pyramid(30, 8, 90, true);
}

TEST_CASE("a pyramid of 5,050 boxes stands for 20 s", "[slow][big]") {
  check_pyramid(100, 16, 120, true);
}

TEST_CASE("a pile of 1,000 balls comes to rest in its bin", "[slow][big]") {
  const Scene scene = scenes::bin_of_spheres(1000);
  for (const Table& table : widest_tables()) {
    if (table.precision == Precision::f64) continue;
    Batch batch(compile(scene), options_of(table));
    const double before = batch.energy(0).potential;
    batch.step(300);
    INFO(name(table) << " speed " << max_speed(batch, 0));
    CHECK(batch.status(0) == Status::ok);
    CHECK(max_penetration(batch, 0) < 0.05);
    CHECK(batch.energy(0).potential < before);
    // Most of all that begins in fall has gone: balls go on rolling for long.
    CHECK(batch.energy(0).kinetic < 1e-3 * before);
    CHECK(batch.contacts(0).size() > 2000);
  }
}

TEST_CASE("big worlds are saved, restored and copied bit by bit", "[fast][big][snapshot]") {
  for (const Scene& scene : {scenes::pyramid(16), scenes::bin_of_boxes(150)}) {
    PlanOptions sparse;
    sparse.broad_phase = BroadPhase::sparse;
    const Plan plan = compile(scene, sparse);
    for (const Table& table : widest_tables()) {
      BatchOptions options = options_of(table, 3);
      Batch batch(plan, options);
      batch.step(60);
      const Snapshot saved = batch.save();
      batch.step(20);
      const std::uint64_t then = batch.hash(), of_first = batch.hash(0);
      batch.restore(saved);
      batch.step(20);
      CHECK(batch.hash() == then);
      options.worlds = 1;
      Batch other(plan, options);
      other.restore(saved, 0, 0);
      other.step(20);
      CHECK(other.hash(0) == of_first);
      // Contacts that only a plan with tables can have stored are refused.
      PlanOptions listed;
      listed.broad_phase = BroadPhase::all_pairs;
      Batch foreign(compile(scene, listed), options);
      CHECK_THROWS_AS(foreign.restore(saved, 0, 0), SnapshotError);
    }
  }
}

TEST_CASE("standard scenes come in other sizes by name", "[fast][scene]") {
  CHECK(scenes::sized("pyramid2d:5")->bodies.size() == 16);
  CHECK(scenes::sized("bin-boxes:300")->bodies.size() == 301);
  CHECK(scenes::sized("bin-spheres:7")->bodies.size() == 8);
  CHECK_FALSE(scenes::sized("pyramid2d"));
  CHECK_FALSE(scenes::sized("domino:5"));
  for (const char* wrong : {"pyramid2d:", "pyramid2d:0", "pyramid2d:256", "pyramid2d:5x"})
    CHECK_THROWS_AS(scenes::sized(wrong), std::invalid_argument);
  for (const char* name : {"pyramid2d:100", "bin-boxes:5000", "bin-spheres:32000"})
    CHECK(validate(*scenes::sized(name)).empty());
}

}  // namespace manyworlds::test
