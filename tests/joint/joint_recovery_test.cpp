// Joints that begin far apart, carry far more than they weigh, or are shaken.
#include <catch2/catch.hpp>

#include <cmath>

#include "manyworlds/scenes.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// A circle or sphere of 0.2 m that collides with nothing.
BodyId add_bead(Scene& scene, const Vec3& position) {
  Body bead = body_of(shape_of(round_of(scene.space, 0.2)), position);
  bead.shapes[0].filter.mask = 0;
  return scene.add(bead);
}
JointType free_joint(Space space) {
  return space == Space::planar ? JointType(HingeJoint{}) : JointType(BallJoint{});
}

}  // namespace

TEST_CASE("a chain whose joints begin a metre apart contracts gently", "[fast][joint]") {
  for (Space space : kSpaces) {
    // Without gravity: a hanging one lashes faster than it contracts.
    Scene scene = empty_scene(space, 0);
    scene.options.joint.pull_speed = 1;
    scene.options.substeps = 8;
    for (int i = 0; i < 40; ++i) {
      const BodyId bead = add_bead(scene, {2.0 * i, 0, 0});
      Joint joint;
      joint.type = free_joint(space);
      joint.body_a = BodyId(i - 1), joint.body_b = bead;
      joint.frame_a.position = {i == 0 ? -0.5 : 0.5, 0, 0};
      joint.frame_b.position = {-0.5, 0, 0};
      scene.add(joint);
    }
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table));
      INFO(name(table) << (space == Space::planar ? " planar" : " spatial"));
      double fastest = 0;
      for (int i = 0; i < 180; ++i) {
        batch.step();
        fastest = std::max(fastest, max_speed(batch, 0));
      }
      CHECK(fastest < 50);
      CHECK(worst_gap(batch, 0) < 1e-2);
    }
  }
}

