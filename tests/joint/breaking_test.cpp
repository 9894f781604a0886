// Joints that break and joints that are taken away.
#include <catch2/catch.hpp>

#include "tests/support/approx.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr double kGravity = 10;

// A weight of 2 kg that hangs still, 1 m below where it is held, by a joint of this type.
Scene hanging(Space space, JointType type, double break_force) {
  Scene scene = empty_scene(space, kGravity);
  const Vec3 up = up_of(space);
  scene.add(lump(space, 2, {0.2, 0.2, 0.2}, -up));
  Joint joint =
      joint_at(scene, {}, BodyId(0), at(Vec3::Zero(), hinge_axes(space)), std::move(type));
  joint.break_force = break_force;
  scene.add(joint);
  return scene;
}
double height(const Batch& batch, int world = 0, int body = 0) {
  return position(batch, world, body).dot(up_of(batch.plan().scene().space));
}
Joint rope_between(const Scene& scene, int a, int b, const Vec3& upper, const Vec3& lower) {
  Joint out = joint_at(scene, BodyId(a), BodyId(b), at(upper), DistanceJoint{});
  out.frame_b.position = lower - scene.bodies[static_cast<std::size_t>(b)].position;
  return out;
}

}  // namespace

TEST_CASE("a joint breaks under more than it bears, and holds under less", "[fast][joint]") {
  const double weight = 2 * kGravity;
  for (const Table& table : widest_tables()) {
    for (Space space : kSpaces) {
      for (const JointType& type : {JointType(HingeJoint{}), JointType(FixedJoint{})}) {
        INFO(name(table) << " type " << type.index());
        Batch holds(compile(hanging(space, type, 1.01 * weight)), options_of(table));
        holds.step(240);
        CHECK(holds.joint_enabled(0, JointId(0)));
        CHECK(holds.status(0) == Status::ok);
        CHECK(height(holds) == approx(-1, 1e-3));

        Batch breaks(compile(hanging(space, type, 0.99 * weight)), options_of(table));
        breaks.step(4);
        CHECK_FALSE(breaks.joint_enabled(0, JointId(0)));
        CHECK(breaks.status(0) == Status::joint_broken);
        CHECK_FALSE(lost(breaks.status(0)));
        const double y = height(breaks);
        breaks.step(60);
        const Vec3 v = velocity(breaks, 0, 0);
        CHECK(-v.dot(up_of(space)) == Approx(kGravity * 63.5 / 60).epsilon(0.02));
        CHECK(height(breaks) == approx(y - 5.6, 0.3));
      }
    }
  }
}

TEST_CASE("a weld breaks by torque: a beam that is clamped at its end", "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    for (Space space : kSpaces) {
      // 3 kg whose centre is 0.5 m out: 15 N m, and a third more while it settles.
      for (const double most : {14.7, 22.0}) {
        Scene scene = empty_scene(space, kGravity);
        scene.add(uniform_rod(space, 3, 1, {0.5, 0, 0}));
        Joint weld = joint_at(scene, {}, BodyId(0), at(Vec3::Zero()), FixedJoint{});
        weld.break_torque = most;
        scene.add(weld);
        Batch batch(compile(scene), options_of(table));
        batch.step(120);
        INFO(name(table) << " most " << most);
        CHECK(batch.joint_enabled(0, JointId(0)) == (most > 15));
      }
    }
  }
}

