// Lines that do not move: bodies slide over the vertices of a terrain as over one ground, and fast
// ones stop at a line.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

Scene terrain_scene(std::vector<Vec2> points, bool loop = false, double friction = 0) {
  Scene scene = empty_scene(Space::planar);
  scene.add(
      body_of(shape_of(Terrain{std::move(points), loop}, friction), Vec3::Zero(), Motion::fixed));
  return scene;
}

std::vector<Vec2> flat(double from, double to, double step) {
  std::vector<Vec2> points;
  for (int i = 0; from + i * step <= to; ++i) points.emplace_back(from + i * step, 0);
  return points;
}

// Slides at 5 m/s for 4 s over a flat terrain; segments of several lengths.
void check_slides(const Geometry& geometry, double height) {
  for (double step : {0.13, 0.5, 1.7}) {
    Scene scene = terrain_scene(flat(-2, 22, step));
    scene.add(body_of(shape_of(geometry, 0), Vec3(0, height, 0)));
    scene.bodies[1].linear_velocity = Vec3(5, 0, 0);
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      double highest = -1, lowest = 1, worst = 0, turn = 0;
      for (int i = 0; i < 240; ++i) {
        batch.step();
        const double y = position(batch, 0, 0).y() - height;
        highest = std::max(highest, y), lowest = std::min(lowest, y);
        worst = std::max(worst, std::abs(velocity(batch, 0, 0).x() - 5));
        turn = std::max(turn, std::abs(spin(batch, 0, 0).z()));
      }
      INFO(name(table) << " step " << step << " high " << highest << " low " << lowest
                       << " speed off by " << worst << " spin " << turn);
      CHECK(worst < 5e-3);
      CHECK(highest < 1e-3);
      CHECK(lowest > -2e-3);
      CHECK(turn < 1e-2);
      CHECK(position(batch, 0, 0).x() == Approx(20).epsilon(1e-3));
    }
  }
}

}  // namespace

TEST_CASE("shapes slide over a flat terrain as over one line", "[fast][terrain]") {
  check_slides(Circle{0.3}, 0.3);
  check_slides(Polygon::box(0.5, 0.25), 0.25);
  check_slides(Polygon::box(0.1, 0.1), 0.1);
  check_slides(Polygon{{{-0.5, -0.2}, {0.5, -0.2}, {0, 0.4}}}, 0.2);
  check_slides(Capsule{0.2, 0.4}, 0.6);  // on its end
}

TEST_CASE("a lying capsule slides over a flat terrain", "[fast][terrain]") {
  Scene scene = terrain_scene(flat(-2, 22, 0.3));
  scene.add(body_of(shape_of(Capsule{0.2, 0.4}, 0), Vec3(0, 0.2, 0)));
  scene.bodies[1].rotation = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
  scene.bodies[1].linear_velocity = Vec3(5, 0, 0);
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table));
    batch.step(240);
    CHECK(velocity(batch, 0, 0).x() == Approx(5).epsilon(1e-3));
    CHECK(std::abs(position(batch, 0, 0).y() - 0.2) < 2e-3);
  }
}

TEST_CASE("a ball keeps its energy through a valley and over a hill", "[fast][terrain]") {
  // A polyline of the smooth curve y = -cos(x). Where the way bends by an angle from one segment or
  // one step to the next, an impact without bounce takes the square of that angle from the energy,
  // so both are short.
  std::vector<Vec2> points;
  for (int i = 0; i <= 1600; ++i) {
    const double x = -2 * kPi + i * kPi / 400;
    points.emplace_back(x, -std::cos(x));
  }
  Scene scene = terrain_scene(points);
  scene.options.dt = 1.0 / 600;
  scene.add(body_of(shape_of(Circle{0.2}, 0), Vec3(-kPi / 2, 0.3, 0)));
  scene.bodies[1].linear_velocity = Vec3(4, -4, 0) / std::sqrt(2.0) * 1.5;
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table));
    batch.step(5);
    const auto energy = [&] {
      return 10 * position(batch, 0, 0).y() + 0.5 * velocity(batch, 0, 0).squaredNorm();
    };
    const double start = energy();
    double least = start;
    while (position(batch, 0, 0).x() < 3 && batch.time() < 5) {
      batch.step();
      least = std::min(least, energy());
    }
    INFO(name(table) << " energy " << start << " then " << least << " at x "
                     << position(batch, 0, 0).x());
    CHECK(position(batch, 0, 0).x() > 3);
    CHECK(least > 0.95 * start);
  }
}

