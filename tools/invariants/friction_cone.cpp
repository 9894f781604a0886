// Friction contact by contact, and turntables.
#include <algorithm>
#include <cmath>

#include "tools/invariants/statics.hpp"

namespace manyworlds::invariants {

std::vector<Family> friction_cone_families();

namespace {

constexpr double kHalfDegree = 0.5 * scenes::kPi / 180;

// ---- the cone -----------------------------------------------------------------------------------

// One manifold: all points of a pair of shapes.
struct Manifold {
  ShapeId a = {}, b = {};
  Vec3 normal = Vec3::Zero(), center = Vec3::Zero(), friction = Vec3::Zero();
  double impulse = 0;
};

// How far the friction of a step is from Coulomb's law, in the worst manifold that slips.
class ConeJudge {
 public:
  ConeJudge(const Scene& scene, double friction, double dt)
      : friction_(friction), dt_(dt), gravity_(scene.options.gravity.norm()) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const bool moves = scene.bodies[i].motion == Motion::dynamic;
      const MassProperties mass =
          moves ? mass_of(scene, BodyId(static_cast<int>(i))) : MassProperties{};
      centers_.push_back(mass.center);
      if (moves) least_ = std::min(least_, mass.mass);
    }
  }

  double operator()(const Seen& seen) {
    gather(seen);
    double worst = 0;
    for (const Manifold& m : manifolds_) worst = std::max(worst, deviation(m, seen));
    return worst;
  }

 private:
  Vec3 velocity(const BodyNow& b, std::size_t body, const Vec3& point, const BodyNow& start) const {
    // The point moves with the body; contacts are those of the start of the step.
    const Vec3 arm = point - start.position - start.rotation * centers_[body];
    return b.velocity + b.spin.cross(arm);
  }
  Vec3 slip(const Seen& seen, bool after, ShapeId a, ShapeId b, const Vec3& point,
            const Vec3& normal) const {
    const auto i = static_cast<std::size_t>(a.body().index());
    const auto j = static_cast<std::size_t>(b.body().index());
    const auto& states = after ? seen.now : seen.before;
    const Vec3 v = velocity(states[j], j, point, seen.before[j]) -
                   velocity(states[i], i, point, seen.before[i]);
    return v - v.dot(normal) * normal;
  }

  void gather(const Seen& seen) {
    manifolds_.clear();
    for (const StepContact& c : seen.contacts) {
      const auto same = [&](const Manifold& m) {
        return m.a == c.shape_a && m.b == c.shape_b && m.normal.dot(c.normal) > 1 - 1e-9;
      };
      auto m = std::find_if(manifolds_.begin(), manifolds_.end(), same);
      if (m == manifolds_.end()) {
        manifolds_.push_back({c.shape_a, c.shape_b, c.normal});
        m = manifolds_.end() - 1;
      }
      m->center += c.normal_impulse * c.point, m->friction += c.friction_impulse;
      m->impulse += c.normal_impulse;
    }
  }

  double deviation(Manifold m, const Seen& seen) const {
    if (m.impulse < 0.02 * least_ * gravity_ * dt_) return 0;
    m.center /= m.impulse;
    const Vec3 before = slip(seen, false, m.a, m.b, m.center, m.normal);
    const Vec3 after = slip(seen, true, m.a, m.b, m.center, m.normal);
    const double slow = 10 * friction_ * gravity_ * dt_;
    if (before.norm() < slow || after.norm() < slow) return 0;
    // One direction for the whole step, of which the impulse may act early or late, and for all
    // points of the manifold.
    const double change = std::acos(std::min(1.0, before.normalized().dot(after.normalized())));
    if (change > 0.05) return 0;
    for (const StepContact& c : seen.contacts) {
      if (!(c.shape_a == m.a && c.shape_b == m.b)) continue;
      const Vec3 at = slip(seen, true, m.a, m.b, c.point, m.normal);
      if (at.normalized().dot(after.normalized()) < std::cos(0.05)) return 0;
    }
    const Vec3 way = (before.normalized() + after.normalized()).normalized();
    const double along = -m.friction.dot(way), full = friction_ * m.impulse;
    const double aside = (m.friction + along * way).norm();
    return std::max(std::abs(m.friction.norm() / full - 1) / 0.01,
                    std::atan2(aside, along) / (kHalfDegree + 0.5 * change));
  }

  double friction_, dt_, gravity_, least_ = 1e300;
  std::vector<Vec3> centers_;  // m, of mass, in body frames
  std::vector<Manifold> manifolds_;
};

