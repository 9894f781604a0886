// Resistance against rolling and spinning: closed forms by every solver, on free bodies and on
// joints, and worlds that come to rest by it.
#include <catch2/catch.hpp>

#include <cmath>

#include "manyworlds/scenes.hpp"
#include "scenes/known_motion.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

using scenes::incline, scenes::kG;

constexpr Solver kSweeping[] = {Solver::tgs_soft, Solver::sequential_impulse, Solver::sor,
                                Solver::nncg, Solver::penalty};
constexpr double kRadius = 0.05;

Scene rolling_ball(Space space, double slope, double rolling) {
  Scene scene = incline(space, slope, 1, round_of(space, kRadius), kRadius);
  scene.bodies[1].shapes[0].material.rolling_resistance = rolling;
  return scene;
}
// I / (m r^2)
double lag_of(Space space) { return space == Space::planar ? 0.5 : 0.4; }
Vec3 rolling_spin(Space space, double speed) {
  return up_of(space).cross(Vec3(speed / kRadius, 0, 0));
}

}  // namespace

TEST_CASE("a ball slows down by what resists its rolling", "[fast][closed_form][resistance]") {
  for (const Space space : kSpaces) {
    for (const Solver solver : kSweeping) {
      Scene scene = rolling_ball(space, 0, 0.1 * kRadius);
      scene.options.solver.method = solver;
      scene.bodies[1].linear_velocity = Vec3(1, 0, 0);
      scene.bodies[1].angular_velocity = rolling_spin(space, 1);
      const double brake = 0.1 * kG / (1 + lag_of(space));  // stops after 1.4 or 1.5 s
      for (const Table& table : all_tables()) {
        Batch batch(compile(scene), options_of(table));
        batch.step(60);
        INFO(name(table) << ", " << to_string(solver));
        CHECK(velocity(batch, 0, 0).x() == Approx(1 - brake).epsilon(0.02));
        batch.step(60);
        CHECK(velocity(batch, 0, 0).norm() < 1e-3);
        CHECK(position(batch, 0, 0).x() == Approx(0.5 / brake).epsilon(0.01));
      }
    }
  }
}

TEST_CASE("a ball stays on slopes up to the quotient of resistance and radius",
          "[fast][closed_form][resistance]") {
  for (const Space space : kSpaces) {
    for (const double slope : {0.09, 0.11}) {
      const Scene scene = rolling_ball(space, std::atan(slope), 0.1 * kRadius);
      Batch batch(compile(scene), {.worlds = 3});
      const Vec3 start = position(batch, 0, 0);
      batch.step(600);
      const double way = (position(batch, 0, 0) - start).norm();
      const double pull = kG * std::cos(std::atan(slope)) * (slope - 0.1) / (1 + lag_of(space));
      if (slope < 0.1) {
        CHECK(way < 0.01 * kRadius);
      } else {
        CHECK(way == Approx(0.5 * pull * 100).epsilon(0.03));
      }
    }
  }
}

TEST_CASE("a top stops by torsional resistance, and not before",
          "[fast][closed_form][resistance]") {
  for (const Solver solver : kSweeping) {
    Scene scene = incline(Space::spatial, 0, 1, Sphere{kRadius}, kRadius);
    scene.bodies[1].shapes[0].material.torsional_resistance = 0.002;
    scene.bodies[1].angular_velocity = Vec3(0, 0, 20);
    scene.options.solver.method = solver;
    const double brake = 0.002 * kG / (0.4 * kRadius * kRadius);
    Batch batch(compile(scene), {.worlds = 2});
    batch.step(30);
    INFO(to_string(solver));
    CHECK(spin(batch, 0, 0).z() == Approx(20 - brake / 2).epsilon(0.01));
    batch.step(60);
    CHECK(spin(batch, 0, 0).norm() < 1e-3);
  }
}

