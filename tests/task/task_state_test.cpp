// State in expressions: memories of tasks, and functions of all steps of an episode.
#include <catch2/catch.hpp>

#include <cmath>
#include <string>
#include <vector>

#include "manyworlds/expression_graph.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/task_bits.hpp"

namespace manyworlds::test {
namespace {

using namespace terms;

// A crate that is pushed along x by what controls remember.
Task pushed() {
  Task task;
  task.scene = one_crate(Space::spatial, -10);
  task.scene.bodies[0].jitter.linear_velocity = Vec3(3, 3, 3);
  for (int i = 0; i < 4; ++i) {
    Control thrust;
    thrust.kind = ControlKind::thrust, thrust.body = BodyId(0), thrust.low = -9, thrust.high = 9;
    task.scene.add(thrust);
  }
  task.actions = {{"push", -1, 1}};
  const Expression x = terms::position(BodyId(0), 0), v = terms::velocity(BodyId(0), 0);
  const Expression count = memory("count"), best = memory("best"), filter = memory("filter");
  task.memories = {{"count", uniform("first", Every::episode, 2, 5), count + 1},
                   {"best", x, max(best, x)},
                   // Both are what they were before the step here.
                   {"filter", 0, filter + 0.25 * (action() - filter) + 0 * count},
                   {"before", -1, memory("count")},
                   {"kept", 7 + v}};
  task.controls = {filter, smoothed(action(), 0.5), 0.1 * age(), memory("count")};
  task.observations = {{"x", x},
                       {"v", v},
                       {"count", count},
                       {"best", best},
                       {"filter", filter},
                       {"before", memory("before")},
                       {"kept", memory("kept")},
                       {"filter control", control(ControlId(0))},
                       {"smoothed control", control(ControlId(1))},
                       {"age control", control(ControlId(2))},
                       {"count control", control(ControlId(3))},
                       {"smoothed", smoothed(action(), 0.5)},
                       {"fast", latched(v > 3.01)},
                       {"sum", summed(v)},
                       {"phase", phase(7.25)},
                       {"back", phase(-7.25)},
                       {"over", smoothed_over(x, 0.1)},
                       {"largest", largest(x)},
                       {"previous", previous(count)},
                       {"pushed", held(action() > 0)},
                       {"age", age()}};
  task.max_steps = 11;
  return task;
}

}  // namespace

TEST_CASE("memories are what their next made of them, from where the episode began",
          "[task][fast]") {
  const Task task = pushed();
  for (const Issue& issue : validate(task)) FAIL_CHECK(to_string(issue));
  for (const Autoreset autoreset : {Autoreset::same_step, Autoreset::next_step}) {
    constexpr std::size_t kWorlds = 13, kColumns = 21;
    Played p(task, {.worlds = int(kWorlds), .seed = 3, .autoreset = autoreset});
    struct Expected {
      float count, before, filter, best, kept, smooth, sum, latch, over, held;
      int age;
    };
    std::vector<Expected> expected(kWorlds);
    std::vector<std::uint8_t> begins(kWorlds, 0);
    const auto begin = [&](std::size_t w) {
      const float* o = p.observations.data() + w * kColumns;
      CHECK((o[2] >= 2 && o[2] <= 5));
      expected[w] = {o[2], -1, 0, o[0], 7 + o[1], 0, 0, o[1] > 3.01f ? 1.f : 0.f, o[0], 0, 0};
    };
    const auto check = [&](std::size_t w, const float* o) {
      const Expected& e = expected[w];
      CAPTURE(w, e.age);
      CHECK(o[2] == e.count);
      CHECK(o[3] == e.best);
      CHECK(o[4] == e.filter);
      CHECK(o[5] == e.before);
      CHECK(o[6] == e.kept);
      CHECK(o[11] == e.smooth);
      CHECK(o[12] == e.latch);
      CHECK(o[13] == e.sum);
      const double cycles = 7.25 * e.age / 60;
      CHECK(o[14] == Approx(cycles - std::floor(cycles)).margin(1e-5));
      CHECK((o[14] >= 0 && o[14] < 1 && o[15] >= 0 && o[15] < 1));
      CHECK(std::cos(6.283185307 * double(o[14] + o[15])) == Approx(1).margin(1e-4));
      CHECK(o[16] == Approx(e.over).epsilon(1e-5));
      CHECK(o[17] == o[3]);
      CHECK(o[18] == (e.age == 0 ? e.count : e.before));
      CHECK(o[19] == e.held);
      CHECK(o[20] == static_cast<float>(e.age));
    };
    for (std::size_t w = 0; w < kWorlds; ++w) begin(w), check(w, &p.observations[w * kColumns]);
    for (int step = 0; step < 40; ++step) {
      p.act_at_random(step);
      p.step();
      for (std::size_t w = 0; w < kWorlds; ++w) {
        const bool ended = p.ended(int(w)), now = ended && autoreset == Autoreset::same_step;
        if (begins[w] != 0) {
          begin(w);
        } else {
          Expected& e = expected[w];
          const float* o = (now ? p.final_observations : p.observations).data() + w * kColumns;
          const float action = p.actions[w];
          CHECK(o[7] == e.filter);  // controls: as the last step left it
          CHECK(o[10] == std::min(e.count, 9.f));
          e.before = e.count, e.count += 1, e.age += 1;
          e.filter += 0.25f * (action - e.filter);
          e.best = std::max(e.best, o[0]);
          e.smooth += 0.5f * (action - e.smooth);
          CHECK(o[8] == e.smooth);  // and functions with the step to take
          CHECK(o[9] == 0.1f * static_cast<float>(e.age));
          e.sum += o[1];
          e.latch = std::max(e.latch, o[1] > 3.01f ? 1.f : 0.f);
          e.over += static_cast<float>(1 - std::exp(-1.0 / 6)) * (o[0] - e.over);
          e.held = action > 0 ? e.held + 1 : 0;
          check(w, o);
          if (now) begin(w), check(w, &p.observations[w * kColumns]);
        }
        begins[w] = ended && autoreset == Autoreset::next_step;
      }
    }
  }
}

TEST_CASE("memories have the same bits whatever the batch and instruction set",
          "[task][bits][fast]") {
  check_same_bits(pushed());
}

TEST_CASE("memories are saved, restored and copied with their worlds", "[task][fast]") {
  constexpr int kWorlds = 9;
  Played p(pushed(), {.worlds = kWorlds, .seed = 6}), q(pushed(), {.worlds = kWorlds, .seed = 1});
  for (int step = 0; step < 7; ++step) p.act_at_random(step), p.step();
  const EnvironmentSnapshot snapshot = p.environment.save();
  q.environment.restore(snapshot);
  p.environment.copy_world(2, 5);
  const std::size_t n = Played::size(p.environment.observations());
  for (int step = 7; step < 30; ++step) {
    p.act_at_random(step), q.act_at_random(step);
    p.actions[5] = p.actions[2];
    p.step(), q.step();
    for (std::size_t w = 0; w < kWorlds; ++w) {
      if (w == 5) continue;
      for (std::size_t i = 0; i < n; ++i)
        REQUIRE(p.observations[w * n + i] == q.observations[w * n + i]);
    }
    if (step > 9) continue;  // until the episode ends
    for (std::size_t i = 0; i < n; ++i)
      REQUIRE(p.observations[2 * n + i] == p.observations[5 * n + i]);
  }
}

TEST_CASE("what is wrong with memories is said", "[task][fast]") {
  Task task = pushed();
  const Expression x = terms::position(BodyId(0), 0);
  task.memories = {{"a", memory("b"), memory("c")}, {"a"}, {""}, {"b", held(memory("a"))}};
  task.controls = {latched(x > 1), summed(memory("b")), previous(summed(x)), memory("nothing")};
  task.observations = {{"x", x}};
  std::vector<std::string> found;
  for (const Issue& issue : validate(task)) found.push_back(issue.place + ": " + issue.message);
  const std::string known =
      "actions, constants, random numbers, parameters, levels, age() and previous(...) only";
  const std::vector<std::string> expected{
      "control 0: depends on position of body 0, axis 0, must depend on " + known,
      "control 1: depends on the memory 'b', must depend on " + known,
      "control 3: uses the memory 'nothing', must be one of Task::memories: a, a, , b",
      "memory 1 'a': has the name of memory 0 'a', must be unique",
      "memory 0 'a', begin: depends on the memory 'b', must depend on terms other than memories",
      "memory 0 'a', next: uses the memory 'c', must be one of Task::memories: a, a, , b",
      "memory 2: has no name, must have one",
      "memory 3 'b', begin: depends on the memory 'a', must depend on terms other than memories"};
  CHECK(found == expected);
}

TEST_CASE("state in expressions is plain values, too", "[task][fast]") {
  const std::vector<Expression> roots{memory("m") + time_step(), latched(age() > 2) & lost(),
                                      summed(action()),          smoothed(action(), 0.5),
                                      smoothed_over(age(), 2),   phase(3)};
  const char* const texts[] = {"memory('m') + time_step()",
                               "latched(2 < age()) & lost()",
                               "summed(action(0))",
                               "smoothed(action(0), 0.5)",
                               "smoothed(age(), 1 - exp(-(time_step() / 2)))",
                               "phase(3)"};
  const std::vector<Expression> again = from_graph(graph_of(roots));
  for (std::size_t i = 0; i < roots.size(); ++i) {
    CHECK(to_string(roots[i]) == texts[i]);
    CHECK(to_string(again[i]) == texts[i]);
  }
}

}  // namespace manyworlds::test
