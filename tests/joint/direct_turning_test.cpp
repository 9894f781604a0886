// Chains that turn as a whole under heavy loads: geometric stiffness does not brake them.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/joints.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr int kLinks = 10;
constexpr double kLink = 0.1;  // m

// Links along x from `from` on, the first of them on `holder`; the last body. `about`: share of a
// link's moments that it has about itself.
BodyId add_links(Scene& scene, BodyId holder, double from, double mass, const JointType& type,
                 double about = 0.03) {
  BodyId last = holder;
  const double across = mass * kLink * kLink / 12;
  for (int i = 0; i < kLinks; ++i) {
    const double x = from + i * kLink;
    const BodyId link =
        scene.add(lump(scene.space, mass, {about * across, across, across}, {x + kLink / 2, 0, 0}));
    scene.add(joint_at(scene, last, link, at({x, 0, 0}, hinge_axes(scene.space)), type));
    last = link;
  }
  return last;
}
std::vector<JointType> types_of(Space space) {
  if (space == Space::planar) return {HingeJoint{}};
  return {HingeJoint{}, BallJoint{}};
}

}  // namespace

TEST_CASE("a load of 10^3 and 10^4 links swings as a pendulum does", "[joint][fast]") {
  for (const Space space : kSpaces) {
    for (const JointType& type : types_of(space)) {
      for (const double ratio : {1e3, 1e4}) {
        Scene scene = tree_scene(space);
        const BodyId last = add_links(scene, {}, 0, 1 / ratio, type);
        const BodyId ball = scene.add(lump(space, 1, Vec3::Constant(1e-3), {kLinks * kLink, 0, 0}));
        const Vec3 end{kLinks * kLink, 0, 0};
        scene.add(joint_at(scene, last, ball, at(end, hinge_axes(space)), type));
        for (const Table& table : widest_tables()) {
          Batch batch(compile(scene), options_of(table));
          Swing swing{10 / (kLinks * kLink), 0, 0};
          double off = 0;
          const double start = energy_of(batch, 0);
          double lowest = 0;
          for (int i = 0; i < 64; ++i) {  // to the other side
            batch.step();
            swing.advance(1.0 / 60, 10);
            const Vec3 where(std::cos(swing.angle), 0, 0);
            const Vec3 now = position(batch, 0, kLinks);
            const double height = now.dot(up_of(space));
            off = std::max(off, std::hypot(now.x() - where.x(), height - std::sin(swing.angle)));
            lowest = std::min(lowest, energy_of(batch, 0) - start);
          }
          INFO(name(table) << (space == Space::planar ? " planar" : " spatial") << " ratio "
                           << ratio << " off " << off << " m, loses " << -lowest << " J of 10");
          CHECK(batch.status(0) == Status::ok);
          CHECK(off < 0.015);
          // Symplectic Euler's energy swings by m g v h / 2, and falls at 4 m/s.
          CHECK(lowest > -0.1);
        }
      }
    }
  }
}

// Some touch the ground on the way, some let go of their load.
TEST_CASE("loads that swing have the same bits wherever a world is", "[bits][fast][joint]") {
  for (const Space space : kSpaces) {
    Scene scene = tree_scene(space);
    scene.add(ground(space));
    for (const double x : {0.0, 3.0}) {
      const Vec3 hook = 1.05 * up_of(space) + x * Vec3::UnitX();
      BodyId last;
      for (int i = 0; i < 4; ++i) {
        const Vec3 from = hook + i * 0.2 * Vec3::UnitX();
        Body link = uniform_rod(space, 0.01, 0.2, from + 0.1 * Vec3::UnitX());
        link.jitter.linear_velocity = {0.3, 0.3, 0};
        const BodyId id = scene.add(link);
        scene.add(joint_at(scene, last, id, at(from, hinge_axes(space)), HingeJoint{}));
        last = id;
      }
      const Vec3 end = hook + 0.8 * Vec3::UnitX();
      Body ball = body_of(shape_of(round_of(space, 0.2)), end);
      const BodyId id = scene.add(ball);
      scene.add(joint_at(scene, last, id, at(end, hinge_axes(space)), HingeJoint{}));
    }
    check_same_bits(compile(scene), {JointId(4), JointId(7)});
  }
}

namespace {
// Two balls that whirl about the middle of a chain, without gravity, at 4 rad/s.
Scene whirl(Space space, const JointType& type, double about) {
  constexpr double kSpeed = 4, kMass = 20;  // rad/s, kg
  Scene scene = tree_scene(space);
  scene.options.gravity.setZero();
  const double half = kLinks * kLink / 2;
  const auto ball = [&](double x) {
    return scene.add(lump(space, kMass, Vec3::Constant(0.01), {x, 0, 0}));
  };
  const BodyId last = add_links(scene, ball(-half), -half, 0.02, type, about), other = ball(half);
  scene.add(joint_at(scene, last, other, at({half, 0, 0}, hinge_axes(space)), type));
  for (Body& body : scene.bodies) {
    body.angular_velocity = kSpeed * (hinge_axes(space) * Vec3::UnitZ());
    body.linear_velocity = body.angular_velocity.cross(body.position);
  }
  return scene;
}
}  // namespace

TEST_CASE("balls that whirl about each other on a light chain keep on", "[joint][fast]") {
  for (const Space space : kSpaces) {
    for (const JointType& type : types_of(space)) {
      for (const double about : {0.03, 0.1}) {
        const Scene scene = whirl(space, type, about);
        for (const Table& table : widest_tables()) {
          Batch batch(compile(scene), options_of(table));
          const double energy = energy_of(batch, 0), turn = momenta(batch, 0).angular.norm();
          batch.step(600);
          INFO(name(table) << (space == Space::planar ? " planar " : " spatial ") << about);
          CHECK(batch.status(0) == Status::ok);
          CHECK(momenta(batch, 0).angular.norm() == Approx(turn).epsilon(2e-3));
          CHECK(energy_of(batch, 0) == Approx(energy).epsilon(4e-3));
          CHECK(worst_gap(batch, 0) < 1e-2 * kLink);
        }
      }
    }
  }
}

}  // namespace manyworlds::test