TEST_CASE("a ball of 672 links' mass swings on its chain", "[joint]") {
  Scene scene = empty_scene(Space::planar, 10);
  scene.options.density = 20;
  scene.options.substeps = 12;  // 4 let its links come 0.24 m apart, 8 0.06 m
  constexpr int kLinks = 40;
  const Quat along_x(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
  for (int i = 0; i <= kLinks; ++i) {
    const bool ball = i == kLinks;
    Body link = body_of(shape_of(ball ? Geometry(Circle{8}) : Geometry(Capsule{0.125, 0.5})),
                        Vec3(ball ? kLinks + 8 : i + 0.5, 0, 0));
    if (!ball) link.shapes[0].rotation = along_x;
    link.shapes[0].filter.mask = 0;
    link.linear_drag = link.angular_drag = 0.1;
    const BodyId body = scene.add(link);
    scene.add(
        joint_at(scene, BodyId(i - 1), body, at({static_cast<double>(i), 0, 0}), HingeJoint{}));
  }
  const Plan plan = compile(scene);
  for (const Table& table : widest_tables()) {
    Batch batch(plan, options_of(table));
    INFO(name(table));
    double worst = 0, fastest = 0;
    for (int i = 0; i < 600; ++i) {
      batch.step();
      worst = std::max(worst, worst_gap(batch, 0));
      fastest = std::max(fastest, max_speed(batch, 0));
    }
    CHECK(worst < 0.05);
    CHECK(fastest < 60);  // free fall from 48 m: 31 m/s, and the lashing tail
  }
}

TEST_CASE("every joint lives through half a minute of shaking", "[joint]") {
  constexpr int kSeeds = 8;
  for (Space space : kSpaces) {
    std::vector<JointType> types = {
        HingeJoint{},
        HingeJoint{Limit{-0.5, 0.5, std::nullopt}, Drive{0.3, 0, Spring{100, 5, 0, 0}, 50}},
        SliderJoint{Limit{-0.5, 0.5, std::nullopt}, std::nullopt},
        FixedJoint{},
        DistanceJoint{},
        DistanceJoint{1.0, Limit{0.5, 1.5, std::nullopt}, Spring{0, 0, 3, 0.5}},
        WheelJoint{Spring{0, 0, 3, 0.5}, Limit{-0.3, 0.3, std::nullopt},
                   Drive{0, 5, std::nullopt, 10}},
        TargetJoint{Spring{0, 0, 5, 1}, 1e4},
    };
    if (space == Space::spatial) types.push_back(BallJoint{0.5, Limit{-0.3, 0.3, std::nullopt}});
    for (std::size_t k = 0; k < types.size(); ++k) {
      Scene scene = empty_scene(space, 10);
      for (int i = 0; i < 3; ++i) {
        scene.add(lump(space, 1, {0.1, 0.15, 0.2}, {static_cast<double>(i), 0, 0}));
        scene.add(joint_at(scene, BodyId(i - 1), BodyId(i), at({i - 0.5, 0, 0}), types[k]));
        if (std::holds_alternative<DistanceJoint>(types[k])) {
          scene.joints.back().frame_b.position = {0.5, 0, 0};
        }
      }
      const Plan plan = compile(scene);
      for (const Table& table : widest_tables()) {
        INFO(name(table) << (space == Space::planar ? " planar" : " spatial") << " type " << k);
        const bool holds = std::holds_alternative<HingeJoint>(types[k]) ||
                           std::holds_alternative<FixedJoint>(types[k]) ||
                           std::holds_alternative<BallJoint>(types[k]);
        double gaps = 0;
        for (int seed = 0; seed < kSeeds; ++seed) {
          Batch batch(plan, options_of(table));
          Random random(static_cast<std::uint64_t>(seed));
          double fastest = 0;
          for (int i = 0; i < 1800; ++i) {
            for (int b = 0; b < 3; ++b) {
              Vec3 force = random.in_cube(100);
              if (space == Space::planar) force.z() = 0;
              batch.add_force(0, batch.body_in_row(b), force);
              batch.add_torque(0, batch.body_in_row(b), Vec3(0, 0, random.uniform(-10, 10)));
            }
            batch.step();
            fastest = std::max(fastest, max_speed(batch, 0));
          }
          CHECK(batch.status(0) == Status::ok);
          CHECK(fastest < 100);
          batch.step(5);
          gaps += worst_gap(batch, 0);
          if (holds) CHECK(worst_gap(batch, 0) < 0.05);
        }
        // The gap of one moment of shaking is anything up to three times the mean.
        if (holds) CHECK(gaps / kSeeds < 0.015);
      }
    }
  }
}

TEST_CASE("bodies that begin with another keep their places on it", "[fast][batch][joint]") {
  for (const char* name : {"car2d", "lunar-lander", "ragdoll"}) {
    const Plan plan = compile(scenes::find(name)->make());
    const Scene& scene = plan.scene();
    Batch batch(plan, options_of(widest_tables().front(), 20));
    const BodyId leader = scene.bodies.back().jitter.with;
    REQUIRE(leader);
    const Body& first = scene.at(leader);
    const int b = plan.row(leader);
    CHECK((position(batch, 3, b) - position(batch, 4, b)).norm() > 0.01);
    for (int w = 0; w < batch.worlds(); ++w) {
      INFO(name << " world " << w);
      CHECK(worst_gap(batch, w) < 1e-5);
      for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
        const Body& body = scene.bodies[static_cast<std::size_t>(i)];
        if (body.jitter.with != leader) continue;
        const int s = plan.row(BodyId(i));
        const Vec3 held =
            rotation(batch, w, b).conjugate() * (position(batch, w, s) - position(batch, w, b));
        CHECK((held - (body.position - first.position)).norm() < 1e-5);
        CHECK((velocity(batch, w, s) - body.linear_velocity -
               (velocity(batch, w, b) - first.linear_velocity))
                  .norm() < 1e-5);
      }
    }
  }
}

