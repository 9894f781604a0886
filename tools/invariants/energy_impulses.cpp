// What Newton's law of restitution determines of a hit (energy_hits.hpp).
#include <algorithm>

#include "tools/invariants/energy_hits.hpp"

namespace manyworlds::invariants {

Mat3 Hit::response() const {
  Mat3 out = Mat3::Zero();
  for (const Rigid* body : {&a, &b}) {
    if (body->inv_mass == 0) continue;
    const Vec3 arm = points[0] - body->position;
    Mat3 cross;
    cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
    out += body->inv_mass * Mat3::Identity() - cross * body->inverse_inertia() * cross;
  }
  return out;
}
Vec3 Hit::approach() const { return b.velocity_at(points[0]) - a.velocity_at(points[0]); }
void Hit::push(const Vec3& impulse) {
  b.push(impulse, points[0]);
  a.push(-impulse, points[0]);
}

Vec3 Hit::impulse_without_slip() const {
  return response().fullPivLu().solve(-(1 + restitution) * approach());
}

std::vector<double> Hit::frictionless_impulses() const {
  const std::size_t n = points.size();
  std::vector<double> impulses(n, 0.0), leaving(n), target(n), couplings(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    leaving[i] = -approach_at(points[i]);
    target[i] = -restitution * std::min(leaving[i], 0.0);
    for (std::size_t j = 0; j < n; ++j) {
      double k = 0;
      for (const Rigid* body : {&a, &b}) {
        const Vec3 at_i = (points[i] - body->position).cross(normal);
        const Vec3 at_j = (points[j] - body->position).cross(normal);
        k += body->inv_mass + at_i.dot(body->inverse_inertia() * at_j);
      }
      couplings[i * n + j] = k;
    }
  }
  for (int sweep = 0; sweep < (n == 1 ? 1 : 400); ++sweep) {  // projected Gauss-Seidel
    for (std::size_t i = 0; i < n; ++i) {
      const double to =
          std::max(0.0, impulses[i] + (target[i] - leaving[i]) / couplings[i * n + i]);
      for (std::size_t j = 0; j < n; ++j) leaving[j] += couplings[i * n + j] * (to - impulses[i]);
      impulses[i] = to;
    }
  }
  return impulses;
}

}  // namespace manyworlds::invariants
