// Limits of ball joints in trees solved at once: cones and twists.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "manyworlds/scenes.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/joint_twin.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/random.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

double lean_of(const Quat& a, const Quat& b) {
  const Vec3 x = a * Vec3::UnitZ(), y = b * Vec3::UnitZ();
  return std::atan2(x.cross(y).norm(), x.dot(y));
}
double twist_of(const Quat& a, const Quat& b) {
  const Quat turn = a.conjugate() * b;
  return 2 * std::atan2(turn.w() < 0 ? -turn.z() : turn.z(), std::abs(turn.w()));
}
// Frames of a joint, now.
struct Ends {
  Quat a, b;
};
Ends ends_of(const Batch& batch, int world, const Joint& joint) {
  return {frame_now(batch, world, joint.body_a, joint.frame_a).rotation,
          frame_now(batch, world, joint.body_b, joint.frame_b).rotation};
}

Vec3 spin_of(const Batch& batch, int body) {
  std::vector<double> w(batch.size(Field::angular_velocity));
  batch.read(Field::angular_velocity, w);
  return Eigen::Map<const Vec3>(w.data() + 3 * body);
}

Quat z_along_x() { return Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitY())); }

// Rods of 1 kg and 0.5 m along x, the last one `load` kg, on ball joints whose cones open along x.
Scene cantilever(int rods, double load, const BallJoint& type) {
  Scene scene = tree_scene(Space::spatial);
  BodyId last;
  for (int i = 0; i < rods; ++i) {
    const double mass = i + 1 == rods ? load : 1;
    const BodyId rod = scene.add(uniform_rod(Space::spatial, mass, 0.5, {(i + 0.5) * 0.5, 0, 0}));
    scene.bodies.back().angular_drag = 3;
    scene.add(joint_at(scene, last, rod, at({i * 0.5, 0, 0}, z_along_x()), type));
    last = rod;
  }
  return scene;
}

// Up to eight bodies on ball joints alone, most of them near one of their limits, in motion.
Scene random_balls(Random& random) {
  Scene scene = tree_scene(Space::spatial);
  scene.options.dt = 1e-3, scene.options.substeps = 1;
  const int bodies = random.integer(2, 8);
  const bool anchored = random.chance(0.5);
  for (int i = 0; i < bodies; ++i) {
    const int hangs_on = i == 0 ? -1 : random.integer(0, i - 1);
    const Vec3 on = hangs_on < 0 ? Vec3(Vec3::Zero()) : scene.at(BodyId(hangs_on)).position;
    const double mass = std::pow(10, random.uniform(-1, 1.5));
    Vec3 inertia = Vec3::Constant(mass * std::pow(10, random.uniform(-2, -0.5)));
    inertia.x() *= random.uniform(1, 1.8);
    const BodyId body = scene.add(lump(scene.space, mass, inertia, on + random.in_cube(1)));
    scene.bodies.back().rotation = random.rotation();
    scene.bodies.back().linear_velocity = random.in_cube(5);
    if (hangs_on < 0 && !anchored) continue;
    const BodyId other = hangs_on < 0 ? BodyId{} : BodyId(hangs_on);
    const Frame frame{on + random.in_cube(0.5), random.rotation()};
    const bool reversed = other && random.chance(0.5);
    Joint joint = reversed ? joint_at(scene, body, other, frame, BallJoint{})
                           : joint_at(scene, other, body, frame, BallJoint{});
    const Quat off(Eigen::AngleAxisd(random.uniform(0.1, 1), random.direction()));
    joint.frame_b.rotation = joint.frame_b.rotation * off;
    BallJoint type;
    if (random.chance(0.7)) {
      type.cone = lean_of(Quat::Identity(), off) + random.uniform(0, 0.005);
    }
    if (random.chance(0.7)) {
      const double twist = twist_of(Quat::Identity(), off);
      type.twist = Limit{twist - random.uniform(0, 0.005), twist + random.uniform(0, 0.005), {}};
    }
    joint.type = type;
    scene.add(joint);
  }
  return scene;
}

}  // namespace

TEST_CASE("ball joints with limits move as the whole system of equations says", "[fast][joint]") {
  Random random(7);
  int acted = 0, limits = 0;
  for (int k = 0; k < 80; ++k) {
    const Scene scene = random_balls(random);
    JointTwin twin(scene);
    twin.step(scene.options.dt);
    for (const Joint& joint : scene.joints) {
      const auto& type = std::get<BallJoint>(joint.type);
      limits += type.cone.has_value() + type.twist.has_value();
    }
    acted += twin.acting();
    double fastest = 1;
    for (const TwinBody& b : twin.closing()) fastest = std::max(fastest, b.linear.norm());
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      REQUIRE(batch.plan().resolved().joint.method == JointMethod::tree);
      batch.step();
      double turned = 0, speed = 0;
      for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
        const TwinBody& end = twin.bodies()[static_cast<std::size_t>(i)];
        const Quat off = rotation(batch, 0, i) * end.rotation.conjugate();
        turned = std::max(turned, 2 * off.vec().norm());
        speed = std::max(speed, (velocity(batch, 0, i) - end.linear).norm());
      }
      INFO(name(table) << " tree " << k << " of " << scene.bodies.size() << ", fastest "
                       << fastest);
      CHECK(turned < pick(table, 2e-4, 1e-7) * fastest);
      CHECK(speed < pick(table, 1e-3, 2e-5) * fastest);
    }
  }
  CHECK(acted > limits / 4);
  CHECK(acted < limits * 3 / 4);
}

