// Pendulums and chains of hinges against elliptic integrals and quadruple-precision references.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Rods of 1 kg and 1 m in a row along x, the first hinged to the world at the origin.
Scene rods(Space space, int count, double dt) {
  Scene scene = empty_scene(space, 9.81);
  scene.options.dt = dt;
  for (int i = 0; i < count; ++i) {
    scene.add(uniform_rod(space, 1, 1, {i + 0.5, 0, 0}));
    scene.add(joint_at(scene, BodyId(i - 1), BodyId(i),
                       at({static_cast<double>(i), 0, 0}, hinge_axes(space)), HingeJoint{}));
  }
  return scene;
}

// Angle of a rod from hanging down, rad.
double angle_from_down(const Batch& batch, int body) {
  const Vec3 along = rotation(batch, 0, body) * Vec3::UnitX();
  const double up = along.dot(up_of(space_of(batch)));
  return std::atan2(along.x(), -up);
}
// What a point of 1 kg on a rod of 1 m does that begins level, seen every half second (A7).
struct PointError {
  double position = 0, gap = 0, gain = 0;  // m, m, J; largest over the run
};
PointError swing_point(Space space, double rate, double seconds) {
  Scene scene = empty_scene(space, 9.81);
  scene.options.dt = 1 / rate;
  scene.add(lump(space, 1, {0.01, 0.01, 0.01}, {1, 0, 0}));
  Joint rod;
  rod.type = DistanceJoint{};
  rod.body_b = BodyId(0);
  scene.add(rod);
  Batch batch(compile(scene), options_of(double_table()));
  Swing swing{9.81, 0, 0};
  const double start = energy_of(batch, 0);
  const int between = static_cast<int>(rate / 2 + 0.5);
  PointError out;
  for (int i = 0; i < static_cast<int>(2 * seconds); ++i) {
    for (int k = 0; k < between; ++k) {
      batch.step();
      out.gap = std::max(out.gap, std::abs(position(batch, 0, 0).norm() - 1));
    }
    swing.advance(0.5, 500);
    const Vec3 there = Vec3::UnitX() * std::cos(swing.angle) + up_of(space) * std::sin(swing.angle);
    out.position = std::max(out.position, (position(batch, 0, 0) - there).norm());
    out.gain = std::max(out.gain, energy_of(batch, 0) - start);
  }
  REQUIRE(batch.status(0) == Status::ok);
  return out;
}

double turn_of(double angle) { return std::remainder(angle, 2 * kPi); }

}  // namespace

TEST_CASE("a rod on a hinge swings as the elliptic integral says", "[fast][joint]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(rods(space, 1, 1.0 / 240));
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table));
      INFO(name(table) << (space == Space::planar ? " planar" : " spatial"));
      const double start = energy_of(batch, 0);
      double gap = 0, energy = 0;
      for (int i = 0; i < 2400; ++i) {
        batch.step();
        gap = std::max(gap, worst_gap(batch, 0));
        energy = std::max(energy, std::abs(energy_of(batch, 0) - start));
      }
      // Three times the error of minimal coordinates with symplectic Euler.
      CHECK(std::abs(turn_of(angle_from_down(batch, 0) - 0.770957622574773133)) < 3 * 9.6e-3);
      CHECK(gap < 1e-4);
      CHECK(energy < 0.03 * 9.81 * 0.5);
    }
  }
}

TEST_CASE("a double pendulum follows its quadruple-precision reference", "[fast][joint]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(rods(space, 2, 1.0 / 960));
    for (const Table& table : widest_tables()) {
      if (table.precision != Precision::f64) continue;
      Batch batch(plan, options_of(table));
      INFO(name(table) << (space == Space::planar ? " planar" : " spatial"));
      batch.step(960);
      CHECK(std::abs(turn_of(angle_from_down(batch, 0) + 1.20771623819064)) < 5e-3);
      CHECK(std::abs(turn_of(angle_from_down(batch, 1) + 0.814391023091296)) < 5e-3);
      batch.step(960);
      CHECK(std::abs(turn_of(angle_from_down(batch, 0) + 0.0827583068205708)) < 2e-2);
      CHECK(std::abs(turn_of(angle_from_down(batch, 1) - 0.407362074911907)) < 2e-2);
    }
  }
}

TEST_CASE("a point on a rod swings as the elliptic integral says", "[fast][joint]") {
  if (!has_table(double_table())) return;
  for (Space space : {Space::planar, Space::spatial}) {
    const PointError e = swing_point(space, 240, 100);
    INFO("off " << e.position << " m, gap " << e.gap << " m, gain " << e.gain << " J");
    CHECK(e.position < 1e-2);
    CHECK(e.gap < 1e-3);
    CHECK(e.gain < 2e-3 * 9.81);
  }
}

TEST_CASE("a point on a rod is within 0.1 m after 2000 s (A7)", "[slow][joint]") {
  if (!has_table(double_table())) return;
  // After 845 swings; a period is 5e-6 of itself off.
  const PointError e = swing_point(Space::planar, 960, 2000);
  INFO("off " << e.position << " m, gap " << e.gap << " m, gain " << e.gain << " J");
  CHECK(e.position < 0.1);
  CHECK(e.gap < 1e-4);
  CHECK(e.gain < 5e-4 * 9.81);
}

}  // namespace manyworlds::test
