// Closed loops of joints, more than are needed to hold them: IFToMM's N-four-bar (numerics.md A11),
// with large steps (B23, B25), and a redundant loop in space.
#include <catch2/catch.hpp>

#include <cmath>

#include "scenes/known_motion.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

struct LoopError {
  double tip = 0, gap = 0;  // m, largest over the run
  double gain = 0;          // of energy, largest, as a share of what moves
};
LoopError run(int n, double rate, double seconds) {
  // All loops stay parallel; when they lie flat, one degree of freedom becomes n + 1.
  Scene scene = scenes::loops_of_four_bars(n);
  scene.options.dt = 1 / rate;
  Batch batch(compile(scene), options_of(double_table()));
  // All uprights keep the same angle, from upright; energy 0 where they hang.
  Swing theta{9.81 * (0.5 * (n + 1) + n) / ((n + 1) / 3.0 + n), kPi / 2, -1};
  const double start = energy_of(batch, 0), lowest = -9.81 * (0.5 * (n + 1) + n);
  LoopError out;
  const int steps = static_cast<int>(seconds * rate + 0.5);
  for (int i = 0; i < steps; ++i) {
    batch.step();
    theta.advance(1 / rate, 20);
    const Vec3 tip = position(batch, 0, 0) + rotation(batch, 0, 0) * Vec3(0.5, 0, 0);
    out.tip =
        std::max(out.tip, (tip - Vec3(std::cos(theta.angle), std::sin(theta.angle), 0)).norm());
    out.gap = std::max(out.gap, worst_gap(batch, 0));
    out.gain = std::max(out.gain, (energy_of(batch, 0) - start) / (start - lowest));
  }
  REQUIRE(batch.status(0) == Status::ok);
  return out;
}

}  // namespace

TEST_CASE("loops of four bars stay closed, gain no energy and reach the 0.1 m level (A11)",
          "[slow][joint]") {
  if (!has_table(double_table())) return;
  for (const int n : {2, 40}) {
    const LoopError coarse = run(n, 240, n == 2 ? 20 : 5), fine = run(n, 960, n == 2 ? 20 : 5);
    INFO("N " << n << ": tip " << coarse.tip << ", " << fine.tip << " m, gap " << coarse.gap
              << " m, gain " << coarse.gain);
    CHECK(coarse.gap < 1e-3);
    CHECK(fine.gap < 1e-3);
    CHECK(coarse.gain < 2e-3);
    CHECK(fine.gain < 5e-4);
    CHECK(fine.tip < 0.1);
    CHECK(fine.tip < coarse.tip);
  }
}

TEST_CASE("loops of four bars live through large steps (B23, B25)", "[fast][joint]") {
  if (!has_table(double_table())) return;
  for (const double rate : {60.0, 100.0}) {
    const LoopError e = run(40, rate, 5);
    INFO("rate " << rate << ": gap " << e.gap << " m, gain " << e.gain);
    CHECK(e.gap < 5e-3);
    CHECK(e.gain < 1e-2);
  }
}

TEST_CASE("a redundant loop in space stays finite and closed (B23)", "[fast][joint]") {
  for (const Table& table : widest_tables()) {
    // A square of four rods on parallel hinges has one degree of freedom, and three rows too many;
    // welded at a corner it has none.
    Scene scene = empty_scene(Space::spatial, 10);
    const Vec3 corner[4] = {{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}};
    for (int i = 0; i < 4; ++i) {
      const Vec3 along = corner[(i + 1) % 4] - corner[i];
      Body rod = uniform_rod(Space::spatial, 1, 1, corner[i] + along / 2);
      rod.mass_properties->inertia = Vec3(0.02, 0.08, 0.08).asDiagonal();
      rod.rotation = rotation_to(Vec3::UnitX(), along);
      scene.add(rod);
    }
    for (int i = 0; i < 4; ++i) {
      const JointType type = i == 2 ? JointType(FixedJoint{}) : JointType(HingeJoint{});
      scene.add(joint_at(scene, BodyId((i + 3) % 4), BodyId(i), at(corner[i], z_to_y()), type));
    }
    scene.add(joint_at(scene, {}, BodyId(0), at(corner[0], z_to_y()), HingeJoint{}));
    Batch batch(compile(scene), options_of(table));
    const double start = energy_of(batch, 0);
    double gap = 0, most = start;
    for (int i = 0; i < 600; ++i) {
      batch.step();
      gap = std::max(gap, worst_gap(batch, 0));
      most = std::max(most, energy_of(batch, 0));
    }
    INFO(name(table) << " gap " << gap << " energy " << start << " to " << most);
    CHECK(batch.status(0) == Status::ok);
    CHECK(gap < 5e-3);
    // 40 N fall by up to 1.5 m.
    CHECK(most - start < 0.02 * 60);
  }
}

TEST_CASE("driven linkages of any size stay closed", "[fast][joint]") {
  for (const double size : {1e-3, 1e-2, 1.0, 100.0}) {  // m, of the crank
    const double speed = size > 1 ? 3 / std::sqrt(size) : 3;
    // Crank, coupler and rocker between two pivots; all bars of one material.
    const Vec3 pin[4] = {Vec3::Zero(), Vec3(0, size, 0), Vec3(2.5 * size, 2 * size, 0),
                         Vec3(3 * size, 0, 0)};
    Scene scene = empty_scene(Space::planar, 9.81);
    BodyId last;
    for (int i = 0; i < 3; ++i) {
      const Vec3 along = pin[i + 1] - pin[i];
      Body bar = uniform_rod(Space::planar, size * along.norm(), along.norm(), pin[i] + along / 2);
      bar.rotation = rotation_to(Vec3::UnitX(), along);
      const BodyId id = scene.add(bar);
      HingeJoint hinge;
      const double weight = 9.81 * size * size;
      if (i == 0) hinge.drive = Drive{.target_speed = speed, .max_force = 20 * weight * size};
      scene.add(joint_at(scene, last, id, at(pin[i]), hinge));
      last = id;
    }
    scene.add(joint_at(scene, {}, last, at(pin[3]), HingeJoint{}));
    const Plan plan = compile(scene);
    if (size < 0.1) {
      CHECK(plan.resolved().joint.method == JointMethod::tree);
      std::string why;
      for (const PlanReport::Choice& choice : plan.report().choices) {
        if (choice.option == "joint.method") why = choice.why;
      }
      CHECK(why.find("4 joints are connected in loops, which fall by") != std::string::npos);
    }
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table));
      double gap = 0;
      for (int i = 0; i < 600; ++i) {
        batch.step();
        gap = std::max(gap, worst_gap(batch, 0));
      }
      INFO(name(table) << ", crank of " << size << " m");
      CHECK(gap < 0.01 * size);
      CHECK(spin(batch, 0, 0).z() == approx(speed, 0.02 * speed));
    }
  }
}

}  // namespace manyworlds::test
