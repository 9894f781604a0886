#include "tools/invariants/momenta.hpp"

namespace manyworlds::invariants {

std::vector<MassProperties> masses_of(const Scene& scene) {
  std::vector<MassProperties> masses;
  for (const Body& body : scene.bodies) masses.push_back(mass_properties(scene, body));
  return masses;
}

Momenta momenta_of(const std::vector<MassProperties>& masses, const std::vector<BodyNow>& bodies) {
  Momenta out;
  double total = 0;
  Vec3 center = Vec3::Zero();
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double m = masses[i].mass;
    center += m * (bodies[i].position + bodies[i].rotation * masses[i].center);
    out.linear += m * bodies[i].velocity, out.linear_sum += m * bodies[i].velocity.norm();
    total += m;
  }
  center /= total;
  const Vec3 drift = out.linear / total;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const BodyNow& b = bodies[i];
    const Vec3 arm = b.position + b.rotation * masses[i].center - center;
    const Vec3 orbit = masses[i].mass * arm.cross(b.velocity - drift);
    const Vec3 spin = inertia_of(masses[i], b.rotation) * b.spin;
    out.angular += orbit + spin, out.angular_sum += orbit.norm() + spin.norm();
    out.kinetic += (masses[i].mass * b.velocity.squaredNorm() + b.spin.dot(spin)) / 2;
  }
  return out;
}

}  // namespace manyworlds::invariants