// The wheels' resistance brakes the cart, whose mass is not all on them, by either method.
TEST_CASE("wheels on joints resist rolling", "[fast][closed_form][resistance]") {
  for (const JointMethod method : {JointMethod::sweep, JointMethod::tree}) {
    Scene scene = empty_scene(Space::planar);
    scene.options.joint.method = method;
    scene.add(ground(Space::planar, 1));
    const double radius = 0.25, rolling = 0.05;
    Body deck = body_of(shape_of(Polygon::box(0.8, 0.1)), Vec3(0, 0.5, 0));
    deck.linear_velocity = Vec3(2, 0, 0);
    const BodyId chassis = scene.add(deck);
    for (const double side : {-0.6, 0.6}) {
      Body wheel = body_of(shape_of(Circle{radius}, 1), Vec3(side, radius, 0));
      wheel.shapes[0].material.rolling_resistance = rolling;
      wheel.linear_velocity = Vec3(2, 0, 0), wheel.angular_velocity = Vec3(0, 0, -2 / radius);
      const BodyId id = scene.add(wheel);
      scene.add(
          joint_at(scene, chassis, id, scenes::frame_at(Vec3(side, radius, 0)), HingeJoint{}));
    }
    const auto mass = [&](int i) {
      return mass_properties(scene, scene.bodies[static_cast<std::size_t>(i)]).mass;
    };
    const double wheels = mass(2) + mass(3), all = mass(1) + wheels;
    const double brake = rolling / radius * 10 * all / (all + 0.5 * wheels);
    Batch batch(compile(scene), {.worlds = 2});
    batch.step(45);
    INFO(to_string(method));
    CHECK(velocity(batch, 0, 0).x() == Approx(2 - 0.75 * brake).epsilon(0.02));
    batch.step(75);
    CHECK(velocity(batch, 0, 0).norm() < 0.01);
  }
}

// Without friction nothing else turns the ball: its spin loses c m (1 + e) v / I.
TEST_CASE("impacts resist rolling by all that they press", "[fast][closed_form][resistance]") {
  for (const Space space : kSpaces) {
    for (const double e : {0.0, 0.5, 1.0}) {
      Scene scene = empty_scene(space, 0);
      scene.add(ground(space, 0, e));
      Body ball = body_of(shape_of(round_of(space, 0.5), 0, e), 0.6 * up_of(space));
      ball.shapes[0].material.rolling_resistance = 0.05;
      ball.linear_velocity = -4 * up_of(space);
      ball.angular_velocity = up_of(space).cross(Vec3(10, 0, 0));
      scene.add(ball);
      const double lost = 0.05 * (1 + e) * 4 / (lag_of(space) * 0.25);
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        batch.step(10);
        INFO(name(table) << ", e " << e);
        CHECK(velocity(batch, 0, 0).dot(up_of(space)) == approx(4 * e, 1e-3));
        CHECK(spin(batch, 0, 0).norm() == Approx(10 - lost).epsilon(1e-3));
      }
    }
  }
}

// Without friction nothing else turns balls that meet head on.
TEST_CASE("resistance keeps momentum", "[fast][resistance]") {
  for (const Space space : kSpaces) {
    Scene scene = empty_scene(space, 0);
    for (const double side : {-1.0, 1.0}) {
      Body ball = body_of(shape_of(round_of(space, 0.5), 0), Vec3(side * 0.6, 0, 0));
      ball.shapes[0].material.rolling_resistance = 0.2;
      if (space == Space::spatial) ball.shapes[0].material.torsional_resistance = 0.2;
      ball.linear_velocity = Vec3(-side, 0, 0);
      ball.angular_velocity =
          space == Space::planar ? Vec3(0, 0, 3 + side) : Vec3(2 * side, side, 3);
      scene.add(ball);
    }
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      const auto momentum = [&] {
        Vec3 out = Vec3::Zero();
        for (int i = 0; i < 2; ++i) {
          const auto m = mass_properties(scene, scene.bodies[static_cast<std::size_t>(i)]);
          out += m.mass * position(batch, 0, i).cross(velocity(batch, 0, i));
          out += m.inertia * spin(batch, 0, i);
        }
        return out;
      };
      const Vec3 before = momentum();
      const Vec3 spins = spin(batch, 0, 0) - spin(batch, 0, 1);
      batch.step(60);
      INFO(name(table));
      CHECK((momentum() - before).norm() < pick(table, 1e-5, 1e-10) * before.norm());
      CHECK((velocity(batch, 0, 0) + velocity(batch, 0, 1)).norm() < pick(table, 1e-6, 1e-12));
      CHECK((spin(batch, 0, 0) - spin(batch, 0, 1)).norm() < 0.9 * spins.norm());
    }
  }
}

TEST_CASE("piles of balls that resist rolling fall asleep", "[resistance]") {
  for (const char* id : {"bin2d", "bin-spheres"}) {
    Scene scene = scenes::find(id)->make();
    const double unit = *compile(scene).resolved().length_unit;
    for (Body& body : scene.bodies) {
      for (Shape& s : body.shapes) s.material.rolling_resistance = 0.02 * unit;
    }
    Batch batch(compile(scene), {.worlds = 4, .sleep = true});
    batch.step(1200);
    INFO(id);
    for (int i = 0; i < 4; ++i) CHECK(batch.asleep(i));
  }
}

}  // namespace manyworlds::test
