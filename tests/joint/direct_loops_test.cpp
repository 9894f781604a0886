// Loops of joints that are solved at once with the trees that they close.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/known_motion.hpp"
#include "scenes/makers.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

Batch batch_of(Scene scene, const Table& table) {
  scene.options.joint.method = JointMethod::tree;
  BatchOptions options = options_of(table, 8);
  options.audit_every = 1;
  return Batch(compile(scene), options);
}
void check_all(const Batch& batch, double gap) {
  for (int w = 0; w < batch.worlds(); ++w) {
    INFO("world " << w << ", gap " << worst_gap(batch, w));
    CHECK(batch.status(w) == Status::ok);
    CHECK(worst_gap(batch, w) < gap);
  }
}

// A bridge of planks between the world and what moves, boxes that fall on it, and a free square of
// sliders and hinges that falls beside it; some worlds let go of a joint that closes a loop.
Scene loops(Space space) {
  Scene scene = empty_scene(space, 9.81);
  scene.options.joint.method = JointMethod::tree;
  scene.add(ground(space));
  const Vec3 up = up_of(space), side = Vec3::UnitX();
  const Quat axes = hinge_axes(space);
  const auto box = [&](const Vec3& place, double half, double jitter) {
    Body body = body_of(shape_of(box_of(space, {half, 0.1, 0.1})), place);
    body.jitter.position = jitter * side;
    return scene.add(body);
  };
  Body bank = body_of(shape_of(box_of(space, {0.1, 0.1, 0.1})), 2 * up - 0.1 * side);
  bank.motion = Motion::kinematic;
  bank.linear_velocity = 0.2 * side;
  BodyId last = scene.add(bank);
  for (int i = 0; i < 6; ++i) {
    const BodyId plank = box(2 * up + (0.5 * i + 0.25) * side, 0.24, 0);
    const bool ball = space == Space::spatial && i % 2 == 1;
    const JointType type = ball ? JointType(BallJoint{}) : HingeJoint{};
    scene.add(joint_at(scene, last, plank, {2 * up + 0.5 * i * side, axes}, type));
    last = plank;
  }
  scene.add(joint_at(scene, {}, last, {2 * up + 3 * side, axes}, HingeJoint{}));
  for (int i = 0; i < 3; ++i) box(3 * up + (0.8 * i + 0.6) * side, 0.2, 0.3);
  BodyId corner[4];
  const Vec3 at_corner[] = {5 * side, 6 * side, 6 * side + up, 5 * side + up};
  for (int i = 0; i < 4; ++i) corner[i] = box(at_corner[i] + up, 0.2, 0);
  for (int i = 0; i < 4; ++i) {
    const JointType type = i % 2 == 0 ? JointType(HingeJoint{}) : SliderJoint{};
    const Vec3 middle = (at_corner[i] + at_corner[(i + 1) % 4]) / 2 + up;
    scene.add(joint_at(scene, corner[i], corner[(i + 1) % 4], {middle, axes}, type));
  }
  return scene;
}

}  // namespace

TEST_CASE("loops have the same bits wherever a world is", "[bits][fast][joint]") {
  for (const Space space : kSpaces) {
    const Plan plan = compile(loops(space));
    const auto joints = static_cast<int>(plan.scene().joints.size());
    check_same_bits(plan, {JointId(6), JointId(joints - 1)});
  }
}

// When they lie flat, one degree of freedom becomes n + 1, and the loops' rows depend on one
// another.
TEST_CASE("loops of four bars solved at once pass through where they lie flat", "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    for (const int n : {1, 2, 4}) {
      INFO(name(table) << ", loops " << n);
      Scene scene = scenes::loops_of_four_bars(n);
      scene.options.substeps = 4;
      Batch batch = batch_of(scene, table);
      REQUIRE(batch.plan().resolved().joint.method == JointMethod::tree);
      const double start = energy_of(batch, 0), lowest = -9.81 * (0.5 * (n + 1) + n);
      double gain = 0, tip = 0;
      Swing theta{9.81 * (0.5 * (n + 1) + n) / ((n + 1) / 3.0 + n), kPi / 2, -1};
      for (int i = 0; i < 300; ++i) {
        batch.step();
        theta.advance(scene.options.dt, 20);
        const Vec3 at = position(batch, 0, 0) + rotation(batch, 0, 0) * Vec3(0.5, 0, 0);
        tip = std::max(tip, (at - Vec3(std::cos(theta.angle), std::sin(theta.angle), 0)).norm());
        gain = std::max(gain, (energy_of(batch, 0) - start) / (start - lowest));
      }
      check_all(batch, 1e-3);
      INFO("tip " << tip << " m, gain " << gain);
      CHECK(gain < 0.02);
      CHECK(tip < 0.2);
    }
  }
}

// Planks in a line between two banks give way along themselves by nothing.
TEST_CASE("a taut bridge solved at once bears boxes", "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch = batch_of(scenes::bridge(), table);
    REQUIRE(batch.plan().resolved().joint.method == JointMethod::tree);
    batch.step(300);
    check_all(batch, 1e-4);
    for (int w = 0; w < batch.worlds(); ++w) CHECK(max_penetration(batch, w) < 0.01);
  }
}

