// Observations, rewards and ends that are not finite, and the text of expressions.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "manyworlds/expression_graph.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/task_bits.hpp"

namespace manyworlds::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A crate; an action above 1 makes log(1 - action) not a number, 1 makes it infinite.
Task fragile() {
  Task task;
  task.scene = one_crate(Space::spatial, -10);
  task.scene.bodies[0].jitter.linear_velocity = Vec3(3, 3, 3);
  task.actions = {{"a", -9, 9}};
  task.observations = {{"x", terms::position(BodyId(0), 0)}};
  return task;
}
Expression risky() { return log(1 - terms::action()); }

struct Seen {
  bool terminated, truncated, lost;
  bool operator==(const Seen&) const = default;
};

// World 4 of 11 acts so, in the third step.
Seen seen_after(const Task& task, float action, std::vector<NonFinite>* named = nullptr) {
  Played p(task, {.worlds = 11, .autoreset = Autoreset::disabled});
  for (int step = 0; step < 3; ++step) {
    p.act_at_random(step);
    for (float& a : p.actions) a = std::min(a, 0.5f);
    if (step == 2) p.actions[4] = action;
    p.step();
  }
  for (int w = 0; w < 11; ++w) {
    if (w != 4) CHECK(!lost(p.environment.batch().status(w)));
  }
  if (named) *named = p.environment.non_finite();
  return {p.terminated[4] != 0, p.truncated[4] != 0, lost(p.environment.batch().status(4))};
}

}  // namespace

TEST_CASE("results that are not finite lose their world, and are named", "[task][fast]") {
  const Seen fine{false, false, false}, flagged{false, true, true};
  const auto named = [&](const Task& task, float action) {
    std::vector<NonFinite> all;
    CHECK(seen_after(task, 0.5f) == fine);
    CHECK(seen_after(task, action, &all) == flagged);
    REQUIRE(all.size() == 1);
    CHECK(all[0].world == 4);
    CHECK(all[0].step == 3);
    return to_string(all[0]);
  };
  Task task = fragile();
  task.observations.push_back({"depth", risky()});
  CHECK(named(task, 2) == "observation 1 'depth' is nan in world 4 at step 3 of its episode");
  CHECK(named(task, 1) == "observation 1 'depth' is -inf in world 4 at step 3 of its episode");
  task = fragile();
  task.rewards = {{"pace", 1}, {"", risky()}};
  CHECK(named(task, 2) == "reward 1 is nan in world 4 at step 3 of its episode");
  task = fragile();
  task.truncated = risky() > 2;
  CHECK(named(task, 2) == "truncated is nan in world 4 at step 3 of its episode");
  // Whatever an end makes of what is not a number: it is not true.
  const Expression nan = risky(), age = terms::age();
  for (const Expression& end :
       {nan + 5, nan > 2, !(nan < 2), (nan > 2) + (nan < 2), select(nan, 0, 1), !equal(nan, nan),
        (nan > 2) | (age > 99), !((nan > 2) & (age > 0)), max(nan > 2, age > 99),
        select(age > 0, nan < 2, 0), terms::held(nan) > 99, terms::latched(!(nan < 2))}) {
    task = fragile();
    task.terminated = end & (terms::action() > 0.75);
    CAPTURE(to_string(end));
    CHECK(named(task, 2) == "terminated is nan in world 4 at step 3 of its episode");
  }
}

TEST_CASE("an end that does not depend on what is not a number is known", "[task][fast]") {
  const Expression nan = risky(), age = terms::age();
  const auto ended = [](const Expression& end) {
    Task task = fragile();
    task.terminated = end;
    return seen_after(task, 2);
  };
  CHECK(ended((nan > 2) & (age > 99)) == Seen{false, false, false});
  CHECK(ended((nan > 2) | (age > 2)) == Seen{true, false, false});
  CHECK(ended(select(age > 99, nan > 2, 0)) == Seen{false, false, false});
  CHECK(ended(select(age > 99, nan, age > 2)) == Seen{true, false, false});
  CHECK(ended(terms::previous(nan) > 2) == Seen{false, false, false});
}

TEST_CASE("a lost world begins anew as lost worlds do, and neighbours keep their bits",
          "[task][bits][fast]") {
  Task task = fragile();
  task.rewards = {{"risk", risky()}};
  task.terminated = !(risky() < 99);
  for (const Autoreset autoreset : {Autoreset::next_step, Autoreset::same_step}) {
    for (const Table& table : all_tables()) {
      const EnvironmentOptions options{
          .worlds = 19, .precision = table.precision, .isa = table.isa, .autoreset = autoreset};
      Played p(task, options), calm(task, options);
      std::vector<std::uint8_t> was_lost(19);
      for (int step = 0; step < 6; ++step) {
        if (step > 0) p.act_at_random(step), calm.act_at_random(step);
        for (float& a : p.actions) a = std::min(a, 0.5f);
        calm.actions = p.actions;
        if (step == 2) p.actions[7] = 3;
        StepArrays out = p.arrays();
        out.lost = was_lost;
        p.environment.step(std::span<const float>(p.actions), out);
        calm.step();
        CHECK(p.terminated[7] == 0);
        CHECK(p.truncated[7] == (step == 2));
        CHECK(was_lost == std::vector<std::uint8_t>([&] {
                std::vector<std::uint8_t> all(19, 0);
                all[7] = step == 2;
                return all;
              }()));
        for (int w = 0; w < 19; ++w) {
          if (w == 7) continue;
          REQUIRE(p.environment.batch().hash(w) == calm.environment.batch().hash(w));
          REQUIRE(p.observations[Played::size(w)] == calm.observations[Played::size(w)]);
        }
      }
      CHECK(!lost(p.environment.batch().status(7)));
      CHECK(p.environment.non_finite_expressions() == 2);
    }
  }
}

