// Impacts of several bodies at once that have a closed form.
#include <algorithm>
#include <cmath>
#include <string>

#include "tools/invariants/energy_hits.hpp"

namespace manyworlds::invariants {
namespace {

constexpr int kStepsOfHit = 6;

double mass_of_ball(Space space, double radius, double density) {
  return density * scenes::kPi *
         (space == Space::planar ? radius * radius : 4.0 / 3 * radius * radius * radius);
}
Body ball(Space space, double radius, double mass, const Material& material) {
  Body body =
      scenes::body_of(scenes::shape_of(scenes::round_of(space, radius), material), Vec3::Zero());
  body.shapes[0].density = mass / mass_of_ball(space, radius, 1);
  return body;
}

// Largest deviation of a velocity from the expected one, over the speed of the impact.
Judge velocities_judge(std::vector<Vec3> expected, double speed, int from) {
  return [expected = std::move(expected), speed, from](const Seen& seen) {
    if (seen.step < from) return 0.0;
    double worst = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      worst = std::max(worst, (seen.now[i].velocity - expected[i]).norm());
    }
    return worst / speed;
  };
}

// A ball hits several equal ones at once that stand in a ring around its path, or two in the plane,
// under equal angles; they may touch one another.
Drawn ball_on_ring(Random& kind, Random& state, const Scale& scale, Space space, double e) {
  Drawn out;
  out.scene = free_scene(space, scale);
  const int count = space == Space::planar ? 2 : kind.integer(2, 5);
  const double radius = scale.length, ring_radius = scale.length * kind.log_uniform(0.3, 1);
  const double restitution = e < 0 ? kind.uniform(0.05, 0.95) : e;
  const double mass = mass_of_ball(space, radius, 1000), ratio = kind.log_uniform(0.01, 100);
  const Material material{0, restitution};
  out.scene.add(ball(space, radius, mass, material));
  for (int i = 0; i < count; ++i) out.scene.add(ball(space, ring_radius, mass * ratio, material));
  const bool touching = kind.chance(0.5);  // one another

  // From the path to the centres of the ring, seen from the ball at the moment of the hit.
  const double sum = radius + ring_radius;
  const double least = std::asin(ring_radius / std::sin(scenes::kPi / count) / sum);
  const double angle = touching ? least : least + state.uniform(0.01, 0.9) * (1.3 - least);
  const double speed = 0.99 * std::min(radius, ring_radius) / scale.dt * state.log_uniform(0.01, 1);
  const double lead = state.uniform(0.05, 1.5);
  const Vec3 along = draw_direction(state, space);
  Vec3 aside(-along.y(), along.x(), 0);
  if (space == Space::spatial) aside = along.cross(draw_direction(state, space));
  aside.normalize();

  // All contacts have the same impulse: rate of approach u = v cos(angle) at each, and the ball
  // is slowed by the sum of them.
  const double approach = speed * std::cos(angle);
  const double impulse = (1 + restitution) * approach /
                         (1 / (mass * ratio) + count * std::pow(std::cos(angle), 2) / mass);
  std::vector<Vec3> expected{(speed - count * impulse * std::cos(angle) / mass) * along};
  out.scene.bodies[0].linear_velocity = speed * along;
  out.scene.bodies[0].position = -speed * lead * scale.dt * along;
  for (int i = 0; i < count; ++i) {
    const Quat turn(Eigen::AngleAxisd(2 * scenes::kPi * i / count, along));
    const Vec3 side = space == Space::planar ? Vec3(i == 0 ? aside : Vec3(-aside)) : turn * aside;
    const Vec3 normal = std::cos(angle) * along + std::sin(angle) * side;
    out.scene.bodies[static_cast<std::size_t>(i + 1)].position = sum * normal;
    expected.push_back(impulse / (mass * ratio) * normal);
  }
  out.steps = kStepsOfHit;
  out.judge = velocities_judge(expected, speed, 4);
  return out;
}

// Equal elastic balls in a row: as many leave as come in.
Drawn cradle(Random& kind, Random& state, const Scale& scale, Space space) {
  Drawn out;
  out.scene = free_scene(space, scale);
  const int count = kind.integer(2, 8), moving = kind.integer(1, count - 1);
  const double radius = scale.length, mass = mass_of_ball(space, radius, 1000);
  for (int i = 0; i < count; ++i) out.scene.add(ball(space, radius, mass, {0, 1}));
  const double gap = kind.chance(0.5) ? 0 : radius * kind.log_uniform(1e-4, 0.03);
  const double speed = radius / scale.dt * state.log_uniform(0.03, 0.9);
  const double lead = speed * scale.dt * state.uniform(0.05, 1.5);
  const Vec3 along = draw_direction(state, space);
  std::vector<Vec3> expected;
  for (int i = 0; i < count; ++i) {
    Body& b = out.scene.bodies[static_cast<std::size_t>(i)];
    const bool moves = i < moving;
    b.position = (i * (2 * radius + gap) - (moves ? lead - gap : 0)) * along;
    b.linear_velocity = moves ? Vec3(speed * along) : Vec3(Vec3::Zero());
    expected.push_back(i >= count - moving ? Vec3(speed * along) : Vec3(Vec3::Zero()));
  }
  // The last hit starts when each ball has closed its gaps.
  const int last = 3 + static_cast<int>((count * gap) / (0.03 * radius));
  out.steps = last + 2;
  out.judge = velocities_judge(expected, speed, last);
  return out;
}

}  // namespace

std::vector<Family> several_energy_families() {
  std::vector<Family> out;
  const auto add = [&](const std::string& id, const std::string& title, Draw draw) {
    Family f;
    f.id = id, f.law = Law::energy, f.title = title;
    f.criterion = "largest deviation of a velocity from the closed form over the speed of the ball";
    f.limit = 0.01;
    f.draw = std::move(draw);
    out.push_back(std::move(f));
  };
  for (const Space space : {Space::planar, Space::spatial}) {
    const std::string in = space == Space::planar ? " 2D" : " 3D";
    for (const auto& [name, e] :
         {std::pair("plastic", 0.0), {"elastic", 1.0}, {"partly elastic", -1.0}}) {
      add(name + std::string(" ball on several") + in,
          name + std::string(" ball that hits two or more equal ones at once, without friction"),
          [=, e = e](Random& kind, Random& state, const Scale& scale) {
            return ball_on_ring(kind, state, scale, space, e);
          });
    }
    add("cradle" + in, "row of 2 to 8 equal elastic balls with or without gaps, hit by 1 or more",
        [=](Random& kind, Random& state, const Scale& scale) {
          return cradle(kind, state, scale, space);
        });
  }
  return out;
}

}  // namespace manyworlds::invariants
