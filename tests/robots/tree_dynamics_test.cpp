// Smooth dynamics of trees: against a twin of other equations, closed forms, and the laws of bits.
#include <catch2/catch.hpp>

#include <limits>

#include "tests/support/approx.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tree_bits.hpp"

namespace manyworlds::test {
namespace {

using kernels::TreeJointKind;
using Numbers = TreeTwin::Numbers;

// Two rods of 1 m and 1 kg on hinges about y, hanging from the world.
std::vector<TwinLink> double_pendulum() {
  std::vector<TwinLink> links(2);
  for (int i = 0; i < 2; ++i) {
    TwinLink& link = links[static_cast<std::size_t>(i)];
    link.frame.body = i, link.frame.parent = i - 1;
    link.frame.position = Vec3(0, 0, i == 0 ? 0 : -1);
    link.frame.center = {0, 0, -0.5};
    link.frame.moments = Vec3(1, 1, 0.01) / 12;
    link.joints = {{TreeJointKind::hinge, Vec3::Zero(), Vec3::UnitY()}};
  }
  return links;
}

template <class Real>
void check_accelerations(const kernels::Kernels<Real>& kernels, double tolerance, bool by_links) {
  constexpr double kDt = 0.01;
  for (int trial = 0; trial < 30; ++trial) {
    INFO(kernels.isa << ", trial " << trial << (by_links ? ", by links" : ", in joint space"));
    Random random(static_cast<std::uint64_t>(100 + trial));
    const TreeTwin twin(random_trees(random, 30, random.chance(0.5) ? 0.3 : 3), {1, -2, -9});
    TreeGroup<Real> group(kernels, twin.links(), {1, -2, -9}, kDt, by_links);
    std::vector<TreeState> states;
    for (int lane = 0; lane < group.lanes(); ++lane) {
      states.push_back(random_state(random, twin));
      group.set(lane, states.back().q, states.back().v);
    }
    group.step(1);
    for (int lane = 0; lane < group.lanes(); ++lane) {
      INFO("lane " << lane);
      const auto& [q, v] = states[static_cast<std::size_t>(lane)];
      REQUIRE(group.status(lane) == 0);
      const Eigen::MatrixXd m =
          twin.inertia(q) + kDt * Eigen::MatrixXd(twin.damping().asDiagonal());
      const Numbers a = (group.velocity(lane) - v) / kDt, f = twin.forces(q, v);
      // What is left, against what adds up in each row.
      const Numbers left = (m * a - f).cwiseAbs(), sums = m.cwiseAbs() * a.cwiseAbs() +
                                                          f.cwiseAbs() +
                                                          m.cwiseAbs() * v.cwiseAbs() / kDt;
      CHECK((left.array() / sums.array()).maxCoeff() < tolerance);
      const Numbers next = twin.advanced(q, group.velocity(lane), kDt);
      for (int c = 0; c < next.size(); ++c) {
        // A quaternion that was not unit is made so.
        CHECK(group.position(lane)[c] == approx(next[c], tolerance));
      }
    }
  }
}

template <class Real>
void check_bodies(const kernels::Kernels<Real>& kernels, double tolerance) {
  for (int trial = 0; trial < 20; ++trial) {
    INFO(kernels.isa << ", trial " << trial);
    Random random(static_cast<std::uint64_t>(500 + trial));
    const TreeTwin twin(random_trees(random, 20, 1), Vec3::Zero());
    TreeGroup<Real> group(kernels, twin.links(), Vec3::Zero(), 0.01);
    const TreeState s = random_state(random, twin);
    for (int lane = 0; lane < group.lanes(); ++lane) group.set(lane, s.q, s.v);
    group.place();
    const auto expected = twin.motion(s.q, s.v, Numbers::Zero(twin.dofs()));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const NewLink& frame = twin.links()[i].frame;
      const TwinMotion& m = expected[i];
      const double far = 1 + m.center.norm(), fast = 1 + m.velocity.norm() + m.spin.norm() * far;
      CHECK((group.body(0, frame.body, 0, 3) - m.center).norm() < tolerance * far);
      const Numbers q = group.body(0, frame.body, 9, 4);
      const Mat3 rotation = Quat(q[0], q[1], q[2], q[3]).toRotationMatrix();
      const Mat3 axes = m.rotation * frame.principal.toRotationMatrix();
      CHECK((rotation - axes).norm() < 10 * tolerance);
      CHECK((group.body(0, frame.body, 3, 3) - m.velocity).norm() < tolerance * fast);
      CHECK((group.body(0, frame.body, 6, 3) - m.spin).norm() < tolerance * fast);
    }
  }
}

}  // namespace

TEST_CASE("trees: accelerations are those of Kane's equations", "[robots][fast]") {
  for (const bool by_links : {true, false}) {
    for_each_isa<double>([&](const auto& k) { check_accelerations<double>(k, 1e-11, by_links); });
    for_each_isa<float>([&](const auto& k) { check_accelerations<float>(k, 2e-3, by_links); });
  }
}

TEST_CASE("trees: bodies are where the coordinates say", "[robots][fast]") {
  for_each_isa<double>([](const auto& k) { check_bodies<double>(k, 1e-13); });
  for_each_isa<float>([](const auto& k) { check_bodies<float>(k, 1e-5); });
}

