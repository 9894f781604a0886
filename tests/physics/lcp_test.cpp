// Solvers of boxed linear complementarity problems against each other, and problems made to be
// hard.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/lcp/problem.hpp"
#include "tests/support/random.hpp"

namespace manyworlds::test {
namespace {

using lcp::Problem, lcp::Solution;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Positive definite, and so with one solution: contacts of n rows on random bodies.
Problem random_problem(Random& random, int n) {
  Problem p;
  Eigen::MatrixXd j(n, n + 2);
  for (Eigen::Index i = 0; i < j.size(); ++i) j.data()[i] = random.uniform(-1, 1);
  p.m = j * j.transpose() + 0.05 * Eigen::MatrixXd::Identity(n, n);
  p.q = p.low = p.high = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    p.q[i] = random.uniform(-3, 3);
    const double kind = random.uniform(0, 1);  // contact, friction, motor
    p.low[i] = kind < 0.4 ? 0 : -random.uniform(0, 1);
    p.high[i] = kind < 0.4 ? kInfinity : kind < 0.7 ? -p.low[i] : random.uniform(0, 2);
  }
  return p;
}

// Murty's and Fathi's problems: M lower triangular with 1 and 2, or that times its transpose, and
// q = -1. The solution of both is the first unit vector; pivoting rules that go by index take 2^n.
Problem murty(int n, bool fathi) {
  Problem p;
  p.m = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index r = 0; r < n; ++r) {
    for (Eigen::Index c = 0; c < r; ++c) p.m(r, c) = 2;
  }
  if (fathi) p.m = p.m * p.m.transpose().eval();
  p.q = Eigen::VectorXd::Constant(n, -1);
  p.low = Eigen::VectorXd::Zero(n);
  p.high = Eigen::VectorXd::Constant(n, kInfinity);
  return p;
}

}  // namespace

TEST_CASE("direct and iterative solvers find the same solution of 1,000 boxed problems",
          "[fast][lcp]") {
  Random random(99);
  int max_sweeps = 0, max_conjugate = 0;
  for (int i = 0; i < 1000; ++i) {
    const Problem p = random_problem(random, random.integer(1, 12));
    const Solution dantzig = lcp::solve_dantzig(p), lemke = lcp::solve_lemke(p);
    const Solution sweeps = lcp::solve_gauss_seidel(p, 1e-13, 100000),
                   relaxed = lcp::solve_gauss_seidel(p, 1e-13, 100000, 1.3),
                   conjugate = lcp::solve_conjugate_gradient(p, 1e-12, 100000);
    INFO("problem " << i << " of " << p.q.size());
    REQUIRE(dantzig.solved);
    REQUIRE(lemke.solved);
    REQUIRE(sweeps.solved);
    REQUIRE(relaxed.solved);
    REQUIRE(conjugate.solved);
    CHECK(lcp::residual(p, dantzig.z) < 1e-10);
    CHECK(lcp::residual(p, lemke.z) < 1e-10);
    for (const Solution* other : {&lemke, &sweeps, &relaxed, &conjugate}) {
      CHECK((dantzig.z - other->z).cwiseAbs().maxCoeff() < 1e-9);
    }
    max_sweeps = std::max(max_sweeps, sweeps.steps);
    max_conjugate = std::max(max_conjugate, conjugate.steps);
  }
  CHECK(max_conjugate < max_sweeps);
}

TEST_CASE("problems that pivoting finds hard are solved or given up, never wrong (B43)",
          "[fast][lcp]") {
  for (int n : {4, 8, 12, 24}) {
    for (bool fathi : {false, true}) {
      const Problem p = murty(n, fathi);
      const Eigen::VectorXd wanted = Eigen::VectorXd::Unit(n, 0);
      INFO(n << (fathi ? " Fathi" : " Murty"));
      const Solution lemke = lcp::solve_lemke(p, 5000);
      if (lemke.solved) CHECK((lemke.z - wanted).norm() < 1e-8);
      if (n <= 8) CHECK(lemke.solved);
      if (!fathi) continue;  // Dantzig's asks for symmetric matrices
      const Solution dantzig = lcp::solve_dantzig(p);
      if (dantzig.solved) CHECK((dantzig.z - wanted).norm() < 1e-8);
      if (n <= 8) CHECK(dantzig.solved);
    }
  }
}

TEST_CASE("redundant, idle and unsolvable problems end as they should (B43)", "[fast][lcp]") {
  // A table on four legs: the forces are not unique, their sum is.
  Problem table;
  Eigen::MatrixXd j(4, 3);
  j << 1, 1, 1, 1, -1, 1, 1, 1, -1, 1, -1, -1;
  table.m = j * j.transpose();
  table.q = Eigen::VectorXd::Constant(4, -1);
  table.low = Eigen::VectorXd::Zero(4);
  table.high = Eigen::VectorXd::Constant(4, kInfinity);
  for (const Solution& s : {lcp::solve_dantzig(table), lcp::solve_lemke(table),
                            lcp::solve_gauss_seidel(table, 1e-12, 1000),
                            lcp::solve_conjugate_gradient(table, 1e-12, 1000)}) {
    CHECK(s.solved);
    CHECK(lcp::residual(table, s.z) < 1e-10);
    CHECK(s.z.sum() == Approx(1));
  }
  // Everything parts by itself.
  Problem idle = table;
  idle.q.setOnes();
  for (const Solution& s : {lcp::solve_dantzig(idle), lcp::solve_lemke(idle),
                            lcp::solve_gauss_seidel(idle, 1e-12, 10)}) {
    CHECK(s.solved);
    CHECK(s.z.norm() == 0);
  }
  // 0 z - 1 >= 0 has no solution.
  Problem none{Eigen::MatrixXd::Zero(1, 1), Eigen::VectorXd::Constant(1, -1),
               Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, kInfinity)};
  CHECK_FALSE(lcp::solve_dantzig(none).solved);
  CHECK_FALSE(lcp::solve_lemke(none).solved);
  CHECK_FALSE(lcp::solve_gauss_seidel(none, 1e-12, 50).solved);
  CHECK_FALSE(lcp::solve_conjugate_gradient(none, 1e-12, 50).solved);
}

TEST_CASE("sweeps lower the residual of contacts, conjugate gradients faster", "[fast][lcp]") {
  // A tower of n unit masses on the ground: one row for each contact.
  constexpr int n = 20;
  Problem p;
  p.m = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    p.m(i, i) = i == 0 ? 1 : 2;
    if (i > 0) p.m(i, i - 1) = p.m(i - 1, i) = -1;
  }
  p.q = Eigen::VectorXd::Zero(n);
  p.q[0] = -1;  // what stands on the ground falls
  p.low = Eigen::VectorXd::Zero(n);
  p.high = Eigen::VectorXd::Constant(n, kInfinity);
  const Solution exact = lcp::solve_dantzig(p);
  REQUIRE(exact.solved);
  for (Eigen::Index i = 0; i < n; ++i) CHECK(exact.z[i] == Approx(static_cast<double>(n - i)));
  const int sweeps = lcp::solve_gauss_seidel(p, 1e-3, 100000).steps,
            relaxed = lcp::solve_gauss_seidel(p, 1e-3, 100000, 1.3).steps,
            conjugate = lcp::solve_conjugate_gradient(p, 1e-3, 100000).steps;
  INFO(sweeps << " sweeps, " << relaxed << " relaxed, " << conjugate << " conjugate");
  CHECK(relaxed < sweeps);
  CHECK(2 * conjugate < sweeps);
}

}  // namespace manyworlds::test
