// Environments: the same bits however they are run, and what happens where episodes end.
#include <catch2/catch.hpp>

#include "manyworlds/tasks.hpp"
#include "tests/support/policy.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// All that a world's user has seen of it after so many random steps, and its state.
std::vector<double> history(Played& p, int world, int steps_seen) {
  const auto w = static_cast<std::size_t>(world);
  const auto n = static_cast<std::size_t>(p.environment.observations());
  const auto terms = p.environment.task().rewards.size();
  std::vector<double> out{static_cast<double>(steps_seen), p.rewards[w],
                          static_cast<double>(p.terminated[w]),
                          static_cast<double>(p.truncated[w])};
  const auto add = [&](const auto& from, std::size_t of) {
    out.insert(out.end(), from.begin() + static_cast<std::ptrdiff_t>(w * of),
               from.begin() + static_cast<std::ptrdiff_t>((w + 1) * of));
  };
  add(p.observations, n);
  add(p.final_observations, n);
  add(p.reward_terms, terms);
  return out;
}

// Ends episodes early and often, so that resets are part of what is compared.
Task hurried(const tasks::Entry& entry) {
  Task task = entry.make();
  task.max_steps = task.max_steps > 0 ? std::min(task.max_steps, 17) : 17;
  return task;
}

}  // namespace

TEST_CASE("a world's episodes have the same bits whatever the batch, threads and instruction set",
          "[task][bits][fast]") {
  const auto index = GENERATE(range(std::size_t{0}, tasks::all().size()));
  const Task task = hurried(tasks::all()[index]);
  INFO(task.name);
  constexpr int kSteps = 40, kWorlds = 37;
  for (const Autoreset autoreset : {Autoreset::next_step, Autoreset::same_step}) {
    for (const Precision precision : {Precision::f32, Precision::f64}) {
      if (!has_table({Isa::scalar, precision})) continue;
      std::vector<std::vector<double>> wanted;
      std::uint64_t hash = 0;
      bool first = true;
      for (const Table& table : all_tables()) {
        if (table.precision != precision) continue;
        for (const int threads : {1, 3}) {
          Played p(task, {.worlds = kWorlds,
                          .threads = threads,
                          .seed = 5,
                          .precision = precision,
                          .isa = table.isa,
                          .autoreset = autoreset});
          std::vector<std::vector<double>> found;
          for (int step = 0; step < kSteps; ++step) {
            p.act_at_random(step);
            p.step();
            for (int w = 0; w < kWorlds; ++w) found.push_back(history(p, w, step));
          }
          if (first) wanted = found, hash = p.environment.batch().hash();
          first = false;
          bool all_same = true;
          for (std::size_t i = 0; i < found.size(); ++i) {
            all_same = all_same && same_bits(found[i], wanted[i]);
          }
          CHECK(all_same);
          CHECK(p.environment.batch().hash() == hash);
        }
      }
      // Alone: the batch's seed is what the world's was.
      for (const int world : {0, 20, kWorlds - 1}) {
        Played alone(task, {.worlds = 1,
                            .seed = 5 + static_cast<std::uint64_t>(world),
                            .precision = precision,
                            .autoreset = autoreset});
        bool all_same = true;
        for (int step = 0; step < kSteps; ++step) {
          alone.act_at_random(step, world);
          alone.step();
          all_same =
              all_same && same_bits(history(alone, 0, step),
                                    wanted[static_cast<std::size_t>(step * kWorlds + world)]);
        }
        CHECK(all_same);
      }
    }
  }
}

TEST_CASE("autoreset does what a loop with resets by hand does", "[task][fast]") {
  const auto name = GENERATE(as<std::string>(), "CartPole", "LunarLander", "Pusher");
  const Task task = hurried(*tasks::find(name));
  const Autoreset mode = GENERATE(Autoreset::next_step, Autoreset::same_step);
  constexpr int kWorlds = 21;
  Played automatic(task, {.worlds = kWorlds, .seed = 3, .autoreset = mode}),
      manual(task, {.worlds = kWorlds, .seed = 3, .autoreset = Autoreset::disabled});
  std::vector<std::uint8_t> pending(kWorlds, 0);
  const auto n = static_cast<std::size_t>(manual.environment.observations());
  int episodes = 0;
  for (int step = 0; step < 60; ++step) {
    automatic.act_at_random(step);
    automatic.step();
    manual.act_at_random(step);
    manual.step();
    std::vector<std::uint8_t> mask(kWorlds, 0);
    for (std::size_t w = 0; w < kWorlds; ++w) {
      if (mode == Autoreset::next_step && pending[w]) {
        manual.rewards[w] = 0;
        manual.terminated[w] = manual.truncated[w] = 0;
        mask[w] = 1;
        pending[w] = 0;
        continue;
      }
      const bool ended = manual.ended(static_cast<int>(w));
      episodes += ended;
      if (!ended) continue;
      if (mode == Autoreset::next_step) {
        pending[w] = 1;
      } else {
        mask[w] = 1;
        std::copy_n(manual.observations.data() + w * n, n,
                    manual.final_observations.data() + w * n);
      }
    }
    manual.environment.reset(mask, manual.observations);
    REQUIRE(automatic.observations == manual.observations);
    REQUIRE(automatic.final_observations == manual.final_observations);
    REQUIRE(automatic.rewards == manual.rewards);
    REQUIRE(automatic.terminated == manual.terminated);
    REQUIRE(automatic.truncated == manual.truncated);
    REQUIRE(automatic.environment.batch().hash() == manual.environment.batch().hash());
  }
  CHECK(episodes > kWorlds);
}

