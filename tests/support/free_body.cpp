#include "tests/support/free_body.hpp"

namespace manyworlds::test {
namespace {

using Vec4 = Eigen::Vector4d;

Vec3 spin_at(const FreeBody& body, const Quat& q) {
  const Mat3 r = q.toRotationMatrix();
  return r * body.mass.inertia.inverse() * r.transpose() * body.angular_momentum;
}

Vec4 rate(const FreeBody& body, const Vec4& coefficients) {
  const Quat q = Quat(coefficients).normalized();
  const Vec3 w = spin_at(body, q);
  return 0.5 * (Quat(0, w.x(), w.y(), w.z()) * q).coeffs();
}

}  // namespace

Vec3 FreeBody::angular_velocity() const { return spin_at(*this, rotation); }

FreeBody start_of(const Scene& scene, const Body& body) {
  FreeBody b;
  b.mass = mass_properties(scene, body);
  b.rotation = body.rotation.normalized();
  b.center = body.position + b.rotation * b.mass.center;
  b.linear_velocity = body.linear_velocity;
  const Mat3 r = b.rotation.toRotationMatrix();
  b.angular_momentum = r * b.mass.inertia * r.transpose() * body.angular_velocity;
  return b;
}

void advance(FreeBody& body, const Vec3& gravity, double time, int steps) {
  body.center += time * body.linear_velocity + 0.5 * time * time * gravity;
  body.linear_velocity += time * gravity;
  const double h = time / steps;
  Vec4 q = body.rotation.coeffs();
  for (int i = 0; i < steps; ++i) {
    const Vec4 k1 = rate(body, q), k2 = rate(body, q + 0.5 * h * k1);
    const Vec4 k3 = rate(body, q + 0.5 * h * k2), k4 = rate(body, q + h * k3);
    q = (q + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)).normalized();
  }
  body.rotation = Quat(q);
}

}  // namespace manyworlds::test