TEST_CASE("of a chain that is too heavy the uppermost joint breaks, and the rest falls as one",
          "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    for (Space space : kSpaces) {
      Scene scene = empty_scene(space, kGravity);
      const Vec3 up = up_of(space);
      constexpr int kLinks = 8;
      for (int i = 0; i < kLinks; ++i) {
        scene.add(lump(space, 1, {0.01, 0.01, 0.01}, -(i + 0.5) * 0.2 * up));
        Joint joint = joint_at(scene, BodyId(i - 1), BodyId(i),
                               at(-i * 0.2 * up, hinge_axes(space)), HingeJoint{});
        joint.break_force = 75;  // the uppermost bears 80 N, the next 70
        scene.add(joint);
      }
      Batch batch(compile(scene), options_of(table));
      batch.step(30);
      INFO(name(table));
      CHECK_FALSE(batch.joint_enabled(0, JointId(0)));
      for (int j = 1; j < kLinks; ++j) CHECK(batch.joint_enabled(0, JointId(j)));
      // Nothing was thrown up: all fall side by side.
      const double fall = -velocity(batch, 0, 0).dot(up);
      for (int i = 1; i < kLinks; ++i) {
        CHECK(-velocity(batch, 0, i).dot(up) == approx(fall, 0.05));
      }
    }
  }
}

TEST_CASE("what one world breaks leaves the bits of its neighbours alone", "[fast][joint][bits]") {
  for (const Table& table : all_tables()) {
    const Plan plan = compile(hanging(Space::spatial, HingeJoint{}, 50));
    Batch alone(plan, options_of(table, 9)), pulled(plan, options_of(table, 9));
    for (int i = 0; i < 60; ++i) {
      if (i > 20) pulled.add_force(4, pulled.body_in_row(0), {0, 0, -40});
      alone.step(), pulled.step();
    }
    for (int w = 0; w < 9; ++w) {
      INFO(name(table) << " world " << w);
      CHECK(pulled.joint_enabled(w, JointId(0)) == (w != 4));
      if (w != 4) CHECK(pulled.hash(w) == alone.hash(w));
    }
    CHECK(pulled.lost_worlds() == 0);
    std::vector<std::uint8_t> mask(9, 0);
    mask[4] = 1;
    pulled.reset(mask);
    CHECK(pulled.joint_enabled(4, JointId(0)));
    CHECK(pulled.status(4) == Status::ok);
  }
}

TEST_CASE("a broken joint stays broken through snapshots and copies", "[fast][joint][bits]") {
  const Table table = widest_tables().front();
  const Plan plan = compile(hanging(Space::spatial, HingeJoint{}, 50));
  Batch batch(plan, options_of(table, 5));
  batch.add_force(2, batch.body_in_row(0), {0, 0, -40});
  batch.step(3);
  REQUIRE_FALSE(batch.joint_enabled(2, JointId(0)));
  const Snapshot saved = batch.save();
  batch.copy_world(2, 0);
  Batch other(plan, options_of(table, 5));
  other.restore(saved);
  batch.step(20), other.step(20);
  CHECK_FALSE(batch.joint_enabled(0, JointId(0)));
  CHECK_FALSE(other.joint_enabled(2, JointId(0)));
  CHECK(other.joint_enabled(0, JointId(0)));
  CHECK(batch.hash(0) == batch.hash(2));
  CHECK(other.hash(2) == batch.hash(2));
}

TEST_CASE("joints are taken away and put back by hand", "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    for (Space space : kSpaces) {
      // Nothing here may break: masks are made by the call.
      const Scene scene = hanging(space, HingeJoint{}, std::numeric_limits<double>::infinity());
      Batch batch(compile(scene), options_of(table, 3));
      batch.step(10);
      batch.set_joint_enabled(1, JointId(0), false);
      batch.step(6);
      INFO(name(table));
      CHECK(height(batch, 0) == approx(-1, 1e-3));
      CHECK(height(batch, 1) < -1.03);
      CHECK(batch.status(1) == Status::ok);  // it did not break
      batch.set_joint_enabled(1, JointId(0), true);
      batch.step(120);
      CHECK(anchor_gap(batch, 1, 0) < 1e-2);
      CHECK_THROWS_WITH(batch.set_joint_enabled(0, JointId(1), false),
                        Catch::Contains("joint is 1, must be 0 to 0"));
    }
  }
}

