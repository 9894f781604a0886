// Boxed linear complementarity problems, dense and in double: what contacts and limits of one world
// ask for, as the direct solvers and the references of the iterative ones take it.
//
// Wanted is z with w = M z + q, where each z_i is in [low_i, high_i] and
//   w_i = 0 between the bounds,  w_i >= 0 at low_i,  w_i <= 0 at high_i.
#pragma once

#include <Eigen/Core>

namespace manyworlds::lcp {

struct Problem {
  Eigen::MatrixXd m;          // [n][n]; symmetric and positive semidefinite for contacts
  Eigen::VectorXd q;          // [n]
  Eigen::VectorXd low, high;  // [n]; low <= 0 <= high, may be infinite
};

struct Solution {
  Eigen::VectorXd z;
  int steps = 0;        // pivots or sweeps
  bool solved = false;  // false: gave up, z is the best that it had
};

// The natural residual |z - clamp(z - w, low, high)| of the largest component; 0 at a solution.
double residual(const Problem& problem, const Eigen::VectorXd& z);

// Principal pivoting after Dantzig as Baraff (1994) has it: components are taken in one after the
// other, each driven until its own condition holds while those of the others keep holding. For
// symmetric positive semidefinite matrices; exact up to rounding.
Solution solve_dantzig(const Problem& problem);

// Lemke's complementary pivots (Cottle, Pang, Stone 1992, 4.4), on a problem with one variable more
// for each bound. For any matrix of the class that it terminates on, symmetric or not;
// `max_pivots` ends it otherwise, since cases are known that take 2^n.
Solution solve_lemke(const Problem& problem, int max_pivots = 10000);

// Projected Gauss-Seidel, over-relaxed for `relaxation` in (1, 2), until the residual is at most
// `enough`. Rows without a positive diagonal are left alone.
Solution solve_gauss_seidel(const Problem& problem, double enough, int max_sweeps,
                            double relaxation = 1);

// Nonsmooth nonlinear conjugate gradients of those sweeps (Silcowitz-Hansen, Niebe, Erleben 2010):
// Fletcher-Reeves with a restart whenever the step grows.
Solution solve_conjugate_gradient(const Problem& problem, double enough, int max_sweeps);

}  // namespace manyworlds::lcp
