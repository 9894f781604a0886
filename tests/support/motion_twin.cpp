#include "tests/support/motion_twin.hpp"

namespace manyworlds::test {
namespace {

Mat3 cross_matrix(const Vec3& w) {
  Mat3 m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

// The body `h` later at the rates that hold at another one.
struct Rate {
  Vec3 x, v, w;
  Mat3 r;
};
std::vector<Rate> rates(const std::vector<MovingBody>& bodies, const Forces& forces) {
  const std::vector<Wrench> wrenches = forces(bodies);
  std::vector<Rate> out;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const MovingBody& b = bodies[i];
    const Mat3 inertia = b.r * b.inertia * b.r.transpose();
    out.push_back({b.v, wrenches[i].force / b.mass,
                   inertia.inverse() * (wrenches[i].torque - b.w.cross(inertia * b.w)),
                   cross_matrix(b.w) * b.r});
  }
  return out;
}
std::vector<MovingBody> moved(std::vector<MovingBody> bodies, const std::vector<Rate>& by,
                              double h) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    bodies[i].x += h * by[i].x, bodies[i].v += h * by[i].v;
    bodies[i].w += h * by[i].w, bodies[i].r += h * by[i].r;
  }
  return bodies;
}

}  // namespace

void advance(std::vector<MovingBody>& bodies, const Forces& forces, double time, int steps) {
  const double h = time / steps;
  for (int s = 0; s < steps; ++s) {
    const auto k1 = rates(bodies, forces), k2 = rates(moved(bodies, k1, h / 2), forces),
               k3 = rates(moved(bodies, k2, h / 2), forces),
               k4 = rates(moved(bodies, k3, h), forces);
    for (const auto& [k, weight] : {std::pair(&k1, 1.0), {&k2, 2.0}, {&k3, 2.0}, {&k4, 1.0}}) {
      bodies = moved(std::move(bodies), *k, weight * h / 6);
    }
    for (MovingBody& b : bodies) {  // Gram, Schmidt
      b.r.col(0).normalize();
      b.r.col(1) = (b.r.col(1) - b.r.col(0) * b.r.col(0).dot(b.r.col(1))).normalized();
      b.r.col(2) = b.r.col(0).cross(b.r.col(1));
    }
  }
}

}  // namespace manyworlds::test
