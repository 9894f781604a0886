// Rods, ropes, springs, pulleys and targets on bodies of trees that are solved at once.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include "scenes/loaded_trees.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/random.hpp"
#include "tests/support/same_bits.hpp"

namespace manyworlds::test {
namespace {

DistanceJoint rope(double length) { return {std::nullopt, Limit{0, length, {}}, {}}; }

BodyId hang(Scene& scene, BodyId on, const Vec3& at_body, const Vec3& load, double mass,
            const DistanceJoint& by) {
  const BodyId body = add_ball(scene, load, mass);
  Joint joint;
  joint.type = by, joint.body_a = on, joint.body_b = body;
  joint.frame_a.position = at_body;
  scene.add(joint);
  return body;
}

// A trolley, an arm with a servo, a limit and a hand that may come off, and all that hangs on them.
Scene crane(Space space) {
  Scene scene = tree_scene(space);
  const Vec3 up = up_of(space);
  scene.add(ground(space));
  const auto box = [&](const Vec3& center, double mass) {
    Body body = body_of(shape_of(cube_of(space, 0.1)), center + 3 * up);
    body.shapes[0].density = mass / (space == Space::planar ? 0.04 : 0.008);
    body.jitter.linear_velocity = Vec3(1, 0, 0);
    return scene.add(body);
  };
  const auto joint = [&](BodyId a, BodyId b, const Vec3& place, const JointType& type) {
    return scene.add(joint_at(scene, a, b, {place + 3 * up, hinge_axes(space)}, type));
  };
  const BodyId trolley = box({0, 0, 0}, 2), arm = box({1, 0, 0}, 1), hand = box({2, 0, 0}, 0.1);
  joint({}, trolley, {0, 0, 0}, SliderJoint{Limit{-0.5, 0.5, {}}, std::nullopt});
  joint(trolley, arm, {0.5, 0, 0},
        HingeJoint{Limit{-0.3, 0.3, {}}, Drive{0, 0, Spring{1e4, 500}, 80}});
  joint(arm, hand, {1.5, 0, 0}, HingeJoint{});
  const Vec3 low = 2 * up;
  hang(scene, hand, Vec3::Zero(), 2 * Vec3::UnitX() + low, 5, rope(1.2));
  hang(scene, arm, Vec3::Zero(), Vec3::UnitX() + low, 1, DistanceJoint{});
  hang(scene, trolley, Vec3::Zero(), low, 1, DistanceJoint{1, std::nullopt, Spring{300, 5}});
  Joint stay;  // which holds the arm up
  stay.type = rope(1.2), stay.body_a = trolley, stay.body_b = arm;
  scene.add(stay);
  Joint pulley;
  const Vec3 high = 5 * up;
  pulley.type = PulleyJoint{2 * Vec3::UnitX() + high, -Vec3::UnitX() + high, 1, {}};
  pulley.body_a = hand, pulley.body_b = add_ball(scene, -Vec3::UnitX() + 3 * up, 2);
  scene.add(pulley);
  Joint target;
  target.type = TargetJoint{Spring{50, 5}, 20}, target.body_b = hand;
  target.frame_a.position = 2 * Vec3::UnitX() + 3.5 * up;
  scene.add(target);
  return scene;
}

// Lengths in units of `size`, and times in those of its fall.
struct Arm {
  Scene scene;
  BodyId tip, load;
  double length = 0;  // m, from the tip to the load at rest
};
// Up to three links held straight by servos that deflect by a thousandth, and a load at the end.
Arm loaded_arm(Random& random, Space space, int kind, double size, double ratio) {
  constexpr double kDeflection = 1e-3;  // rad
  Arm out;
  Scene& scene = out.scene = empty_scene(space, 10);
  const double tick = std::sqrt(size);
  scene.options.dt *= tick;
  const double mass = std::pow(size, 3) * random.uniform(100, 2000), load = ratio * mass;
  const int links = random.integer(1, 3);
  for (int i = 0; i < links; ++i) {
    const Vec3 inertia = Vec3::Constant(mass * size * size / 12);
    out.tip = scene.add(lump(space, mass, inertia, (i + 0.5) * size * Vec3::UnitX()));
    double moment = 10 * load * (links - i) * size;
    for (int k = i; k < links; ++k) moment += 10 * mass * (k - i + 0.5) * size;
    const Spring servo{moment / kDeflection, 0.05 * tick * moment / kDeflection};
    const Frame frame{i * size * Vec3::UnitX(), hinge_axes(space)};
    const BodyId on = i == 0 ? BodyId{} : BodyId(i - 1);
    scene.add(joint_at(scene, on, out.tip, frame, HingeJoint{std::nullopt, Drive{0, 0, servo}}));
  }
  const double drop = random.uniform(0.3, 2) * size, stretch = 0.1 * size;
  const double stiffness = 10 * load / stretch;
  out.length = kind == 2 ? drop + stretch : drop;
  const DistanceJoint by =
      kind == 0 ? DistanceJoint{}
      : kind == 1
          ? rope(drop)
          : DistanceJoint{drop, std::nullopt, Spring{stiffness, std::sqrt(stiffness * load)}};
  const Vec3 end = links * size * Vec3::UnitX();
  out.load =
      hang(scene, out.tip, 0.5 * size * Vec3::UnitX(), end - out.length * up_of(space), load, by);
  return out;
}

}  // namespace

TEST_CASE("what hangs on trees has the same bits wherever a world is", "[bits][fast][joint]") {
  for (const Space space : kSpaces) {
    const Scene scene = crane(space);
    check_same_bits(compile(scene), {JointId(2), JointId(1), JointId(3), JointId(6)});
  }
}

TEST_CASE("attached joints leave trees to be solved at once", "[fast][joint][plan]") {
  for (const Space space : kSpaces) {
    const PlanReport report = compile(crane(space)).report();
    const auto joints =
        std::find_if(report.stages.begin(), report.stages.end(),
                     [](const PlanReport::Item& stage) { return stage.name == "joints"; });
    REQUIRE(joints != report.stages.end());
    CHECK(joints->why == "3 solved at once, 6 attached to these");
    Random random(7);
    const Plan plan = compile(loaded_arm(random, space, 1, 1, 100).scene);
    CHECK(plan.resolved().joint.method == JointMethod::tree);  // for the load on the rope
  }
}

TEST_CASE("loads of any mass hang still on arms of any size", "[fast][joint]") {
  Random random(48);
  for (const Space space : kSpaces) {
    for (int k = 0; k < 60; ++k) {
      const int kind = k % 3;
      const double size = std::pow(10, random.uniform(-2, 1)),
                   ratio = std::pow(10, random.uniform(0, 3));
      const Arm arm = loaded_arm(random, space, kind, size, ratio);
      for (const Table& table : widest_tables()) {
        INFO(name(table) << ' ' << (space == Space::planar ? "planar" : "spatial") << " kind "
                         << kind << ", size " << size << " m, ratio " << ratio << ", "
                         << arm.scene.joints.size() - 1 << " links");
        Batch batch(compile(arm.scene), options_of(table));
        batch.step(300);
        const auto last = static_cast<int>(arm.scene.joints.size()) - 1;
        const double length = anchor_gap(batch, 0, last);
        CHECK(std::abs(length - arm.length) < 0.01 * size);
        const Vec3 moved = position(batch, 0, arm.load.index()) - arm.scene.at(arm.load).position;
        CHECK(moved.norm() < 0.02 * size);
        CHECK(velocity(batch, 0, arm.load.index()).norm() < 1e-2 * std::sqrt(10 * size));
      }
    }
  }
}

// Symplectic Euler's energy swings by m g v h / 2, and the load falls at 9 m/s.
TEST_CASE("loads that swing on a chain by a rod or rope gain no energy", "[fast][joint]") {
  constexpr int kLinks = 6;
  for (const Space space : kSpaces) {
    for (const DistanceJoint& by : {DistanceJoint{}, rope(1)}) {
      for (const double load : {1.0, 10.0, 100.0, 1000.0}) {
        Scene scene = tree_scene(space);
        scenes::add_rods(scene, kLinks, 0.5, 1, HingeJoint{});
        const Vec3 end = 0.5 * kLinks * Vec3::UnitX();
        hang(scene, BodyId(kLinks - 1), 0.25 * Vec3::UnitX(), end + Vec3::UnitX(), load, by);
        const double fall = 10 * (4 * load + kLinks * 1.5);  // J
        for (const Table& table : widest_tables()) {
          INFO(name(table) << " load " << load << ", rope " << by.limit.has_value());
          Batch batch(compile(scene), options_of(table));
          const double start = energy_of(batch, 0);
          double gain = 0;
          for (int i = 0; i < 600; ++i) {
            batch.step();
            gain = std::max(gain, energy_of(batch, 0) - start);
          }
          CHECK(batch.status(0) == Status::ok);
          CHECK(gain < 4e-3 * fall);
        }
      }
    }
  }
}

}  // namespace manyworlds::test
