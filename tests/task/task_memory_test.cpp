// Delays, levels that outlive episodes, and numbers of the scene that a task sets where one begins.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "manyworlds/expression_graph.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/task_bits.hpp"
#include "tests/support/varied.hpp"

namespace manyworlds::test {
namespace {

// A falling crate that is pushed along x by actions which come late, by another number of steps in
// every episode.
constexpr int kMost = 4;
Expression lag() { return terms::uniform("lag", Every::episode, 0, kMost + 2); }
Task late() {
  Task task;
  task.scene = one_crate(Space::spatial, -10);
  task.scene.bodies[0].jitter.linear_velocity = Vec3(1, 1, 1);
  Control thrust;
  thrust.kind = ControlKind::thrust, thrust.body = BodyId(0), thrust.low = -9, thrust.high = 9;
  task.scene.add(thrust);
  task.actions = {{"push", -1, 1}};
  task.controls = {terms::delayed(terms::action(), lag(), kMost)};
  const Expression height = terms::position(BodyId(0), 2);
  task.observations = {
      {"lag", lag()},
      {"height", height},
      {"three ago", terms::delayed(height, 3)},
      {"lag ago", terms::delayed(height, lag(), kMost)},
      {"control", terms::control(ControlId(0))},
      {"height at the action", terms::previous(terms::delayed(height, lag(), kMost))}};
  task.max_steps = 9;
  return task;
}

// How far each world has come: one more after each episode that it ends itself, which takes as
// many steps as it has levels, and where it begins then.
Task stairs(Draw draw = Draw::none) {
  Task task;
  task.scene = one_crate(Space::spatial);
  Variation start;
  start.parameter = Parameter::initial_position, start.body = BodyId(0), start.draw = draw;
  start.high = Vec3(5, 0, 0);
  task.scene.variations = {start, vary(Parameter::mass, 900, 1100)};
  const Expression step = terms::level("step");
  task.levels = {{"step", 1, step + 1},
                 {"luck", terms::uniform("luck", Every::episode, 2, 3),
                  max(terms::level("luck"), terms::uniform("luck", Every::episode, 2, 3))},
                 {"broken", 7, log(terms::level("broken") * -1)}};
  task.initial_parameters = {{terms::parameter(Parameter::initial_position, BodyId(0), 0), step}};
  task.observations = {{"step", step},
                       {"x", terms::position(BodyId(0), 0)},
                       {"luck", terms::level("luck")},
                       {"broken", terms::level("broken")},
                       {"mass", terms::parameter(Parameter::mass, BodyId(0))}};
  task.terminated = terms::age() >= step;
  return task;
}

std::vector<double> levels(const Environment& environment) {
  std::vector<double> out(Played::size(environment.worlds() * environment.levels()));
  environment.read_levels(out);
  return out;
}

}  // namespace

TEST_CASE("what is delayed is what was seen as many steps before, or where the episode began",
          "[task][fast]") {
  const Task task = late();
  REQUIRE(validate(task).empty());
  for (const Autoreset autoreset : {Autoreset::same_step, Autoreset::next_step}) {
    constexpr std::size_t kWorlds = 21, kColumns = 6;
    Played p(task, {.worlds = int(kWorlds), .seed = 3, .autoreset = autoreset});
    std::vector<std::vector<float>> heights(kWorlds), actions(kWorlds);
    const auto ago = [](const std::vector<float>& all, std::size_t steps, float before) {
      return steps < all.size() ? all[all.size() - 1 - steps] : before;
    };
    const auto check = [&](std::size_t w) {
      const float* o = p.observations.data() + w * kColumns;
      heights[w].push_back(o[1]);
      const auto steps = std::min<std::size_t>(static_cast<std::size_t>(o[0]), kMost);
      CHECK(o[2] == ago(heights[w], 3, heights[w].front()));
      CHECK(o[3] == ago(heights[w], steps, heights[w].front()));
      CHECK(o[5] == ago(heights[w], steps + 1, heights[w].front()));
      if (heights[w].size() > 1) CHECK(o[4] == ago(actions[w], steps, 0));
    };
    for (std::size_t w = 0; w < kWorlds; ++w) check(w);
    std::vector<std::uint8_t> begins(kWorlds, 0);
    for (int step = 0; step < 60; ++step) {
      p.act_at_random(step);
      p.step();
      for (std::size_t w = 0; w < kWorlds; ++w) {
        const bool ended = p.ended(int(w));
        if (begins[w] != 0 || (ended && autoreset == Autoreset::same_step)) {
          heights[w].clear(), actions[w].clear();
        } else {
          actions[w].push_back(p.actions[w]);
        }
        begins[w] = ended && autoreset == Autoreset::next_step;
        check(w);
      }
    }
  }
}

TEST_CASE(
    "delays, levels and initial parameters have the same bits whatever the batch and instruction "
    "set",
    "[task][bits][fast]") {
  for (const Task& task : {late(), stairs()}) {
    REQUIRE(validate(task).empty());
    check_same_bits(task);
  }
}

TEST_CASE("levels stay for an episode, and go on where it ends by itself", "[task][fast]") {
  const Task task = stairs();
  for (const Autoreset autoreset : {Autoreset::same_step, Autoreset::next_step}) {
    Played p(task, {.worlds = 2, .seed = 8, .autoreset = autoreset});
    const std::vector<double> first = levels(p.environment);
    CHECK(first[0] == 1);
    CHECK((first[1] >= 2 && first[1] <= 3 && first[1] != first[4]));
    const bool same_step = autoreset == Autoreset::same_step;
    int ended = 0;
    float luck = p.observations[2], episode = 1;
    bool begins = false;
    for (int step = 1; step <= 60; ++step) {
      p.step();
      if (same_step && p.ended(0)) CHECK(p.final_observations[0] == episode);
      episode += same_step ? p.ended(0) : begins;
      begins = p.ended(0);
      ended += p.ended(0);
      CHECK(p.observations[0] == episode);
      CHECK(p.observations[2] >= luck);
      CHECK(p.observations[3] == 7);  // log(-7) is not a number
      luck = p.observations[2];
      // Where the world begins: within the range that is declared.
      CHECK(p.observations[1] == std::min(p.observations[0], 5.f));
    }
    CHECK(ended == (same_step ? 10 : 9));  // of 1, 2, 3 ... steps
    CHECK(luck > first[1]);

    const auto all = p.all();
    p.environment.reset(all, p.observations);  // in the middle of an episode
    CHECK(levels(p.environment)[0] == ended + 1);
    const std::vector<std::uint64_t> seeds{8, 9};
    p.environment.reset(all, seeds, p.observations);
    CHECK(levels(p.environment) == first);
    CHECK(p.observations[1] == 1);
  }
}

TEST_CASE("a level changes by the step that ends an episode, and by none after it",
          "[task][fast]") {
  Task task = stairs();
  task.levels[0].next = 10 * terms::age();
  Played p(task, {.worlds = 1, .autoreset = Autoreset::disabled});
  for (int step = 0; step < 4; ++step) p.step();
  CHECK(p.ended(0));
  CHECK(levels(p.environment)[0] == 1);
  const EnvironmentSnapshot snapshot = p.environment.save();
  p.environment.restore(snapshot);
  p.step();
  p.environment.write_levels(p.all(), levels(p.environment));  // changes nothing
  p.environment.reset(p.all(), p.observations);
  CHECK(levels(p.environment)[0] == 10);
  CHECK(p.observations[0] == 10);
}

TEST_CASE("levels that are written hold where worlds begin in their state", "[task][fast]") {
  Played p(stairs(), {.worlds = 1});
  for (int episode = 0; episode < 2; ++episode) {
    p.environment.write_levels(p.all(), std::vector<double>{4, 2, 7});
    p.environment.begin(p.all(), p.observations);
    CHECK(p.observations[0] == 4);
    p.environment.reset(p.all(), p.observations);
    CHECK(p.observations[0] == 4);
    CHECK(p.observations[1] == 4);
  }
}

TEST_CASE("a world of a seed begins as ever, whatever was before", "[task][fast]") {
  Task task = stairs();
  // Not a number in about every second episode: then the scene's own.
  const Expression u = terms::uniform("u", Every::episode, -1, 3);
  task.initial_parameters[0].value = log(u);
  task.levels.push_back({"kept", 3});
  Played p(task, {.worlds = 40, .seed = 2}), q(task, {.worlds = 40, .seed = 2});
  for (int step = 0; step < 9; ++step) p.step();
  std::vector<std::uint64_t> seeds(40);
  for (std::size_t w = 0; w < 40; ++w) seeds[w] = 2 + w;
  p.environment.reset(p.all(), seeds, p.observations);
  CHECK(p.observations == q.observations);
  CHECK(levels(p.environment) == levels(q.environment));
  CHECK(levels(p.environment)[3] == 3);
}

TEST_CASE("writing some worlds' levels leaves pending levels of others alone", "[task][fast]") {
  Played p(stairs(), {.worlds = 2, .autoreset = Autoreset::next_step});
  p.step();
  REQUIRE((p.ended(0) && p.ended(1)));
  const std::vector<double> others{5, 2, 7, 5, 2, 7};
  p.environment.write_levels(std::vector<std::uint8_t>{1, 0}, others);
  p.step();
  CHECK(p.observations[0] == 5);
  CHECK(p.observations[5] == 2);
}

TEST_CASE("levels are written, copied and saved with their worlds", "[task][fast]") {
  Played p(stairs(), {.worlds = 3, .seed = 1, .autoreset = Autoreset::same_step});
  Environment& e = p.environment;
  e.write_levels(p.all(), std::vector<double>{4, 2.5, 7, 1, 2.25, 7, 1, 2, 7});
  CHECK(levels(e) == std::vector<double>{4, 2.5, 7, 1, 2.25, 7, 1, 2, 7});
  for (int step = 0; step < 3; ++step) p.step();
  CHECK(levels(e)[0] == 4);
  e.copy_world(0, 1);
  const EnvironmentSnapshot snapshot = e.save();
  p.step();
  CHECK(levels(e)[0] == 5);
  CHECK(levels(e)[3] == 5);
  CHECK(p.observations[1] == 5);
  const std::vector<double> later = levels(e);
  e.restore(snapshot);
  CHECK(levels(e)[0] == 4);
  p.step();
  CHECK(levels(e) == later);
  e.restore(snapshot, 2, 0);
  CHECK(levels(e)[0] == 3);  // after episodes of one step and two
  std::vector<double> bad(9, 1);
  bad[4] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(e.write_levels(p.all(), bad),
                    Catch::Contains("the level 'luck' of world 1 is nan"));
  CHECK(levels(e)[0] == 3);
  CHECK_THROWS_AS(e.write_levels(p.all(), std::vector<double>(8)), std::invalid_argument);
  CHECK_THROWS_AS(e.write_levels(std::vector<std::uint8_t>(2), std::vector<double>(9)),
                  std::invalid_argument);
  bad[4] = 1e300;  // more than a float holds
  CHECK_THROWS_AS(e.write_levels(p.all(), bad), std::invalid_argument);
  bad[0] = 9;
  e.write_levels(std::vector<std::uint8_t>{1, 0, 0}, bad);  // the others are not looked at
  CHECK(levels(e)[0] == 9);
}

TEST_CASE("a world whose numbers a task sets has the bits of a scene that has them",
          "[task][fast]") {
  Task task = stairs();
  task.scene.bodies[0].jitter.angular_velocity = Vec3(1, 1, 1);
  task.scene.variations.push_back(vary(Parameter::gravity_scale, 0.5, 2, Draw::none));
  task.initial_parameters.push_back({terms::parameter(Parameter::gravity_scale, BodyId(0)),
                                     terms::uniform("pull", Every::episode, 0, 3)});
  task.scene.options.gravity = Vec3(0, 0, -10);
  task.terminated = 0;
  REQUIRE(validate(task).empty());
  Played p(task, {.worlds = 5, .seed = 3});
  for (int episode = 0; episode < 2; ++episode) {
    for (int w = 0; w < 5; ++w) {
      const double pull = numbers(p.environment.batch(), Parameter::gravity_scale, w)[0];
      CHECK((pull >= 0.5 && pull <= 2));
      Batch alone(compile(built_with(p.environment.batch(), w)),
                  {.worlds = 1, .seed = 3 + static_cast<std::uint64_t>(w)});
      for (int i = 0; i < episode; ++i) alone.reset(std::vector<std::uint8_t>{1});
      CHECK(alone.hash(0) == p.environment.batch().hash(w));
    }
    p.environment.reset(p.all(), p.observations);
  }
}

TEST_CASE("a task reads and sets attractors", "[task][fast]") {
  Task task;
  task.scene = one_crate(Space::spatial);
  task.scene.attractors = {{Vec3(1, 0, 0), 2}, {Vec3(0, 3, 0), 5}};
  Variation strength = vary(Parameter::attractor_strength, 1, 10, Draw::none);
  strength.attractor = 1;
  task.scene.variations = {strength};
  const Expression of = terms::attractor_parameter(Parameter::attractor_strength, 1);
  task.levels = {{"pull", terms::uniform("pull", Every::episode, 2, 9)}};
  task.initial_parameters = {{of, terms::level("pull")}};
  task.observations = {{"own", of},
                       {"fixed", terms::attractor_parameter(Parameter::attractor_position, 0, 0)}};
  REQUIRE(validate(task).empty());
  Played p(task, {.worlds = 3});
  for (int w = 0; w < 3; ++w) {
    const std::size_t at = Played::size(2 * w);
    CHECK(p.observations[at] ==
          static_cast<float>(numbers(p.environment.batch(), Parameter::attractor_strength, w)[1]));
    CHECK((p.observations[at] >= 2 && p.observations[at + 1] == 1));
  }
  CHECK(p.observations[0] != p.observations[2]);
  task.observations[0].value = terms::attractor_parameter(Parameter::attractor_strength, 2);
  REQUIRE(validate(task).size() == 1);
  CHECK_THAT(validate(task)[0].message, Catch::Contains("the attractor must be 0 to 1"));
}

TEST_CASE("what is wrong with delays, levels and initial parameters is said", "[task][fast]") {
  CHECK_THROWS_WITH(terms::delayed(1, -1), "delayed: steps is -1, must be 0 to 256");
  CHECK_THROWS_WITH(terms::delayed(1, 2, 257), "delayed: max_steps is 257, must be 0 to 256");
  Task task = stairs(Draw::uniform);
  const auto mass = terms::parameter(Parameter::mass, BodyId(0));
  task.levels.push_back({"step", terms::level("step"), terms::level("stairs")});
  task.levels.push_back({"", terms::uniform("u", Every::step), 0});
  task.initial_parameters.push_back({terms::age(), 1});
  task.initial_parameters.push_back(
      {terms::parameter(Parameter::friction, ShapeId(BodyId(0), 0)), 1});
  task.scene.variations[1].draw = Draw::none;
  task.initial_parameters.push_back({mass, terms::age()});
  task.initial_parameters.push_back({mass, 2});
  std::vector<std::string> found;
  for (const Issue& issue : validate(task)) found.push_back(issue.place + ": " + issue.message);
  const std::vector<std::string> expected{
      "level 3 'step': has the name of level 0 'step', must be unique",
      "level 3 'step', begin: depends on the level 'step', must depend on constants and random "
      "numbers of the episode only",
      "level 3 'step', next: uses the level 'stairs', must be one of Task::levels: step, luck, "
      "broken, step, ",
      "level 4: has no name, must have one",
      "level 4, begin: depends on the random number 'u', must depend on constants and random "
      "numbers of the episode only",
      "initial parameter 0: sets initial_position of body 0, number 0, which is drawn, must vary "
      "with Draw::none",
      "initial parameter 1: sets age, must set a parameter (terms::parameter)",
      "initial parameter 2: sets friction of body 0, shape 0, which does not vary "
      "(Scene::variations)",
      "initial parameter 3, value: depends on age, must depend on constants, random numbers of the "
      "episode and levels only",
      "initial parameter 4: sets mass of body 0, which another initial parameter sets"};
  CHECK(found == expected);
}

TEST_CASE("a snapshot of a task that goes on otherwise is refused", "[task][fast]") {
  Task task = stairs(), other = task, sets = task;
  other.levels[0].next = terms::level("step") + 2;
  sets.initial_parameters[0].value = 2 * terms::level("step");
  const EnvironmentSnapshot saved = Environment(task, {.worlds = 2}).save();
  Environment(task, {.worlds = 2}).restore(saved);
  CHECK_THROWS_AS(Environment(other, {.worlds = 2}).restore(saved), SnapshotError);
  CHECK_THROWS_AS(Environment(sets, {.worlds = 2}).restore(saved), SnapshotError);
}

TEST_CASE("levels are plain values, too", "[task][fast]") {
  const Expression e = terms::level("step") + 1;
  CHECK(text_of(e, 80) == "level('step') + 1");
  const std::vector<Expression> roots{e};
  CHECK(text_of(from_graph(graph_of(roots))[0], 80) == "level('step') + 1");
}

}  // namespace manyworlds::test
