// Wind and points that attract, by closed forms.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/approx.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

Scene floating(Space space, const Vec3& place, const Vec3& v) {
  Scene scene = empty_scene(space, 0);
  scene.add(lump(space, 2, {0.2, 0.2, 0.2}, place));
  scene.bodies[0].linear_velocity = v;
  return scene;
}

}  // namespace

TEST_CASE("a body drifts with the wind as its drag says", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    for (Space space : kSpaces) {
      Scene scene = floating(space, Vec3::Zero(), Vec3::Zero());
      scene.options.wind = {3, 0, 0};
      scene.bodies[0].linear_drag = 2;
      Batch batch(compile(scene), options_of(table));
      batch.step(30);
      // v' = (v + h c u) / (1 + h c), 120 substeps.
      const double left = std::pow(1 + 2.0 / 240, -120);
      INFO(name(table));
      CHECK(velocity(batch, 0, 0).x() == Approx(3 * (1 - left)).epsilon(pick(table, 1e-5, 1e-12)));
      batch.step(600);
      CHECK(velocity(batch, 0, 0).x() == Approx(3).epsilon(1e-5));
      const double from = position(batch, 0, 0).x();
      batch.step(60);
      CHECK(position(batch, 0, 0).x() - from == Approx(3).epsilon(1e-4));
    }
  }
}

TEST_CASE("wind varies with the drag of each world", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    Scene scene = floating(Space::spatial, Vec3::Zero(), Vec3::Zero());
    scene.options.wind = {0, 4, 0};
    scene.variations = {vary(Parameter::linear_drag, 0.1, 1)};
    Batch batch(compile(scene), options_of(table, 8));
    std::vector<double> drag(8);
    batch.read(Parameter::linear_drag, drag);
    batch.step(60);
    for (int w = 0; w < 8; ++w) {
      const double left = std::pow(1 + drag[static_cast<std::size_t>(w)] / 240, -240);
      CHECK(velocity(batch, w, 0).y() == Approx(4 * (1 - left)).epsilon(pick(table, 2e-5, 1e-10)));
    }
  }
}

TEST_CASE("a body circles an attractor, and the orbit's error falls with the square of the step",
          "[fast][field]") {
  const Table table = double_table();
  if (!has_table(table)) return;
  for (Space space : kSpaces) {
    double last = 0;
    for (const int rate : {30, 60, 120}) {
      // Eccentricity 0.3 about a focus off the origin, period 2 pi.
      Scene scene = floating(space, {1.7, 0.5, 0}, {0, std::sqrt(1.3 / 0.7), 0});
      scene.attractors = {{{1, 0.5, 0}, 1, 0}};
      scene.options.dt = 2 * kPi / (6 * rate);
      Batch batch(compile(scene), options_of(table));
      const double energy = energy_of(batch, 0);
      double worst = 0;
      for (int i = 0; i < 6 * rate; ++i) {
        batch.step();
        worst = std::max(worst, std::abs(energy_of(batch, 0) - energy));
      }
      const double error = (position(batch, 0, 0) - Vec3(1.7, 0.5, 0)).norm();
      INFO("rate " << rate << " error " << error << " energy " << worst);
      CHECK(worst < 2e-2 * 900 / (rate * rate));
      if (last > 0) CHECK(std::log2(last / error) == approx(2, 0.15));
      last = error;
    }
  }
}

TEST_CASE("an orbit keeps its energy for a hundred turns", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    for (Space space : kSpaces) {
      Scene scene = floating(space, {1, 0, 0}, {0, 1, 0});
      scene.attractors = {{Vec3::Zero(), 1, 0}};
      scene.options.dt = 2 * kPi / 100;
      Batch batch(compile(scene), options_of(table));
      batch.step(10000);
      CHECK(energy_of(batch, 0) == Approx(2 * -0.5).epsilon(pick(table, 1e-5, 1e-6)));
    }
  }
}