TEST_CASE("what hangs still and asleep wakes and falls when its joint is cut", "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    Scene scene = empty_scene(Space::spatial, kGravity);
    scene.add(lump(Space::spatial, 2, {0.2, 0.2, 0.2}, {0, 0, -1}));
    scene.add(lump(Space::spatial, 2, {0.2, 0.2, 0.2}, {0, 0, -2}));
    scene.add(rope_between(scene, -1, 0, {0, 0, 0}, {0, 0, -1}));
    scene.add(rope_between(scene, 0, 1, {0, 0, -1}, {0, 0, -2}));
    scene.joints[1].break_force = 25;
    BatchOptions options = options_of(table, 3);
    options.sleep = true;
    Batch batch(compile(scene), options);
    batch.step(200);
    INFO(name(table));
    REQUIRE(batch.asleep(0, batch.body_in_row(1)));
    batch.set_joint_enabled(0, JointId(1), false);
    batch.add_force(1, batch.body_in_row(1), {0, 0, -6});
    batch.step(30);
    CHECK(height(batch, 0, 1) < -2.5);
    CHECK_FALSE(batch.joint_enabled(1, JointId(1)));
    CHECK(height(batch, 1, 1) < -2.5);
    CHECK(height(batch, 2, 1) == approx(-2, 0.01));
    CHECK(batch.asleep(2));
  }
}

TEST_CASE("a slow body does not fall asleep in the step in which its joint breaks",
          "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    Scene scene = hanging(Space::spatial, DistanceJoint{1.0, {}, {}}, 20.5);
    scene.options.sleep.time = 1.0 / 60;
    BatchOptions options = options_of(table);
    options.sleep = true;
    Batch batch(compile(scene), options);
    batch.add_force(0, batch.body_in_row(0), {0, 0, -1});
    batch.step();
    REQUIRE_FALSE(batch.joint_enabled(0, JointId(0)));
    CHECK_FALSE(batch.asleep(0, batch.body_in_row(0)));
    batch.step(30);
    CHECK(height(batch) < -1.5);
  }
}

TEST_CASE("a world that goes wrong in the step in which its joint would break keeps it",
          "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    Scene scene = hanging(Space::spatial, HingeJoint{}, 50);
    scene.options.joint.method = JointMethod::sweep;  // by a tree it bears that, and breaks
    Batch batch(compile(scene), options_of(table, 3));
    batch.step(5);
    const std::uint64_t before = batch.hash(1);
    batch.add_force(1, batch.body_in_row(0), {0, 0, -1e30});
    batch.step();
    INFO(name(table));
    CHECK(frozen(batch.status(1)));
    CHECK_FALSE(has(batch.status(1), Status::joint_broken));
    CHECK(batch.joint_enabled(1, JointId(0)));
    CHECK(batch.hash(1) == before);
    CHECK(batch.joint_enabled(0, JointId(0)));
  }
}

TEST_CASE("what a broken joint would bear is read as nothing", "[fast][joint]") {
  const Table table = widest_tables().front();
  BatchOptions options = options_of(table, 2);
  options.observe.what = {Observer::joint_loads};
  Batch batch(compile(hanging(Space::spatial, HingeJoint{}, 50)), options);
  batch.add_force(1, batch.body_in_row(0), {0, 0, -40});
  batch.step(2);
  std::vector<double> force(batch.size(Observed::joint_force));
  batch.read(Observed::joint_force, force);
  CHECK(force[2] == Approx(20).epsilon(0.02));
  CHECK(force[5] == 0);
}

TEST_CASE("what joints bear at most is checked", "[fast][scene]") {
  Scene scene = hanging(Space::spatial, HingeJoint{}, -1);
  scene.joints[0].break_torque = std::nan("");
  const auto issues = validate(scene);
  REQUIRE(issues.size() == 2);
  CHECK(to_string(issues[0]) == "joint 0: break_force is -1 N, must be > 0");
  CHECK(to_string(issues[1]) == "joint 0: break_torque is nan N m, must be > 0");
}

}  // namespace manyworlds::test
