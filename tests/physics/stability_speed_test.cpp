// Fast bodies against thin fixed shapes, and friction at its critical angle.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "tests/support/joints.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr int kPhases = 1000;

// A thin wall across x = 0 and a body that flies at it from the left, at a random distance.
Scene shot(Space space, Geometry bullet, double speed, double spin, double height) {
  Scene scene = empty_scene(space, 0);
  const Geometry wall = box_of(space, space == Space::planar ? Vec3(0.05, 5, 0) : Vec3(0.1, 5, 5));
  scene.add(body_of(shape_of(wall), Vec3::Zero(), Motion::fixed));
  Body body = body_of(shape_of(std::move(bullet)), Vec3(-10, 0, 0) + height * up_of(space));
  body.linear_velocity = Vec3(speed, 0, 0);
  body.angular_velocity = space == Space::planar ? Vec3(0, 0, spin) : Vec3(spin, spin, spin);
  body.jitter.position = Vec3(3, 0.3, space == Space::planar ? 0 : 0.3);
  scene.add(body);
  return scene;
}

void check_stopped(const Scene& scene, bool must_rest) {
  const Plan plan = compile(scene);
  for (const Table& table : widest_tables()) {
    Batch batch(plan, options_of(table, kPhases));
    std::vector<double> x(batch.size(Field::position));
    const std::size_t stride = scene.space == Space::planar ? 2 : 3;
    int crossed = 0, away = 0, worst_world = -1;
    double farthest = -1e9;
    for (int i = 0; i < 60; ++i) {
      batch.step();
      batch.read(Field::position, std::span<double>(x));
      for (std::size_t w = 0; w < kPhases; ++w) {
        if (x[stride * w] > farthest) {
          farthest = x[stride * w];
          worst_world = static_cast<int>(w);
        }
      }
    }
    for (std::size_t w = 0; w < kPhases; ++w) {
      if (x[stride * w] > 0) ++crossed;
      if (x[stride * w] < -0.5) ++away;
    }
    INFO(name(table) << " crossed " << crossed << " away " << away << " farthest " << farthest
                     << " in world " << worst_world);
    CHECK(crossed == 0);
    CHECK(farthest < 0);
    if (must_rest) CHECK(away == 0);
    CHECK(batch.lost_worlds() == 0);
  }
}

}  // namespace

TEST_CASE("a circle at 200 m/s stops at a thin wall", "[slow][stability]") {
  check_stopped(shot(Space::planar, Circle{0.1}, 200, 0, 0), true);
}
TEST_CASE("a square at 200 m/s stops at a thin wall", "[slow][stability]") {
  check_stopped(shot(Space::planar, Polygon::box(0.1, 0.1), 200, 20, 0), false);
}
TEST_CASE("a sphere at 180 m/s stops at a thin wall", "[slow][stability]") {
  check_stopped(shot(Space::spatial, Sphere{0.1}, 180, 20, 0), false);
}
TEST_CASE("a box at 180 m/s stops at a thin wall", "[slow][stability]") {
  check_stopped(shot(Space::spatial, Box{{0.1, 0.1, 0.1}}, 180, 20, 0), false);
}

TEST_CASE("hulls, rods and plates at 100 m/s stop at a thin wall", "[slow][stability]") {
  const double a = 0.1;
  check_stopped(
      shot(Space::spatial, Hull{{{-a, -a, -a}, {a, -a, -a}, {0, a, -a}, {0, 0, a}}}, 100, 20, 0),
      false);
  check_stopped(shot(Space::spatial, Capsule{0.01, 0.2}, 100, 20, 0), false);
  check_stopped(shot(Space::spatial, Box{{0.2, 0.2, 0.01}}, 100, 20, 0), false);
  check_stopped(shot(Space::planar, Polygon::box(0.2, 0.01), 100, 20, 0), false);
  check_stopped(shot(Space::planar, Capsule{0.01, 0.2}, 100, 20, 0), false);
}

TEST_CASE("a fast body ends its step where it touches a wall", "[fast][stability]") {
  // It flies 0.9 m to the wall, 1 m in a step.
  for (Space space : {Space::planar, Space::spatial}) {
    const double half = 0.01, face = space == Space::planar ? 0.05 : 0.1;
    const Geometry plate = space == Space::planar ? box_of(space, Vec3(half, 0.2, 0))
                                                  : box_of(space, Vec3(half, 0.2, 0.2));
    Scene scene = shot(space, plate, 60, 0, 0);
    scene.bodies[1].jitter = {};
    scene.bodies[1].position.x() = -face - half - 0.9;
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 1));
      std::vector<double> x(batch.size(Field::position)), v(batch.size(Field::linear_velocity));
      batch.step();
      batch.read(Field::position, std::span<double>(x));
      batch.read(Field::linear_velocity, std::span<double>(v));
      CHECK(x[0] == Approx(-face - half).margin(1e-3));  // a fifth of the slop
      CHECK(v[0] == Approx(60));
      batch.step();
      batch.read(Field::position, std::span<double>(x));
      batch.read(Field::linear_velocity, std::span<double>(v));
      CHECK(x[0] < -face - half + 1e-3);
      CHECK(v[0] < 0.1);
    }
  }
}

