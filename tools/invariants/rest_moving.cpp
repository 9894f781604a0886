// What is out of balance by 5 % moves.
#include <algorithm>
#include <cmath>

#include "tools/invariants/rest_assembly.hpp"

namespace manyworlds::invariants {
namespace {

// A body on a slope that is 5 to 30 % above the threshold.
Drawn draw_steep(Space space, Random& kind, Random& state, const Scale& scale) {
  Drawn out{scene_of(space, scale)};
  const Material any{};
  Standing standing = draw_standing(kind, space, 0.5 * scale.length, any);
  const double center = standing.height + standing.center.dot(scenes::up_of(space));
  const double wanted = kind.log_uniform(0.05, 1);
  const double friction = std::min(wanted, 0.6 * standing.support / center);
  const double tilt = std::atan(friction * kind.uniform(1.05, 1.3));
  const double pull =
      scale.gravity * (std::sin(tilt) - friction * std::cos(tilt));  // m/s^2 down the slope
  // Three lengths, below a length per step.
  const double time = std::sqrt(6 * scale.length / pull),
               fastest = scale.length / (pull * scale.dt);
  out.steps = std::clamp(static_cast<int>(std::min(time, fastest) / scale.dt), 60, kRestSteps);
  for (Shape& s : standing.body.shapes) s.material.friction = friction;
  const FloorDraw draw{
      .extent = 20 * scale.length, .tilt = tilt, .material = {.friction = friction}};
  const Floor floor = add_floor(out.scene, kind, scale, draw);
  Vec3 at = scale.length * state.in_cube(1);
  const double yaw = state.uniform(-scenes::kPi, scenes::kPi);
  if (space == Space::planar) at.y() = 0;
  at.z() = 0;
  out.scene.add(stand(space, standing, floor, at, yaw));
  const Vec3 start = out.scene.bodies[1].position;
  const double way = 0.5 * pull * std::pow(out.steps * scale.dt, 2);
  out.judge = [start, way](const Seen& seen) {
    return seen.last ? std::abs((seen.now[1].position - start).norm() / way - 1) : 0;
  };
  return out;
}

// Two equal columns of blocks, the upper one beyond the edge of the lower one by 5 to 20 %.
Drawn draw_overhang(Space space, Random& kind, Random& state, const Scale& scale) {
  Drawn out{scene_of(space, scale)};
  const double size = 0.5 * scale.length, friction = kind.log_uniform(0.3, 2);
  const double a = size * kind.uniform(0.5, 1), b = size * kind.uniform(0.5, 1);
  const double c = size * kind.uniform(0.2, 1), beyond = kind.uniform(1.05, 1.2);
  const int upper = kind.integer(1, 3);
  const bool planar = space == Space::planar;
  const Geometry block = planar ? Geometry(Polygon::box(a, c)) : Geometry(Box{{a, b, c}});
  const double mass = draw_mass(kind, scale, 1);
  out.scene.add(scenes::ground(space, friction));
  Vec3 shift = scale.length * state.in_cube(1);
  const double yaw = state.uniform(-scenes::kPi, scenes::kPi);
  const Quat turn = planar ? Quat(Quat::Identity()) : Quat(Eigen::AngleAxisd(yaw, Vec3::UnitZ()));
  const Vec3 up = scenes::up_of(space);
  shift -= shift.dot(up) * up;
  if (planar) shift.z() = 0;
  // The lower one is heavy, so that it does not tip with the rest.
  for (int i = 0; i <= upper; ++i) {
    const Vec3 at = (i == 0 ? 0 : beyond * a) * Vec3::UnitX() + (2 * i + 1) * c * up;
    add_block(out.scene, block, turn * at + shift, turn, i == 0 ? 20 * mass : mass, friction);
  }
  // It leaves its unstable balance at the rate sqrt(g / l).
  const double time = 12 * std::sqrt((a + (2 * upper) * c) / scale.gravity);
  out.steps = std::clamp(static_cast<int>(time / scale.dt), 60, kRestSteps);
  const auto last = out.scene.bodies.size() - 1;
  const Vec3 start = out.scene.bodies[last].position;
  out.judge = [start, last, size](const Seen& seen) {
    if (!seen.last) return 0.0;
    return std::max(0.0, 1 - (seen.now[last].position - start).norm() / (0.2 * size));
  };
  return out;
}

}  // namespace

std::vector<Family> must_move_families() {
  std::vector<Family> out;
  for (const Space space : {Space::spatial, Space::planar}) {
    const std::string end = space == Space::planar ? " 2D" : " 3D";
    Family f;
    f.law = Law::rest;
    f.id = "slope too steep" + end;
    f.title = "a body on a slope 5 to 30 % above the threshold";
    f.criterion = "way down the slope against half of g (sin - mu cos) t^2, relative";
    f.limit = 0.2;
    f.draw = [space](Random& k, Random& s, const Scale& scale) {
      return draw_steep(space, k, s, scale);
    };
    out.push_back(f);
    f.id = "overhang" + end;
    f.title = "blocks whose centre of mass is 5 to 20 % of their half width beyond an edge";
    f.criterion = "1 less the way of the highest block over 0.2 of half a size";
    f.limit = 0.5;
    f.draw = [space](Random& k, Random& s, const Scale& scale) {
      return draw_overhang(space, k, s, scale);
    };
    out.push_back(f);
  }
  return out;
}

}  // namespace manyworlds::invariants