TEST_CASE("each expression is named once, and check throws after the step", "[task][fast]") {
  Task task = fragile();
  task.rewards = {{"risk", risky()}};
  Played p(task, {.worlds = 5});
  for (const int world : {3, 1}) {
    p.actions.assign(5, 0);
    p.actions[Played::size(world)] = 2;
    for (int step = 0; step < 3; ++step) p.step();
  }
  REQUIRE(p.environment.non_finite().size() == 1);
  CHECK(p.environment.non_finite()[0].world == 3);

  Played q(task, {.worlds = 5, .threads = 2, .autoreset = Autoreset::same_step, .check = true});
  q.actions.assign(5, 0);
  q.step();
  q.actions[4] = q.actions[2] = 2;
  CHECK_THROWS_WITH(q.step(), "reward 0 'risk' is nan in world 2 at step 2 of its episode");
  CHECK(q.truncated == std::vector<std::uint8_t>{0, 0, 1, 0, 1});  // the step was taken
  CHECK(q.environment.batch().steps() == 2);
  q.actions.assign(5, 0);
  CHECK_NOTHROW(q.step());
  try {
    q.actions[1] = 1;
    q.step();
  } catch (const NonFiniteError& error) {
    CHECK(error.fault().expression == "reward 0 'risk'");
    CHECK(error.fault().value == -std::numeric_limits<double>::infinity());
    CHECK(error.fault().step == 4);
  }

  task = fragile();
  task.observations.push_back({"start", log(terms::age() - 0.5)});
  CHECK_THROWS_WITH(Environment(task, {.worlds = 2, .check = true}),
                    "observation 1 'start' is nan in world 0 at the start of its episode");
  CHECK(lost(Environment(task, {.worlds = 2}).batch().status(1)));
}

TEST_CASE("numbers that are not finite and names that are not single are issues", "[task][fast]") {
  Task task = fragile();
  const Expression x = terms::position(BodyId(0), 0);
  const double infinity = std::numeric_limits<double>::infinity();
  task.actions.push_back({"a"});
  task.observations.push_back({"top", clamp(x, 0, infinity)});
  task.observations.push_back({"x", x});
  task.observations.push_back({"", x});
  task.observations.push_back({"", x, -infinity, infinity});
  task.rewards = {{"r", kNan}, {"s", 1}, {"r", 2}};
  task.infos = {{"i", 1}, {"i", select(x > 1, -infinity, 2)}};
  task.terminated = x > kNan;
  task.memories = {{"m", kNan, infinity}};
  std::vector<std::string> found;
  for (const Issue& issue : validate(task)) found.push_back(issue.place + ": " + issue.message);
  const std::vector<std::string> expected{
      "action 1 'a': has the name of action 0 'a', must be unique",
      "memory 0 'm', begin: holds the number nan, must be finite",
      "memory 0 'm', next: holds the number inf, must be finite",
      "observation 2 'x': has the name of observation 0 'x', must be unique",
      "observation 1 'top': holds the number inf, must be finite",
      "reward 2 'r': has the name of reward 0 'r', must be unique",
      "reward 0 'r': holds the number nan, must be finite",
      "info 1 'i': has the name of info 0 'i', must be unique",
      "info 1 'i': holds the number -inf, must be finite",
      "terminated: holds the number nan, must be finite"};
  CHECK(found == expected);
}

