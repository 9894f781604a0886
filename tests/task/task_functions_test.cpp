// Logarithms, powers, remainders and their like in expressions, against those of <cmath>.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "manyworlds/expression_graph.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/policy.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// A ball at x without forces, one per world.
Task ball_at_x() {
  Task task;
  task.scene = empty_scene(Space::spatial, 0);
  Body ball = body_of(shape_of(Sphere{0.5}), {0, 0, 0});
  ball.jitter.position = {20, 0, 0};
  task.scene.add(ball);
  return task;
}

}  // namespace

TEST_CASE("logarithms, powers and remainders are those of mathematics", "[task][fast]") {
  const Precision precision = GENERATE(from_range(widest_tables())).precision;
  const double ulp = precision == Precision::f32 ? 0x1p-23 : 0x1p-52;
  Task task = ball_at_x();
  const Expression x = terms::position(BodyId(0), 0), size = abs(x) + 0.25;
  task.observations = {{"x", x}};
  task.rewards = {{"log", log(size)},      {"tanh", tanh(x / 4)},
                  {"acos", acos(x / 25)},  {"sign", sign(x)},
                  {"mod", mod(x, 3)},      {"mod down", mod(x, -2.5)},
                  {"pow", pow(size, 1.5)}, {"pow of x", pow(size, -x / 8)},
                  {"cube", pow(x, 3)},     {"small", tanh(x / 1000)}};
  Played p(task, {.worlds = 500, .precision = precision});
  p.step();
  const std::size_t terms = task.rewards.size();
  for (std::size_t w = 0; w < 500; ++w) {
    const double* found = p.reward_terms.data() + w * terms;
    std::vector<double> at(3);
    p.environment.batch().read(Field::position, static_cast<int>(w), at);
    const double v = at[0], s = std::abs(v) + 0.25, log_s = std::log(s);
    const auto rest = [v](double b) { return v - std::floor(v / b) * b; };
    const double wanted[] = {log_s,     std::tanh(v / 4),   std::acos(v / 25), v < 0 ? -1.0 : 1.0,
                             rest(3),   rest(-2.5),         std::pow(s, 1.5),  std::pow(s, -v / 8),
                             v * v * v, std::tanh(v / 1000)};
    // Of arguments that are rounded, and of powers by what multiplies an error of the logarithm.
    const double most[] = {2,
                           2,
                           3,
                           0,
                           2,
                           2,
                           4 + 1.5 * std::abs(log_s),
                           4 + 2 * std::abs(v / 8 * log_s),
                           4 + 3 * std::abs(std::log(std::abs(v))),
                           2};
    for (std::size_t i = 0; i < terms; ++i) {
      CAPTURE(task.rewards[i].name, v, found[i], wanted[i]);
      const double scale = i >= 6 ? std::abs(wanted[i]) : std::max(1.0, std::abs(wanted[i]));
      CHECK(std::abs(found[i] - wanted[i]) <= (most[i] + (i == 9 ? 2 : 0)) * ulp * scale);
    }
    CHECK((found[4] >= 0 && found[4] < 3));
    CHECK((found[5] <= 0 && found[5] > -2.5));
  }
}

TEST_CASE("logarithms, powers and remainders at the ends of their ranges", "[task][fast]") {
  Task task = ball_at_x();
  const Expression nan = Expression(0) / 0, infinite = Expression(1) / 0;
  const std::pair<Expression, double> all[] = {{log(0), -INFINITY},   {log(infinite), INFINITY},
                                               {log(-1), NAN},        {log(nan), NAN},
                                               {log(1), 0},           {pow(-2, 3), -8},
                                               {pow(-2, 2), 4},       {pow(-2, 0.5), NAN},
                                               {pow(0, 2), 0},        {pow(0, -1), INFINITY},
                                               {pow(0, 0), 1},        {pow(nan, 0), 1},
                                               {pow(1, infinite), 1}, {pow(2, -infinite), 0},
                                               {pow(2, nan), NAN},    {tanh(infinite), 1},
                                               {tanh(-infinite), -1}, {tanh(nan), NAN},
                                               {acos(1), 0},          {acos(-1), 3.14159265f},
                                               {acos(1.5), NAN},      {acos(nan), NAN},
                                               {mod(-1e-30, 3), 0},   {mod(7, 3), 1},
                                               {mod(-7, 3), 2},       {mod(7, -3), -2},
                                               {mod(1, 0), NAN},      {sign(0), 0},
                                               {sign(-3), -1},        {sign(nan), NAN}};
  for (const auto& [value, wanted] : all) task.observations.push_back({"", value});
  Played p(task, {.worlds = 1});
  for (std::size_t i = 0; i < std::size(all); ++i) {
    CAPTURE(i, text_of(all[i].first, 60), p.observations[i]);
    const auto wanted = static_cast<float>(all[i].second);
    CHECK((std::isnan(wanted) ? std::isnan(p.observations[i])
                              : p.observations[i] == approx(wanted, 1e-7)));
  }
}

}  // namespace manyworlds::test
