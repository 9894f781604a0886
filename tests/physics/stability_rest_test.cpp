// Piles come to rest and stay there: what does not keep its warm start, or moves a body that a
// contact holds, shows as creep.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "manyworlds/scenes.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

std::vector<double> positions(const Batch& batch) {
  std::vector<double> out(batch.size(Field::position));
  batch.read(Field::position, out);
  return out;
}

// How far each body goes in the next `steps`, m, in ascending order.
std::vector<double> sorted_moves(Batch& batch, int steps) {
  const std::vector<double> before = positions(batch);
  batch.step(steps);
  const std::vector<double> after = positions(batch);
  const auto dim =
      static_cast<std::size_t>(components(Field::position, batch.plan().scene().space));
  std::vector<double> moves;
  for (std::size_t i = 0; i < before.size(); i += dim) {
    double d2 = 0;
    for (std::size_t c = i; c < i + dim; ++c) d2 += (after[c] - before[c]) * (after[c] - before[c]);
    moves.push_back(std::sqrt(d2));
  }
  std::sort(moves.begin(), moves.end());
  return moves;
}

}  // namespace

// Boxes of 0.8 m in heaps: on faces, edges and walls, so most manifolds have fewer than four
// points.
TEST_CASE("heaps of boxes come to rest", "[slow][stability]") {
  const Plan plan = compile(scenes::find("bin-boxes")->make());
  for (const Table& table : widest_tables()) {
    constexpr int kWorlds = 32;
    Batch batch(plan, options_of(table, kWorlds));
    batch.step(1200);
    for (int w = 0; w < kWorlds; ++w) {
      INFO(name(table) << ", world " << w);
      CHECK(max_speed(batch, w) < 0.05);  // the usual threshold of sleep, m/s
    }
    const std::vector<double> moves = sorted_moves(batch, 60);
    INFO(name(table));
    CHECK(moves[moves.size() / 2] < 1e-5);
    CHECK(moves[moves.size() * 9 / 10] < 1e-3);
  }
}

// The gates of 20 s for the standard stacks, in every one of 1024 worlds.
TEST_CASE("stack10 and pyramid2d stand and their tops stay", "[slow][stability]") {
  constexpr int kWorlds = 1024;
  for (const char* scene : {"stack10", "pyramid2d"}) {
    const Plan plan = compile(scenes::find(scene)->make());
    const bool planar = plan.scene().space == Space::planar;
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table, kWorlds, 2));
      INFO(scene << ' ' << name(table));
      const int top = batch.bodies(0) - 1;
      std::vector<Vec3> start;
      for (int w = 0; w < kWorlds; ++w) start.push_back(position(batch, w, top));
      batch.step(1200);
      double sum = 0, most = 0, lowest = 0, deepest = 0;
      for (int w = 0; w < kWorlds; ++w) {
        const Vec3 moved = position(batch, w, top) - start[static_cast<std::size_t>(w)];
        const double drift = planar ? std::abs(moved.x()) : moved.head<2>().norm();
        sum += drift;
        most = std::max(most, drift);
        lowest = std::min(lowest, planar ? moved.y() : moved.z());
        deepest = std::max(deepest, max_penetration(batch, w));
      }
      CHECK(sum / kWorlds < 0.02);
      CHECK(most < 0.1);
      CHECK(lowest > -0.3);  // a top that fell came down by half a box at least
      CHECK(deepest < 0.006);
      CHECK(batch.lost_worlds() == 0);
    }
  }
}

// The second box is held by the first, which the ground holds: it does not fall freely, although
// the two have the same acceleration of gravity. (Taken for falling, it crept by 5 mm/s at 5
// degrees and a yaw of pi / 6.)
TEST_CASE("a box on a box stays where it is on a slope", "[fast][stability]") {
  for (const double slope : {5.0, 15.0, 25.0}) {
    for (const double yaw : {0.0, kPi / 6, kPi / 4}) {
      Scene scene = empty_scene(Space::spatial);
      const double angle = slope * kPi / 180;
      scene.options.gravity = 9.81 * Vec3(std::sin(angle), 0, -std::cos(angle));
      scene.add(ground(Space::spatial, 0.6));
      for (int i = 0; i < 2; ++i) {
        Body box = body_of(shape_of(cube_of(Space::spatial, 0.5), 0.6),
                           Vec3(0.02 * i, 0.01 * i, 0.5 + 1.0 * i));
        box.rotation = Quat(std::cos(yaw / 2), 0, 0, std::sin(yaw / 2));
        scene.add(box);
      }
      for (const Table& table : widest_tables()) {
        INFO(name(table) << ", slope " << slope << " degrees, yaw " << yaw);
        Batch batch(compile(scene), options_of(table));
        batch.step(300);
        CHECK(sorted_moves(batch, 600).back() < 1e-4);  // in 10 s
      }
    }
  }
}

}  // namespace manyworlds::test
