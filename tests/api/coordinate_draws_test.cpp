// What worlds of Solver::newton begin with where their coordinates are drawn.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "tests/support/approx.hpp"
#include "tests/support/newton_scenes.hpp"
#include "tests/support/scene_cases.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr int kWorlds = 2000;
constexpr double kRounding = 1e-6;  // of float32, in builds without float64

Numbers begun(const Scene& scene, Field field, std::size_t item, std::uint64_t seed = 1) {
  const Precision precision = has_table(double_table()) ? Precision::f64 : Precision::f32;
  const Batch batch(compile(scene),
                    {.worlds = kWorlds, .threads = 1, .seed = seed, .precision = precision});
  Numbers all(batch.size(field)), out;
  batch.read(field, std::span<double>(all));
  const std::size_t items = all.size() / kWorlds;
  for (std::size_t w = 0; w < kWorlds; ++w) out.push_back(all[w * items + item]);
  return out;
}
double mean(const Numbers& x) {
  double sum = 0;
  for (const double v : x) sum += v / static_cast<double>(x.size());
  return sum;
}
double deviation(const Numbers& x) {
  Numbers squares;
  for (const double v : x) squares.push_back((v - mean(x)) * (v - mean(x)));
  return std::sqrt(mean(squares));
}

}  // namespace

TEST_CASE("coordinates are drawn about where the scene begins", "[fast][newton][draws]") {
  Scene scene = newton_robot();
  scene.coordinate_draws = {
      {.first = 7, .low = {0.2}, .high = {0.6}},
      {.velocity = true, .first = 5, .low = {-1, 2}, .high = {3, 2}, .normal = true}};
  const Numbers hinge = begun(scene, Field::generalized_position, 7);
  CHECK(*std::min_element(hinge.begin(), hinge.end()) >= 0.2 - kRounding);
  CHECK(*std::max_element(hinge.begin(), hinge.end()) < 0.6 + kRounding);
  CHECK(mean(hinge) == approx(0.4, 0.01));
  CHECK(deviation(hinge) == Approx(0.4 / std::sqrt(12)).epsilon(0.05));
  const Numbers spin = begun(scene, Field::generalized_velocity, 5);
  CHECK(mean(spin) == approx(1, 0.15));
  CHECK(deviation(spin) == Approx(2).epsilon(0.06));
  for (const double speed : begun(scene, Field::generalized_velocity, 6)) CHECK(speed == 2);
  // The jitter of the free root stays below: another number of the same world.
  Scene still = scene;
  still.coordinate_draws = {{.first = 0, .low = {5}, .high = {5}}};
  const Numbers with = begun(still, Field::generalized_position, 0);
  still.coordinate_draws.clear();
  const Numbers without = begun(still, Field::generalized_position, 0);
  for (std::size_t w = 0; w < kWorlds; ++w) CHECK(with[w] == Approx(without[w] + 5));
  still.coordinate_draws = {{.first = 0, .low = {5}, .high = {5}, .replaces = true}};
  for (const double x : begun(still, Field::generalized_position, 0)) CHECK(x == 5);
}

TEST_CASE("draws stay within a ring", "[fast][newton][draws]") {
  Scene scene = newton_robot();
  scene.coordinate_draws = {{.first = 0,
                             .low = {-0.3, -0.2},
                             .high = {0, 0.2},
                             .replaces = true,
                             .nearest = 0.17,
                             .farthest = 0.3}};
  const Numbers x = begun(scene, Field::generalized_position, 0),
                y = begun(scene, Field::generalized_position, 1);
  for (std::size_t w = 0; w < kWorlds; ++w) {
    CHECK(std::hypot(x[w], y[w]) > 0.17 - kRounding);
    CHECK(std::hypot(x[w], y[w]) < 0.3 + kRounding);
    CHECK((x[w] >= -0.3 - kRounding && x[w] < kRounding));
    CHECK(std::abs(y[w]) < 0.2 + kRounding);
  }
}

TEST_CASE("draws depend on the world's seed and episode alone", "[fast][newton][draws]") {
  Scene scene = newton_pendulum();
  scene.coordinate_draws = {{.low = {-1}, .high = {1}}};
  const Numbers first = begun(scene, Field::generalized_position, 0);
  CHECK(first == begun(scene, Field::generalized_position, 0));
  const Numbers second = begun(scene, Field::generalized_position, 0, 2);
  for (std::size_t w = 0; w + 1 < kWorlds; ++w) CHECK(first[w + 1] == second[w]);
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table, 3));
    const Numbers before = of(batch, Field::generalized_position, 1);
    batch.reset(std::vector<std::uint8_t>{0, 1, 0});
    CHECK(of(batch, Field::generalized_position, 1) != before);
    batch.reset();
    CHECK(of(batch, Field::generalized_position, 1) == before);
    // Bodies are where the coordinates put them.
    const double angle = of(batch, Field::generalized_position, 1)[0];
    CHECK(position(batch, 1, BodyId(0)).z() == approx(-kLength * std::sin(angle), 1e-6));
  }
}

TEST_CASE("what is wrong with draws is said", "[fast][validate][draws]") {
  Scene scene = newton_pendulum();
  scene.coordinate_draws = {{.low = {-1}, .high = {1}}};
  CHECK(validate(scene).empty());
  check_each(
      scene, "coordinate draw 0: ",
      {{"high", "has 2 values, must have as many as low: 1",
        [](Scene& s) {
          s.coordinate_draws[0].high = {1, 2};
        }},
       {"low[0]", "is 2, must be <= high[0], which is 1",
        [](Scene& s) { s.coordinate_draws[0].low[0] = 2; }},
       {"low[0]", "is nan, must be finite",
        [](Scene& s) { s.coordinate_draws[0].low[0] = std::nan(""); }},
       {"nearest", "is 3, must be < farthest, which is 2",
        [](Scene& s) { s.coordinate_draws[0].nearest = 3, s.coordinate_draws[0].farthest = 2; }},
       {"first", "is 1 of 1 values, must be within the 1 coordinates of Solver::newton",
        [](Scene& s) { s.coordinate_draws[0].first = 1; }},
       {"first", "is 0 of 2 values, must be within the 1 degrees of freedom of Solver::newton",
        [](Scene& s) {
          s.coordinate_draws[0] = {.velocity = true, .low = {0, 0}, .high = {0, 0}};
        }}});
  Scene other = empty_scene(Space::spatial);
  other.add(body_of(shape_of(Sphere{0.2}), Vec3::Zero()));
  other.coordinate_draws = {{.low = {-1}, .high = {1}}};
  CHECK(validate(other).size() == 1);
}

}  // namespace manyworlds::test
