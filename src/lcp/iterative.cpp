// Sweeps over the rows of a problem, and what speeds them up.
#include <algorithm>
#include <cmath>

#include "src/lcp/problem.hpp"

namespace manyworlds::lcp {
namespace {

void sweep(const Problem& p, double relaxation, Eigen::VectorXd& z) {
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double diagonal = p.m(i, i);
    if (!(diagonal > 0)) continue;
    const double w = p.m.row(i).dot(z) + p.q[i];
    z[i] = std::clamp(z[i] - relaxation * w / diagonal, p.low[i], p.high[i]);
  }
}

}  // namespace

double residual(const Problem& p, const Eigen::VectorXd& z) {
  const Eigen::VectorXd w = p.m * z + p.q;
  double most = 0;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    most = std::max(most, std::abs(z[i] - std::clamp(z[i] - w[i], p.low[i], p.high[i])));
  }
  return most;
}

Solution solve_gauss_seidel(const Problem& p, double enough, int max_sweeps, double relaxation) {
  Solution out;
  out.z = Eigen::VectorXd::Zero(p.q.size());
  for (; out.steps < max_sweeps && !out.solved; ++out.steps) {
    sweep(p, relaxation, out.z);
    out.solved = residual(p, out.z) <= enough;
  }
  return out;
}

Solution solve_conjugate_gradient(const Problem& p, double enough, int max_sweeps) {
  Solution out;
  Eigen::VectorXd z = Eigen::VectorXd::Zero(p.q.size()), way = z, best = z;
  double before = 0, least = residual(p, z);  // before: square of the last step
  for (; out.steps < max_sweeps && !out.solved; ++out.steps) {
    Eigen::VectorXd next = z;
    sweep(p, 1, next);
    const Eigen::VectorXd step = next - z;
    const double square = step.squaredNorm();
    const double beta = before > 0 ? square / before : 0;
    if (beta > 1) {
      way = step;  // it grew: from here anew
    } else {
      next += beta * way;
      way = beta * way + step;
    }
    z = next, before = square;
    // What conjugate steps lead out of the box is brought back by the next sweep.
    const Eigen::VectorXd inside = z.cwiseMax(p.low).cwiseMin(p.high);
    const double now = residual(p, inside);
    if (now < least) least = now, best = inside;
    out.solved = least <= enough;
  }
  out.z = best;
  return out;
}

}  // namespace manyworlds::lcp
