// Trees of joints solved at once: what they hold that sweeps do not.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenes/loaded_trees.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Links of 1 kg and `length`, from the origin along x or downwards, the last one `load` kg.
Scene chain(Space space, int links, double length, double load, bool hangs, JointType type) {
  Scene scene = tree_scene(space);
  if (!hangs) {
    scenes::add_rods(scene, links, length, load, type);
    return scene;
  }
  for (int i = 0; i < links; ++i) {
    const double mass = i + 1 == links ? load : 1;
    const Vec3 down = -length * up_of(space);
    scene.add(lump(space, mass, Vec3::Constant(mass * length * length / 12), (i + 0.5) * down));
    scene.add(joint_at(scene, BodyId(i - 1), BodyId(i), at(i * down, hinge_axes(space)), type));
  }
  return scene;
}

}  // namespace

TEST_CASE("chains of light links keep together under any load", "[joint][slow]") {
  for (const double load : {1.0, 5.0, 10.0, 20.0, 60.0, 100.0, 1000.0}) {
    const double fall = (9 + load) * 10 * 5;  // m g L
    double lost = 0;
    int runs = 0;
    for (const Space space : kSpaces) {
      for (const Table& table : widest_tables()) {
        Batch batch(compile(chain(space, 10, 0.5, load, false, HingeJoint{})), options_of(table));
        const double start = energy_of(batch, 0);
        double gap = 0, gain = 0;
        for (int i = 0; i < 600; ++i) {
          batch.step();
          gap = std::max(gap, worst_gap(batch, 0));
          gain = std::max(gain, energy_of(batch, 0) - start);
        }
        const double of_run = (start - energy_of(batch, 0)) / fall;
        lost += of_run, ++runs;
        INFO(name(table) << " load " << load << " gap " << gap << " gain " << gain);
        CHECK(batch.status(0) == Status::ok);
        CHECK(gap < (load < 5 ? 0.03 : 0.01) * 0.5);  // swept over, links as heavy as the load lash
        // Symplectic Euler's energy swings by m g v h / 2, and falls at 8 m/s.
        CHECK(gain < 3.5e-3 * fall);
        CHECK(of_run < 0.5);
      }
    }
    // What chains lose where they are drawn taut. How they whip is chaotic, so the mean counts.
    INFO("load " << load << " lost " << lost / runs);
    CHECK(lost / runs < (load < 50 ? 0.5 : load < 500 ? 0.2 : 0.05));
  }
}

TEST_CASE("compact bodies on long arms rest", "[joint][fast]") {
  for (const Space space : kSpaces) {
    for (const double inertia : {1e-2, 1e-4, 1e-6}) {
      for (const JointType& type : {JointType(FixedJoint{}), JointType(HingeJoint{})}) {
        Scene scene = tree_scene(space);
        const bool welded = std::holds_alternative<FixedJoint>(type);
        const Vec3 place = welded ? Vec3(Vec3::UnitX()) : Vec3(-up_of(space));
        scene.add(lump(space, 1, Vec3::Constant(inertia), place));
        scene.add(joint_at(scene, {}, BodyId(0), at(Vec3::Zero(), hinge_axes(space)), type));
        for (const Table& table : widest_tables()) {
          Batch batch(compile(scene), options_of(table));
          const double start = energy_of(batch, 0);
          batch.step(300);
          INFO(name(table) << " inertia " << inertia << " type " << type.index());
          CHECK(worst_gap(batch, 0) < 1e-4);
          CHECK((position(batch, 0, 0) - place).norm() < 1e-4);
          CHECK(energy_of(batch, 0) - start < 1e-4);
        }
      }
    }
  }
}

TEST_CASE("a chain that hangs bears its weight from the first step on", "[joint][fast]") {
  for (const Space space : kSpaces) {
    for (const double share : {0.95, 1.05}) {
      Scene scene = chain(space, 10, 0.5, 100, true, HingeJoint{});
      scene.joints.front().break_force = share * 109 * 10;
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        batch.step(1);
        INFO(name(table) << " share " << share);
        CHECK(batch.joint_enabled(0, JointId(0)) == (share > 1));
        batch.step(120);
        CHECK(batch.joint_enabled(0, JointId(0)) == (share > 1));
        if (share > 1) CHECK(worst_gap(batch, 0) < 1e-4);
      }
    }
  }
}

