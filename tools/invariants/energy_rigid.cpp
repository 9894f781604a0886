// Rigid bodies in free motion, and how shapes touch a plane.
#include <algorithm>
#include <cmath>
#include <variant>

#include "tools/invariants/energy_hits.hpp"

namespace manyworlds::invariants {

Mat3 Rigid::inverse_inertia() const {
  const Mat3 r = rotation.toRotationMatrix();
  return r * inv_inertia * r.transpose();
}
void Rigid::set_spin(const Vec3& spin) {
  const Mat3 r = rotation.toRotationMatrix();
  momentum = r * (inertia * (r.transpose() * spin));
}
double Rigid::energy() const {
  if (inv_mass == 0) return 0;
  return (velocity.squaredNorm() / inv_mass + momentum.dot(spin())) / 2;
}
void Rigid::push(const Vec3& impulse, const Vec3& point) {
  if (inv_mass == 0) return;
  velocity += inv_mass * impulse;
  momentum += (point - position).cross(impulse);
}
void Rigid::advance(double time) {
  if (inv_mass == 0) return;
  position += time * velocity;
  const auto turned = [](const Quat& q, const Vec3& angle) -> Quat {
    const double size = angle.norm();
    if (size == 0) return q;
    return (Quat(Eigen::AngleAxisd(size, angle / size)) * q).normalized();
  };
  const int parts = 1 + static_cast<int>(std::ceil(spin().norm() * std::abs(time) / 0.02));
  const double h = time / parts;
  for (int i = 0; i < parts; ++i) {  // midpoint rule
    const Quat start = rotation;
    rotation = turned(start, h / 2 * spin());
    rotation = turned(start, h * spin());
  }
}

Rigid rigid_of(const Scene& scene, BodyId id) {
  const Body& body = scene.at(id);
  Rigid out;
  if (body.motion == Motion::dynamic) {
    const MassProperties mass = mass_properties(scene, body);
    out.inv_mass = 1 / mass.mass, out.center = mass.center;
    if (scene.space == Space::planar) {
      out.inertia(2, 2) = mass.inertia(2, 2), out.inv_inertia(2, 2) = 1 / mass.inertia(2, 2);
    } else {
      out.inertia = mass.inertia, out.inv_inertia = mass.inertia.inverse();
    }
  }
  read_state(
      {body.position, body.rotation.normalized(), body.linear_velocity, body.angular_velocity},
      out);
  return out;
}
void put_state(Scene& scene, BodyId id, const Rigid& rigid) {
  Body& body = scene.at(id);
  body.position = rigid.origin(), body.rotation = rigid.rotation;
  body.linear_velocity = rigid.velocity, body.angular_velocity = rigid.spin();
}
void read_state(const BodyNow& now, Rigid& rigid) {
  rigid.rotation = now.rotation;
  rigid.position = now.position + now.rotation * rigid.center;
  rigid.velocity = now.velocity;
  rigid.set_spin(now.spin);
}
double energy_of(std::vector<Rigid>& bodies, const std::vector<BodyNow>& now) {
  double sum = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    read_state(now[i], bodies[i]);
    sum += bodies[i].energy();
  }
  return sum;
}

