// A listener hears of every call that changes a world, after it, and of nothing else.
#include <catch2/catch.hpp>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/crowd.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

struct Log final : BatchListener {
  std::vector<std::string> lines;
  std::vector<std::vector<double>> values;
  std::uint64_t hash = 0;
  void on_input(const Batch& batch, const InputCall& call) noexcept override {
    lines.push_back(std::string(to_string(call.input)) + " " + std::to_string(call.world) + " " +
                    std::to_string(call.body.index()));
    values.emplace_back(call.values.begin(), call.values.end());
    hash = batch.hash(call.world);
  }
  void on_step(const Batch& batch, int n) noexcept override {
    lines.push_back("step " + std::to_string(n));
    hash = batch.hash(0);
  }
};

}  // namespace

TEST_CASE("a listener hears of every input and step call", "[fast][listener]") {
  Batch batch(compile(crowd(Space::spatial)), options_of(widest_tables().front(), 3));
  const auto log = std::make_shared<Log>();
  batch.listen(log);
  const auto heard = [&](const std::vector<std::string>& lines, int world) {
    CHECK(log->lines == lines);
    CHECK(log->hash == batch.hash(world));  // after the change
    log->lines.clear();
  };
  CHECK_FALSE(batch.forces_pending());
  batch.add_force(1, BodyId(4), Vec3(1, 2, 3));
  CHECK(batch.forces_pending());
  heard({"force 1 4"}, 1);
  CHECK(log->values.back() == std::vector<double>{1, 2, 3});
  batch.add_torque(1, BodyId(4), Vec3(1, 2, 3));
  heard({"torque 1 4"}, 1);
  batch.add_force_at(1, BodyId(4), Vec3(1, 2, 3), Vec3(4, 5, 6));
  heard({"force_at 1 4"}, 1);
  CHECK(log->values.back() == std::vector<double>{1, 2, 3, 4, 5, 6});
  batch.add_impulse(1, BodyId(4), Vec3(1, 2, 3));
  heard({"impulse 1 4"}, 1);
  batch.add_angular_impulse(1, BodyId(4), Vec3(1, 2, 3));
  heard({"angular_impulse 1 4"}, 1);
  batch.add_impulse_at(1, BodyId(4), Vec3(1, 2, 3), Vec3(4, 5, 6));
  heard({"impulse_at 1 4"}, 1);
  batch.set_enabled(2, BodyId(2), false);
  batch.set_enabled(2, BodyId(2), true);
  heard({"disable 2 2", "enable 2 2"}, 2);
  batch.spawn(2, BodyId(2), {Vec3(1, 2, 3), Quat(0.6, 0.8, 0, 0), Vec3(4, 5, 6), Vec3(7, 8, 9)});
  heard({"spawn 2 2"}, 2);
  CHECK(log->values.back() == std::vector<double>{1, 2, 3, 0.6, 0.8, 0, 0, 4, 5, 6, 7, 8, 9});
  batch.wake(1);
  heard({"wake 1 -1"}, 1);
  const std::vector<double> at = values(batch, Field::position, 1);
  batch.write(Field::position, 1, at);
  heard({"write_position 1 -1"}, 1);
  CHECK(log->values.back() == at);
  std::vector<float> all(batch.size(Field::angular_velocity), 0.5f);
  batch.write(Field::angular_velocity, all);
  const char* const write = "write_angular_velocity ";
  heard({write + std::string("0 -1"), write + std::string("1 -1"), write + std::string("2 -1")}, 2);
  CHECK(log->values.back() == std::vector<double>(all.size() / 3, 0.5));
  batch.step(4);
  CHECK_FALSE(batch.forces_pending());
  heard({"step 4"}, 0);
  batch.step_to(batch.time() + 10);
  CHECK(log->lines == std::vector<std::string>{"step 8"});
  log->lines.clear();
  batch.step(std::array<std::uint8_t, 3>{1, 0, 1}, 2);
  heard({"reset 0 -1", "reset 2 -1"}, 2);
  const Snapshot saved = batch.save();
  batch.restore(saved);
  heard({"restore 0 -1", "restore 1 -1", "restore 2 -1"}, 2);
  batch.restore(saved, 0, 2);
  heard({"restore 2 -1"}, 2);
  batch.copy_world(1, 0);
  heard({"restore 0 -1"}, 0);
  batch.reset(std::array<std::uint8_t, 3>{0, 1, 0});
  heard({"reset 1 -1"}, 1);
  batch.reset();
  heard({"reset 0 -1", "reset 1 -1", "reset 2 -1"}, 2);

  batch.set_controls(std::vector<float>{});
  heard({"set_controls 0 -1", "set_controls 1 -1", "set_controls 2 -1"}, 2);

  // What is refused did not happen, and reading is no input.
  CHECK_THROWS(batch.add_force(3, batch.body_in_row(0), Vec3::Zero()));
  CHECK_THROWS(batch.spawn(0, batch.body_in_row(0), {.rotation = Quat(0, 0, 0, 0)}));
  CHECK_THROWS(batch.restore(saved, 3, 0));
  batch.step(0);
  batch.contacts(0);
  batch.energy(0);
  CHECK(log->lines.empty());
}

TEST_CASE("listeners are heard of no more when they are gone", "[fast][listener]") {
  Batch batch(compile(crowd(Space::planar)), options_of(widest_tables().front(), 2));
  auto one = std::make_shared<Log>();
  const auto two = std::make_shared<Log>();
  batch.listen(one);
  batch.listen(two);
  Batch moved = std::move(batch);
  moved.step();
  CHECK(one->lines.size() == 1);
  one.reset();
  moved.step();
  CHECK(two->lines.size() == 2);
}

}  // namespace manyworlds::test