TEST_CASE("a heavy cart stands still on light wheels (B24)", "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    // 1000 kg on two wheels of 1.6 kg each, under 22 m/s^2.
    Scene scene = empty_scene(Space::planar, 22);
    scene.options.substeps = 12;
    scene.options.contact.frequency = 240;
    scene.options.contact.push_out_speed = 0.5;
    scene.options.joint.frequency = 240;
    scene.options.joint.damping_ratio = 0;
    scene.add(ground(Space::planar));
    Body chassis = body_of(shape_of(Polygon::box(1, 0.25)), {0, 0.6, 0});
    chassis.shapes[0].density = 1000;
    const BodyId cart = scene.add(chassis);
    for (const double x : {-0.8, 0.8}) {
      Body wheel = body_of(shape_of(Circle{0.1}), {x, 0.1, 0});
      wheel.shapes[0].density = 50;
      const BodyId body = scene.add(wheel);
      // Gives way by 5 cm.
      const WheelJoint suspension{Spring{2.2e5, 1.2e4, 0, 0}, Limit{-0.2, 0.2, {}}, {}};
      const Quat up(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
      scene.add(joint_at(scene, cart, body, at({x, 0.1, 0}, up), suspension));
    }
    Batch batch(compile(scene), options_of(table));
    batch.step(120);
    const double rest = position(batch, 0, 0).y();
    INFO(name(table) << " rests at " << rest);
    CHECK(rest == approx(0.55, 0.01));
    double low = rest, high = rest;
    for (int i = 0; i < 600; ++i) {
      batch.step();
      low = std::min(low, position(batch, 0, 0).y()),
      high = std::max(high, position(batch, 0, 0).y());
      for (const int wheel : {1, 2}) CHECK(position(batch, 0, wheel).y() > 0.08);
    }
    CHECK(high - low < 2e-3);
    CHECK(velocity(batch, 0, 0).norm() < 0.01);
  }
}

TEST_CASE("a bridge of 160 links hangs as the catenary (B19)", "[slow][joint]") {
  const Table table = double_table();
  if (!has_table(table)) return;
  // 160 m of links over 158 m, with 64 substeps; with 4 a row so long sags half as much again.
  constexpr int kLinks = 160;
  constexpr double kSpan = 158;
  Scene scene = empty_scene(Space::planar, 10);
  scene.options.substeps = 64;
  for (int i = 0; i < kLinks; ++i) {
    Body link =
        body_of(shape_of(Polygon::box(0.5, 0.125)), {(i + 0.5) * kSpan / kLinks - kSpan / 2, 0, 0});
    link.shapes[0].density = 20;
    link.shapes[0].filter.mask = 0;
    link.linear_drag = link.angular_drag = 0.1;
    scene.add(link);
  }
  for (int i = 0; i <= kLinks; ++i) {
    Joint hinge;
    hinge.body_a = BodyId(i == kLinks ? -1 : i - 1);
    hinge.body_b = BodyId(i == kLinks ? i - 1 : i);
    hinge.frame_a.position = {i == 0 ? -kSpan / 2 : i == kLinks ? kSpan / 2 : 0.5, 0, 0};
    hinge.frame_b.position = {i == kLinks ? 0.5 : -0.5, 0, 0};
    scene.add(hinge);
  }
  Batch batch(compile(scene), options_of(table));
  batch.step(1800);
  double sag = 0;
  for (int i = 0; i < kLinks; ++i) sag = std::max(sag, -position(batch, 0, i).y());
  // 2 a sinh(span / 2a) = length.
  double low = 1, high = 1e6;
  for (int i = 0; i < 200; ++i) {
    const double a = std::sqrt(low * high);
    (2 * a * std::sinh(kSpan / 2 / a) > kLinks ? low : high) = a;
  }
  CHECK(sag == Approx(low * (std::cosh(kSpan / 2 / low) - 1)).epsilon(0.05));
  CHECK(worst_gap(batch, 0) < 1e-3);
}

}  // namespace manyworlds::test