TEST_CASE("trees: a rod on a hinge swings with the period of its elliptic integral",
          "[robots][fast]") {
  std::vector<TwinLink> rod = double_pendulum();
  rod.pop_back();
  // omega^2 = m g d / I about the hinge; T = 4 K(sin(a / 2)) / omega by the arithmetic-geometric
  // mean: 2 pi / (omega agm(1, cos(a / 2))).
  const double amplitude = 2, gravity = 9.81, omega = std::sqrt(gravity * 0.5 * 3);
  double a = 1, b = std::cos(amplitude / 2);
  while (std::abs(a - b) > 1e-15) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b), a = mean;
  }
  const double period = 2 * kPi / (omega * a);
  for_each_isa<double>([&](const auto& k) {
    double error[2];
    for (int i = 0; i < 2; ++i) {
      const int steps = 2000 << i;
      TreeGroup<double> group(k, rod, {0, 0, -gravity}, period / steps);
      for (int lane = 0; lane < group.lanes(); ++lane) {
        group.set(lane, Numbers::Constant(1, amplitude), Numbers::Zero(1));
      }
      group.step(steps);
      error[i] = std::abs(group.position(0)[0] - amplitude);
    }
    CHECK(error[0] < 0.02);
    CHECK(error[1] < 0.6 * error[0]);  // first order
  });
}

TEST_CASE("trees: the energy of a double pendulum is kept, the closer the shorter the step",
          "[robots][fast]") {
  const TreeTwin twin(double_pendulum(), {0, 0, -9.81});
  const TreeState start{Eigen::Vector2d(1.5, -2), Eigen::Vector2d(1, 3)};
  const double before = twin.energy(start.q, start.v);
  for_each_isa<double>([&](const auto& k) {
    double drift[2];
    for (int i = 0; i < 2; ++i) {
      const int steps = 4000 << i;
      TreeGroup<double> group(k, twin.links(), {0, 0, -9.81}, 2.0 / steps);
      for (int lane = 0; lane < group.lanes(); ++lane) group.set(lane, start.q, start.v);
      group.step(steps);
      drift[i] = std::abs(twin.energy(group.position(0), group.velocity(0)) - before);
    }
    CHECK(drift[0] < 0.02 * 2 * 9.81);  // of the weight of both times 1 m
    CHECK(drift[1] < 0.7 * drift[0]);
  });
}

TEST_CASE("trees: a free body in space keeps its momentum and its spin", "[robots][fast]") {
  TwinLink body;
  body.frame.mass = 2, body.frame.moments = {0.1, 0.1, 0.1};
  body.frame.center = {0.1, -0.2, 0.3};
  body.joints = {{TreeJointKind::free}};
  const TreeTwin twin({body}, Vec3::Zero());
  TreeState s{Numbers(7), Numbers(6)};
  s.q << 1e3, -2e3, 5e2, 1, 0, 0, 0;
  s.v << 1, 2, 3, 0.4, -0.5, 0.6;
  const TwinMotion start = twin.motion(s.q, s.v, Numbers::Zero(6))[0];
  for_each_isa<double>([&](const auto& k) {
    TreeGroup<double> group(k, twin.links(), Vec3::Zero(), 1e-3);
    for (int lane = 0; lane < group.lanes(); ++lane) group.set(lane, s.q, s.v);
    group.step(1000);
    const TwinMotion end = twin.motion(group.position(0), group.velocity(0), Numbers::Zero(6))[0];
    CHECK((end.velocity - start.velocity).norm() < 1e-3);  // first order in the step
    CHECK((end.spin - start.spin).norm() < 1e-9);
    CHECK((end.center - start.center - start.velocity).norm() < 1e-3);
  });
}

TEST_CASE("trees: bits depend on neither lane nor instruction set", "[robots][fast][bits]") {
  Random random(7);
  const TreeTwin twin(random_trees(random, 12, 0.5), {0, 0, -9.81});
  std::vector<TreeState> states;
  for (int i = 0; i < 16; ++i) states.push_back(random_state(random, twin));
  check_bits<float>(twin.links(), states, 50);
  check_bits<double>(twin.links(), states, 50);
}

TEST_CASE("trees: a world that is not finite stops alone", "[robots][fast][bits]") {
  const TreeTwin twin(double_pendulum(), {0, 0, -9.81});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for_each_isa<float>([&](const auto& k) {
    TreeGroup<float> good(k, twin.links(), {0, 0, -9.81}, 0.01),
        mixed(k, twin.links(), {0, 0, -9.81}, 0.01);
    for (int lane = 0; lane < good.lanes(); ++lane) {
      const Eigen::Vector2d q(0.1 * lane, 1), v(1, 0);
      good.set(lane, q, v);
      mixed.set(lane, q, lane == 1 ? Eigen::Vector2d(nan, 0) : v);
    }
    good.step(30), mixed.step(30);
    for (int lane = 0; lane < good.lanes(); ++lane) {
      if (lane == 1) {
        CHECK((mixed.status(lane) & kernels::kNonFinite) != 0);
        CHECK(mixed.position(lane)[0] == static_cast<double>(0.1f));
        continue;
      }
      CHECK(mixed.status(lane) == 0);
      CHECK(mixed.position(lane) == good.position(lane));
      CHECK(mixed.velocity(lane) == good.velocity(lane));
    }
  });
}

}  // namespace manyworlds::test
