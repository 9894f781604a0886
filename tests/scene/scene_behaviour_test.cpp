// Named scenes do what they are there for.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "examples/birds/knocked_out.hpp"
#include "manyworlds/scenes.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr int kWorlds = 64;

Batch worlds_of(const char* scene, const Table& table) {
  const scenes::Entry* entry = scenes::find(scene);
  REQUIRE(entry != nullptr);
  return Batch(compile(entry->make()), options_of(table, kWorlds));
}

int row_named(const Batch& batch, const std::string& name) { return batch.row(batch.body(name)); }

void step_seconds(Batch& batch, double seconds) {
  batch.step(static_cast<int>(std::lround(seconds / batch.plan().scene().options.dt)));
}

void set_all_controls(Batch& batch, const std::vector<double>& values) {
  for (int w = 0; w < batch.worlds(); ++w) batch.set_controls(w, values);
}

void check_ok(const Batch& batch) {
  for (int w = 0; w < batch.worlds(); ++w) CHECK(batch.status(w) == Status::ok);
}

double total_energy(const Batch& batch, int world) {
  const Energy energy = batch.energy(world);
  return energy.kinetic + energy.potential;
}

// Boxes of bird-sling that each world has lost after 4 s.
std::vector<int> knocked_out(Batch& batch) {
  const std::vector<int> boxes = birds::boxes(batch.plan());
  CHECK(boxes.size() == 14);
  std::vector<std::vector<double>> began;
  for (int w = 0; w < kWorlds; ++w) began.push_back(values(batch, Field::position, w));
  step_seconds(batch, 4);
  check_ok(batch);
  std::vector<int> out;
  for (int w = 0; w < kWorlds; ++w) {
    out.push_back(birds::knocked_out(boxes, began[static_cast<std::size_t>(w)],
                                     values(batch, Field::position, w),
                                     values(batch, Field::orientation, w)));
  }
  return out;
}

}  // namespace

TEST_CASE("the bird knocks boxes out of the pile, which stands without it", "[fast][scene]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch slung = worlds_of("bird-sling", table);
    for (const int boxes : knocked_out(slung)) CHECK(boxes >= 1);
    Batch kept = worlds_of("bird-sling", table);
    for (int w = 0; w < kWorlds; ++w) {
      set_vector(kept, Field::linear_velocity, w, row_named(kept, "bird"), Vec3::Zero());
    }
    for (const int boxes : knocked_out(kept)) CHECK(boxes == 0);
  }
}

TEST_CASE("a cradle on rods passes the swing on and gains no energy", "[fast][scene][joint]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch = worlds_of("cradle-joints", table);
    const int first = row_named(batch, "ball0"), last = row_named(batch, "ball4");
    const double rest = position(batch, 0, last).y();
    std::vector<double> start, swing, rise(kWorlds), back(kWorlds);
    batch.step();  // what the jitter gave along the rod is gone
    for (int w = 0; w < kWorlds; ++w) {
      start.push_back(total_energy(batch, w));
      const Energy energy = batch.energy(w);  // of four balls at rest and the raised one
      swing.push_back(energy.kinetic + 10 * kPi / 4 * (position(batch, w, first).y() - rest));
    }
    const auto most = [&](int body, std::vector<double>& height) {
      for (int i = 0; i < 20; ++i) {
        step_seconds(batch, 0.1);
        for (int w = 0; w < kWorlds; ++w) {
          const auto k = static_cast<std::size_t>(w);
          height[k] = std::max(height[k], position(batch, w, body).y() - rest);
          // Semi-implicit steps let the energy of a swing waver by this much.
          CHECK(total_energy(batch, w) < start[k] + 0.005 * swing[k]);
        }
      }
    };
    most(last, rise);   // within 2 s
    most(first, back);  // and 4 s
    for (std::size_t w = 0; w < kWorlds; ++w) {
      const double height = swing[w] / (10 * kPi / 4);
      CHECK(rise[w] > 0.95 * height);
      CHECK(back[w] > 0.95 * height);
    }
    check_ok(batch);
  }
}

