// Steps that ask now and then whether to go on: the same bits, forces, observations and news for
// listeners as in one call, and an early end that is one of so many steps.
#include <catch2/catch.hpp>

#include <memory>
#include <vector>

#include "tests/support/crowd.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr int kSteppedWorlds = 9;

struct Steps final : BatchListener {
  std::vector<int> calls;
  int resets = 0;
  void on_input(const Batch&, const InputCall& call) noexcept override {
    resets += call.input == Input::reset ? 1 : 0;
  }
  void on_step(const Batch&, int n) noexcept override { calls.push_back(n); }
};

// Worlds that are pushed on from the start of the next call to its end.
struct Driven {
  Batch batch;
  std::shared_ptr<Steps> heard = std::make_shared<Steps>();

  explicit Driven(const Scene& scene, bool sleep = false) : batch(compile(scene), options(sleep)) {
    for (int w = 0; w < kSteppedWorlds; ++w)
      batch.add_force(w, batch.body_in_row(1), Vec3(0.5 * w, 1, 0));
    batch.listen(heard);
  }
  static BatchOptions options(bool sleep) {
    BatchOptions out = options_of(widest_tables().front(), kSteppedWorlds, 2);
    out.sleep = sleep;
    out.observe.what = {Observer::contacts, Observer::touching, Observer::motion};
    return out;
  }
};

// Says no when it is asked the n-th time.
GoOn times(int n) {
  return [n]() mutable { return --n > 0; };
}

void check_equal(const Batch& a, const Batch& b) {
  CHECK(a.steps() == b.steps());
  CHECK(hashes(a) == hashes(b));
  CHECK(a.forces_pending() == b.forces_pending());
  for (int w = 0; w < kSteppedWorlds; ++w) {
    const auto seen = a.step_contacts(w), wanted = b.step_contacts(w);
    REQUIRE(seen.size() == wanted.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
      REQUIRE(seen[i].normal_impulse == wanted[i].normal_impulse);
      REQUIRE(seen[i].separation == wanted[i].separation);
      REQUIRE(seen[i].feature == wanted[i].feature);
    }
    for (int row = 0; row < a.bodies(w); ++row) {
      REQUIRE(a.touching(w, a.body_in_row(row)) == b.touching(w, b.body_in_row(row)));
    }
  }
}

}  // namespace

TEST_CASE("steps that ask whether to go on are the steps of one call", "[fast][batch]") {
  const auto space = GENERATE(Space::planar, Space::spatial);
  const bool sleep = GENERATE(false, true);
  const Scene scene = crowd(space);
  const int n = sleep ? 400 : 60;  // until some worlds rest
  Driven asked(scene, sleep), whole(scene, sleep);
  int questions = 0;
  CHECK(asked.batch.step(n, [&] { return ++questions > 0; }) == n);
  whole.batch.step(n);
  CHECK(questions > 1);  // a new batch does not know what its steps take: it begins with one
  check_equal(asked.batch, whole.batch);
  CHECK(asked.heard->calls == whole.heard->calls);
  CHECK_FALSE(asked.batch.forces_pending());
}

TEST_CASE("a call that is ended early is one of so many steps", "[fast][batch]") {
  const Scene scene = crowd(Space::spatial);
  Driven ended(scene), whole(scene);
  const int taken = ended.batch.step(1'000'000, times(3));
  CHECK(taken >= 3);
  CHECK(taken < 1000);
  CHECK(ended.batch.steps() == taken);
  CHECK(ended.heard->calls == std::vector<int>{taken});
  whole.batch.step(taken);
  check_equal(ended.batch, whole.batch);
  ended.batch.step(5);  // usable, without the forces
  whole.batch.step(5);
  check_equal(ended.batch, whole.batch);
  CHECK(ended.batch.step(0, times(1)) == 0);
  const int more = ended.batch.step_to(1e6, 1'000'000, times(3));
  CHECK(more < 1'000'000);
  CHECK(ended.batch.steps() == taken + 5 + more);
}

TEST_CASE("a question that throws ends the call as a no does", "[fast][batch]") {
  struct Enough {};
  const Scene scene = crowd(Space::spatial);
  Driven thrown(scene), whole(scene);
  const auto throws_at = [](int n) {
    return [n]() mutable {
      if (--n == 0) throw Enough();
      return true;
    };
  };
  CHECK_THROWS_AS(thrown.batch.step(1'000'000, throws_at(3)), Enough);
  const auto taken = static_cast<int>(thrown.batch.steps());
  CHECK(taken >= 3);
  CHECK(taken < 1000);
  CHECK(thrown.heard->calls == std::vector<int>{taken});
  whole.batch.step(taken);
  check_equal(thrown.batch, whole.batch);

  const std::vector<std::uint8_t> all(kSteppedWorlds, 1);
  CHECK_THROWS_AS(thrown.batch.step(all, 1'000'000, throws_at(1)), Enough);
  CHECK(thrown.batch.steps() == taken);  // steps with a mask do not count
  CHECK(thrown.heard->resets == kSteppedWorlds);

  // The clock of step_to has moved by what was stepped: what is due is still due.
  Driven timed(scene);
  const double dt = scene.options.dt;
  CHECK_THROWS_AS(timed.batch.step_to(1000.5 * dt, 1'000'000, throws_at(2)), Enough);
  const auto done = static_cast<int>(timed.batch.steps());
  CHECK(done > 0);
  CHECK(timed.batch.step_to(1000.5 * dt, 1'000'000) == 1000 - done);
  CHECK(timed.batch.steps() == 1000);
  CHECK_THROWS_AS(timed.batch.measure_contacts(throws_at(2)), Enough);
}

TEST_CASE("steps of some worlds alone ask, too", "[fast][batch]") {
  const Scene scene = crowd(Space::planar);
  const std::vector<std::uint8_t> mask = {1, 0, 1, 1, 0, 0, 0, 1, 0};
  Driven ended(scene), whole(scene);
  const int taken = ended.batch.step(mask, 1'000'000, times(2));
  CHECK(taken < 1000);
  CHECK(ended.heard->resets == 4);
  whole.batch.step(mask, taken);
  CHECK(ended.batch.forces_pending());  // those of the others
  check_equal(ended.batch, whole.batch);
  CHECK_THROWS_AS(ended.batch.step(std::vector<std::uint8_t>(3), 1, times(1)),
                  std::invalid_argument);
}

TEST_CASE("measuring contacts can be ended", "[fast][batch]") {
  Batch batch(compile(crowd(Space::planar)), options_of(widest_tables().front(), kSteppedWorlds));
  batch.step(60);
  int questions = 0;
  const ContactSummary whole = batch.measure_contacts([&] { return ++questions > 0; });
  CHECK(questions > kSteppedWorlds);
  CHECK(whole.points_per_world == batch.measure_contacts().points_per_world);
  CHECK(whole.points_per_world > 0);
  CHECK(whole.mean_occupancy == batch.measure_contacts().mean_occupancy);
  questions = 0;
  CHECK(batch.measure_contacts([&] { return ++questions < 4; }).points_per_world == 0);
  CHECK(questions == 4);
}

}  // namespace manyworlds::test
