// Random numbers and parameters of the scene in expressions.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "manyworlds/expression_graph.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/newton_scenes.hpp"
#include "tests/support/task_bits.hpp"
#include "tests/support/varied.hpp"

namespace manyworlds::test {
namespace {

// A crate that a noisy action pushes, with a goal that it does not know of.
Task noisy() {
  Task task;
  task.name = "Noisy";
  task.scene = one_crate(Space::spatial);
  task.scene.bodies[0].jitter.linear_velocity = Vec3(1, 1, 0);
  Control thrust;
  thrust.kind = ControlKind::thrust, thrust.body = BodyId(0), thrust.low = -9, thrust.high = 9;
  task.scene.add(thrust);
  task.actions = {{"push", -1, 1}};
  const Expression noise = terms::normal("action", Every::step, 0, 0.5);
  task.controls = {terms::action() + noise};
  const Expression goal = terms::uniform("goal", Every::episode, -3, 3);
  task.observations = {{"goal", goal},
                       {"x", terms::position(BodyId(0), 0) + terms::uniform("x", Every::step)},
                       {"noise", noise},
                       {"control", terms::control(ControlId(0))}};
  task.rewards = {{"near", -abs(goal - terms::position(BodyId(0), 0))}};
  task.max_steps = 7;
  return task;
}

double mean(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v / static_cast<double>(x.size());
  return sum;
}

}  // namespace

TEST_CASE("random numbers are the same bits whatever the lane, batch, threads and instruction set",
          "[task][bits][fast]") {
  check_same_bits(noisy());
}

TEST_CASE("goals stay for an episode, and noise is drawn at each step", "[task][fast]") {
  const Task task = noisy();
  for (const Autoreset autoreset : {Autoreset::same_step, Autoreset::next_step}) {
    Played p(task, {.worlds = 3, .seed = 1, .autoreset = autoreset});
    float goal = p.observations[0], x = 0;
    int changed = 0;
    for (int step = 1; step <= 30; ++step) {
      p.step();
      // The noise that the observation tells is that which has acted.
      if (!p.ended(0)) CHECK((p.observations[3] == 0 || p.observations[3] == p.observations[2]));
      CHECK(p.observations[1] != x);
      x = p.observations[1];
      if (p.observations[0] == goal) continue;
      ++changed;
      goal = p.observations[0];
      CHECK(std::abs(goal) <= 3);
    }
    CHECK(changed == (autoreset == Autoreset::same_step ? 4 : 3));
  }
}

TEST_CASE("random numbers have the distributions that they say", "[task][fast]") {
  Task task;
  task.scene = one_crate(Space::spatial);
  task.observations = {{"zero", 0}};
  const Expression u = terms::uniform("u", Every::step), n = terms::normal("n", Every::step, 2, 3);
  task.rewards = {{"u", u},
                  {"low", terms::uniform("low", Every::step, -2, -1)},
                  {"n", n},
                  {"another", terms::uniform("v", Every::step)},
                  {"same", terms::uniform("u", Every::step)},
                  {"episode", terms::uniform("u", Every::episode)}};
  constexpr int kWorlds = 20000;
  Played p(task, {.worlds = kWorlds});
  p.step();
  std::vector<std::vector<double>> of(task.rewards.size());
  for (std::size_t i = 0; i < p.reward_terms.size(); ++i) {
    of[i % of.size()].push_back(p.reward_terms[i]);
  }
  const auto [low, high] = std::minmax_element(of[0].begin(), of[0].end());
  CHECK(*low >= 0);
  CHECK(*low < 1e-3);
  CHECK(*high < 1);
  CHECK(*high > 1 - 1e-3);
  CHECK(mean(of[0]) == approx(0.5, 0.01));  // 5 sigma
  CHECK(mean(of[1]) == approx(-1.5, 0.01));
  CHECK(mean(of[2]) == approx(2, 0.11));
  std::vector<double> squares, together, episode;
  std::size_t within = 0;
  for (std::size_t w = 0; w < kWorlds; ++w) {
    squares.push_back((of[2][w] - 2) * (of[2][w] - 2));
    within += std::abs(of[2][w] - 2) < 3;
    together.push_back((of[0][w] - 0.5) * (of[3][w] - 0.5));
    episode.push_back((of[0][w] - 0.5) * (of[5][w] - 0.5));
  }
  CHECK(mean(squares) == Approx(9).epsilon(0.05));
  CHECK(static_cast<double>(within) / kWorlds == approx(0.6827, 0.017));
  CHECK(of[4] == of[0]);
  CHECK(std::abs(mean(together)) < 0.003);  // 5 sigma of 1 / 12
  CHECK(std::abs(mean(episode)) < 0.003);
}

TEST_CASE("copies of a world draw what it would have drawn, until its episode ends",
          "[task][fast]") {
  const Task task = noisy();
  Played p(task, {.worlds = 3, .autoreset = Autoreset::same_step}), q(task, {.worlds = 2});
  for (int step = 0; step < 3; ++step) p.step();
  p.environment.copy_world(0, 1);
  const EnvironmentSnapshot snapshot = p.environment.save();
  q.environment.restore(snapshot, 0, 1);
  const auto told = [](const Played& from, std::size_t world) {
    return std::vector<float>(
        from.observations.begin() + static_cast<std::ptrdiff_t>(4 * world),
        from.observations.begin() + static_cast<std::ptrdiff_t>(4 * world + 4));
  };
  for (int step = 3; step < 6; ++step) {
    p.step(), q.step();
    CHECK(told(p, 1) == told(p, 0));
    CHECK(told(q, 1) == told(p, 0));
    CHECK(told(p, 2) != told(p, 0));
  }
  p.step();  // the seventh ends it
  CHECK(told(p, 1) != told(p, 0));
  const std::vector<float> later = p.observations;
  p.environment.restore(snapshot);
  for (int step = 3; step < 7; ++step) p.step();
  CHECK(p.observations == later);
}

TEST_CASE("expressions read the numbers of the scene that vary, as a batch does", "[task][fast]") {
  for (const Space space : {Space::planar, Space::spatial}) {
    Task task;
    task.scene = varied_crowd(space);
    const int crates = static_cast<int>(task.scene.bodies.size());
    std::vector<Parameter> of;
    std::vector<std::size_t> item;
    const auto add = [&](Parameter p, std::size_t at, const Expression& value) {
      of.push_back(p), item.push_back(at);
      task.observations.push_back({to_string(value), value});
    };
    add(Parameter::gravity, 1, terms::parameter(Parameter::gravity, 1));
    std::size_t shape = 0, row = 0;
    for (int b = 0; b < crates; ++b) {
      const Body& body = task.scene.bodies[static_cast<std::size_t>(b)];
      for (int s = 0; s < static_cast<int>(body.shapes.size()); ++s, ++shape) {
        const ShapeId id(BodyId(b), s);
        add(Parameter::friction, shape, terms::parameter(Parameter::friction, id));
        if (body.motion != Motion::dynamic) continue;
        add(Parameter::density, shape, terms::parameter(Parameter::density, id));
        add(Parameter::size, 3 * shape, terms::parameter(Parameter::size, id, 0));
      }
      if (body.motion == Motion::fixed) continue;
      if (body.motion == Motion::dynamic) {
        add(Parameter::mass, row, terms::parameter(Parameter::mass, BodyId(b)));
        add(Parameter::linear_drag, row, terms::parameter(Parameter::linear_drag, BodyId(b)));
      }
      ++row;
    }
    REQUIRE(validate(task).empty());
    Played p(task, {.worlds = 11, .seed = 3});
    const auto check = [&] {
      for (int w = 0; w < 11; ++w) {
        for (std::size_t i = 0; i < of.size(); ++i) {
          const auto wanted = numbers(p.environment.batch(), of[i], w)[item[i]];
          const std::size_t at = static_cast<std::size_t>(w) * of.size() + i;
          CHECK(p.observations[at] == static_cast<float>(wanted));
        }
      }
    };
    check();
    p.step();
    check();
    std::vector<double> friction = numbers(p.environment.batch(), Parameter::friction, 4);
    friction[0] = 0.25;
    p.environment.batch().write(Parameter::friction, 4, friction);
    p.step();
    check();
  }
}

TEST_CASE("what does not vary is a constant, and gains are those of servos that do",
          "[task][fast][newton]") {
  Task task;
  task.scene = newton_pendulum();
  Control servo;
  servo.kind = ControlKind::joint_force, servo.joint = JointId(0);
  servo.actuator.gain = {5, 0, 0}, servo.actuator.bias = {0, -5, -2};
  task.scene.add(servo);
  task.controls = {terms::parameter(Parameter::kp, ControlId(0)) / 10};
  task.scene.joints[0].dynamics.damping = 0.25;
  task.scene.variations = {vary(Parameter::kp, 4, 6)};
  task.observations = {{"kp", terms::parameter(Parameter::kp, ControlId(0))},
                       {"gain", terms::parameter(Parameter::gain, ControlId(0), 0)},
                       {"bias", terms::parameter(Parameter::bias, ControlId(0), 1)},
                       {"kv", terms::parameter(Parameter::kv, ControlId(0))},
                       {"damping", terms::parameter(Parameter::damping, JointId(0))},
                       {"control", terms::control(ControlId(0))}};
  Played p(task, {.worlds = 5});
  p.step();
  for (std::size_t w = 0; w < 5; ++w) {
    const float* of = p.observations.data() + 6 * w;
    CHECK(of[0] >= 4);
    CHECK(of[0] <= 6);
    CHECK(of[1] == of[0]);
    CHECK(of[2] == -of[0]);
    CHECK(of[3] == 2);
    CHECK(of[4] == 0.25f);
    CHECK(of[5] == Approx(of[0] / 10));
  }
  CHECK(p.observations[0] != p.observations[6]);
}

TEST_CASE("controls of expressions keep to the ranges of their worlds", "[task][fast]") {
  Task task;
  task.scene = one_crate(Space::spatial);
  Control thrust;
  thrust.kind = ControlKind::thrust, thrust.body = BodyId(0);
  thrust.direction = Vec3::UnitX(), thrust.low = -1, thrust.high = 1;
  task.scene.add(thrust);
  task.scene.variations = {vary(Parameter::control_high, 0.5, 3)};
  task.controls = {100};
  task.observations = {{"high", terms::parameter(Parameter::control_high, ControlId(0))},
                       {"control", terms::control(ControlId(0))}};
  Played p(task, {.worlds = 9});
  p.step();
  for (std::size_t w = 0; w < 9; ++w) CHECK(p.observations[2 * w + 1] == p.observations[2 * w]);
  CHECK(p.observations[0] != p.observations[2]);
}

TEST_CASE("what is wrong with random numbers and parameters is said", "[task][fast]") {
  Task task;
  task.scene = one_crate(Space::spatial);
  const auto crate = BodyId(0);
  task.observations = {{"a", terms::uniform("", Every::step)},
                       {"b", terms::parameter(Parameter::friction, ShapeId(crate, 1))},
                       {"c", terms::parameter(Parameter::mass, BodyId(7))},
                       {"d", terms::parameter(Parameter::gravity, 3)},
                       {"e", terms::parameter(Parameter::damping, JointId(0))},
                       {"f", terms::parameter(Parameter::mass, crate)}};
  std::vector<std::string> found;
  for (const Issue& issue : validate(task)) found.push_back(to_string(issue));
  CHECK(found ==
        std::vector<std::string>{
            "observation 0 'a' a random number has no name, must have one",
            "observation 1 'b' friction of body 0, shape 1: the shape must be 0 to 0",
            "observation 2 'c' mass of body 7: the body must be 0 to 0",
            "observation 3 'd' gravity, number 3: the number must be 0 to 2",
            "observation 4 'e' damping of joint 0: the joint must be 0 to 0, but there are none"});
  task.scene.bodies[0].motion = Motion::kinematic;
  task.observations = {{"f", terms::parameter(Parameter::mass, crate)}};
  REQUIRE(validate(task).size() == 1);
  CHECK(validate(task)[0].message == "mass of body 0: this parameter cannot vary");
  CHECK_THROWS_WITH(terms::parameter(Parameter::friction, crate),
                    "parameter: friction belongs to a shape, not to a body");
}

TEST_CASE("random numbers and parameters are plain values, too", "[task][fast]") {
  const std::vector<Expression> all = {
      terms::uniform("goal", Every::episode), terms::normal("noise", Every::step, 1, 2),
      terms::parameter(Parameter::friction, ShapeId(BodyId(3), 1)),
      pow(mod(terms::age(), 7), tanh(acos(sign(log(terms::age())))))};
  const ExpressionGraph graph = graph_of(all), again = graph_of(from_graph(graph));
  REQUIRE(again.nodes.size() == graph.nodes.size());
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    CHECK(again.nodes[i].name == graph.nodes[i].name);
    CHECK(again.nodes[i].text == graph.nodes[i].text);
    CHECK(again.nodes[i].arguments == graph.nodes[i].arguments);
  }
  CHECK(again.roots == graph.roots);
  CHECK(text_of(all[0], 99) == "0 + (1 - 0) * uniform('goal', 'episode')");
  CHECK(text_of(all[2], 99) == "parameter('friction', 3, 1, 0)");
  CHECK(text_of(all[3], 99) == "(age() % 7) ** tanh(arccos(sign(log(age()))))");
  CHECK_THROWS_WITH(from_graph({{{"uniform", 0, {2, 0}, "x"}}, {0}}),
                    "nodes[0] is drawn every 2, must be 0 or 1");
  CHECK_THROWS_WITH(from_graph({{{"parameter", 0, {0, 0, 0}, "colour"}}, {0}}),
                    "nodes[0] is the parameter 'colour', which does not exist");
}

}  // namespace manyworlds::test