TEST_CASE("what whirls bears m w^2 r", "[joint][fast]") {
  constexpr double kSpeed = 3, kRadius = 1.5, kMass = 2;
  for (const Space space : kSpaces) {
    for (const int substeps : {1, 4, 8}) {
      for (const double share : {0.97, 1.03}) {
        Scene scene = tree_scene(space);
        scene.options.gravity.setZero();
        scene.options.substeps = substeps;
        Body body = lump(space, kMass, Vec3::Constant(0.3), {kRadius, 0, 0});
        const Vec3 axis = hinge_axes(space) * Vec3::UnitZ();
        body.angular_velocity = kSpeed * axis;
        body.linear_velocity = body.angular_velocity.cross(body.position);
        scene.add(body);
        Joint joint =
            joint_at(scene, {}, BodyId(0), at(Vec3::Zero(), hinge_axes(space)), HingeJoint{});
        joint.break_force = share * kMass * kSpeed * kSpeed * kRadius;
        scene.add(joint);
        for (const Table& table : widest_tables()) {
          Batch batch(compile(scene), options_of(table));
          batch.step(120);
          INFO(name(table) << " substeps " << substeps << " share " << share);
          CHECK(batch.joint_enabled(0, JointId(0)) == (share > 1));
        }
      }
    }
  }
}

TEST_CASE("arms of ten driven hinges hold loads with any gain", "[joint][fast]") {
  for (const Space space : kSpaces) {
    for (const double gain : {200.0, 2000.0, 20000.0}) {
      for (const double load : {1.0, 10.0, 100.0}) {
        const Spring spring{gain, 0.1 * gain, 0, 0};
        const HingeJoint hinge{std::nullopt, Drive{0, 0, spring}};
        Batch batch(compile(chain(space, 10, 0.2, load, false, hinge)),
                    options_of(widest_tables().front()));
        const double start = energy_of(batch, 0);
        double gap = 0, most = start;
        for (int i = 0; i < 600; ++i) {
          batch.step();
          gap = std::max(gap, worst_gap(batch, 0));
          most = std::max(most, energy_of(batch, 0));
        }
        INFO("gain " << gain << " load " << load);
        CHECK(batch.status(0) == Status::ok);
        CHECK(gap < 1e-3);
        CHECK(most - start < 1e-3 * (9 + load) * 10 * 2);
        CHECK(max_speed(batch, 0) < 20);
      }
    }
  }
}

TEST_CASE("a motor in a tree turns with what it has, up to its speed", "[joint][fast]") {
  constexpr double kMoment = 0.5, kTorque = 2;
  for (const Space space : kSpaces) {
    for (const double way : {1.0, -1.0, 10.0}) {
      const double kSpeed = 3;
      for (const bool reversed : {false, true}) {
        Scene scene = tree_scene(space);
        scene.options.gravity.setZero();
        const BodyId wheel = scene.add(lump(space, 1, Vec3::Constant(kMoment), Vec3::Zero()));
        const HingeJoint hinge{std::nullopt, Drive{0, way * kSpeed, std::nullopt, kTorque}};
        const Frame frame = at(Vec3::Zero(), hinge_axes(space));
        if (reversed) {
          Body frame_body = lump(space, 1, Vec3::Constant(1), Vec3::Zero());
          frame_body.motion = Motion::kinematic;
          const BodyId fixed = scene.add(frame_body);
          scene.add(joint_at(scene, wheel, fixed, frame, hinge));
        } else {
          scene.add(joint_at(scene, {}, wheel, frame, hinge));
        }
        const double sign = reversed ? -way : way;
        for (const Table& table : widest_tables()) {
          Batch batch(compile(scene), options_of(table));
          const auto rate = [&] {
            const Vec3 w = spin(batch, 0, 0);
            return space == Space::planar ? w.z() : (hinge_axes(space) * Vec3::UnitZ()).dot(w);
          };
          INFO(name(table) << " way " << way << " reversed " << reversed);
          batch.step(30);
          const double torque_way = sign > 0 ? kTorque : -kTorque;
          CHECK(rate() == Approx(torque_way / kMoment * 0.5).epsilon(1e-3));
          batch.step(570);
          CHECK(rate() == Approx(sign * kSpeed).epsilon(1e-3));
        }
      }
    }
  }
}

