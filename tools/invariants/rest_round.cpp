// Logs and balls between fixed faces, and bodies in grips.
#include <algorithm>
#include <cmath>

#include "tools/invariants/rest_assembly.hpp"

namespace manyworlds::invariants {
namespace {

// A log along y; a circle in the plane.
struct Log {
  Geometry geometry;
  double radius, half;  // m; half length of the line of contact, 0: a point
};
Log draw_log(Random& r, Space space, double radius, double half) {
  if (space == Space::planar) return {Circle{radius}, radius, 0};
  if (r.chance(0.5)) return {Capsule{radius, half}, radius, half};
  return {Cylinder{radius, half}, radius, half};
}
Vec3 upward(Space space, double x, double z) {
  return space == Space::planar ? Vec3(x, z, 0) : Vec3(x, 0, z);
}
void touch(Assembly& out, int a, int b, const Vec3& point, const Vec3& normal, double half,
           double friction) {
  if (half == 0) out.touches.push_back({a, b, point, normal, friction});
  for (const double side : {-0.9, 0.9}) {
    if (half > 0) out.touches.push_back({a, b, point + Vec3(0, side * half, 0), normal, friction});
  }
}
Quat log_rotation(Space space) {
  return space == Space::planar ? Quat(Quat::Identity()) : scenes::z_to_y();
}

// One log in a groove of two planes.
Assembly groove(Space space, Random& r, const Scale& scale, double) {
  Assembly out{scene_of(space, scale)};
  const double friction = r.log_uniform(0.1, 2), size = 0.5 * scale.length;
  const double half = size * r.uniform(0.5, 2);
  const Log log = draw_log(r, space, size * r.uniform(0.3, 1), half);
  const double left = r.uniform(0.2, 1.2), right = r.uniform(0.2, 1.2),
               mass = draw_mass(r, scale, 1);
  const Vec3 normals[] = {upward(space, std::sin(left), std::cos(left)),
                          upward(space, -std::sin(right), std::cos(right))};
  for (const Vec3& n : normals) {
    Geometry face = Plane{n, 0};
    if (space == Space::planar) face = HalfPlane{{n.x(), n.y()}, 0};
    add_fixed(out.scene, face, Vec3::Zero(), Quat::Identity(), friction);
  }
  // On the line at the distance of the radius from both.
  const double height = std::cos((left - right) / 2) / std::cos((left + right) / 2);
  const double aside = std::sin((left - right) / 2) / std::cos((left + right) / 2);
  const Vec3 center = log.radius * upward(space, aside, height);
  add_block(out.scene, log.geometry, center, log_rotation(space), mass, friction);
  for (int i = 0; i < 2; ++i) {
    touch(out, i, 2, center - log.radius * normals[i], normals[i], log.half, friction);
  }
  out.free = false;
  if (space == Space::spatial) out.shift = Vec3(0, size, 0);
  return out;
}

// Rows of logs between two walls.
Assembly logs(Space space, Random& r, const Scale& scale, double) {
  Assembly out{scene_of(space, scale)};
  const double friction = r.log_uniform(0.1, 2), size = 0.5 * scale.length;
  out.scene.add(scenes::ground(space, friction));
  const Log log = draw_log(r, space, size * r.uniform(0.3, 1), size * r.uniform(0.5, 2));
  const int wide = r.integer(2, 4), rows = r.integer(1, wide);
  const double rad = log.radius, ratio = r.log_uniform(1, 100);
  for (const double side : {-1.0, 1.0}) {
    const Vec3 half(rad, 4 * log.half + rad, wide * 2 * rad);
    const Geometry wall =
        space == Space::planar ? Geometry(Polygon::box(rad, half.z())) : Geometry(Box{half});
    add_fixed(out.scene, wall, upward(space, side * (wide + 1) * rad, half.z()), Quat::Identity(),
              friction);
  }
  std::vector<Vec3> centers;
  std::vector<int> ids;
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < wide - row; ++i) {
      const double x = (2 * i - (wide - 1 - row)) * rad, mass = draw_mass(r, scale, ratio);
      centers.push_back(upward(space, x, rad * (1 + row * std::sqrt(3.0))));
      ids.push_back(
          add_block(out.scene, log.geometry, centers.back(), log_rotation(space), mass, friction)
              .index());
      const Vec3 up = scenes::up_of(space), across = upward(space, 1, 0), c = centers.back();
      if (row == 0) touch(out, 0, ids.back(), c - rad * up, up, log.half, friction);
      if (row == 0 && i == 0)
        touch(out, 1, ids.back(), c - rad * across, across, log.half, friction);
      if (row == 0 && i == wide - 1)
        touch(out, 2, ids.back(), c + rad * across, -across, log.half, friction);
    }
  }
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t j = i + 1; j < ids.size(); ++j) {
      const Vec3 d = centers[j] - centers[i];
      if (d.norm() > 2.001 * rad) continue;
      touch(out, ids[i], ids[j], centers[i] + d / 2, d.normalized(), log.half, friction);
    }
  }
  out.free = false;
  if (space == Space::spatial) out.shift = Vec3(0, size, 0);
  return out;
}