TEST_CASE("worlds that are not reset automatically step on", "[task][fast]") {
  Task task = hurried(*tasks::find("Pendulum"));
  Played p(task, {.worlds = 3, .autoreset = Autoreset::disabled});
  for (int step = 1; step <= 30; ++step) {
    p.step();
    CHECK((p.truncated[1] != 0) == (step >= 17));
    CHECK(p.rewards[1] != 0);
  }
}

TEST_CASE("seeds: world i of seed s begins as a batch of seed s + i does", "[task][fast]") {
  const Task task = tasks::find("LunarLander")->make();
  Played p(task, {.worlds = 4, .seed = 100});
  for (int step = 0; step < 5; ++step) p.step();
  const std::vector<std::uint64_t> seeds = {7, 100, 8, 7};
  const std::vector<std::uint8_t> mask = {1, 1, 0, 1};
  const std::vector<float> before = p.observations;
  p.environment.reset(mask, seeds, p.observations);
  Played seven(task, {.worlds = 1, .seed = 7}), hundred(task, {.worlds = 1, .seed = 100});
  const auto n = static_cast<std::size_t>(p.environment.observations());
  const auto of = [n](const std::vector<float>& all, std::size_t w) {
    return std::vector<float>(all.begin() + static_cast<std::ptrdiff_t>(w * n),
                              all.begin() + static_cast<std::ptrdiff_t>((w + 1) * n));
  };
  CHECK(of(p.observations, 0) == seven.observations);
  CHECK(of(p.observations, 1) == hundred.observations);
  CHECK(of(p.observations, 2) == of(before, 2));
  CHECK(of(p.observations, 3) == seven.observations);
  // Their next episodes, too.
  p.environment.reset(p.all(), p.observations);
  seven.environment.reset(seven.all(), seven.observations);
  CHECK(of(p.observations, 3) == seven.observations);
  CHECK(of(p.observations, 3) != of(before, 3));

  // Batch by itself.
  Batch batch(compile(task.scene), {.worlds = 3, .seed = 1}),
      other(compile(task.scene), {.seed = 9});
  const std::vector<std::uint64_t> nine(3, 9);
  batch.step(3);
  batch.reset(std::vector<std::uint8_t>{0, 1, 0}, nine);
  CHECK(batch.hash(1) == other.hash(0));
  CHECK_THROWS_AS(batch.reset(std::vector<std::uint8_t>{0, 1, 0}, std::vector<std::uint64_t>{1}),
                  std::invalid_argument);
}

TEST_CASE("an action that is not a number breaks its world's episode off and no other",
          "[task][fast]") {
  const Task task = tasks::find("Pendulum")->make();
  Played p(task, {.worlds = 11}), calm(task, {.worlds = 11});
  p.actions[4] = std::numeric_limits<float>::quiet_NaN();
  p.step();
  calm.step();
  CHECK(p.truncated[4] == 1);
  CHECK(p.environment.batch().status(4) == Status::non_finite);
  for (int w = 0; w < 11; ++w) {
    if (w != 4) CHECK(p.environment.batch().hash(w) == calm.environment.batch().hash(w));
  }
  p.actions[4] = 0;
  p.step();  // begins anew
  CHECK(p.environment.batch().status(4) == Status::ok);
  CHECK(p.truncated[4] == 0);
}

TEST_CASE("a copied world goes on as the one it is a copy of, with what is remembered of it",
          "[task][fast]") {
  const Task task = hurried(*tasks::find("LunarLander"));
  Played p(task, {.worlds = 20});
  const auto act = [&](int step) {
    p.act_at_random(step);
    p.choices[18] = p.choices[2];
    p.step();
  };
  for (int step = 0; step < 9; ++step) act(step);
  p.environment.copy_world(2, 18);
  for (int step = 9; step < 17; ++step) {
    act(step);
    CHECK(same_bits(history(p, 18, step), history(p, 2, step)));
  }
}