TEST_CASE("limits in a tree stop what falls on them", "[joint][fast]") {
  for (const Space space : kSpaces) {
    for (const bool reversed : {false, true}) {
      Scene scene = tree_scene(space);
      const Vec3 place = Vec3::UnitX();
      const BodyId arm = scene.add(uniform_rod(space, 3, 2, place));
      const HingeJoint hinge{Limit{-0.5, 0.5, std::nullopt}, std::nullopt};
      const Frame frame = at(Vec3::Zero(), hinge_axes(space));
      Body carrier = lump(space, 1, Vec3::Constant(1), Vec3::Zero());
      carrier.motion = Motion::kinematic;
      const BodyId post = scene.add(carrier);
      scene.add(reversed ? joint_at(scene, arm, post, frame, hinge)
                         : joint_at(scene, post, arm, frame, hinge));
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        double deepest = 0;
        for (int i = 0; i < 240; ++i) {
          batch.step();
          const double angle = Eigen::AngleAxisd(rotation(batch, 0, 0)).angle();
          deepest = std::max(deepest, angle - 0.5);
        }
        INFO(name(table) << " reversed " << reversed << " deepest " << deepest);
        CHECK(deepest < 0.01);
        CHECK(Eigen::AngleAxisd(rotation(batch, 0, 0)).angle() == approx(0.5, 5e-3));
        CHECK(max_speed(batch, 0) < 1e-2);
      }
    }
  }
}

TEST_CASE("a motor does not drive through a limit", "[joint][fast]") {
  for (const Space space : kSpaces) {
    for (const double most : {5.0, std::numeric_limits<double>::infinity()}) {
      Scene scene = tree_scene(space);
      scene.options.gravity.setZero();
      scene.add(lump(space, 1, Vec3::Constant(0.5), Vec3::Zero()));
      const HingeJoint hinge{Limit{-1, 0.5, std::nullopt}, Drive{0, 3, std::nullopt, most}};
      scene.add(joint_at(scene, {}, BodyId(0), at(Vec3::Zero(), hinge_axes(space)), hinge));
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        double farthest = 0;
        for (int i = 0; i < 180; ++i) {
          batch.step();
          farthest = std::max(farthest, Eigen::AngleAxisd(rotation(batch, 0, 0)).angle());
        }
        INFO(name(table) << " most " << most << " farthest " << farthest);
        CHECK(farthest < 0.505);
        CHECK(farthest > 0.49);
        CHECK(spin(batch, 0, 0).norm() < 0.02);
      }
    }
  }
}

TEST_CASE("what hangs on a kinematic body goes with it", "[joint][fast]") {
  for (const Space space : kSpaces) {
    Scene scene = tree_scene(space);
    Body carrier = lump(space, 1, Vec3::Constant(1), Vec3::Zero());
    carrier.motion = Motion::kinematic;
    carrier.linear_velocity = {2, 0, 0};
    const BodyId post = scene.add(carrier);
    const BodyId body = scene.add(uniform_rod(space, 1, 1, {0.5, 0, 0}));
    scene.add(joint_at(scene, post, body, at(Vec3::Zero()), FixedJoint{}));
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      batch.step(60);
      INFO(name(table));
      CHECK((position(batch, 0, 1) - Vec3(2.5, 0, 0)).norm() < 1e-4);
      CHECK((velocity(batch, 0, 1) - Vec3(2, 0, 0)).norm() < 1e-4);
    }
  }
}

TEST_CASE("a joint that is disabled lets its branch of the tree fall", "[joint][fast]") {
  for (const Space space : kSpaces) {
    const Scene scene = chain(space, 6, 0.5, 1, true, HingeJoint{});
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 9));
      batch.set_joint_enabled(4, JointId(3), false);
      const double height = position(batch, 4, 3).dot(up_of(space));
      batch.step(30);
      INFO(name(table));
      for (int w = 0; w < 9; ++w) {
        const double fallen = height - position(batch, w, 3).dot(up_of(space));
        CHECK(fallen == approx(w == 4 ? 0.5 * 10 * 0.25 : 0, 0.03));
        CHECK(anchor_gap(batch, w, 2) < 1e-4);
        CHECK(anchor_gap(batch, w, 5) < 1e-4);
      }
    }
  }
}