// Bodies on joints stop where a ball inside them does, so that joints are stretched less.
TEST_CASE("jointed balls at 60 m/s stop at a thin wall, and stay joined", "[fast][stability]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (int phase = 0; phase < 20; ++phase) {
      Scene scene = shot(space, round_of(space, 0.1), 60, 0, 0);
      scene.bodies[1].jitter = {};
      scene.bodies[1].position.x() += 0.05 * phase;
      Body second = scene.bodies[1];
      second.position += 0.25 * up_of(space);
      scene.add(second);
      const Vec3 anchor = scene.bodies[1].position + 0.125 * up_of(space);
      scene.add(joint_at(scene, BodyId(1), BodyId(2), at(anchor), HingeJoint{}));
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        double gap = 0, farthest = -1e9;
        for (int i = 0; i < 30; ++i) {
          batch.step();
          gap = std::max(gap, worst_gap(batch, 0));
          for (int b = 0; b < 2; ++b) farthest = std::max(farthest, position(batch, 0, b).x());
        }
        INFO(name(table) << " phase " << phase);
        CHECK(farthest < 0);
        CHECK(gap < 0.005);
      }
    }
  }
}

TEST_CASE("a body that passes an edge at 200 m/s is not stopped", "[slow][stability]") {
  // The wall ends at height 5; the body's lowest point clears it by 4 to 64 cm.
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(shot(space, round_of(space, 0.1), 200, 0, 5.1 + 0.34));
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table, kPhases));
      batch.step(12);
      double slowest = 1e9, lift = 0;
      for (int w = 0; w < kPhases; ++w) {
        slowest = std::min(slowest, velocity(batch, w, 0).x());
        lift = std::max(lift, std::abs(velocity(batch, w, 0).dot(up_of(space))));
      }
      INFO(name(table) << " slowest " << slowest << " lift " << lift);
      CHECK(slowest == 200);
      CHECK(lift == 0);
    }
  }
}

// A bullet and something that moves towards it, at a random distance and with a random offset
// across. How many worlds end with the bullet before it?
enum class Target { wall, bullet };
struct Volley {
  Target target = Target::wall;
  bool box = false, cast = true, collides = true;
};

int stopped_bullets(Space space, const Table& table, const Volley& volley) {
  Scene scene = empty_scene(space, 0);
  scene.options.contact.cast_between_moving = volley.cast;
  const Geometry ball = volley.box ? cube_of(space, 0.1) : round_of(space, 0.1);
  Body bullet = body_of(shape_of(ball), Vec3(-10, 0, 0));
  bullet.linear_velocity = Vec3(200, 0, 0);
  if (!volley.collides) bullet.shapes[0].filter.mask = 0;
  bullet.jitter.position = 3 * Vec3::UnitX();
  Body target = body_of(shape_of(ball), Vec3::Zero());
  target.linear_velocity = Vec3(-150, 0, 0);
  if (volley.target == Target::wall) {
    const Geometry wall =
        box_of(space, space == Space::planar ? Vec3(0.05, 5, 0) : Vec3(0.05, 5, 5));
    target.shapes[0] = shape_of(wall);
    target.shapes[0].density = 1e6;
    target.linear_velocity = Vec3(-2, 0, 0);
    bullet.jitter.position += up_of(space);
  }
  // Off the bullet's axis in the batch's order, too: each must see the other.
  scene.add(volley.box ? bullet : target);
  scene.add(volley.box ? target : bullet);
  const int shot = volley.box ? 0 : 1, hit = volley.box ? 1 : 0;
  Batch batch(compile(scene), options_of(table, kPhases));
  batch.step(20);
  int stopped = 0;
  for (int w = 0; w < kPhases; ++w) {
    const bool before = position(batch, w, shot).x() < position(batch, w, hit).x();
    const bool slowed = velocity(batch, w, shot).x() < velocity(batch, w, hit).x() + 1;
    if (before && slowed) ++stopped;
  }
  return stopped;
}

