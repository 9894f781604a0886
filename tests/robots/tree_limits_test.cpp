// Joint limits of trees by the newton solver: the conditions of its minimum by a twin, statics, and
// the law that lanes do not see each other.
#include <catch2/catch.hpp>

#include "tests/support/approx.hpp"
#include "tests/support/tree_bits.hpp"

namespace manyworlds::test {
namespace {

using kernels::TreeJointKind;
using Numbers = TreeTwin::Numbers;

// One side of a limited joint, by MuJoCo's formulas.
struct TwinRow {
  int dof = 0;
  double side = 1, weight = 0, reference = 0;
};

double impedance_of(const Compliance& c, double violation) {
  const double low = c.min_impedance, high = c.max_impedance;
  const double width = c.width, middle = c.midpoint, power = c.power;
  if (low == high || width == 0) return (low + high) / 2;
  const double x = std::min(1.0, std::abs(violation) / width);
  const double y = x <= middle ? std::pow(x, power) / std::pow(middle, power - 1)
                               : 1 - std::pow(1 - x, power) / std::pow(1 - middle, power - 1);
  return low + y * (high - low);
}

TwinRow row_of(const NewTreeJoint& joint, double inverse_weight, double side, double end, double q,
               double v, double dt) {
  TwinRow row;
  row.side = side;
  const double distance = side * (q - end), violation = distance - joint.margin;
  if (distance >= joint.margin) return row;
  const Compliance& c = joint.compliance;
  const double d = impedance_of(c, violation), high = c.max_impedance;
  row.weight = d / ((1 - d) * inverse_weight);
  const double first = c.time_constant, second = c.damping_ratio;
  const double time = std::max(first, 2 * dt);
  const double stiffness =
      first > 0 ? 1 / std::pow(high * time * second, 2) : -first / (high * high);
  const double damping = first > 0 ? 2 / (high * time) : -second / high;
  row.reference = -damping * side * v - stiffness * d * violation;
  return row;
}

std::vector<TwinRow> rows_of(const TreeTwin& twin, const TreeWeights& weights, const Numbers& q,
                             const Numbers& v, double dt) {
  std::vector<TwinRow> rows;
  int c = 0, k = 0;
  for (const TwinLink& link : twin.links()) {
    for (const NewTreeJoint& joint : link.joints) {
      for (int i = 0; joint.range && i < 2; ++i) {
        TwinRow row = row_of(joint, weights.dof[static_cast<std::size_t>(k)], i == 0 ? 1 : -1,
                             (*joint.range)[static_cast<std::size_t>(i)], q[c], v[k], dt);
        row.dof = k;
        if (row.weight > 0) rows.push_back(row);
      }
      c += kernels::coordinates_of(joint.kind), k += kernels::dofs_of(joint.kind);
    }
  }
  return rows;
}

void add_limits(Random& random, std::vector<TwinLink>& links) {
  for (TwinLink& link : links) {
    for (NewTreeJoint& joint : link.joints) {
      if (kernels::dofs_of(joint.kind) > 1 || random.chance(0.3)) continue;
      const double low = random.uniform(-1.5, 0.5);
      joint.range = {low, low + random.uniform(0.1, 1.5)};
      if (random.chance(0.3)) joint.margin = random.uniform(0, 0.2);
      Compliance& c = joint.compliance;
      if (random.chance(0.5)) {
        c.min_impedance = random.uniform(0.1, 0.9), c.width = random.uniform(0.01, 1);
        c.midpoint = random.uniform(0.2, 0.8);
        c.power = static_cast<double>(random.integer(1, 4));
      }
      if (random.chance(0.2)) c.min_impedance = c.max_impedance;
      if (random.chance(0.3)) c.time_constant = -300, c.damping_ratio = -20;
    }
  }
}

// Of the gradient at the accelerations that were found: what is left, against what adds up.
double gradient_left(const TreeTwin& twin, const std::vector<TwinRow>& rows, const TreeState& s,
                     const Numbers& a) {
  const Eigen::MatrixXd m = twin.inertia(s.q);
  const Numbers f = twin.forces(s.q, s.v);
  Numbers left = m * a - f, sums = m.cwiseAbs() * a.cwiseAbs() + f.cwiseAbs();
  for (const TwinRow& row : rows) {
    const double x = row.side * a[row.dof] - row.reference;
    const double force = row.weight * std::max(0.0, -x);
    left[row.dof] -= row.side * force;
    sums[row.dof] += force + row.weight * (std::abs(a[row.dof]) + std::abs(row.reference));
  }
  return (left.cwiseAbs().array() / sums.array().max(1e-12)).maxCoeff();
}

template <class Real>
void check_minimum(const kernels::Kernels<Real>& kernels, double tolerance, bool by_links) {
  constexpr double kDt = 0.005;
  int active = 0;
  for (int trial = 0; trial < 30; ++trial) {
    INFO(kernels.isa << ", trial " << trial << (by_links ? ", by links" : ", in joint space"));
    Random random(static_cast<std::uint64_t>(900 + trial));
    std::vector<TwinLink> links = random_trees(random, 20, 0.5);
    add_limits(random, links);
    const TreeTwin twin(links, {0, 0, -9.81});
    TreeGroup<Real> group(kernels, links, {0, 0, -9.81}, kDt, by_links);
    std::vector<TreeState> states;
    for (int lane = 0; lane < group.lanes(); ++lane) {
      states.push_back(random_state(random, twin));
      group.set(lane, states.back().q, states.back().v);
    }
    group.step(1);
    for (int lane = 0; lane < group.lanes(); ++lane) {
      INFO("lane " << lane);
      const TreeState& s = states[static_cast<std::size_t>(lane)];
      REQUIRE(group.status(lane) == 0);
      const auto rows = rows_of(twin, group.trees().weights, s.q, s.v, kDt);
      if (rows.empty()) continue;
      ++active;
      CHECK(gradient_left(twin, rows, s, group.acceleration(lane)) < tolerance);
    }
  }
  CHECK(active > 20);
}

}  // namespace

TEST_CASE("trees: inverse weights are those of the inertia by Kane's equations", "[robots][fast]") {
  for (int trial = 0; trial < 20; ++trial) {
    INFO("trial " << trial);
    Random random(static_cast<std::uint64_t>(40 + trial));
    const TreeTwin twin(random_trees(random, 15, 1), Vec3::Zero());
    const PlanTrees trees = trees_of(twin.links(), 0.01);
    const Numbers q = reference_coordinates(twin);
    const Eigen::MatrixXd m = twin.inertia(q), inverse = m.inverse();
    CHECK(trees.weights.mean_inertia == Approx(m.diagonal().mean()).epsilon(1e-10));
    for (const auto& joint : trees.joints) {
      if (kernels::dofs_of(joint.kind) > 1) {
        const double mean = inverse.diagonal().segment<3>(joint.dof).mean();
        CHECK(trees.weights.dof[static_cast<std::size_t>(joint.dof)] == Approx(mean).epsilon(1e-8));
        continue;
      }
      CHECK(trees.weights.dof[static_cast<std::size_t>(joint.dof)] ==
            Approx(inverse(joint.dof, joint.dof)).epsilon(1e-8));
    }
  }
}

TEST_CASE("trees: limits minimise the cost of the newton solver", "[robots][fast]") {
  for (const bool by_links : {true, false}) {
    for_each_isa<double>([&](const auto& k) { check_minimum<double>(k, 1e-10, by_links); });
    for_each_isa<float>([&](const auto& k) { check_minimum<float>(k, 2e-3, by_links); });
  }
}

TEST_CASE("trees: a rod comes to rest on its limit where the soft row carries it",
          "[robots][fast]") {
  // Level at 0, kept above -0.1 rad. At rest the row's force D aref is the torque of gravity.
  TwinLink rod;
  rod.frame.center = {0.5, 0, 0};
  rod.frame.moments = Vec3(0.01, 1, 1) / 12;
  rod.joints = {{TreeJointKind::hinge, Vec3::Zero(), -Vec3::UnitY()}};
  NewTreeJoint& joint = rod.joints[0];
  joint.range = {-0.1, 1};
  joint.damping = 0.5;
  joint.compliance.width = 0.01;
  constexpr double kDt = 0.002;
  const double inverse_weight = 3;  // of 1/3 kg m^2
  double deep = -0.2, shallow = -0.1;
  for (int i = 0; i < 100; ++i) {  // the angle, by bisection
    const double middle = (deep + shallow) / 2;
    const TwinRow row = row_of(joint, inverse_weight, 1, -0.1, middle, 0, kDt);
    const double torque = 9.81 * 0.5 * std::cos(middle);
    (row.weight * row.reference > torque ? deep : shallow) = middle;
  }
  const TreeTwin twin({rod}, {0, 0, -9.81});
  for_each_isa<double>([&](const auto& k) {
    TreeGroup<double> group(k, twin.links(), {0, 0, -9.81}, kDt);
    for (int lane = 0; lane < group.lanes(); ++lane) {
      group.set(lane, Numbers::Zero(1), Numbers::Zero(1));
    }
    group.step(5000);
    CHECK(group.position(0)[0] == approx(deep, 1e-9));
    CHECK(std::abs(group.velocity(0)[0]) < 1e-9);
  });
}

TEST_CASE("trees: a lane on its limits does not see the lanes beside it", "[robots][fast][bits]") {
  Random random(77);
  std::vector<TwinLink> links = random_trees(random, 8, 0.5);
  while (links.size() < 6) links = random_trees(random, 8, 0.5);
  add_limits(random, links);
  for (const bool damped : {true, false}) {
    for (TwinLink& link : links) {
      for (NewTreeJoint& joint : link.joints) joint.damping = damped ? 0.3 : 0;
    }
    const TreeTwin twin(links, {0, 0, -9.81});
    std::vector<TreeState> states;
    for (int i = 0; i < 16; ++i) states.push_back(random_state(random, twin));
    check_bits<float>(links, states, 40);
    check_bits<double>(links, states, 40);
  }
}

}  // namespace manyworlds::test
