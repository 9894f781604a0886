// The same scene of round bodies in both spaces: with equal mass properties the planar engine and
// the spatial one must move alike in the plane.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

struct Ball {
  double radius;
  Vec3 position, velocity;  // z = 0
  double spin;              // about z
  double mass;
};

// Both scenes have y up, so that the planar axes are the spatial ones.
Scene scene_of(Space space, const std::vector<Ball>& balls, const Vec3& gravity, bool grounded,
               double friction, double restitution) {
  Scene scene = empty_scene(space);
  scene.options.gravity = gravity;
  for (const Ball& b : balls) {
    Body body = body_of(shape_of(round_of(space, b.radius), friction, restitution), b.position);
    MassProperties m;
    m.mass = b.mass;
    m.inertia = 0.45 * b.mass * b.radius * b.radius * Mat3::Identity();
    body.mass_properties = m;
    body.linear_velocity = b.velocity;
    body.angular_velocity = Vec3(0, 0, b.spin);
    scene.add(body);
  }
  if (grounded) {
    Shape floor = shape_of(ground_of(space), friction, restitution);
    if (space == Space::spatial) floor.geometry = Plane{Vec3(0, 1, 0), 0};
    scene.add(body_of(floor, Vec3::Zero(), Motion::fixed));
  }
  return scene;
}

void compare(const std::vector<Ball>& balls, const Vec3& gravity, bool grounded, double friction,
             double restitution) {
  for (Isa isa : available_isas()) {
    const Table table{isa, Precision::f64};
    if (!has_table(table)) continue;
    Batch flat(compile(scene_of(Space::planar, balls, gravity, grounded, friction, restitution)),
               options_of(table));
    Batch full(compile(scene_of(Space::spatial, balls, gravity, grounded, friction, restitution)),
               options_of(table));
    for (int n = 1; n <= 30; ++n) {
      flat.step();
      full.step();
      for (int i = 0; i < static_cast<int>(balls.size()); ++i) {
        INFO(name(table) << " step " << n << " ball " << i);
        const Vec3 x = position(full, 0, i), v = velocity(full, 0, i), w = spin(full, 0, i);
        REQUIRE((position(flat, 0, i) - x).norm() < 1e-8);
        REQUIRE((velocity(flat, 0, i) - v).norm() < 1e-8);
        REQUIRE((spin(flat, 0, i) - w).norm() < 1e-8);
        const Quat between = rotation(flat, 0, i).conjugate() * rotation(full, 0, i);
        REQUIRE(between.vec().norm() < 1e-8);
      }
    }
  }
}

}  // namespace

TEST_CASE("planar and spatial balls fly alike", "[fast][planar_spatial]") {
  compare({{0.5, {0, 5, 0}, {1, 2, 0}, 3, 2}, {0.2, {3, 6, 0}, {-1, 0, 0}, -5, 0.3}}, {0, -10, 0},
          false, 0.6, 0);
}

TEST_CASE("planar and spatial balls roll alike", "[fast][planar_spatial]") {
  compare({{0.5, {0, 0.5, 0}, {3, 0, 0}, 0, 2}, {0.2, {3, 0.2, 0}, {0, 0, 0}, -30, 0.3}},
          {2, -9, 0}, true, 0.3, 0);
}

TEST_CASE("planar and spatial balls bounce alike", "[fast][planar_spatial]") {
  compare({{0.5, {0, 0.9, 0}, {2, -3, 0}, 4, 2}, {0.3, {3, 0.5, 0}, {-1, -4, 0}, -9, 0.5}},
          {0, -10, 0}, true, 0.4, 0.7);
}

TEST_CASE("planar and spatial balls collide alike", "[fast][planar_spatial]") {
  compare({{0.5, {0, 2, 0}, {4, 0, 0}, 4, 2},
           {0.3, {1.3, 2.2, 0}, {-1, -1, 0}, -9, 0.5},
           {0.4, {0.4, 3.2, 0}, {0, -3, 0}, 1, 1}},
          {0, -10, 0}, true, 0.5, 0.5);
  compare({{0.5, {0, 2, 0}, {4, 0, 0}, 4, 2}, {0.3, {1.3, 2.2, 0}, {-1, -1, 0}, -9, 0.5}},
          {0, 0, 0}, false, 0.5, 0);
}

TEST_CASE("planar and spatial piles settle alike", "[fast][planar_spatial]") {
  compare({{0.5, {0, 0.5, 0}, {0, 0, 0}, 0, 1},
           {0.5, {1.02, 0.5, 0}, {0, 0, 0}, 0, 1},
           {0.5, {0.48, 1.4, 0}, {0, 0, 0}, 0, 1}},
          {0, -10, 0}, true, 0.6, 0);
}

TEST_CASE("planar and spatial joints move alike", "[fast][planar_spatial][joint]") {
  // A hinge with a motor, one with a limit, a slider with a spring and a rope, in the plane y up.
  const auto scene_with = [](Space space) {
    Scene scene = empty_scene(space);
    scene.options.gravity = {1, -10, 0};
    const auto rod = [&](double x, double y) {
      Body body = lump(space, 1.5, {0.1, 0.1, 0.1}, {x, y, 0});
      body.angular_velocity = {0, 0, 2 - x};
      return scene.add(body);
    };
    const BodyId a = rod(0.5, 0), b = rod(1.5, 0.1), c = rod(2.4, 0.3), d = rod(0, -1);
    const auto join = [&](BodyId first, BodyId second, const Vec3& where, JointType type) {
      scene.add(joint_at(scene, first, second, at(where), std::move(type)));
    };
    join({}, a, {0, 0, 0}, HingeJoint{std::nullopt, Drive{0, 3, std::nullopt, 4}});
    join(a, b, {1, 0, 0}, HingeJoint{Limit{-0.05, 0.02, std::nullopt}, std::nullopt});
    join(b, c, {2, 0.2, 0}, SliderJoint{std::nullopt, Drive{0.1, 0, Spring{40, 1, 0, 0}}});
    join({}, d, {0, 0, 0}, DistanceJoint{});
    scene.joints.back().frame_b.position.setZero();  // a rod of 1 m to the middle of the body
    return scene;
  };
  for (const Isa isa : available_isas()) {
    const Table table{isa, Precision::f64};
    if (!has_table(table)) continue;
    Batch flat(compile(scene_with(Space::planar)), options_of(table));
    Batch full(compile(scene_with(Space::spatial)), options_of(table));
    for (int n = 1; n <= 30; ++n) {
      flat.step(), full.step();
      for (int i = 0; i < 4; ++i) {
        INFO(name(table) << " step " << n << " body " << i);
        REQUIRE((position(flat, 0, i) - position(full, 0, i)).norm() < 1e-8);
        REQUIRE((velocity(flat, 0, i) - velocity(full, 0, i)).norm() < 1e-7);
        REQUIRE((spin(flat, 0, i) - spin(full, 0, i)).norm() < 1e-7);
      }
    }
  }
}

}  // namespace manyworlds::test