TEST_CASE("the plan solves joints at once where that is worth it, and says why", "[joint][fast]") {
  std::string why;  // of the last one
  const auto method = [&why](Scene scene) {
    scene.options.joint.method = std::nullopt;
    const Plan plan = compile(scene);
    for (const PlanReport::Choice& choice : plan.report().choices) {
      if (choice.option != "joint.method") continue;
      why = choice.why;
      CHECK(why.find("solved at once") == 0);
    }
    return plan.resolved().joint.method;
  };
  for (const Space space : kSpaces) {
    CHECK(method(chain(space, 10, 0.5, 500, true, HingeJoint{})) == JointMethod::tree);
    CHECK(method(chain(space, 3, 0.5, 1, true, FixedJoint{})) == JointMethod::tree);
    CHECK_FALSE(method(chain(space, 3, 0.5, 1, true, HingeJoint{})).has_value());
    Scene loop = chain(space, 10, 0.5, 500, true, FixedJoint{});
    loop.add(joint_at(loop, {}, BodyId(9), at(Vec3::Zero()), FixedJoint{}));
    CHECK(method(loop) == JointMethod::tree);
    Scene breaks = loop;
    breaks.joints.back().break_force = 1e6;
    CHECK_FALSE(method(breaks).has_value());
    Scene apart = loop;
    apart.bodies[4].position += 0.1 * up_of(space);
    CHECK(method(apart) == JointMethod::tree);
    Scene row = chain(space, 33, 0.5, 1, false, HingeJoint{});
    row.options.gravity.setZero();  // no joint carries anything
    CHECK_FALSE(method(row).has_value());
    const Frame end = at(Vec3(16.5, 0, 0), hinge_axes(space));
    Scene tail = row;  // many joints, of which five make a loop
    tail.add(joint_at(tail, {}, BodyId(3), at(Vec3(2, 0, 0), hinge_axes(space)), HingeJoint{}));
    CHECK_FALSE(method(tail).has_value());
    Scene small = row;  // six in a loop, of which each falls by much of its size in a step
    small.bodies.resize(5), small.joints.resize(5);
    small.add(joint_at(small, {}, BodyId(4), at(Vec3(2.5, 0, 0), hinge_axes(space)), HingeJoint{}));
    CHECK_FALSE(method(small).has_value());
    small.options.gravity = 100 * -up_of(space);
    CHECK(method(small) == JointMethod::tree);
    CHECK(why.find("6 joints are connected in loops, which fall by") != std::string::npos);
    Scene arm = row;  // its motors count with the fastest speed that a control may set
    arm.bodies.resize(3), arm.joints.resize(3);
    for (Joint& joint : arm.joints) {
      std::get<HingeJoint>(joint.type).drive = Drive{.target_speed = 100, .max_force = 1};
    }
    CHECK_FALSE(method(arm).has_value());
    std::get<HingeJoint>(arm.joints[1].type).drive->max_force = 1e4;
    CHECK(method(arm) == JointMethod::tree);
    std::get<HingeJoint>(arm.joints[1].type).drive->target_speed = 0;
    CHECK_FALSE(method(arm).has_value());
    arm.add(Control{.joint = JointId(1), .low = -100, .high = 0});
    CHECK(method(arm) == JointMethod::tree);
    row.add(joint_at(row, {}, BodyId(32), end, HingeJoint{}));
    CHECK(method(row) == JointMethod::tree);
    Scene many = loop;
    for (const int body : {2, 4, 6, 8}) {
      many.add(joint_at(many, {}, BodyId(body), at(Vec3::Zero()), FixedJoint{}));
    }
    CHECK_FALSE(method(many).has_value());
    Scene touching = chain(space, 10, 0.5, 500, true, FixedJoint{});
    touching.add(
        body_of(shape_of(ground_of(space)), Vec3(0, 0, 0) - 20 * up_of(space), Motion::fixed));
    touching.bodies[3].shapes = {shape_of(cube_of(space, 0.1))};
    CHECK(method(touching) == JointMethod::tree);
    Scene compact = chain(space, 1, 1, 1, true, HingeJoint{});
    CHECK_FALSE(method(compact).has_value());
    compact.bodies[0].mass_properties->inertia *= 0.05;
    CHECK(method(compact) == JointMethod::tree);
    Scene uneven = tree_scene(space);  // no joint carries anything
    uneven.options.gravity.setZero();
    uneven.add(uniform_rod(space, 1, 1, Vec3::Zero()));
    uneven.add(uniform_rod(space, 40, 1, Vec3::UnitX()));
    uneven.add(joint_at(uneven, BodyId(0), BodyId(1), at({0.5, 0, 0}), HingeJoint{}));
    CHECK_FALSE(method(uneven).has_value());
    uneven.bodies[1].mass_properties->mass = 60;
    CHECK(method(uneven) == JointMethod::tree);
    Scene other = chain(space, 10, 0.5, 500, true, FixedJoint{});
    other.options.solver.method = Solver::sequential_impulse;
    CHECK_FALSE(method(other).has_value());
  }
}

}  // namespace manyworlds::test