// A ball in the corner of three planes.
Assembly corner(Random& r, const Scale& scale, double) {
  Assembly out{scene_of(Space::spatial, scale)};
  const double friction = r.log_uniform(0.1, 2), radius = 0.5 * scale.length * r.uniform(0.3, 1);
  // Upward in the corner's frame: every plane carries some of the weight.
  const double x = r.uniform(0.2, 1), y = r.uniform(0.2, 1), z = r.uniform(0.2, 1);
  const Quat turn = Quat::FromTwoVectors(Vec3(x, y, z), Vec3::UnitZ());
  const double mass = draw_mass(r, scale, 1);
  for (int i = 0; i < 3; ++i) {
    add_fixed(out.scene, Plane{turn * Vec3::Unit(i), 0}, Vec3::Zero(), Quat::Identity(), friction);
  }
  const Vec3 center = turn * Vec3::Constant(radius);
  add_block(out.scene, Sphere{radius}, center, Quat::Identity(), mass, friction);
  for (int i = 0; i < 3; ++i) {
    const Vec3 n = turn * Vec3::Unit(i);
    touch(out, i, 3, center - radius * n, n, 0, friction);
  }
  out.free = false;
  return out;
}

// A body between a fixed wall and a jaw on a slider that presses with a given force.
Assembly grip(Space space, Random& r, const Scale& scale, double) {
  Assembly out{scene_of(space, scale)};
  const bool planar = space == Space::planar;
  const double friction = r.log_uniform(0.1, 2), size = 0.5 * scale.length;
  const double a = size * r.uniform(0.3, 1), b = size * r.uniform(0.3, 1),
               c = size * r.uniform(0.3, 1);
  const double t = size * r.uniform(0.2, 0.6), mass = draw_mass(r, scale, 1);
  const double jaw_mass = mass * r.log_uniform(0.1, 10);
  // Twice the wall's friction holds 1.2 / 0.8 of the weight, and more.
  const double force = 1.2 / 0.8 * mass * scale.gravity / (2 * friction) * r.uniform(1.05, 3);
  const auto plate = [&](double wide) {
    return planar ? Geometry(Polygon::box(wide, c)) : Geometry(Box{{wide, b, c}});
  };
  add_fixed(out.scene, plate(t), upward(space, -a - t, 0), Quat::Identity(), friction);
  Geometry held = plate(a);
  Quat turn = Quat::Identity();
  if (!planar && r.chance(0.5)) {
    held = Cylinder{std::min(b, c), a};
    turn = Quat(Eigen::AngleAxisd(scenes::kPi / 2, Vec3::UnitY()));
  }
  add_block(out.scene, held, Vec3::Zero(), turn, mass, friction);
  const BodyId jaw =
      add_block(out.scene, plate(t), upward(space, a + t, 0), Quat::Identity(), jaw_mass, friction);
  SliderJoint slider;
  slider.drive = Drive{.target_speed = -100 * scale.speed(), .max_force = force};
  out.scene.add(joint_at(out.scene, {}, jaw, scenes::frame_at(upward(space, a + t, 0)), slider));
  out.preloads = {{jaw.index(), Vec3(-force, 0, 0)}};
  out.margin.all_weights = true, out.closing = Vec3::UnitX();
  out.free = false;
  return out;
}

}  // namespace

std::vector<Family> rest_round_families() {
  std::vector<Family> out;
  for (const Space space : {Space::spatial, Space::planar}) {
    const std::string end = space == Space::planar ? " 2D" : " 3D";
    const auto add = [&](const char* id, const char* title, auto make) {
      out.push_back(
          rest_family(id + end, title, [space, make](Random& r, const Scale& s, double ease) {
            return make(space, r, s, ease);
          }));
    };
    add("log in a groove", "a capsule, cylinder or circle between two slopes", groove);
    add("logs between walls", "rows of logs between two walls, ratios of mass to 100", logs);
    add("grip", "a body between a wall and a jaw whose motor presses with a given force", grip);
  }
  out.push_back(rest_family("ball in a corner", "a ball between three planes", corner));
  return out;
}

}  // namespace manyworlds::invariants