TEST_CASE("attractors act beside contacts and joints, on dynamic bodies only", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    for (Space space : kSpaces) {
      // A planet of radius 1 with balls all around it: they come to rest on it.
      Scene scene = empty_scene(space, 0);
      Body planet = body_of(shape_of(round_of(space, 1)), Vec3::Zero());
      planet.motion = Motion::kinematic;
      scene.add(planet);
      const Vec3 up = up_of(space);
      for (const Vec3& out : {Vec3(1, 0, 0), Vec3(-1, 0, 0), up, Vec3(-up)}) {
        scene.add(body_of(shape_of(round_of(space, 0.1)), 1.5 * out));
      }
      scene.attractors = {{Vec3::Zero(), 10, 0}};
      BatchOptions options = options_of(table, 3);
      options.sleep = true;
      Batch batch(compile(scene), options);
      batch.step(300);
      INFO(name(table));
      for (int b = 1; b <= 4; ++b) CHECK(position(batch, 0, b).norm() == approx(1.1, 0.005));
      CHECK(position(batch, 0, 0).norm() == 0);
      CHECK(batch.asleep(0, batch.body_in_row(1)));
    }
  }
}

TEST_CASE("a ball that bounces on a planet keeps its height", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    for (Space space : kSpaces) {
      Scene scene = empty_scene(space, 0);
      Body planet = body_of(shape_of(round_of(space, 10), 0, 1), Vec3::Zero(), Motion::fixed);
      scene.add(planet);
      const Vec3 up = up_of(space);
      Body ball = body_of(shape_of(round_of(space, 0.5), 0, 1), 12.5 * up);
      scene.add(ball);
      scene.attractors = {{Vec3::Zero(), 1000, 0}};  // 10 m/s^2 on the ground
      Batch batch(compile(scene), options_of(table));
      double top = 0;
      for (int i = 0; i < 1200; ++i) {
        batch.step();
        if (i >= 1000) top = std::max(top, position(batch, 0, 0).dot(up));
      }
      INFO(name(table) << " height " << top);  // after eight bounces or more
      CHECK(top == approx(12.5, 0.06));
    }
  }
}

TEST_CASE("a body floats above an attractor without falling asleep", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    Scene scene = floating(Space::spatial, {0, 0, 30}, Vec3::Zero());
    scene.add(lump(Space::spatial, 1, {1, 1, 1}, {9, 0, 0}));
    scene.add(
        joint_at(scene, {}, BodyId(1), at({9, 0, 1}), HingeJoint{}));  // there is a solver step
    scene.attractors = {{Vec3::Zero(), 10, 1}};
    BatchOptions options = options_of(table);
    options.sleep = true;
    Batch batch(compile(scene), options);
    batch.step(120);
    CHECK_FALSE(batch.asleep(0, batch.body_in_row(0)));
    CHECK(position(batch, 0, 0).z() < 29.99);
  }
}

TEST_CASE("a body at an attractor is not drawn anywhere", "[fast][field]") {
  for (const Table& table : widest_tables()) {
    Scene scene = floating(Space::spatial, {1, 2, 3}, Vec3::Zero());
    scene.attractors = {{{1, 2, 3}, 10, 0}};
    Batch batch(compile(scene), options_of(table));
    batch.step(10);
    CHECK(position(batch, 0, 0) == Vec3(1, 2, 3));
  }
}

TEST_CASE("attractors and wind are checked", "[fast][scene]") {
  Scene scene = floating(Space::planar, Vec3::Zero(), Vec3::Zero());
  scene.attractors = {{Vec3::Zero(), 1, 0}, {{0, 0, 1}, std::nan(""), -1}};
  scene.options.wind = {0, 0, 2};
  std::string all;
  for (const Issue& issue : validate(scene)) all += to_string(issue) + "\n";
  CHECK_THAT(all, Catch::Contains("attractor 1: position.z"));
  CHECK_THAT(all, Catch::Contains("attractor 1: strength"));
  CHECK_THAT(all, Catch::Contains("attractor 1: softening is -1 m, must be >= 0"));
  CHECK_THAT(all, Catch::Contains("options.wind.z"));
}

}  // namespace manyworlds::test