// Straight and compressed between two anchors: closed, it sags by the root of what closes.
TEST_CASE("rows of links that begin apart close and hang as the catenary", "[joint][slow]") {
  constexpr int kLinks = 40;
  for (const double size : {0.01, 1.0}) {
    for (const double share : {0.9, 0.9875}) {
      const double span = share * kLinks * size;
      Scene scene = empty_scene(Space::planar, 10);
      for (int i = 0; i < kLinks; ++i) {
        const double x = (i + 0.5) * span / kLinks - span / 2;
        Body link = uniform_rod(Space::planar, 1, size, {x, 0, 0});
        link.linear_drag = link.angular_drag = 0.1 / std::sqrt(size);
        link.jitter.linear_velocity = {0, 0.01 * std::sqrt(size), 0};
        scene.add(link);
      }
      for (int i = 0; i <= kLinks; ++i) {
        Joint hinge;
        hinge.body_a = BodyId(i == kLinks ? -1 : i - 1);
        hinge.body_b = BodyId(i == kLinks ? i - 1 : i);
        hinge.frame_a.position.x() = i == 0 ? -span / 2 : i == kLinks ? span / 2 : size / 2;
        hinge.frame_b.position.x() = i == kLinks ? size / 2 : -size / 2;
        scene.add(hinge);
      }
      double low = 1e-3 * size, high = 1e6 * size;  // 2 a sinh(span / 2 a) = length
      for (int i = 0; i < 200; ++i) {
        const double a = std::sqrt(low * high);
        (2 * a * std::sinh(span / 2 / a) > kLinks * size ? low : high) = a;
      }
      const double right = low * (std::cosh(span / 2 / low) - 1);
      for (const Table& table : widest_tables()) {
        BatchOptions options = options_of(table, 8);
        options.audit_every = 1;
        Batch batch(compile(scene), options);
        CHECK(batch.plan().resolved().joint.method == JointMethod::tree);
        batch.step(1800);
        INFO(name(table) << " links of " << size << " m, span " << share);
        check_all(batch, 1e-3 * size);
        for (int w = 0; w < batch.worlds(); ++w) {
          double sag = 0;
          for (int i = 0; i < kLinks; ++i) sag = std::max(sag, -position(batch, w, i).y());
          INFO(name(table) << " links of " << size << " m, span " << share);
          CHECK(sag == Approx(right).epsilon(0.05));
        }
      }
    }
  }
}

TEST_CASE("a driven four-bar linkage solved at once stays closed", "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch = batch_of(scenes::four_bar(), table);
    for (int i = 0; i < 30; ++i) batch.step(10), check_all(batch, 1e-4);
  }
}

// Nothing in it gives way: the rows of its loop say nothing new at all.
TEST_CASE("a welded frame solved at once bears a hundred times its mass", "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    for (const Space space : kSpaces) {
      INFO(name(table) << (space == Space::planar ? " planar" : " spatial"));
      Scene scene = empty_scene(space, 10);
      const Vec3 up = up_of(space), side = Vec3::UnitX(), inertia = Vec3::Constant(0.1);
      const BodyId left = scene.add(lump(space, 1, inertia, 0.5 * up - side));
      const BodyId right = scene.add(lump(space, 1, inertia, 0.5 * up + side));
      const BodyId beam = scene.add(lump(space, 200, 200 * inertia, up));
      scene.add(joint_at(scene, {}, left, at(-side), FixedJoint{}));
      scene.add(joint_at(scene, {}, right, at(side), FixedJoint{}));
      scene.add(joint_at(scene, left, beam, at(up - side), FixedJoint{}));
      scene.add(joint_at(scene, right, beam, at(up + side), FixedJoint{}));
      Batch batch = batch_of(scene, table);
      REQUIRE(batch.plan().resolved().joint.method == JointMethod::tree);
      for (int i = 0; i < 60; ++i) batch.step(10), check_all(batch, 1e-5);
      CHECK((position(batch, 0, 2) - up).norm() < 1e-5);
      CHECK(velocity(batch, 0, 2).norm() < 1e-4);
    }
  }
}

// Hinges with parallel axes in space: three of the five rows that close the loop say nothing new.
TEST_CASE("a planar loop in space is closed by more than it takes", "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Scene scene = empty_scene(Space::spatial, 10);
    const Vec3 corner[] = {{0, 0, 0}, {0, 0, 1}, {2, 0, 1}, {2, 0, 0}};
    std::vector<BodyId> bar;
    for (int i = 0; i < 3; ++i) {
      bar.push_back(scene.add(
          lump(Space::spatial, 1, Vec3::Constant(0.05), (corner[i] + corner[i + 1]) / 2)));
    }
    for (int i = 0; i < 4; ++i) {
      const bool banks = i == 0 || i == 3;
      const BodyId a = banks ? BodyId{} : bar[static_cast<std::size_t>(i - 1)];
      const BodyId b = bar[static_cast<std::size_t>(std::min(i, 2))];
      scene.add(joint_at(scene, a, b, {corner[i], z_to_y()}, HingeJoint{}));
    }
    scene.at(bar[0]).linear_velocity = {0.5, 0, 0};
    scene.at(bar[1]).linear_velocity = {1, 0, 0};
    scene.at(bar[2]).linear_velocity = {0.5, 0, 0};
    Batch batch = batch_of(scene, table);
    REQUIRE(batch.plan().resolved().joint.method == JointMethod::tree);
    for (int i = 0; i < 60; ++i) batch.step(10), check_all(batch, 1e-3);
    CHECK(std::abs(position(batch, 0, 1).y()) < 1e-4);
  }
}

}  // namespace manyworlds::test