TEST_CASE("bodies that may be cast at each other meet at 200 m/s", "[slow][stability]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (const Table& table : widest_tables()) {
      for (Target target : {Target::wall, Target::bullet}) {
        for (bool box : {false, true}) {
          INFO(name(table) << (space == Space::planar ? " planar" : " spatial")
                           << (target == Target::wall ? " wall" : " bullet")
                           << (box ? " box" : ""));
          CHECK(stopped_bullets(space, table, {target, box, true, true}) == kPhases);
          CHECK(stopped_bullets(space, table, {target, box, false, true}) < kPhases / 2);
          CHECK(stopped_bullets(space, table, {target, box, true, false}) == 0);
        }
      }
    }
  }
}

TEST_CASE("an elastic ball stays in its house for a minute", "[slow][stability]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 0);
    const int axes = space == Space::planar ? 2 : 3;
    for (int axis = 0; axis < axes; ++axis) {
      for (double side : {-10.25, 10.25}) {
        Vec3 half = Vec3::Constant(10.5), at = Vec3::Zero();
        half(axis) = 0.25;
        at(axis) = side;
        const Geometry wall = box_of(space, half);
        scene.add(body_of(shape_of(wall, 0, 1), at, Motion::fixed));
      }
    }
    Body ball = body_of(shape_of(round_of(space, 0.5), 0, 1), Vec3::Zero());
    ball.linear_velocity = space == Space::planar ? Vec3(120, 120, 0) : Vec3(120, 0, 120);
    ball.jitter.position = space == Space::planar ? Vec3(5, 5, 0) : Vec3(5, 5, 5);
    ball.jitter.linear_velocity = space == Space::planar ? Vec3(20, 20, 0) : Vec3(20, 20, 20);
    scene.add(ball);
    constexpr int kWorlds = 64;
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, kWorlds));
      std::vector<double> start;
      for (int w = 0; w < kWorlds; ++w) start.push_back(velocity(batch, w, 0).norm());
      std::vector<double> x(batch.size(Field::position));
      double farthest = 0;
      for (int i = 0; i < 3600; ++i) {
        batch.step();
        batch.read(Field::position, std::span<double>(x));
        for (double coordinate : x) farthest = std::max(farthest, std::abs(coordinate));
      }
      double fastest = 0, slowest = 1e9;
      for (int w = 0; w < kWorlds; ++w) {
        const double ratio = velocity(batch, w, 0).norm() / start[static_cast<std::size_t>(w)];
        fastest = std::max(fastest, ratio);
        slowest = std::min(slowest, ratio);
      }
      INFO(name(table) << " farthest " << farthest << " speed ratio " << slowest << ".."
                       << fastest);
      CHECK(farthest < 10);
      CHECK(fastest < 1.01);
      CHECK(slowest > 0.9);
    }
  }
}

// A slab on a slope holds just below the critical angle atan(mu) and slides just above it.
TEST_CASE("friction holds below its critical angle and slides above it", "[slow][stability]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (double mu : {0.2, 0.3, 0.5, 0.6, 0.8, 1.0}) {
      for (double beside : {-1.0, 1.0}) {
        const double angle = std::atan(mu) + beside * kPi / 180;
        Scene scene = empty_scene(space);
        scene.options.gravity =
            10 * (std::sin(angle) * Vec3::UnitX() - std::cos(angle) * up_of(space));
        scene.add(ground(space, mu));
        const Geometry slab = slab_of(space, 0.2, 0.05);
        scene.add(body_of(shape_of(slab, mu), 0.05 * up_of(space)));
        for (const Table& table : widest_tables()) {
          Batch batch(compile(scene), options_of(table));
          batch.step(60);
          const Vec3 x = position(batch, 0, 0), v = velocity(batch, 0, 0);
          batch.step(600);
          const Vec3 moved = position(batch, 0, 0) - x, gained = velocity(batch, 0, 0) - v;
          INFO(name(table) << (space == Space::planar ? " planar" : " spatial") << " mu " << mu
                           << " angle " << angle * 180 / kPi << " moved " << moved.transpose()
                           << " gained " << gained.transpose());
          if (beside < 0) {
            CHECK(moved.norm() < 1e-3);
            CHECK(velocity(batch, 0, 0).norm() < 1e-3);
          } else {
            const double a = 10 * (std::sin(angle) - mu * std::cos(angle));
            CHECK(gained.x() == Approx(10 * a).epsilon(0.01));
            CHECK(v.x() == Approx(a).epsilon(0.02));
          }
        }
      }
    }
  }
}

}  // namespace manyworlds::test