// Bodies that slide, tip and bounce at will; those on feet spin too.
Drawn draw_cone(Space space, Random& kind, Random& state, const Scale& scale) {
  constexpr int kSteps = 60;
  const bool planar = space == Space::planar;
  Drawn out{scene_of(space, scale), kSteps};
  out.contacts = true;
  const double dt = scale.dt, fall = scale.gravity * dt * dt;
  // Slips faster than the law's 10 mu g dt for a while.
  const double steps = kind.uniform(30, 100);
  const double friction = kind.log_uniform(0.02, std::min(2.0, scale.length / (steps * fall)));
  const double speed = steps * friction * scale.gravity * dt;
  const double share = kind.log_uniform(0.5, 2);
  Material floor_material, body_material;
  floor_material.friction = friction * share, body_material.friction = friction / share;
  if (kind.chance(0.3)) body_material.restitution = kind.uniform(0, 1);
  Standing standing = draw_standing(kind, space, 0.5 * scale.length, body_material);
  const double tilt = kind.uniform(0, 0.6), time = kSteps * dt;
  FloorDraw floor_draw{
      .extent = 4 * (speed * time + scale.gravity * time * time) + 10 * scale.length,
      .tilt = tilt,
      .material = floor_material,
      .belt = speed};
  const Floor floor = add_floor(out.scene, kind, scale, floor_draw);
  if (!planar && kind.chance(0.3)) {
    // Any inertia that a body of this size can have.
    out.scene.bodies.push_back(standing.body);
    MassProperties mass = mass_of(out.scene, BodyId(1));
    out.scene.bodies.pop_back();
    const double x = kind.uniform(0.2, 1), y = kind.uniform(0.2, 1), z = kind.uniform(0.2, 1);
    const double moment = 0.3 * mass.mass * standing.size * standing.size;
    mass.inertia = moment * Vec3(y + z, x + z, x + y).asDiagonal();
    standing.body.mass_properties = mass;
  }
  const Vec3 at = 0.5 * scale.length * state.in_cube(1);
  const double yaw = state.uniform(-scenes::kPi, scenes::kPi);
  const double fast = state.uniform(0.5, 1), way = state.uniform(-scenes::kPi, scenes::kPi);
  const double spin = state.uniform(-0.05, 0.05) / dt;
  Body body =
      stand(space, standing, floor, planar ? Vec3(at.x(), 0, 0) : Vec3(at.x(), at.y(), 0), yaw);
  const Vec3 along = planar ? Vec3(way < 0 ? -1 : 1, 0, 0) : Vec3(std::cos(way), std::sin(way), 0);
  body.linear_velocity = floor.velocity + floor.rotation * (speed * fast * along);
  const bool single_points = body.shapes.size() == 4;
  if (single_points) body.angular_velocity = floor.rotation * Vec3(0, 0, spin);
  out.scene.add(body);
  out.judge = ConeJudge(out.scene, friction, dt);
  return out;
}

// ---- turntables ---------------------------------------------------------------------------------

Drawn draw_turntable(Random& kind, Random& state, const Scale& scale) {
  constexpr int kSteps = 300;
  Drawn out{scene_of(Space::spatial, scale), kSteps};
  const double friction = kind.log_uniform(0.1, 2), share = kind.log_uniform(0.5, 2);
  Material body_material{.friction = friction / share};
  const Standing standing = draw_standing(kind, Space::spatial, 0.5 * scale.length, body_material);
  const double center = standing.height + standing.center.z();
  const double radius = scale.length * kind.uniform(0.5, 4),
               thick = scale.length * kind.uniform(0.1, 2);
  // Half of what friction and the width of the base can hold, and 0.1 rad a step.
  const double hold = 0.5 * scale.gravity * std::min(friction, standing.support / center);
  const double rate =
      std::min(std::sqrt(hold / radius), 0.1 / scale.dt) * (kind.chance(0.5) ? 1 : -1);
  const double edge = radius + 2 * scale.length;
  Body table;
  table.motion = Motion::kinematic;
  const Geometry disc =
      kind.chance(0.5) ? Geometry(Cylinder{edge, thick}) : Geometry(Box{{edge, edge, thick}});
  table.shapes.push_back(scenes::shape_of(disc, Material{.friction = friction * share}));
  table.position = Vec3(0, 0, -thick), table.angular_velocity = Vec3(0, 0, rate);
  Floor floor;
  floor.body = out.scene.add(table);
  const double where = state.uniform(-scenes::kPi, scenes::kPi);
  const double yaw = state.uniform(-scenes::kPi, scenes::kPi);
  const double out_at = radius * state.uniform(0.8, 1);
  Body body = stand(Space::spatial, standing, floor,
                    out_at * Vec3(std::cos(where), std::sin(where), 0), yaw);
  const Vec3 mass_center = standing.rotation.conjugate() * standing.center;
  const Vec3 arm = body.position + body.rotation.normalized() * mass_center;
  body.angular_velocity = table.angular_velocity;
  body.linear_velocity = table.angular_velocity.cross(arm);
  const auto i = static_cast<std::size_t>(out.scene.add(body).index());
  const Vec3 first(arm.x(), arm.y(), 0);
  const double dt = scale.dt;
  out.judge = [=](const Seen& seen) {
    const BodyNow& b = seen.now[i];
    Vec3 now = b.position + b.rotation * mass_center;
    now.z() = 0;
    const Vec3 expected = Eigen::AngleAxisd(rate * dt * seen.step, Vec3::UnitZ()) * first;
    return std::abs(now.norm() - first.norm()) / first.norm() +
           0.1 * (now - expected).norm() / first.norm();
  };
  return out;
}

}  // namespace

std::vector<Family> friction_cone_families() {
  Family cone;
  cone.id = "cone", cone.law = Law::friction;
  cone.title = "bodies slide, tip and bounce on floors, slopes, height fields and conveyors";
  cone.criterion =
      "friction impulse of a manifold in a step in which it slips faster than 10 mu g dt: "
      "mu N to 1 %, against the slip to 0.5 degrees, the larger as a share of what is allowed";
  cone.limit = 1;
  std::vector<Family> out = in_both_spaces(cone, draw_cone);
  Family f;
  f.id = "turntable";
  f.law = Law::friction;
  f.title =
      "a body stands on a rotating kinematic disc or box at half of the speed that friction holds";
  f.criterion =
      "drift of its radius, and a tenth of its distance from where the table carries it, over the "
      "radius";
  f.limit = 0.01;
  f.draw = draw_turntable;
  out.push_back(std::move(f));
  return out;
}

}  // namespace manyworlds::invariants
