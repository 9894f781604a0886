#include "tools/invariants/statics.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <variant>

namespace manyworlds::invariants {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Least squares over x >= 0 (Lawson, Hanson 1974), by the normal equations.
class NonnegativeLeastSquares {
 public:
  explicit NonnegativeLeastSquares(const MatrixXd& a) : a_(a), gram_(a.transpose() * a) {
    // Columns depend on each other where points of contact are redundant.
    gram_.diagonal().array() += 1e-10 * gram_.diagonal().maxCoeff();
  }

  // The residual a x - b of the best x.
  VectorXd residual(const VectorXd& b) const {
    const auto n = gram_.rows();
    const VectorXd c = a_.transpose() * b;
    VectorXd x = VectorXd::Zero(n);
    std::vector<Eigen::Index> used;
    for (Eigen::Index round = 0; round < 3 * n; ++round) {
      VectorXd gradient = c;
      for (const auto i : used) gradient -= x(i) * gram_.col(i);
      for (const auto i : used) gradient(i) = 0;
      Eigen::Index best = 0;
      if (gradient.maxCoeff(&best) < 1e-9 * c.cwiseAbs().maxCoeff()) break;
      used.push_back(best);
      for (;;) {
        const VectorXd z = solve(used, c);
        if (z.minCoeff() > 0) {
          for (std::size_t k = 0; k < used.size(); ++k)
            x(used[k]) = z(static_cast<Eigen::Index>(k));
          break;
        }
        step_to_bound(used, z, x);
        if (used.empty()) break;
      }
    }
    return a_ * x - b;
  }

 private:
  VectorXd solve(const std::vector<Eigen::Index>& used, const VectorXd& c) const {
    return MatrixXd(gram_(used, used)).llt().solve(VectorXd(c(used)));
  }
  static void step_to_bound(std::vector<Eigen::Index>& used, const VectorXd& z, VectorXd& x) {
    double alpha = 1;
    std::size_t first = 0;
    for (std::size_t k = 0; k < used.size(); ++k) {
      const double target = z(static_cast<Eigen::Index>(k)), now = x(used[k]);
      if (target > 0) continue;
      const double share = now / std::max(now - target, 1e-300);
      if (share <= alpha) alpha = share, first = k;
    }
    for (std::size_t k = 0; k < used.size(); ++k) {
      x(used[k]) += alpha * (z(static_cast<Eigen::Index>(k)) - x(used[k]));
    }
    x(used[first]) = 0;
    std::erase_if(used, [&](Eigen::Index i) { return x(i) <= 0; });
  }

  MatrixXd a_, gram_;
};

// Degrees of freedom of every body, rows of the equations of balance.
struct Rows {
  std::vector<int> first;  // of a body; -1: it does not move
  std::vector<bool> slides;
  int count = 0;
};
Rows rows_of(const Scene& scene) {
  Rows rows;
  rows.slides.assign(scene.bodies.size(), false);
  for (const Joint& joint : scene.joints) {
    rows.slides[static_cast<std::size_t>(joint.body_b.index())] = true;
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const bool moves = scene.bodies[i].motion == Motion::dynamic;
    rows.first.push_back(moves ? rows.count : -1);
    if (moves) rows.count += rows.slides[i] ? 1 : scene.space == Space::planar ? 3 : 6;
  }
  return rows;
}

}  // namespace

