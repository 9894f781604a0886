// Coulomb's law: bodies that slide without spin follow a curve that is known, and slipping contacts
// have the friction impulse mu N against the slip.
#include <algorithm>
#include <cmath>

#include "tools/invariants/path.hpp"
#include "tools/invariants/statics.hpp"

namespace manyworlds::invariants {
namespace {

// Friction of a pair, split over the two materials, whose geometric mean counts.
struct Pair {
  Material floor, body;
};
Pair pair_of(Random& kind, double friction) {
  const double share = kind.log_uniform(0.5, 2);
  Pair out;
  out.floor.friction = friction * share, out.body.friction = friction / share;
  return out;
}

Drawn draw_slide(Space space, Random& kind, Random& state, const Scale& scale) {
  constexpr int kSteps = 150;
  const bool planar = space == Space::planar;
  Drawn out{scene_of(space, scale), kSteps};
  const double dt = scale.dt, fall = scale.gravity * dt * dt;
  // Stops after 60 to 140 steps on level ground, and moves less than a length per step.
  const double steps = kind.uniform(60, 140),
               fastest = std::min(2.0, scale.length / (steps * fall));
  const double wanted = kind.log_uniform(0.02, fastest);
  // Standing first: what tips is not the law's.
  const Material any{};
  Standing standing = draw_standing(kind, space, 0.5 * scale.length, any);
  const double center = standing.height + standing.center.dot(scenes::up_of(space));
  const double friction = std::min(wanted, 0.7 * standing.support / center);
  const double share = kind.chance(0.5) ? kind.uniform(0, 1) : 0;
  const double tilt = share * std::asin(std::min(0.6, scale.length / (kSteps * fall)));
  const double speed = steps * friction * scale.gravity * dt;
  const double slope = scale.gravity * std::sin(tilt), time = kSteps * dt;
  const Pair pair = pair_of(kind, friction);
  FloorDraw floor_draw{.extent = 2 * (speed * time + 0.5 * slope * time * time) + 10 * scale.length,
                       .tilt = tilt,
                       .material = pair.floor,
                       .belt = speed * kind.uniform(0.1, 1)};
  const Floor floor = add_floor(out.scene, kind, scale, floor_draw);
  for (Shape& s : standing.body.shapes) s.material = pair.body;
  for (Shape& s : standing.body.shapes) s.density = 1000;

  const Vec3 at = 0.5 * scale.length * state.in_cube(1);
  const double yaw = state.uniform(-scenes::kPi, scenes::kPi);
  const double fast = state.uniform(0.9, 1), way = state.uniform(-scenes::kPi, scenes::kPi);
  Body body =
      stand(space, standing, floor, planar ? Vec3(at.x(), 0, 0) : Vec3(at.x(), at.y(), 0), yaw);
  Vec3 along(std::cos(way), std::sin(way), 0);
  if (planar) along = Vec3(way < 0 ? -1 : 1, 0, 0);
  body.linear_velocity = floor.velocity + floor.rotation * (speed * fast * along);
  const BodyId id = out.scene.add(body);

  const Vec3 normal = floor.rotation * scenes::up_of(space);
  const Vec3 mass_center = mass_of(out.scene, id).center;
  const auto where = [mass_center](const BodyNow& b) {
    return Vec3(b.position + b.rotation * mass_center);
  };
  Path path(body.position + body.rotation.normalized() * mass_center, body.linear_velocity,
            floor.velocity, out.scene.options.gravity, normal, friction);
  const std::size_t i = static_cast<std::size_t>(id.index());
  out.judge = [=](const Seen& seen) mutable {
    if (seen.step == 0) return 0.0;
    path.advance(dt);
    if (seen.step < 20) return 0.0;
    const Quat turned = seen.now[i].rotation * body.rotation.normalized().conjugate();
    const double turn = 2 * std::abs(std::atan2(turned.vec().dot(normal), turned.w()));
    return std::max(path.deviation(where(seen.now[i]), normal, dt),
                    std::min(turn, 2 * scenes::kPi - turn) / 0.02);
  };
  return out;
}

}  // namespace

std::vector<Family> friction_cone_families();     // friction_cone.cpp
std::vector<Family> friction_rolling_families();  // friction_rolling.cpp

std::vector<Family> friction_families() {
  Family slide;
  slide.id = "slide", slide.law = Law::friction;
  slide.title = "a body slides without spin on a floor, slope, height field or conveyor";
  slide.criterion =
      "distance from Coulomb's path (1 % along it, 0.5 degrees aside), yaw (0.02 rad), the "
      "largest as a share of what is allowed";
  slide.limit = 1;
  std::vector<Family> out = in_both_spaces(slide, draw_slide);
  for (Family& f : friction_cone_families()) out.push_back(std::move(f));
  for (Family& f : friction_rolling_families()) out.push_back(std::move(f));
  return out;
}

}  // namespace manyworlds::invariants
