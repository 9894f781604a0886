// Arches, cards and ladders.
#include <algorithm>
#include <cmath>

#include "tools/invariants/rest_assembly.hpp"

namespace manyworlds::invariants {
namespace {

// A block whose outline in the plane of x and upward is given, counter-clockwise; in space it is
// 2 half wide along y.
struct Block {
  Geometry geometry;
  Vec3 position;
};
Block extruded(Space space, const std::vector<Vec2>& outline, double half) {
  Vec2 middle = Vec2::Zero();
  for (const Vec2& p : outline) middle += p / static_cast<double>(outline.size());
  if (space == Space::planar) {
    Polygon polygon;
    for (const Vec2& p : outline) polygon.vertices.push_back(p - middle);
    return {polygon, {middle.x(), middle.y(), 0}};
  }
  Hull hull;
  for (const Vec2& p : outline) {
    hull.vertices.push_back({p.x() - middle.x(), -half, p.y() - middle.y()});
    hull.vertices.push_back({p.x() - middle.x(), half, p.y() - middle.y()});
  }
  return {hull, {middle.x(), 0, middle.y()}};
}

// A ring of voussoirs, half a circle on the ground or less between fixed springers.
Assembly arch(Space space, Random& r, const Scale& scale, double ease) {
  Assembly out{scene_of(space, scale)};
  const double friction = r.log_uniform(0.3, 2), size = scale.length;
  const int count = r.integer(3, 11);
  const bool segment = r.chance(0.4);
  const double first = segment ? r.uniform(0.15, 0.8) : 0;
  const double inner = size * r.uniform(0.5, 2),
               thick = inner * (r.uniform(0.12, 0.4) + 0.2 * ease);
  const double depth = thick * r.uniform(0.5, 2), density = 1000 * r.log_uniform(0.1, 10);
  if (!segment) out.scene.add(scenes::ground(space, friction));
  const double each = (scenes::kPi - 2 * first) / count;
  for (int i = segment ? -1 : 0; i < (segment ? count + 1 : count); ++i) {
    const auto on = [&](double radius, double angle) {
      return Vec2(radius * Vec2(std::cos(angle), std::sin(angle)));
    };
    const double a = first + i * each, b = a + each;
    const Block block = extruded(
        space, {on(inner, a), on(inner + thick, a), on(inner + thick, b), on(inner, b)}, depth);
    if (i < 0 || i == count) {
      add_fixed(out.scene, block.geometry, block.position, Quat::Identity(), friction);
      continue;
    }
    const BodyId id =
        add_block(out.scene, block.geometry, block.position, Quat::Identity(), 1, friction);
    out.scene.at(id).shapes[0].density = density;
  }
  out.free = !segment;
  if (space == Space::spatial) out.shift = Vec3(0, 0.05 * depth, 0);
  return out;
}

// A plank of length 2 l and thickness 2 t, turned by `lean` about its lower corner, which is at x
// on the ground: the right one if it leans to the right (lean < 0), else the left one.
Block leaning(Space space, double x, double l, double t, double lean, double half) {
  const Eigen::Rotation2Dd turn(lean);
  const Vec2 corner = turn * Vec2(lean < 0 ? t : -t, -l), middle = Vec2(x, 0) - corner;
  std::vector<Vec2> outline;
  for (const auto& [u, v] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
    outline.push_back(middle + turn * Vec2(u * t, v * l));
  }
  return extruded(space, outline, half);
}

// A plank whose upper edge rests on the face of another one, or on a wall.
Assembly lean(Space space, bool wall, Random& r, const Scale& scale, double) {
  Assembly out{scene_of(space, scale)};
  const double friction = r.log_uniform(0.3, 2), size = 0.5 * scale.length;
  out.scene.add(scenes::ground(space, friction));
  const double l = size * r.uniform(0.7, 2), t = l * r.uniform(0.02, 0.15),
               half = size * r.uniform(0.2, 1);
  const double alpha = r.uniform(0.1, 0.7), beta = r.uniform(0.1, 0.7),
               share = r.uniform(0.7, 0.95);
  const double density = 1000 * r.log_uniform(0.1, 10), ratio = r.log_uniform(0.1, 10);
  const Vec2 top(2 * l * std::sin(alpha), 2 * l * std::cos(alpha));
  const auto add = [&](const Block& block, double of) {
    const BodyId id =
        add_block(out.scene, block.geometry, block.position, Quat::Identity(), 1, friction);
    out.scene.at(id).shapes[0].density = of;
  };
  add(leaning(space, 0, l, t, -alpha, half), density);
  if (wall) {
    const double thick = size * r.uniform(0.1, 1), x = top.x();
    const Block block = extruded(
        space, {{x, 0}, {x + thick, 0}, {x + thick, 1.5 * top.y()}, {x, 1.5 * top.y()}}, 3 * half);
    add_fixed(out.scene, block.geometry, block.position, Quat::Identity(), friction);
    out.free = false;
    if (space == Space::spatial) out.shift = Vec3(0, half, 0);
    return out;
  }
  const double s = top.y() / std::cos(beta), other = s / (2 * share);
  add(leaning(space, top.x() + s * std::sin(beta), other, t, beta, half), density * ratio);
  return out;
}

}  // namespace

std::vector<Family> rest_structure_families() {
  std::vector<Family> out;
  for (const Space space : {Space::spatial, Space::planar}) {
    const std::string end = space == Space::planar ? " 2D" : " 3D";
    out.push_back(rest_family(
        "arch" + end, "arches of 3 to 11 voussoirs on the ground or springers",
        [space](Random& r, const Scale& s, double ease) { return arch(space, r, s, ease); }));
    out.push_back(rest_family("cards" + end, "a card whose edge rests on the face of another one",
                              [space](Random& r, const Scale& s, double ease) {
                                return lean(space, false, r, s, ease);
                              }));
    out.push_back(rest_family(
        "ladder" + end, "a plank that leans against a fixed wall",
        [space](Random& r, const Scale& s, double ease) { return lean(space, true, r, s, ease); }));
  }
  return out;
}

}  // namespace manyworlds::invariants
