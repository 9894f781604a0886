// Lemke's method: z_0 times a vector of ones is added so that z = 0 is a solution, then
// complementary pivots take z_0 out again.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "src/lcp/problem.hpp"

namespace manyworlds::lcp {
namespace {

constexpr double kTinyPivot = 1e-11;

// w = m z + q with w, z >= 0 and w z = 0.
struct Standard {
  Eigen::MatrixXd m;
  Eigen::VectorXd q;
};

// Unknowns: z - low where low is finite (else low is taken as a number that nothing reaches), then
// for each finite upper bound how far w is below 0, which goes with the way up to it.
struct Boxes {
  Standard problem;
  Eigen::VectorXd low;
};
Boxes without_boxes(const Problem& p) {
  const Eigen::Index n = p.q.size();
  std::vector<Eigen::Index> above;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (std::isfinite(p.high[i])) above.push_back(i);
  }
  const auto k = static_cast<Eigen::Index>(above.size());
  Boxes out;
  out.low = p.low;
  out.problem.m = Eigen::MatrixXd::Zero(n + k, n + k);
  out.problem.q = Eigen::VectorXd::Zero(n + k);
  out.problem.m.topLeftCorner(n, n) = p.m;
  out.problem.q.head(n) = p.q + p.m * p.low;
  for (Eigen::Index r = 0; r < k; ++r) {
    const Eigen::Index i = above[static_cast<std::size_t>(r)];
    out.problem.m(i, n + r) = 1;
    out.problem.m(n + r, i) = -1;
    out.problem.q[n + r] = p.high[i] - p.low[i];
  }
  return out;
}

// The tableau [basis | w, z, z_0 | right-hand side], variables numbered w 0 .. n - 1,
// z n .. 2n - 1, z_0 2n.
class Tableau {
 public:
  explicit Tableau(const Standard& s) : n_(s.q.size()), rows_(n_, 2 * n_ + 2), basis_(size(n_)) {
    rows_.setZero();
    rows_.leftCols(n_).setIdentity();
    rows_.middleCols(n_, n_) = -s.m;
    rows_.col(2 * n_).setConstant(-1);
    rows_.col(2 * n_ + 1) = s.q;
    for (Eigen::Index i = 0; i < n_; ++i) basis_[size(i)] = i;
  }

  bool solve(int max_pivots, int& pivots) {
    Eigen::Index row = 0;
    if (rows_.col(2 * n_ + 1).minCoeff(&row) >= 0) return true;  // z = 0 solves it
    Eigen::Index entering = 2 * n_;
    for (pivots = 0; pivots < max_pivots; ++pivots) {
      if (pivots > 0) {
        row = leaving_row(entering);
        if (row < 0) return false;  // a ray: no solution is found
      }
      const Eigen::Index left = basis_[size(row)];
      pivot(row, entering);
      if (left == 2 * n_) return true;
      entering = left < n_ ? left + n_ : left - n_;  // the complement of what left
    }
    return false;
  }

  Eigen::VectorXd z() const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(n_);
    for (Eigen::Index i = 0; i < n_; ++i) {
      const Eigen::Index v = basis_[size(i)];
      if (v >= n_ && v < 2 * n_) out[v - n_] = rows_(i, 2 * n_ + 1);
    }
    return out;
  }

 private:
  static std::size_t size(Eigen::Index i) { return static_cast<std::size_t>(i); }

  // The row that reaches 0 first; of equal ones z_0's if it is among them, else that whose row is
  // lexicographically least, which keeps it from going in circles.
  Eigen::Index leaving_row(Eigen::Index entering) const {
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (!(rows_(i, entering) > kTinyPivot)) continue;
      if (best < 0 || before(i, best, entering)) best = i;
    }
    return best;
  }
  bool before(Eigen::Index a, Eigen::Index b, Eigen::Index entering) const {
    const double of_a = rows_(a, entering), of_b = rows_(b, entering);
    const double x = rows_(a, 2 * n_ + 1) / of_a, y = rows_(b, 2 * n_ + 1) / of_b;
    const double same = kTinyPivot * std::max({1.0, std::abs(x), std::abs(y)});
    if (std::abs(x - y) > same) return x < y;
    if (basis_[size(a)] == 2 * n_ || basis_[size(b)] == 2 * n_) return basis_[size(a)] == 2 * n_;
    for (Eigen::Index c = 0; c < n_; ++c) {
      const double u = rows_(a, c) / of_a, v = rows_(b, c) / of_b;
      if (std::abs(u - v) > kTinyPivot) return u < v;
    }
    return a < b;
  }

  void pivot(Eigen::Index row, Eigen::Index entering) {
    rows_.row(row) /= rows_(row, entering);
    for (Eigen::Index i = 0; i < n_; ++i) {
      if (i == row || rows_(i, entering) == 0) continue;
      rows_.row(i) -= rows_(i, entering) * rows_.row(row);
      rows_(i, entering) = 0;
    }
    basis_[size(row)] = entering;
  }

  Eigen::Index n_;
  Eigen::MatrixXd rows_;
  std::vector<Eigen::Index> basis_;
};

}  // namespace

Solution solve_lemke(const Problem& problem, int max_pivots) {
  Problem finite = problem;
  // Far below what any component of a solution comes to, so that nothing sits there.
  const double far = 1e6 * std::max(1.0, problem.q.cwiseAbs().maxCoeff());
  for (Eigen::Index i = 0; i < finite.low.size(); ++i) {
    finite.low[i] = std::max(finite.low[i], -far);
  }
  const Boxes boxes = without_boxes(finite);
  Tableau tableau(boxes.problem);
  Solution out;
  out.solved = tableau.solve(max_pivots, out.steps);
  out.z = tableau.z().head(problem.q.size()) + boxes.low;
  return out;
}

}  // namespace manyworlds::lcp
