#include "src/plan/contact_springs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace manyworlds {

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

void put(const ContactSprings& group, int body, const Vec3& place, const Vec3& force,
         const Vec3& torque, double* out) {
  const Vec3 turn = (place - group.bodies[at(body)]->center).cross(force) + torque;
  const double scale = 1 / group.lengths[at(body)];
  if (group.planar) {
    out[0] = force.x(), out[1] = force.y(), out[2] = scale * turn.z();
  } else {
    for (int k = 0; k < 3; ++k) out[k] = force[k], out[3 + k] = scale * turn[k];
  }
}

ContactSpring spring(const ContactSprings& group, int a, int b, double mass, const Vec3& place,
                     const Vec3& force, const Vec3& torque) {
  ContactSpring out;
  out.a = a, out.b = b, out.mass = mass, out.place = place, out.way = force;
  put(group, b, place, force, torque, out.of_b);
  if (a >= 0) put(group, a, place, -force, -torque, out.of_a);
  return out;
}

ContactRows rows_of(const ContactSprings& group, const Touching& t, int a, int b) {
  ContactRows out;
  out.touching = &t;
  double mass = 0;
  Vec3 middle = Vec3::Zero();
  for (const TouchingPoint& p : t.points) {
    out.points.push_back(spring(group, a, b, p.mass, p.place, t.normal, Vec3::Zero()));
    mass += p.mass, middle += p.place / static_cast<double>(t.points.size());
  }
  if (t.friction == 0) return out;
  const Vec3 n = t.normal, x = group.planar ? Vec3(-n.y(), n.x(), 0) : Vec3(n.unitOrthogonal());
  out.friction.push_back(spring(group, a, b, mass, middle, x, Vec3::Zero()));
  if (group.planar) return out;
  out.friction.push_back(spring(group, a, b, mass, middle, n.cross(x), Vec3::Zero()));
  for (const TouchingPoint& p : t.points) out.arm = std::max(out.arm, (p.place - middle).norm());
  if (out.arm > 0) {
    out.friction.push_back(spring(group, a, b, mass, middle, Vec3::Zero(), out.arm * n));
  }
  return out;
}

std::vector<ContactSprings> groups_of(const Scene& scene, const TouchingBodies& all) {
  std::vector<int> group(all.bodies.size());
  std::iota(group.begin(), group.end(), 0);
  const auto first_of = [&](int i) {
    while (group[at(i)] != i) i = group[at(i)] = group[at(group[at(i)])];
    return i;
  };
  for (const Touching& t : all.touchings) {
    if (t.a < 0) continue;
    const int a = first_of(t.a), b = first_of(t.b);
    group[at(std::max(a, b))] = std::min(a, b);
  }
  std::vector<int> number(all.bodies.size(), -1);  // of the group that the first one of it leads
  std::vector<int> local(all.bodies.size());
  std::vector<ContactSprings> out;
  for (std::size_t i = 0; i < all.bodies.size(); ++i) {
    const int first = first_of(static_cast<int>(i));
    if (number[at(first)] < 0) {
      number[at(first)] = static_cast<int>(out.size());
      ContactSprings one;
      one.planar = scene.space == Space::planar, one.dofs = one.planar ? 3 : 6;
      out.push_back(std::move(one));
    }
    ContactSprings& one = out[at(number[at(first)])];
    const StandingBody& body = all.bodies[i];
    local[i] = static_cast<int>(one.bodies.size());
    one.bodies.push_back(&body);
    const double inertia = one.planar ? body.inertia(2, 2) : body.inertia.trace() / 3;
    one.lengths.push_back(std::sqrt(inertia / body.mass));
  }
  for (const Touching& t : all.touchings) {
    ContactSprings& one = out[at(number[at(first_of(t.b))])];
    one.contacts.push_back(rows_of(one, t, t.a < 0 ? -1 : local[at(t.a)], local[at(t.b)]));
  }
  std::erase_if(out, [](const ContactSprings& one) { return one.contacts.empty(); });
  return out;
}

}  // namespace

StandingScene standing_scene(const Scene& scene) {
  StandingScene out{touching_bodies(scene), {}};
  out.groups = groups_of(scene, out.touching);
  return out;
}

int depth_of(const ContactSprings& group) {
  std::vector<std::vector<int>> next(group.bodies.size());
  std::vector<int> depth(group.bodies.size(), 0), reached;
  for (const ContactRows& c : group.contacts) {
    const int a = c.points[0].a, b = c.points[0].b;
    if (a >= 0) {
      next[at(a)].push_back(b), next[at(b)].push_back(a);
    } else if (depth[at(b)] == 0) {
      depth[at(b)] = 1, reached.push_back(b);
    }
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const int other : next[at(reached[i])]) {
      if (depth[at(other)] != 0) continue;
      depth[at(other)] = depth[at(reached[i])] + 1, reached.push_back(other);
    }
  }
  return reached.empty() ? 0 : depth[at(reached.back())];
}

BodyId highest_of(const Scene& scene, const ContactSprings& group) {
  const Vec3 down = scene.options.gravity;
  const auto it = std::min_element(group.bodies.begin(), group.bodies.end(),
                                   [&](const StandingBody* a, const StandingBody* b) {
                                     return down.dot(a->top) < down.dot(b->top);
                                   });
  return BodyId((*it)->body);
}

}  // namespace manyworlds