namespace {

// Corners of the shape, or the points of round ones that reach farthest along d.
std::vector<Vec3> corners(const Geometry& geometry, Space space, const Vec3& d) {
  if (const auto* s = std::get_if<Sphere>(&geometry)) return {s->radius * d};
  if (const auto* s = std::get_if<Circle>(&geometry)) return {s->radius * d};
  if (const auto* s = std::get_if<Hull>(&geometry)) return s->vertices;
  if (const auto* s = std::get_if<Ellipsoid>(&geometry)) {
    const Vec3 scaled = s->radii.cwiseProduct(d);
    return {s->radii.cwiseProduct(scaled) / scaled.norm()};
  }
  std::vector<Vec3> out;
  if (const auto* s = std::get_if<Box>(&geometry)) {
    for (int i = 0; i < 8; ++i) {
      out.push_back(
          s->half_extents.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    }
  } else if (const auto* p = std::get_if<Polygon>(&geometry)) {
    for (const Vec2& v : p->vertices) out.push_back(Vec3(v.x(), v.y(), 0) + p->radius * d);
  } else if (const auto* c = std::get_if<Capsule>(&geometry)) {
    const Vec3 along = space == Space::planar ? Vec3::UnitY() : Vec3::UnitZ();
    for (const double side : {-1.0, 1.0}) {
      out.push_back(side * c->half_length * along + c->radius * d);
    }
  } else if (const auto* y = std::get_if<Cylinder>(&geometry)) {
    const Vec3 across(d.x(), d.y(), 0);
    for (const double side : {-1.0, 1.0}) {
      const Vec3 end(0, 0, side * y->half_length);
      if (across.norm() > 1e-6) {
        out.push_back(end + y->radius * across.normalized());
      } else {
        for (int i = 0; i < 8; ++i) {
          const double angle = i * scenes::kPi / 4;
          out.push_back(end + y->radius * Vec3(std::cos(angle), std::sin(angle), 0));
        }
      }
    }
  }
  return out;
}

// Outward normals of the faces of a convex polytope below which `center` projects into the face.
std::vector<Vec3> stable_faces(const std::vector<Vec3>& vertices, Space space, const Vec3& center) {
  std::vector<Vec3> out;
  const std::size_t n = vertices.size(), last = space == Space::planar ? 1 : n;
  const double size = std::max(1e-300, (vertices[0] - vertices[n - 1]).norm());
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    Vec3 normal = (b - a).cross(c - a);
    if (normal.norm() < 1e-6 * size * size) return;
    normal.normalize();
    if (normal.dot(a - center) < 0) normal = -normal;
    for (const Vec3& v : vertices) {
      if (normal.dot(v - a) > 1e-9 * size) return;
    }
    // Inside the triangle, by a margin.
    const Vec3 foot = center + normal.dot(a - center) * normal, middle = (a + b + c) / 3;
    if (space == Space::planar) {
      const double at = (foot - a).dot(b - a) / (b - a).squaredNorm();
      if (at > 0.05 && at < 0.95) out.push_back(normal);
      return;
    }
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      const Vec3 inward =
          normal.cross(q - p) * ((middle - p).dot(normal.cross(q - p)) < 0 ? -1 : 1);
      if (inward.dot(foot - p) < 0.03 * inward.dot(middle - p)) return;
    }
    out.push_back(normal);
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (space == Space::planar) {
      const Vec3 a = vertices[i], b = vertices[(i + 1) % n];
      add(a, b, a + Vec3::UnitZ() * size);
      continue;
    }
    for (std::size_t j = i + 1; j < last; ++j) {
      for (std::size_t k = j + 1; k < last; ++k) add(vertices[i], vertices[j], vertices[k]);
    }
  }
  return out;
}

}  // namespace

std::vector<Vec3> farthest_points(const Geometry& geometry, Space space, const Vec3& direction) {
  std::vector<Vec3> all = corners(geometry, space, direction), out;
  double most = -1e300;
  for (const Vec3& p : all) most = std::max(most, direction.dot(p));
  const double near = 1e-7 * outer_radius(geometry);
  for (const Vec3& p : all) {
    if (direction.dot(p) > most - near) out.push_back(p);
  }
  return out;
}

Quat rotation_to(const Vec3& from, const Vec3& to) {
  if (from.z() == 0 && to.z() == 0) {
    const double turn = std::atan2(to.y(), to.x()) - std::atan2(from.y(), from.x());
    return Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
  }
  return Quat(Quat::FromTwoVectors(from, to)).normalized();
}

Vec3 draw_flat_side(Random& random, const Geometry& geometry, Space space, const Vec3& center) {
  const Vec3 axis = Vec3::Unit(random.integer(0, space == Space::planar ? 1 : 2));
  const double sign = random.chance(0.5) ? 1 : -1, angle = random.uniform(0, 2 * scenes::kPi);
  const Vec3 around(std::cos(angle), std::sin(angle), 0);
  if (std::holds_alternative<Capsule>(geometry)) {
    return space == Space::planar ? Vec3(sign, 0, 0) : around;
  }
  if (std::holds_alternative<Cylinder>(geometry)) {
    return random.chance(0.5) ? Vec3(0, 0, sign) : around;
  }
  const auto* hull = std::get_if<Hull>(&geometry);
  const auto* polygon = std::get_if<Polygon>(&geometry);
  if (!hull && !polygon) return sign * axis;
  const std::vector<Vec3> vertices = corners(geometry, space, Vec3::Zero());
  const std::vector<Vec3> sides = stable_faces(vertices, space, center);
  if (sides.empty()) return Vec3::Zero();
  return sides[static_cast<std::size_t>(random.integer(0, static_cast<int>(sides.size()) - 1))];
}

}  // namespace manyworlds::invariants