TEST_CASE("expressions are evaluated on the worlds as they are", "[task][fast]") {
  Task task = fragile();
  const Expression x = terms::position(BodyId(0), 0), v = terms::velocity(BodyId(0), 2);
  task.scene.add(body_of(shape_of(Box{{9, 9, 1}}), {0, 0, -3}, Motion::fixed));
  task.memories = {{"sum", 1, terms::memory("sum") + x}};
  task.max_steps = 7;
  const std::vector<Expression> all{x,
                                    terms::touching(BodyId(0)),
                                    x - terms::previous(x),
                                    terms::memory("sum"),
                                    terms::summed(v) + terms::held(terms::action() > 0),
                                    terms::action() + 10 * terms::age(),
                                    terms::uniform("noise", Every::step) - v,
                                    terms::largest(x * v)};
  for (std::size_t i = 0; i < all.size(); ++i) task.infos.push_back({std::to_string(i), all[i]});
  constexpr int kWorlds = 11;
  for (const Autoreset autoreset : {Autoreset::next_step, Autoreset::same_step}) {
    Played p(task, {.worlds = kWorlds, .seed = 2, .autoreset = autoreset});
    std::vector<double> infos(kWorlds * all.size()), found(kWorlds);
    const auto check = [&](Environment& e) {
      const std::uint64_t hash = e.batch().hash();
      for (std::size_t i = 0; i < all.size(); ++i) {
        e.evaluate(all[i], found);
        for (std::size_t w = 0; w < kWorlds; ++w) REQUIRE(found[w] == infos[w * all.size() + i]);
        // What the task has no row of.
        e.evaluate(2 * all[i] + 1, found);
        for (std::size_t w = 0; w < kWorlds; ++w) {
          REQUIRE(found[w] == Approx(2 * infos[w * all.size() + i] + 1).epsilon(1e-6));
        }
      }
      CHECK(e.batch().hash() == hash);
    };
    p.environment.begin(p.all(), BeginArrays{});
    for (int step = 0; step < 20; ++step) {
      p.act_at_random(step);
      StepArrays out = p.arrays();
      out.infos = infos;
      p.environment.step(std::span<const float>(p.actions), out);
      check(p.environment);
    }
    Environment again(task, {.worlds = kWorlds, .autoreset = autoreset});
    again.restore(p.environment.save());
    const auto touching = all[1];
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i == 1) continue;  // observers see steps
      again.evaluate(all[i], found);
      for (std::size_t w = 0; w < kWorlds; ++w) REQUIRE(found[w] == infos[w * all.size() + i]);
    }
  }
}

TEST_CASE("what cannot be evaluated is said", "[task][fast]") {
  Environment e(fragile(), {.worlds = 2});
  std::vector<double> out(2);
  const Expression x = terms::position(BodyId(0), 0);
  e.evaluate(terms::uniform("goal", Every::episode) + 3, out);
  CHECK((out[0] > 3 && out[0] < 4 && out[0] != out[1]));
  CHECK_THROWS_WITH(e.evaluate(terms::position(BodyId(7), 0), out),
                    Catch::Contains("position of body 7, axis 0: the body must be 0 to 0"));
  CHECK_THROWS_WITH(e.evaluate(terms::memory("m"), out), Catch::Contains("the memory 'm'"));
  CHECK_THROWS_WITH(e.evaluate(terms::previous(x), out),
                    Catch::Contains("previous(position(0, 'x')) depends on earlier steps"));
  CHECK_THROWS_WITH(e.evaluate(terms::touching(BodyId(0)), out),
                    Catch::Contains("depends on the observer 'touching'"));
  CHECK_THROWS_WITH(e.evaluate(x * kNan, out), Catch::Contains("must be finite"));
  CHECK_THROWS_AS(e.evaluate(x, std::span(out).first(1)), std::invalid_argument);
}

TEST_CASE("the text of an expression is all of it, as Python reads it", "[task][fast]") {
  const Expression a = terms::angle(BodyId(2)), b = terms::velocity(BodyId(1), 1);
  const auto text = [](const Expression& e) { return to_string(e); };
  CHECK(text(1 - 2 * a * a - (b - 3)) == "1 - 2 * angle(2) * angle(2) - (velocity(1, 'y') - 3)");
  CHECK(text((1 - a) * (b + 2) / (a / b)) ==
        "(1 - angle(2)) * (velocity(1, 'y') + 2) / (angle(2) / velocity(1, 'y'))");
  CHECK(text((!(a < b)) | ((a < 1) & (b <= 2))) ==
        "~(angle(2) < velocity(1, 'y')) | (angle(2) < 1) & (velocity(1, 'y') <= 2)");
  CHECK(text(equal(a < b, 1)) == "(angle(2) < velocity(1, 'y')) == 1");
  CHECK(text(-pow(a, -b) + pow(-a, 2)) == "-angle(2) ** -velocity(1, 'y') + (-angle(2)) ** 2");
  CHECK(text(pow(-2, pow(a, b))) == "(-2) ** angle(2) ** velocity(1, 'y')");
  CHECK(text(-(a + b) - -3) == "-(angle(2) + velocity(1, 'y')) - -3");
  CHECK(text(terms::delayed(a, 3) + terms::previous(b)) ==
        "delayed(angle(2), 3) + previous(velocity(1, 'y'))");
  Expression deep = a, wide = a;
  for (int i = 0; i < 500; ++i) deep = abs(deep);
  CHECK(text(deep).size() == 500 * 5 + 8);
  for (int i = 0; i < 500; ++i) wide = wide * wide;
  CHECK(text(wide).size() <= 20001);
  CHECK_THAT(text(wide), Catch::Contains("..."));
}

}  // namespace manyworlds::test
