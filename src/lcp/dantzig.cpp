// Dantzig's principal pivoting for boxed problems (Baraff, Fast Contact Force Computation for
// Nonpenetrating Rigid Bodies, 1994).
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "src/lcp/problem.hpp"

namespace manyworlds::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTiny = 1e-12;  // of the scale of the problem: counts as nothing

enum class Place { open, free, low, high };  // open: not taken in yet

class Dantzig {
 public:
  explicit Dantzig(const Problem& p)
      : p_(p),
        z_(Eigen::VectorXd::Zero(p.q.size())),
        w_(p.q),
        place_(static_cast<std::size_t>(p.q.size()), Place::open),
        tiny_(kTiny * std::max({1.0, p.q.cwiseAbs().maxCoeff(), p.m.cwiseAbs().maxCoeff()})) {}

  Solution solve() {
    Solution out;
    out.solved = true;
    // No more than there are ways to place all components, in practice a few times n.
    const int most = 100 + 50 * static_cast<int>(z_.size());
    for (Eigen::Index i = 0; i < z_.size() && out.solved; ++i) {
      w_ = p_.m * z_ + p_.q;  // what rounding has added up is gone
      while (out.steps++ < most && drive(i)) {
      }
      out.solved = out.steps <= most && !stuck_;
    }
    out.z = z_;
    return out;
  }

 private:
  Place& at(Eigen::Index i) { return place_[static_cast<std::size_t>(i)]; }

  // Changes of the free components that keep their w at 0 while z_i moves by 1.
  Eigen::VectorXd direction(Eigen::Index i) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index k = 0; k < z_.size(); ++k) {
      if (at(k) == Place::free) free.push_back(k);
    }
    Eigen::VectorXd d = Eigen::VectorXd::Zero(z_.size());
    d[i] = 1;
    if (free.empty()) return d;
    const auto n = static_cast<Eigen::Index>(free.size());
    Eigen::MatrixXd m(n, n);
    Eigen::VectorXd column(n);
    for (Eigen::Index r = 0; r < n; ++r) {
      for (Eigen::Index c = 0; c < n; ++c) {
        m(r, c) = p_.m(free[static_cast<std::size_t>(r)], free[static_cast<std::size_t>(c)]);
      }
      column[r] = p_.m(free[static_cast<std::size_t>(r)], i);
    }
    const Eigen::VectorXd change = m.fullPivLu().solve(-column);
    for (Eigen::Index r = 0; r < n; ++r) d[free[static_cast<std::size_t>(r)]] = change[r];
    return d;
  }

  // One pivot for component i; false when its condition holds.
  bool drive(Eigen::Index i) {
    if (std::abs(w_[i]) <= tiny_) {
      at(i) = z_[i] <= p_.low[i] ? Place::low : z_[i] >= p_.high[i] ? Place::high : Place::free;
      return false;
    }
    const double sign = w_[i] < 0 ? 1 : -1;  // z_i moves so that w_i comes to 0
    if ((sign > 0 && z_[i] >= p_.high[i]) || (sign < 0 && z_[i] <= p_.low[i])) {
      at(i) = sign > 0 ? Place::high : Place::low;
      return false;
    }
    const Eigen::VectorXd d = sign * direction(i);
    Eigen::VectorXd change = p_.m * d;
    for (Eigen::Index k = 0; k < z_.size(); ++k) {
      if (at(k) == Place::free) change[k] = 0;
    }
    double far = kInfinity;
    Eigen::Index blocking = -1;
    const auto meet = [&](double distance, Eigen::Index k) {
      if (distance < far) far = std::max(distance, 0.0), blocking = k;
    };
    if (sign * change[i] > kTiny) meet(-w_[i] / change[i], i);
    for (Eigen::Index k = 0; k <= i; ++k) {
      if (k == i || at(k) == Place::free) {
        if (d[k] > kTiny) meet((p_.high[k] - z_[k]) / d[k], k);
        if (d[k] < -kTiny) meet((p_.low[k] - z_[k]) / d[k], k);
      } else if (at(k) == Place::low && change[k] < -kTiny) {
        meet(-w_[k] / change[k], k);
      } else if (at(k) == Place::high && change[k] > kTiny) {
        meet(-w_[k] / change[k], k);
      }
    }
    if (blocking < 0) {  // nothing stops it: there is no solution
      stuck_ = true;
      return false;
    }
    z_ += far * d, w_ += far * change;
    return settle(blocking, i);
  }

  // Component k is what ended the move of i; true when i has to go on.
  bool settle(Eigen::Index k, Eigen::Index i) {
    const bool at_high = z_[k] >= p_.high[k] - tiny_, at_low = z_[k] <= p_.low[k] + tiny_;
    if (k == i) {
      if (std::abs(w_[k]) <= 1e3 * tiny_) w_[k] = 0;
      const bool bound = w_[k] != 0;
      at(k) = !bound ? Place::free : at_high ? Place::high : Place::low;
      if (bound) z_[k] = at_high ? p_.high[k] : p_.low[k];
      return false;
    }
    if (at(k) == Place::free) {
      at(k) = at_high ? Place::high : at_low ? Place::low : Place::free;
      z_[k] = at_high ? p_.high[k] : at_low ? p_.low[k] : z_[k];
      w_[k] = 0;
    } else {
      at(k) = Place::free, w_[k] = 0;
    }
    return true;
  }

  const Problem& p_;
  Eigen::VectorXd z_, w_;
  std::vector<Place> place_;
  double tiny_;
  bool stuck_ = false;
};

}  // namespace

Solution solve_dantzig(const Problem& problem) { return Dantzig(problem).solve(); }

}  // namespace manyworlds::lcp