TEST_CASE("a crane's load comes to rest below its trolley and goes where it is driven",
          "[fast][scene][joint]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch = worlds_of("crane", table);
    const int trolley = row_named(batch, "trolley"), load = row_named(batch, "load");
    const auto hanging = [&](int w) {
      return Vec3(position(batch, w, load) - position(batch, w, trolley));
    };
    set_all_controls(batch, {0, 0});
    step_seconds(batch, 30);
    std::vector<double> from;
    for (int w = 0; w < kWorlds; ++w) {
      CHECK(std::abs(hanging(w).x()) < 0.02);
      CHECK(hanging(w).y() == approx(-6, 0.01));
      CHECK(velocity(batch, w, load).norm() < 0.02);
      from.push_back(position(batch, w, trolley).x());
    }
    set_all_controls(batch, {-2, 0.5});
    step_seconds(batch, 2);
    for (int w = 0; w < kWorlds; ++w) {
      CHECK(position(batch, w, trolley).x() - from[static_cast<std::size_t>(w)] == approx(-4, 0.2));
      CHECK(hanging(w).norm() == approx(7, 0.1));
    }
    check_ok(batch);
  }
}

TEST_CASE("a jenga tower with one block drawn stands", "[slow][scene]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch = worlds_of("jenga", table);
    const Batch began = worlds_of("jenga", table);
    step_seconds(batch, 10);
    for (int w = 0; w < kWorlds; ++w) {
      for (int b = 0; b < batch.bodies(); ++b) {
        CHECK((position(batch, w, b) - position(began, w, b)).norm() < 0.01);
      }
      CHECK(max_speed(batch, w) < 0.05);
    }
    check_ok(batch);
  }
}

TEST_CASE("a car drives over rough ground by its motors and turns where it is steered",
          "[slow][scene][joint]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    const auto driven = [&](const std::vector<double>& controls, double seconds) {
      Batch batch = worlds_of("car3d", table);
      set_all_controls(batch, controls);
      step_seconds(batch, seconds);
      check_ok(batch);
      return batch;
    };
    const Batch ahead = driven({12, 12, 0, 0}, 10), left = driven({12, 12, 0.3, 0.3}, 3),
                still = driven({0, 0, 0, 0}, 10), fresh = worlds_of("car3d", table);
    const int car = row_named(fresh, "chassis");
    for (int w = 0; w < kWorlds; ++w) {
      const Vec3 from = position(fresh, w, car);
      CHECK(position(ahead, w, car).x() - from.x() > 30);
      CHECK((rotation(ahead, w, car) * Vec3::UnitZ()).z() > 0.8);
      const Vec3 heading = rotation(left, w, car) * Vec3::UnitX();
      CHECK(heading.x() < 0.8);
      CHECK(position(left, w, car).y() - from.y() > 2);
      CHECK(std::abs(position(still, w, car).x() - from.x()) < 0.1);
    }
  }
}

TEST_CASE("a chain reaction hoists its flag, and not without the ball that starts it",
          "[slow][scene][joint]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    const auto risen = [&](bool ball) {
      Batch batch = worlds_of("chain-reaction", table);
      const int flag = row_named(batch, "flag");
      const double from = position(batch, 0, flag).y();
      for (int w = 0; w < kWorlds && !ball; ++w) {
        batch.set_enabled(w, batch.body("ball"), false);
      }
      step_seconds(batch, 12);
      check_ok(batch);
      std::vector<double> out;
      for (int w = 0; w < kWorlds; ++w) out.push_back(position(batch, w, flag).y() - from);
      return out;
    };
    for (const double height : risen(true)) CHECK(height > 1.5);
    for (const double height : risen(false)) CHECK(std::abs(height) < 0.01);
  }
}

}  // namespace manyworlds::test