bool stands(const Scene& scene, const std::vector<Touch>& touches, const Margin& margin,
            const std::vector<Preload>& preloads) {
  const bool planar = scene.space == Space::planar;
  const Rows rows = rows_of(scene);
  const double g = scene.options.gravity.norm();
  std::vector<Vec3> centers;
  std::vector<double> weights, sizes;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (rows.first[i] < 0) {
      centers.push_back(body.position), weights.push_back(0), sizes.push_back(1);
      continue;
    }
    const MassProperties mass = mass_of(scene, BodyId(static_cast<int>(i)));
    centers.push_back(body.position + body.rotation.normalized() * mass.center);
    weights.push_back(mass.mass * g);
    double size = 0;
    for (const Shape& s : body.shapes) size = std::max(size, outer_radius(s.geometry));
    sizes.push_back(size);
  }

  // One column per edge of the pyramid within each cone; fewer where there are many.
  const int edges = planar ? 2 : touches.size() > 24 ? 4 : 8;
  MatrixXd a = MatrixXd::Zero(rows.count, edges * static_cast<int>(touches.size()));
  const auto put = [&](int body, const Vec3& point, const Vec3& force, int column) {
    if (body < 0 || rows.first[static_cast<std::size_t>(body)] < 0) return;
    const auto i = static_cast<std::size_t>(body);
    const int row = rows.first[i];
    const double unit = 1 / weights[i];
    if (rows.slides[i]) {
      a(row, column) += force.x() * unit;
      return;
    }
    const Vec3 torque = (point - centers[i]).cross(force) / sizes[i];
    if (planar) {
      a.block<3, 1>(row, column) += unit * Vec3(force.x(), force.y(), torque.z());
    } else {
      a.block<3, 1>(row, column) += unit * force;
      a.block<3, 1>(row + 3, column) += unit * torque;
    }
  };
  int column = 0;
  for (const Touch& touch : touches) {
    const Vec3 n = touch.normal;
    const Vec3 t = planar ? Vec3(-n.y(), n.x(), 0) : Vec3(n.unitOrthogonal()), s = n.cross(t);
    for (int k = 0; k < edges; ++k, ++column) {
      const double angle = 2 * scenes::kPi * k / edges;
      const Vec3 along = std::cos(angle) * t + (planar ? 0 : std::sin(angle)) * s;
      const Vec3 force = n + margin.friction * touch.friction * along;
      put(touch.b, touch.point, force, column);
      put(touch.a, touch.point, -force, column);
    }
  }
  const NonnegativeLeastSquares solver(a);

  const auto balances = [&](const Vec3& down, double even, double odd) {
    VectorXd b = VectorXd::Zero(rows.count);
    std::vector<Vec3> loads(scene.bodies.size(), Vec3::Zero());
    for (std::size_t i = 0; i < loads.size(); ++i) {
      loads[i] = weights[i] * (i % 2 == 0 ? even : odd) * down;
    }
    for (const Preload& p : preloads) loads[static_cast<std::size_t>(p.body)] += p.force;
    for (std::size_t i = 0; i < loads.size(); ++i) {
      if (rows.first[i] < 0) continue;
      const Vec3 load = -loads[i] / weights[i];
      if (rows.slides[i])
        b(rows.first[i]) = load.x();
      else
        b.segment(rows.first[i], planar ? 2 : 3) = load.head(planar ? 2 : 3);
    }
    return solver.residual(b).cwiseAbs().maxCoeff() < 1e-3;
  };
  const Vec3 down = scene.options.gravity / g;
  const double w = margin.weight;
  if (margin.all_weights && !balances(down, w, w)) return false;
  if (!balances(down, 1, 1)) return false;
  if (w != 1 && !margin.all_weights && (!balances(down, w, 1) || !balances(down, 1, w)))
    return false;
  if (margin.tilt == 0) return true;
  const Vec3 x = planar ? Vec3(-down.y(), down.x(), 0) : Vec3(down.unitOrthogonal()),
             y = down.cross(x);
  for (int k = 0; k < (planar ? 2 : 4); ++k) {
    const double angle = 2 * scenes::kPi * k / (planar ? 2 : 4);
    const Vec3 along = std::cos(angle) * x + (planar ? 0 : std::sin(angle)) * y;
    if (!balances(down + std::tan(margin.tilt) * along, 1, 1)) return false;
  }
  return true;
}

}  // namespace manyworlds::invariants
