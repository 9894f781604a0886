// Steps of a task that ask whether to go on: the same bits as without, and what becomes of one that
// is ended early, in whose middle the worlds then stand.
#include <catch2/catch.hpp>

#include <functional>
#include <memory>

#include "manyworlds/tasks.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/policy.hpp"

namespace manyworlds::test {
namespace {

constexpr int kWorlds = 21, kFrames = 200;

// Says no when it is asked the n-th time. A new batch does not know what its steps take: it begins
// with one of them, and then has at most four times as many at once.
GoOn times(int n) {
  return [n]() mutable { return --n > 0; };
}

// A task with long steps and short episodes.
Task slow(Task task) {
  task.frame_skip = kFrames;
  task.max_steps = 3;
  return task;
}

Played play(const Task& task, Autoreset autoreset, int threads = 1) {
  return {task, {.worlds = kWorlds, .threads = threads, .seed = 5, .autoreset = autoreset}};
}

bool step(Played& p, const GoOn& go_on) {
  return p.environment.task().choices > 0
             ? p.environment.step(std::span<const std::int64_t>(p.choices), p.arrays(), go_on)
             : p.environment.step(std::span<const float>(p.actions), p.arrays(), go_on);
}

void check_equal(const Played& a, const Played& b) {
  CHECK(a.environment.batch().steps() == b.environment.batch().steps());
  CHECK(hashes(a.environment.batch()) == hashes(b.environment.batch()));
  CHECK(a.observations == b.observations);
  CHECK(a.final_observations == b.final_observations);
  CHECK(a.rewards == b.rewards);
  CHECK(a.reward_terms == b.reward_terms);
  CHECK(a.terminated == b.terminated);
  CHECK(a.truncated == b.truncated);
}

struct Steps final : BatchListener {
  std::vector<int> calls;
  void on_input(const Batch&, const InputCall&) noexcept override {}
  void on_step(const Batch&, int n) noexcept override { calls.push_back(n); }
};

}  // namespace

TEST_CASE("a task's steps have the same bits whether they are asked, ended and finished, or not",
          "[task][bits][fast]") {
  const auto index = GENERATE(range(std::size_t{0}, tasks::all().size()));
  const auto autoreset = GENERATE(Autoreset::next_step, Autoreset::same_step);
  const Task task = slow(tasks::all()[index].make());
  INFO(task.name);
  Played whole = play(task, autoreset), asked = play(task, autoreset, 2),
         ended = play(task, autoreset);
  int questions = 0;
  for (int i = 0; i < 5; ++i) {
    for (Played* p : {&whole, &asked, &ended}) p->act_at_random(i);
    whole.step();
    CHECK(step(asked, [&] { return ++questions > 0; }));
    const std::int64_t before = ended.environment.batch().steps();
    if (!step(ended, times(i % 2 + 1))) {
      CHECK(ended.environment.batch().steps() + ended.environment.steps_left() == before + kFrames);
      ended.act_at_random(100 + i);  // it has those of its own
      while (!ended.environment.finish_step(ended.arrays(), times(1))) {
      }
    } else {
      CHECK(i > 0);  // by then it knows that its steps are short
    }
    check_equal(asked, whole);
    check_equal(ended, whole);
  }
  CHECK(questions > 1);
}

TEST_CASE("an environment that stands in the middle of a step says so, and refuses others",
          "[task][fast]") {
  const Task task = slow(tasks::find("LunarLander")->make());
  Played p = play(task, Autoreset::next_step), other = play(task, Autoreset::next_step);
  const auto heard = std::make_shared<Steps>();
  Environment& e = p.environment;
  const EnvironmentSnapshot start = e.save();
  CHECK_THROWS_WITH(e.finish_step(p.arrays()), Catch::Contains("no step was interrupted"));
  e.batch().listen(heard);
  e.batch().add_force(0, e.batch().body_in_row(0), Vec3(1, 0, 0));
  const std::vector<double> untouched(kWorlds, 7.5);
  p.rewards = untouched;
  REQUIRE_FALSE(step(p, times(2)));
  const auto taken = static_cast<int>(e.batch().steps());
  CHECK(taken > 1);
  CHECK(e.steps_left() == kFrames - taken);
  CHECK(heard->calls == std::vector<int>{taken});
  CHECK(p.rewards == untouched);
  CHECK_FALSE(e.batch().forces_pending());
  const std::string text =
      "after " + std::to_string(taken) + " of its " + std::to_string(kFrames) + " physics steps";
  std::vector<std::uint8_t> some = p.all();
  some[3] = 0;
  const std::vector<std::uint64_t> seeds(kWorlds);
  const std::uint64_t hash = e.batch().hash();
  for (const std::function<void()>& call : std::vector<std::function<void()>>{
           [&] { p.step(); },
           [&] { step(p, times(9)); },
           [&] { e.reset(some, {}); },
           [&] { e.reset(some, seeds, {}); },
           [&] { e.begin(some, {}); },
           [&] { e.copy_world(0, 1); },
           [&] { (void)e.save(); },
           [&] { e.restore(start, 0, 1); },
       }) {
    CHECK_THROWS_WITH(call(), Catch::Contains(text) && Catch::Contains("finish_step"));
    CHECK_THROWS_AS(call(), std::invalid_argument);
  }
  CHECK(e.batch().hash() == hash);
  CHECK(e.steps_left() == kFrames - taken);
  e.finish_step(p.arrays());
  CHECK(heard->calls == std::vector<int>{taken, kFrames - taken});
  CHECK(e.steps_left() == 0);
  CHECK(p.rewards != untouched);
  p.step();
}

TEST_CASE("a step whose question throws stands where one that was ended early does",
          "[task][fast]") {
  struct Enough {};
  const auto throws = []() -> bool { throw Enough(); };
  for (const char* name : {"LunarLander", "Pendulum"}) {  // choices, and numbers
    const Task task = slow(tasks::find(name)->make());
    Played p = play(task, Autoreset::same_step), other = play(task, Autoreset::same_step);
    p.act_at_random(1), other.act_at_random(1);
    REQUIRE_THROWS_AS(step(p, throws), Enough);
    const auto taken = static_cast<int>(p.environment.batch().steps());
    CHECK(taken > 0);
    CHECK(p.environment.steps_left() == kFrames - taken);
    p.act_at_random(2);                  // the step has those of its own
    for (bool whole = false; !whole;) {  // what is left may be too short for another question
      try {
        p.environment.finish_step(p.arrays(), throws);
        whole = true;
      } catch (const Enough&) {
        const auto now = static_cast<int>(p.environment.batch().steps());
        CHECK(p.environment.steps_left() == kFrames - now);
      }
    }
    other.step();
    check_equal(p, other);
  }
}

TEST_CASE("a step that was ended early is given up where all worlds begin", "[task][fast]") {
  const Task task = slow(tasks::find("CartPole")->make());
  Played p = play(task, Autoreset::disabled), other = play(task, Autoreset::disabled);
  const EnvironmentSnapshot start = p.environment.save();
  const auto end_early = [&] {
    Played fresh = play(task, Autoreset::disabled);  // that does not know how long its steps take
    std::swap(p.environment, fresh.environment);
    REQUIRE_FALSE(step(p, times(1)));
    REQUIRE(p.environment.steps_left() > 0);
  };
  end_early();
  p.environment.restore(start);
  for (Played* each : {&p, &other}) each->step();
  check_equal(p, other);

  const std::vector<std::uint64_t> seeds(kWorlds, 11);
  end_early();
  for (Played* each : {&p, &other}) {
    each->environment.reset(each->all(), seeds, each->observations);
    CHECK(each->environment.steps_left() == 0);
    each->step();
  }
  CHECK(p.observations == other.observations);
  CHECK(p.rewards == other.rewards);

  end_early();
  const std::vector<std::uint64_t> there = hashes(p.environment.batch());
  p.environment.begin(p.all(), {});
  CHECK(hashes(p.environment.batch()) == there);
  CHECK(p.environment.steps_left() == 0);
  p.step();
}

}  // namespace manyworlds::test