TEST_CASE("boxes come to rest in and on a rough terrain", "[slow][terrain]") {
  // Saw teeth in a trough, and a heap of every shape on them.
  std::vector<Vec2> points = {{-6, 5}};
  for (int i = 0; i <= 20; ++i) points.emplace_back(-5 + 0.5 * i, i % 2 == 0 ? 0 : 0.25);
  points.emplace_back(6, 5);
  Scene scene = terrain_scene(points, false, 0.6);
  const Geometry shapes[] = {Circle{0.3}, Polygon::box(0.4, 0.2), Capsule{0.2, 0.3},
                             Polygon{{{-0.3, -0.2}, {0.3, -0.2}, {0, 0.4}}}};
  for (int i = 0; i < 24; ++i) {
    Body body = body_of(shape_of(shapes[i % 4]), Vec3(-3 + i % 6 * 1.2, 1 + i / 6 * 1.1, 0));
    body.jitter.position = Vec3(0.2, 0.1, 0);
    body.jitter.angle = 3;
    scene.add(body);
  }
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table, 32));
    batch.step(600);
    CHECK(batch.lost_worlds() == 0);
    for (int w = 0; w < batch.worlds(); ++w) {
      INFO(name(table) << " world " << w);
      CHECK(max_speed(batch, w) < 0.3);
      CHECK(max_penetration(batch, w) < 0.02);
      for (int b = 0; b < batch.bodies(w); ++b) CHECK(position(batch, w, b).y() > 0);
    }
  }
}

TEST_CASE("a long terrain takes no more room than the shapes on it need", "[fast][terrain]") {
  // Two bodies on 2000 links, one of them over 50 at once.
  Scene scene = terrain_scene(flat(-100, 100, 0.1), false, 0.6);
  scene.add(body_of(shape_of(Polygon::box(2.5, 0.2)), Vec3(0, 0.2, 0)));
  scene.add(body_of(shape_of(Circle{0.2}), Vec3(5, 0.2, 0)));
  const Plan plan = compile(scene);
  CHECK(plan.report().fixed_capacity < 500);
  for (const Table& table : widest_tables()) {
    Batch batch(plan, options_of(table));
    batch.step(120);
    CHECK(batch.status(0) == Status::ok);
    CHECK(max_speed(batch, 0) < 1e-3);
    CHECK(std::abs(position(batch, 0, 0).y() - 0.2) < 2e-3);
  }
}

TEST_CASE("a ball rolls off the end of a terrain", "[fast][terrain]") {
  Scene scene = terrain_scene({{-5, 0}, {0, 0}}, false, 0.6);
  scene.add(body_of(shape_of(Circle{0.3}), Vec3(-1, 0.3, 0)));
  scene.bodies[1].linear_velocity = Vec3(1, 0, 0);
  scene.bodies[1].angular_velocity = Vec3(0, 0, -1 / 0.3);
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table));
    double before = 0.3;
    for (int i = 0; i < 120; ++i) {
      batch.step();
      CHECK(position(batch, 0, 0).y() < before + 1e-3);  // never thrown up
      before = position(batch, 0, 0).y();
    }
    CHECK(position(batch, 0, 0).y() < -1);
  }
}

TEST_CASE("a terrain lets pass what comes from behind", "[fast][terrain]") {
  for (double speed : {2.0, 60.0}) {
    Scene scene = terrain_scene(flat(-5, 5, 0.7));
    scene.options.gravity.setZero();
    scene.add(body_of(shape_of(Circle{0.2}), Vec3(0, -1, 0)));
    scene.bodies[1].linear_velocity = Vec3(0, speed, 0);
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      batch.step(60);
      INFO(name(table) << " speed " << speed << " y " << position(batch, 0, 0).y());
      CHECK(position(batch, 0, 0).y() > 0.2);
    }
  }
}

TEST_CASE("a fast ball stops at a thin line", "[slow][terrain]") {
  const Geometry lines[] = {Segment{{0, -5}, {0, 5}}, Terrain{{{0, -5}, {0, -1}, {0, 0.3}, {0, 5}}},
                            Capsule{0.02, 5}};
  for (const Geometry& line : lines) {
    for (double speed : {20.0, 200.0}) {
      Scene scene = empty_scene(Space::planar, 0);
      scene.add(body_of(shape_of(line), Vec3::Zero(), Motion::fixed));
      scene.add(body_of(shape_of(Circle{0.1}), Vec3(-10, 0, 0)));
      scene.bodies[1].linear_velocity = Vec3(speed, 0, 0);
      scene.bodies[1].jitter.position = Vec3(3, 0.5, 0);
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table, 500));
        batch.step(60);
        int crossed = 0;
        for (int w = 0; w < batch.worlds(); ++w) crossed += position(batch, w, 0).x() > 0;
        INFO(name(table) << " line " << line.index() << " speed " << speed);
        CHECK(crossed == 0);
      }
    }
  }
}

}  // namespace manyworlds::test