// Each rod leans by its cone against the one before, whatever hangs on the last.
TEST_CASE("rods under a load rest where their cones end", "[fast][joint]") {
  const double cone = 0.1;
  for (const double load : {1.0, 1000.0}) {
    for (const bool twist : {false, true}) {
      BallJoint type{cone, std::nullopt};
      if (twist) type.twist = Limit{-0.2, 0.2, {}};
      const Scene scene = cantilever(5, load, type);
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        batch.step(600);
        Vec3 tip = Vec3::Zero();
        for (int i = 1; i <= 5; ++i) {
          tip += (i < 5 ? 0.5 : 0.25) * Vec3(std::cos(cone * i), 0, -std::sin(cone * i));
        }
        INFO(name(table) << " load " << load << (twist ? " with twist" : ""));
        CHECK(batch.status(0) == Status::ok);
        CHECK((position(batch, 0, 4) - tip).norm() < 2e-4);
        CHECK(worst_gap(batch, 0) < 1e-5);
        for (const Joint& joint : scene.joints) {
          const Ends ends = ends_of(batch, 0, joint);
          CHECK(lean_of(ends.a, ends.b) == approx(cone, 1e-4));
        }
      }
    }
  }
}

// In a plane a cone is a hinge with limits.
TEST_CASE("a pendulum within a cone swings as on a limited hinge", "[fast][joint]") {
  if (!has_table(double_table())) return;
  const auto pendulum = [](const JointType& type, const Quat& frame) {
    Scene scene = tree_scene(Space::spatial);
    const BodyId rod = scene.add(uniform_rod(Space::spatial, 1, 1, {0.5, 0, 0}));
    scene.bodies.back().angular_velocity = {0, 0, 3};
    scene.options.gravity = {0, -10, 0};
    scene.add(joint_at(scene, {}, rod, at(Vec3::Zero(), frame), type));
    return scene;
  };
  const Scene ball = pendulum(BallJoint{0.4, std::nullopt}, z_along_x());
  const Scene hinge = pendulum(HingeJoint{Limit{-0.4, 0.4, {}}, {}}, Quat::Identity());
  const Table table = double_table();
  Batch a(compile(ball), options_of(table)), b(compile(hinge), options_of(table));
  double worst = 0, lean = 0;
  for (int i = 0; i < 60; ++i) {
    a.step(), b.step();
    worst = std::max(worst, (position(a, 0, 0) - position(b, 0, 0)).norm());
    const Ends ends = ends_of(a, 0, ball.joints[0]);
    lean = std::max(lean, lean_of(ends.a, ends.b));
  }
  CHECK(worst < 1e-5);
  CHECK(lean == approx(0.4, 1e-3));
}

TEST_CASE("ball joints with limits have the same bits wherever a world is", "[bits][fast][joint]") {
  Scene scene = cantilever(6, 20, BallJoint{0.3, Limit{-0.2, 0.2, {}}});
  for (Body& body : scene.bodies) body.jitter.linear_velocity = {1, 1, 1};
  check_same_bits(compile(scene), {JointId(2), JointId(5)});
  Scene doll = scenes::find("ragdoll")->make();
  doll.options.joint.method = JointMethod::tree;
  check_same_bits(compile(doll), {JointId(0), JointId(4), JointId(7)});
}

// A limit of the twist takes the spin of the child along as a whole: angular momentum stays.
TEST_CASE("a limit of the twist shares out the spin", "[fast][joint]") {
  Scene scene = empty_scene(Space::spatial, 0);
  scene.options.joint.method = JointMethod::tree;
  scene.add(lump(Space::spatial, 2, {0.3, 0.3, 0.4}, {0, 0, 0}));
  scene.add(lump(Space::spatial, 1, {0.1, 0.1, 0.1}, {0, 0, 1}));
  scene.bodies[1].angular_velocity = {0, 0, 5};
  scene.add(joint_at(scene, BodyId(0), BodyId(1), at({0, 0, 0.5}),
                     BallJoint{std::nullopt, Limit{-0.5, 0.5, {}}}));
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table));
    batch.step(3);
    CHECK(spin_of(batch, 1).z() == Approx(5));
    batch.step(30);
    const double shared = 0.1 * 5 / (0.4 + 0.1);
    INFO(name(table));
    for (const int b : {0, 1}) {
      CHECK((spin_of(batch, b) - shared * Vec3::UnitZ()).norm() < 1e-4);
    }
    const Ends ends = ends_of(batch, 0, scene.joints[0]);
    CHECK(twist_of(ends.a, ends.b) == approx(0.5, 1e-4));
  }
}

}  // namespace manyworlds::test
