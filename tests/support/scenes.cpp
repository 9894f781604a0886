#include "tests/support/scenes.hpp"

#include <algorithm>

namespace manyworlds::test {
namespace {

template <class Visit>
void for_each_dynamic(const Batch& batch, int world, Visit visit) {
  const Plan& plan = batch.plan(batch.kind_of(world));
  for (int i = 0; i < plan.bodies(); ++i) {
    const Body& body = plan.scene().at(plan.body_in_row(i));
    if (body.motion == Motion::dynamic) visit(i, mass_properties(plan.scene(), body));
  }
}

Mat3 world_inertia(const Batch& batch, int world, int body, const MassProperties& m) {
  const Mat3 r = rotation(batch, world, body).normalized().toRotationMatrix();
  return r * m.inertia * r.transpose();
}

}  // namespace

Quat rotation_to(const Vec3& from, const Vec3& to) { return Quat::FromTwoVectors(from, to); }

Geometry slab_of(Space space, double side, double height) {
  if (space == Space::planar) return box_of(space, Vec3(side, height, 0));
  return box_of(space, Vec3(side, side, height));
}

Momenta momenta(const Batch& batch, int world) {
  Momenta sum;
  for_each_dynamic(batch, world, [&](int i, const MassProperties& m) {
    const Quat q = rotation(batch, world, i).normalized();
    const Vec3 center = position(batch, world, i) + q * m.center;
    const Vec3 p = m.mass * velocity(batch, world, i);
    sum.linear += p;
    sum.angular += center.cross(p) + world_inertia(batch, world, i, m) * spin(batch, world, i);
  });
  return sum;
}

double kinetic_energy(const Batch& batch, int world) {
  double sum = 0;
  for_each_dynamic(batch, world, [&](int i, const MassProperties& m) {
    const Vec3 w = spin(batch, world, i);
    sum += 0.5 * m.mass * velocity(batch, world, i).squaredNorm() +
           0.5 * w.dot(world_inertia(batch, world, i, m) * w);
  });
  return sum;
}

double max_speed(const Batch& batch, int world) {
  double top = 0;
  for (int i = 0; i < batch.bodies(world); ++i)
    top = std::max(top, velocity(batch, world, i).norm());
  return top;
}

double max_penetration(const Batch& batch, int world) {
  double deepest = 0;
  for (const Contact& c : batch.contacts(world)) deepest = std::max(deepest, -c.separation);
  return deepest;
}

}  // namespace manyworlds::test
