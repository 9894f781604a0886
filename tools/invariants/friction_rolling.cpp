// Resistance against rolling and spinning: balls roll along curves that are known, stay on slopes
// that they can resist, and tops stop after a known time.
#include <algorithm>
#include <cmath>

#include "tools/invariants/path.hpp"
#include "tools/invariants/rest_assembly.hpp"

namespace manyworlds::invariants {
namespace {

// Of a pair the larger number counts.
void share_out(Random& kind, double amount, double& a, double& b) {
  const double smaller = kind.chance(0.5) ? amount : kind.uniform(0, amount);
  const bool first = kind.chance(0.5);
  a = first ? amount : smaller, b = first ? smaller : amount;
}

// A ball, or in space a capsule or cylinder that lies on its side.
struct Roller {
  Geometry geometry = Sphere{};
  double radius = 0, lag = 0;  // m; I / (m r^2)
  bool log = false;
  Material material = {}, floor = {};
};
Roller draw_roller(Random& kind, Space space, double size) {
  Roller out;
  out.radius = size * kind.uniform(0.3, 1);
  const double half = out.radius * kind.uniform(0.3, 2);
  out.geometry = scenes::round_of(space, out.radius);
  out.log = space == Space::spatial && kind.chance(0.4);
  if (out.log && kind.chance(0.5)) {
    out.geometry = Capsule{out.radius, half};
  } else if (out.log) {
    out.geometry = Cylinder{out.radius, half};
  }
  Scene alone;
  alone.space = space;
  const MassProperties mass =
      mass_properties(alone, scenes::body_of(scenes::shape_of(out.geometry), Vec3::Zero()));
  out.lag = mass.inertia(2, 2) / (mass.mass * out.radius * out.radius);
  return out;
}
// `at`, and which way it rolls, in the frame of the floor; logs roll the way that the floor falls.
Body rolling_body(const Scene& scene, const Roller& roller, const Floor& floor, const Vec3& at,
                  Vec3 way, double speed) {
  const Vec3 normal = floor.rotation * scenes::up_of(scene.space);
  const Vec3& gravity = scene.options.gravity;
  const Vec3 fall = gravity - normal.dot(gravity) * normal;
  way = floor.rotation * way;
  if (roller.log && fall.norm() > 1e-6 * gravity.norm()) {
    way = std::copysign(1.0, way.dot(fall)) * fall.normalized();
  }
  Body body = scenes::body_of(scenes::shape_of(roller.geometry),
                              floor.rotation * at + roller.radius * normal);
  body.shapes[0].material = roller.material;
  if (roller.log) body.rotation = Quat::FromTwoVectors(Vec3::UnitZ(), normal.cross(way));
  body.linear_velocity = speed * way;
  body.angular_velocity = normal.cross(body.linear_velocity) / roller.radius;
  return body;
}

// On level ground and slopes, where it slows down, stops, stays, or goes on.
Drawn draw_roll(Space space, Random& kind, Random& state, const Scale& scale) {
  constexpr int kSteps = 150;
  const bool planar = space == Space::planar;
  Drawn out{scene_of(space, scale), kSteps};
  const double dt = scale.dt, fall = scale.gravity * dt * dt;
  Roller roller = draw_roller(kind, space, 0.5 * scale.length);
  // Stops after 60 to 140 steps on level ground, and turns by less than 0.4 rad a step.
  const double steps = kind.uniform(60, 140);
  const double fastest = std::min(0.3, 0.4 * roller.radius * (1 + roller.lag) / (steps * fall));
  const double resists = kind.log_uniform(std::min(0.002, 0.5 * fastest), fastest);
  // At the threshold rounding would decide.
  const double below = kind.uniform(0, 0.9), above = kind.uniform(1.1, 2);
  const int slope = kind.integer(0, 3);  // half of them are level
  const double share = slope == 3 ? above : slope == 2 ? below : 0;
  // Steeper slopes make it faster: less than 0.4 rad a step, too.
  const double steepest = 0.4 * roller.radius * (1 + roller.lag) / (kSteps * fall);
  const double tilt = std::min(std::atan(share * resists), std::asin(std::min(0.5, steepest)));
  const double brake = resists / (1 + roller.lag), speed = steps * brake * scale.gravity * dt;
  // So that it does not slip: what drives or brakes it at most.
  const double least = (std::tan(tilt) + resists) * 1.5;
  roller.material.friction = roller.floor.friction = least + kind.uniform(0, 1);
  share_out(kind, resists * roller.radius, roller.material.rolling_resistance,
            roller.floor.rolling_resistance);
  const double reach =
      speed * kSteps * dt + 0.5 * scale.gravity * std::sin(tilt) * std::pow(kSteps * dt, 2);
  const Floor floor =
      add_floor(out.scene, kind, scale,
                {.extent = 2 * reach + 10 * scale.length, .tilt = tilt, .material = roller.floor});

  const Vec3 at = 0.5 * scale.length * state.in_cube(1);
  const double fast = state.uniform(0.9, 1), way = state.uniform(-scenes::kPi, scenes::kPi);
  const bool rests = state.chance(0.2) && std::tan(tilt) > 1.05 * resists;
  Vec3 along(std::cos(way), std::sin(way), 0);
  if (planar) along = Vec3(way < 0 ? -1 : 1, 0, 0);
  const Body body =
      rolling_body(out.scene, roller, floor, planar ? Vec3(at.x(), 0, 0) : Vec3(at.x(), at.y(), 0),
                   along, rests ? 0 : speed * fast);
  out.scene.add(body);
  const Vec3 normal = floor.rotation * scenes::up_of(space);
  Path path(body.position, body.linear_velocity, Vec3::Zero(),
            out.scene.options.gravity / (1 + roller.lag), normal, resists);
  out.judge = [=](const Seen& seen) mutable {
    if (seen.step == 0) return 0.0;
    path.advance(dt);
    return seen.step < 20 ? 0.0 : path.deviation(seen.now[1].position, normal, dt);
  };
  return out;
}

// A ball or log that its resistance holds on a slope.
Drawn draw_held(Space space, Random& kind, Random& state, const Scale& scale) {
  const bool planar = space == Space::planar;
  Drawn out{scene_of(space, scale), kRestSteps};
  out.sleep = kind.chance(0.5);
  out.scene.options.sleep.time = kSleepSteps * scale.dt;
  Roller roller = draw_roller(kind, space, 0.5 * scale.length);
  const double resists = kind.log_uniform(0.01, 1);
  const double tilt = std::atan(resists * kind.uniform(0, 0.9));
  roller.material.friction = roller.floor.friction = std::tan(tilt) * 1.25 + kind.uniform(0.05, 1);
  share_out(kind, resists * roller.radius, roller.material.rolling_resistance,
            roller.floor.rolling_resistance);
  const Floor floor =
      add_floor(out.scene, kind, scale,
                {.extent = 10 * scale.length, .tilt = tilt, .material = roller.floor});
  const Vec3 at = scale.length * state.in_cube(1);
  out.scene.add(rolling_body(out.scene, roller, floor,
                             planar ? Vec3(at.x(), 0, 0) : Vec3(at.x(), at.y(), 0), Vec3::UnitX(),
                             0));
  out.judge = rest_judge(out.scene, out.sleep, floor.rotation * scenes::up_of(space));
  return out;
}

// A ball, or a brick without friction, that spins about the normal: a principal axis, or it would
// wobble.
Drawn draw_top(Random& kind, Random& state, const Scale& scale) {
  constexpr int kSteps = 150;
  Drawn out{scene_of(Space::spatial, scale), kSteps};
  const double dt = scale.dt, fall = scale.gravity * dt * dt, size = 0.5 * scale.length;
  const double steps = kind.uniform(60, 140), turn = kind.log_uniform(0.004, 0.4);
  const double a = size * kind.uniform(0.3, 1), b = size * kind.uniform(0.3, 1),
               height = size * kind.uniform(0.3, 1), rubs = kind.uniform(0, 1);
  const bool round = kind.chance(0.5);
  const Geometry geometry = round ? Sphere{height} : draw_brick(kind, Space::spatial, a, b, height);
  const double friction = round ? rubs : 0;
  Body body = scenes::body_of(scenes::shape_of(geometry), Vec3::Zero());
  Scene alone;
  const MassProperties mass = mass_properties(alone, body);
  // Decelerates by turn / steps rad a step.
  const double torsional = turn / steps * mass.inertia(2, 2) / (mass.mass * fall);
  Material of_floor{.friction = friction};
  body.shapes[0].material.friction = friction;
  share_out(kind, torsional, body.shapes[0].material.torsional_resistance,
            of_floor.torsional_resistance);
  add_floor(out.scene, kind, scale, {.extent = 10 * scale.length, .material = of_floor});
  const Vec3 at = scale.length * state.in_cube(1);
  const double yaw = state.uniform(-scenes::kPi, scenes::kPi);
  const double fast = state.uniform(0.9, 1) * (state.chance(0.5) ? -1 : 1);
  body.position = {at.x(), at.y(), height};
  body.rotation = Eigen::AngleAxisd(yaw, Vec3::UnitZ());
  body.angular_velocity = Vec3(0, 0, fast * turn / dt);
  out.scene.add(body);
  out.judge = [=](const Seen& seen) {
    if (seen.step < 20) return 0.0;
    const double left = std::max(std::abs(fast) - seen.step / steps, 0.0) * turn / dt;
    return std::abs(seen.now[1].spin.z() - std::copysign(left, fast)) * dt / turn;
  };
  return out;
}

}  // namespace

std::vector<Family> friction_rolling_families() {
  Family roll;
  roll.id = "roll with resistance", roll.law = Law::friction;
  roll.title = "a ball or log with rolling resistance on a floor, slope or height field";
  roll.criterion =
      "distance from the path of constant resistance (1 % along it, 0.5 degrees aside), as a share "
      "of what is allowed";
  roll.limit = 1;
  std::vector<Family> out = in_both_spaces(roll, draw_roll);
  Family held =
      rest_family("held from rolling",
                  "a ball or log on a slope up to 0.9 of what rolling resistance holds", {});
  for (Family& f : in_both_spaces(held, draw_held)) out.push_back(std::move(f));
  Family top;
  top.id = "spin with resistance", top.law = Law::friction;
  top.title = "a body that spins about the normal, with torsional resistance";
  top.criterion =
      "difference of the spin about the normal from the closed form, over the spin at the start";
  top.limit = 0.02;
  top.draw = draw_top;
  out.push_back(std::move(top));
  return out;
}

}  // namespace manyworlds::invariants
