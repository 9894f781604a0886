// Numbers of the scene that differ from world to world.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/tables.hpp"
#include "tests/support/varied.hpp"

namespace manyworlds::test {

TEST_CASE(
    "every world falls by its own gravity, slides by its own friction, bounces by its own "
    "restitution, and moves by its own mass",
    "[fast][parameters]") {
  for (const Table& table : all_tables()) {
    constexpr int kWorlds = 9;
    Scene fall = empty_scene(Space::spatial);
    fall.add(body_of(shape_of(Box{{0.1, 0.2, 0.3}}), Vec3(0, 0, 5)));
    fall.variations = {gravity_between(Vec3(-3, 0, -20), Vec3(3, 0, 0)),
                       vary(Parameter::gravity_scale, 0.5, 2), vary(Parameter::mass, 1, 9)};
    Batch falling(compile(fall), options_of(table, kWorlds));
    for (int w = 0; w < kWorlds; ++w) falling.add_force(w, falling.body_in_row(0), Vec3(0, 12, 0));
    falling.step(1);
    const double dt = fall.options.dt;
    for (int w = 0; w < kWorlds; ++w) {
      const auto g = numbers(falling, Parameter::gravity, w);
      const double k = numbers(falling, Parameter::gravity_scale, w)[0];
      const double m = numbers(falling, Parameter::mass, w)[0];
      const Vec3 a = k * Vec3(g[0], g[1], g[2]) + Vec3(0, 12 / m, 0);
      CHECK((velocity(falling, w, 0) - a * dt).norm() < pick(table, 1e-6, 1e-14));
      CHECK((position(falling, w, 0) - Vec3(0, 0, 5) - a * dt * dt / 2).norm() <
            pick(table, 1e-6, 1e-14));
    }

    // A sliding body stops after v^2 / (2 mu g), whatever the mass.
    Scene slide = empty_scene(Space::spatial);
    slide.add(ground(Space::spatial));
    Body block = body_of(shape_of(Box{{0.5, 0.5, 0.1}}), Vec3(0, 0, 0.1));
    block.linear_velocity = Vec3(2, 0, 0);
    slide.add(block);
    Variation together = vary(Parameter::friction, 0.2, 0.8);
    together.together = true;
    slide.variations = {together, vary(Parameter::density, 100, 5000)};
    Batch sliding(compile(slide), options_of(table, kWorlds));
    sliding.step(120);
    for (int w = 0; w < kWorlds; ++w) {
      const auto mu = numbers(sliding, Parameter::friction, w);
      REQUIRE(mu.size() == 2);
      CHECK(mu[0] == mu[1]);
      const double expected = 4 / (2 * mu[0] * 10);
      CHECK(position(sliding, w, 0).x() == Approx(expected).epsilon(0.02));
    }

    Scene bounce = empty_scene(Space::planar);
    bounce.add(ground(Space::planar, 0, 0));
    Body ball = body_of(shape_of(Circle{0.1}, 0, 0), Vec3(0, 1.1, 0));
    bounce.add(ball);
    bounce.variations = {vary(Parameter::restitution, 0.3, 0.9)};
    Batch bouncing(compile(bounce), options_of(table, kWorlds));
    std::vector<double> top(kWorlds, 0);
    bool rising = false;
    for (int i = 0; i < 60; ++i) {
      bouncing.step();
      for (int w = 0; w < kWorlds; ++w) {
        if (velocity(bouncing, w, 0).y() <= 0 && !rising) continue;
        top[static_cast<std::size_t>(w)] =
            std::max(top[static_cast<std::size_t>(w)], position(bouncing, w, 0).y() - 0.1);
      }
      rising = i > 30;
    }
    for (int w = 0; w < kWorlds; ++w) {
      const auto e = numbers(bouncing, Parameter::restitution, w);
      const double most = std::max(e[0], e[1]);
      CHECK(top[static_cast<std::size_t>(w)] == Approx(most * most).epsilon(0.02));
    }
  }
}

TEST_CASE("draws depend on the world's seed and its episode, and keep to their range",
          "[fast][parameters]") {
  Scene scene = varied_crowd(Space::spatial);
  for (const Parameter parameter :
       {Parameter::initial_position, Parameter::initial_rotation,
        Parameter::initial_linear_velocity, Parameter::initial_angular_velocity,
        Parameter::shape_position, Parameter::shape_rotation, Parameter::center_of_mass,
        Parameter::wind}) {
    scene.variations.push_back(vary_three(parameter, Vec3::Constant(-0.01), Vec3::Constant(0.01)));
  }
  scene.variations.push_back(vary(Parameter::inertia_scale, 0.9, 1.1));
  Batch batch(compile(scene), {.worlds = 40, .threads = 1, .seed = 3});
  Batch other(compile(scene), {.worlds = 8, .threads = 1, .seed = 13});
  for (int p = 0; p < kParameterCount; ++p) {
    const auto parameter = static_cast<Parameter>(p);
    // World 10 of one is world 0 of the other.
    CHECK(numbers(batch, parameter, 10) == numbers(other, parameter, 0));
    // There are neither joints nor controls, nor links.
    if (batch.size(parameter) == 0 || is_of_newton(parameter)) continue;
    CHECK(numbers(batch, parameter, 10) != numbers(batch, parameter, 11));
  }
  double low = 1e9, high = 0, below = 0;
  for (int w = 0; w < 40; ++w) {
    for (double x : numbers(batch, Parameter::density, w)) {
      if (x == 1000) continue;  // of fixed shapes, which have no mass
      low = std::min(low, x), high = std::max(high, x);
      below += x < std::sqrt(200.0 * 2000.0) ? 1 : -1;
    }
  }
  CHECK(low >= 200);
  CHECK(low < 220);
  CHECK(high <= 2000);
  CHECK(high > 1800);
  CHECK(std::abs(below) < 90);  // 560 draws: half of them below the geometric mean, 3.8 sigma

  const auto first = numbers(batch, Parameter::friction, 7);
  const auto eighth = numbers(batch, Parameter::friction, 8);
  std::vector<std::uint8_t> mask(40, 0);
  mask[7] = 1;
  batch.reset(mask);
  CHECK(numbers(batch, Parameter::friction, 7) != first);
  CHECK(numbers(batch, Parameter::friction, 8) == eighth);
  batch.reset();
  CHECK(numbers(batch, Parameter::friction, 7) == first);
}

TEST_CASE("written numbers hold from the next step, over resets, and what is wrong changes nothing",
          "[fast][parameters]") {
  Scene scene = empty_scene(Space::planar);
  scene.add(ground(Space::planar));
  scene.add(body_of(shape_of(Polygon::box(0.5, 0.25)), Vec3(0, 0.25, 0)));
  scene.variations = {vary(Parameter::friction, 0.1, 0.9, Draw::none),
                      vary(Parameter::mass, 1, 1000, Draw::none)};
  Batch batch(compile(scene), {.worlds = 3, .threads = 1});
  CHECK(numbers(batch, Parameter::mass, 2) == std::vector<double>{500});
  CHECK(numbers(batch, Parameter::friction, 2) == std::vector<double>{0.6, 0.6});
  const std::vector<double> friction{0.1, 0.2, 0.3, 0.4, 0.5, 0.9};
  batch.write(Parameter::friction, friction);
  batch.reset();
  std::vector<double> back(6);
  batch.read(Parameter::friction, back);
  CHECK(back == friction);

  const auto message = [&](Parameter parameter, std::vector<double> in) -> std::string {
    try {
      batch.write(parameter, in);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  CHECK(message(Parameter::friction, {0.1, 0.2, 0.3, 0.95, 0.5, 0.9}) ==
        "world 1: friction of shape 1 is 0.95, must be between 0.1 and 0.9, its declared range");
  CHECK(message(Parameter::friction, {0.1, 0.2, 0.3, std::nan(""), 0.5, 0.9}) ==
        "world 1: friction of shape 1 is nan, must be between 0.1 and 0.9, its declared range");
  CHECK(message(Parameter::mass, {5, 5, 2000}) ==
        "world 2: mass of body 0 is 2000, must be between 1 and 1000, its declared range");
  CHECK(message(Parameter::linear_drag, {0, 1, 0}) ==
        "world 1: linear_drag of body 0 is 1, must be 0: it does not vary (Scene::variations)");
  CHECK(message(Parameter::gravity, std::vector<double>(8)) ==
        "gravity has 9 values, the buffer has 8");
  batch.read(Parameter::friction, back);
  CHECK(back == friction);
  CHECK(numbers(batch, Parameter::mass, 0) == std::vector<double>{500});
  CHECK(message(Parameter::linear_drag, {0, 0, 0}).empty());
}

TEST_CASE("a body keeps its place when its sizes shift its centre of mass", "[fast][parameters]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space);
    Body two = body_of(shape_of(cube_of(space, 0.25)), Vec3(1, 2, 0));
    two.shapes.push_back(shape_of(round_of(space, 0.3)));
    two.shapes[1].position = Vec3(0.5, 0, 0);
    two.rotation = Quat(Eigen::AngleAxisd(0.5, Vec3::UnitZ()));
    scene.add(two);
    Variation size;
    size.parameter = Parameter::size;
    size.shape = ShapeId(BodyId(0), 1);
    size.low.setConstant(0.1), size.high.setConstant(0.9);
    size.draw = Draw::none;
    scene.variations = {size};
    for (const Table& table : all_tables()) {
      Batch batch(compile(scene), options_of(table, 3));
      std::vector<double> sizes = numbers(batch, Parameter::size, 1);
      sizes[3] = 0.8;
      const double mass = numbers(batch, Parameter::mass, 1)[0];
      batch.write(Parameter::size, 1, sizes);
      CHECK(numbers(batch, Parameter::mass, 1)[0] > 2 * mass);
      CHECK(numbers(batch, Parameter::mass, 0)[0] == mass);
      for (int w = 0; w < 3; ++w) {
        CHECK((position(batch, w, 0) - Vec3(1, 2, 0)).norm() < pick(table, 1e-6, 1e-14));
        CHECK(rotation(batch, w, 0).angularDistance(two.rotation) < pick(table, 1e-3, 1e-7));
      }
      // A force at the centre of mass does not rotate it, wherever that has gone.
      const double own = numbers(batch, Parameter::mass, 1)[0];
      batch.add_impulse(1, batch.body_in_row(0), Vec3(own, 0, 0));
      CHECK((velocity(batch, 1, 0) - Vec3(1, 0, 0)).norm() < pick(table, 1e-6, 1e-14));
      CHECK(spin(batch, 1, 0).norm() < 1e-12);
    }
  }
}

TEST_CASE("a ray goes with its body wherever sizes put the centre of mass",
          "[fast][parameters][observe]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space);
    scene.add(
        body_of(shape_of(cube_of(space, 1)), 5 * Vec3::UnitX() + 3 * up_of(space), Motion::fixed));
    Body two = body_of(shape_of(cube_of(space, 0.25)), 3 * up_of(space));
    two.shapes.push_back(shape_of(round_of(space, 0.3)));
    two.shapes[1].position = Vec3(0.5, 0, 0);
    scene.add(two);
    Variation size;
    size.parameter = Parameter::size;
    size.shape = ShapeId(BodyId(1), 1);
    size.low.setConstant(0.1), size.high.setConstant(0.9);
    scene.variations = {size};
    for (const Table& table : all_tables()) {
      BatchOptions options = options_of(table, 9);
      options.observe.rays = {
          {.origin = Vec3(0.1, 0, 0), .direction = Vec3::UnitX(), .body = BodyId(1)}};
      Batch batch(compile(scene), options);
      batch.look();
      for (int w = 0; w < 9; ++w) {
        REQUIRE(batch.ray_hits(w).size() == 1);
        CHECK(batch.ray_hits(w)[0].distance == Approx(3.9).epsilon(pick(table, 1e-5, 1e-12)));
        CHECK(batch.ray_hits(w)[0].body == BodyId(0));
      }
    }
  }
}

TEST_CASE("a written number wakes its world", "[fast][parameters][sleep]") {
  Scene scene = empty_scene(Space::spatial);
  scene.add(ground(Space::spatial));
  scene.add(body_of(shape_of(Box{{0.5, 0.5, 0.5}}), Vec3(0, 0, 0.5)));
  scene.variations = {vary(Parameter::friction, 0, 1, Draw::none),
                      gravity_between(Vec3(-5, 0, -10), Vec3(5, 0, -10), Draw::none)};
  Batch batch(compile(scene), {.worlds = 10, .threads = 1, .sleep = true});
  batch.step(60);
  CHECK(batch.awake_fraction() == 0);
  const std::vector<double> slope{5, 0, -10}, same{0.6, 0.6}, slippery{0, 0};
  batch.write(Parameter::gravity, 3, slope);
  batch.write(Parameter::friction, 4, same);  // nothing new
  batch.write(Parameter::friction, 5, slippery);
  for (int w = 0; w < 10; ++w) CHECK(batch.asleep(w) == (w != 3 && w != 5));
  batch.write(Parameter::friction, 3, slippery);
  const auto resting = state(batch, 2);
  batch.step(30);
  CHECK(position(batch, 3, 0).x() == Approx(5 * 0.25 / 2).epsilon(0.02));
  CHECK(state(batch, 2) == resting);
}

TEST_CASE("worlds begin where they are told to", "[fast][parameters]") {
  Scene scene = crowd(Space::planar);
  Batch batch(compile(scene), {.worlds = 6, .threads = 1});
  std::vector<double> x(batch.size(Field::position)), v(batch.size(Field::linear_velocity), 0);
  batch.read(Field::position, x);
  const std::vector<double> drawn = x;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 0.01 * static_cast<double>(i % 7);
  batch.set_initial(Field::position, x);
  batch.set_initial(Field::linear_velocity, v);
  std::vector<double> now(x.size());
  batch.read(Field::position, now);
  CHECK(now == drawn);  // not before the next reset
  batch.step(10);
  std::vector<std::uint8_t> mask(6, 0);
  mask[2] = 1;
  batch.reset(mask);
  CHECK(velocity(batch, 2, 3).norm() == 0);
  CHECK(velocity(batch, 1, 3).norm() > 0);
  for (int round = 0; round < 2; ++round) {
    batch.reset();
    batch.read(Field::position, now);
    for (std::size_t i = 0; i < x.size(); ++i) CHECK(now[i] == static_cast<float>(x[i]));
    batch.step(10);
  }
  batch.set_initial(Field::position, {});
  batch.reset();
  batch.read(Field::position, now);
  CHECK(now == drawn);
  CHECK_THROWS_AS(batch.set_initial(Field::position, std::vector<double>(3)),
                  std::invalid_argument);
}

}  // namespace manyworlds::test