TEST_CASE("a saved environment goes on as it did, elsewhere and over the ends of episodes",
          "[task][bits][fast]") {
  const auto index = GENERATE(range(std::size_t{0}, tasks::all().size()));
  const Task task = hurried(tasks::all()[index]);
  INFO(task.name);
  constexpr int kWorlds = 20;
  for (const Autoreset autoreset : {Autoreset::next_step, Autoreset::same_step}) {
    const EnvironmentOptions options{.worlds = kWorlds, .seed = 5, .autoreset = autoreset};
    Played p(task, options);
    const auto play = [](Played& played, int begin, int end) {
      std::vector<std::vector<double>> seen;
      for (int step = begin; step < end; ++step) {
        played.act_at_random(step);
        played.step();
        for (int w = 0; w < kWorlds; ++w) seen.push_back(history(played, w, step));
      }
      return seen;
    };
    const std::vector<std::uint8_t> some(kWorlds, 1);
    std::vector<std::uint64_t> seeds(kWorlds);
    for (std::size_t w = 0; w < seeds.size(); ++w) seeds[w] = 1000 + 3 * w;
    p.environment.reset(some, seeds, {});
    // Some worlds end with the very step after which it is saved.
    play(p, 0, 17);
    const EnvironmentSnapshot saved = p.environment.save();
    Played other(
        task,
        {.worlds = kWorlds, .threads = 3, .seed = 99, .isa = Isa::scalar, .autoreset = autoreset});
    play(other, 0, 3);
    other.environment.restore(saved);
    other.final_observations = p.final_observations;  // they stay where no world ends
    const auto wanted = play(p, 17, 40), found = play(other, 17, 40);
    CHECK(p.environment.batch().hash() == other.environment.batch().hash());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (!same_bits(found[i], wanted[i])) FAIL_CHECK("step and world " << i);
    }
  }
}

TEST_CASE("a saved world goes on in another place, and nothing else is let in", "[task][fast]") {
  const Task task = hurried(*tasks::find("LunarLander"));
  Played p(task, {.worlds = 20}), few(task, {.worlds = 3, .autoreset = Autoreset::disabled});
  for (int step = 0; step < 9; ++step) {
    p.act_at_random(step);
    p.step();
  }
  const EnvironmentSnapshot saved = p.environment.save();
  few.environment.restore(saved, 13, 1);
  const std::uint64_t beside = few.environment.batch().hash(2);
  CHECK(few.environment.batch().hash(1) == p.environment.batch().hash(13));
  CHECK(few.environment.batch().hash(2) == beside);
  for (int step = 9; step < 15; ++step) {
    p.act_at_random(step);
    few.choices[1] = p.choices[13];
    p.step();
    few.step();
    INFO(step);
    CHECK(few.rewards[1] == p.rewards[13]);
    CHECK(few.environment.batch().hash(1) == p.environment.batch().hash(13));
  }

  const auto refuse = [&](auto change) {
    Task other = task;
    change(other);
    Environment environment(other, {.worlds = 20});
    const std::uint64_t before = environment.batch().hash();
    CHECK_THROWS_WITH(environment.restore(saved),
                      "snapshot: belongs to another task than 'LunarLander'");
    CHECK(environment.batch().hash() == before);
  };
  refuse([](Task& t) { t.max_steps += 1; });
  refuse([](Task& t) { t.frame_skip += 1; });
  refuse([](Task& t) { t.choices += 1; });
  refuse([](Task& t) { t.rewards.pop_back(); });
  refuse([](Task& t) { t.terminated = t.terminated | (terms::position(BodyId(2), 1) > 100); });
  refuse([](Task& t) { t.rays.push_back({}); });
  CHECK_THROWS_AS(few.environment.restore(saved), SnapshotError);
  CHECK_THROWS_AS(p.environment.restore(saved, 20, 0), std::invalid_argument);
  EnvironmentSnapshot cut = saved;
  cut.memory.pop_back();
  CHECK_THROWS_WITH(p.environment.restore(cut), Catch::Matchers::Contains("values, must be"));
}

TEST_CASE(
    "arrays of the wrong size, choices that there are not and actions of the other kind throw",
    "[task][fast]") {
  Environment lander(tasks::find("LunarLander")->make(), {.worlds = 3});
  Environment pendulum(tasks::find("Pendulum")->make(), {.worlds = 3});
  std::vector<float> numbers(3);
  std::vector<std::int64_t> choices(3);
  const std::uint64_t before = lander.batch().hash();
  CHECK_THROWS_WITH(lander.step(std::span<const float>(numbers), {}),
                    "the task's actions are choices, these are numbers");
  CHECK_THROWS_WITH(pendulum.step(std::span<const std::int64_t>(choices), {}),
                    "the task's actions are numbers, these are choices");
  choices[1] = 4;
  CHECK_THROWS_WITH(lander.step(std::span<const std::int64_t>(choices), {}),
                    "the action of world 1 is 4, must be 0 to 3");
  choices[1] = 0;
  std::vector<double> rewards(2);
  StepArrays out;
  out.rewards = rewards;
  CHECK_THROWS_WITH(lander.step(std::span<const std::int64_t>(choices), out),
                    "rewards are 3 values, the buffer has 2");
  CHECK_THROWS_AS(lander.step(std::span<const std::int64_t>(choices).subspan(1), {}),
                  std::invalid_argument);
  const std::vector<std::uint8_t> mask(2);
  CHECK_THROWS_AS(lander.reset(mask, {}), std::invalid_argument);
  CHECK_THROWS_AS(lander.begin(mask, {}), std::invalid_argument);
  CHECK(lander.batch().hash() == before);
}

}  // namespace manyworlds::test
