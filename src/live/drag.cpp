#include "src/live/drag.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>

#include "manyworlds/query.hpp"
#include "src/page/room.hpp"

namespace manyworlds::live {
namespace {

constexpr double kGravity = 9.81;  // m/s^2, where a scene has none
constexpr double kSag = 0.2;       // of the body's radius
constexpr double kStiffest = 1;    // rad of the spring's motion in a step() call
constexpr double kReach = 50;      // m: what is farther away pulls no more than this
constexpr double kLeast = 3;       // rad/s

// Which bodies joints connect with one, itself included.
std::vector<bool> connected_with(const Scene& scene, BodyId body) {
  std::vector<bool> out(scene.bodies.size());
  out[static_cast<std::size_t>(body.index())] = true;
  const auto moves = [&](BodyId id) {
    return id && scene.bodies[static_cast<std::size_t>(id.index())].motion == Motion::dynamic;
  };
  for (bool more = true; more;) {
    more = false;
    for (const Joint& joint : scene.joints) {
      if (!moves(joint.body_a) || !moves(joint.body_b)) continue;
      const auto a = static_cast<std::size_t>(joint.body_a.index());
      const auto b = static_cast<std::size_t>(joint.body_b.index());
      if (out[a] == out[b]) continue;
      out[a] = out[b] = more = true;
    }
  }
  return out;
}

std::vector<double> read(const Batch& batch, const KindOfWorlds& kind, int world, Field field) {
  std::vector<double> out(kind.plan.numbers(field));
  if (!out.empty()) batch.read(field, world, out);
  return out;
}

}  // namespace

PointMotion motion_of(const Batch& batch, const KindOfWorlds& kind, int world, BodyId body,
                      const Vec3& at) {
  const Scene& scene = kind.plan.scene();
  const bool planar = scene.space == Space::planar;
  const auto row = static_cast<std::size_t>(kind.plan.row(body));
  const auto x = read(batch, kind, world, Field::position);
  const auto q = read(batch, kind, world, Field::orientation);
  const auto v = read(batch, kind, world, Field::linear_velocity);
  const auto w = read(batch, kind, world, Field::angular_velocity);
  const MassProperties mass =
      mass_properties(scene, scene.bodies[static_cast<std::size_t>(body.index())]);
  Quat turn = Quat::Identity();
  PointMotion out;
  Vec3 position = Vec3::Zero(), spin = Vec3::Zero();
  if (planar) {
    position = {x[2 * row], x[2 * row + 1], 0};
    out.velocity = {v[2 * row], v[2 * row + 1], 0};
    spin.z() = w[row];
    if (!q.empty()) {
      turn = Eigen::AngleAxisd(std::atan2(q[2 * row + 1], q[2 * row]), Vec3::UnitZ());
    }
  } else {
    position = {x[3 * row], x[3 * row + 1], x[3 * row + 2]};
    out.velocity = {v[3 * row], v[3 * row + 1], v[3 * row + 2]};
    spin = {w[3 * row], w[3 * row + 1], w[3 * row + 2]};
    if (!q.empty()) {
      turn = Quat(q[4 * row], q[4 * row + 1], q[4 * row + 2], q[4 * row + 3]).normalized();
    }
  }
  out.point = position + turn * at;
  // A point that does not turn with the body moves as its centre.
  if (!kind.plan.has(Feature::orientation)) return out;
  out.velocity +=
      spin.cross(turn * (at - mass.center));  // velocities are those of the centre of mass
  return out;
}

Drag make_drag(const KindOfWorlds& kind, int world, BodyId body, const Vec3& at) {
  const Scene& scene = kind.plan.scene();
  const auto index = static_cast<std::size_t>(body.index());
  Drag out{.world = world, .body = body, .at = at};
  if (scene.bodies[index].motion != Motion::dynamic) return out;
  const std::vector<bool> connected = connected_with(scene, body);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (connected[b] && scene.bodies[b].motion == Motion::dynamic) {
      out.mass += mass_properties(scene, scene.bodies[b]).mass;
    }
  }
  const MassProperties own = mass_properties(scene, scene.bodies[index]);
  out.turns = kind.plan.has(Feature::orientation);
  const Vec3 arm = out.turns ? Vec3(at - own.center) : Vec3::Zero();
  double most = 1 / own.mass;  // 1/kg, what a force at the point moves it by
  if (scene.space == Space::planar) {
    if (own.inertia(2, 2) > 0) most += arm.head<2>().squaredNorm() / own.inertia(2, 2);
  } else {
    Mat3 cross;
    cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
    const Mat3 turned = cross.transpose() * own.inertia.inverse() * cross;
    if (turned.allFinite()) {
      most += Eigen::SelfAdjointEigenSolver<Mat3>(turned, Eigen::EigenvaluesOnly)
                  .eigenvalues()
                  .maxCoeff();
    }
  }
  out.light = 1 / most;
  const double g = std::max(scene.options.gravity.norm(), kGravity);
  out.rate = std::max(kLeast, std::sqrt(g / (kSag * page::drawn_radii(scene)[index])));
  return out;
}

void add_drag(Batch& batch, const KindOfWorlds& kind, const Drag& drag, int steps) {
  if (drag.mass == 0) return;
  const Scene& scene = kind.plan.scene();
  const PointMotion now = motion_of(batch, kind, drag.world, drag.body, drag.at);
  const double h = std::max(1, steps) * scene.options.dt;
  const double rate = std::min(drag.rate, kStiffest / h);
  const double stiffness = rate * rate * drag.mass, damping = 2 * rate * drag.mass;
  Vec3 apart = drag.to - now.point;
  if (scene.space == Space::planar) apart.z() = 0;
  if (const double far = apart.norm(); far > kReach) apart *= kReach / far;
  // Implicit Euler, of the point alone.
  const double scale = 1 / (1 + (damping * h + stiffness * h * h) / drag.light);
  const Vec3 force = scale * (stiffness * (apart - h * now.velocity) - damping * now.velocity);
  if (!force.allFinite()) return;
  if (drag.turns) {
    batch.add_force_at(drag.world, drag.body, force, now.point);
  } else {
    batch.add_force(drag.world, drag.body, force);
  }
}

}  // namespace manyworlds::live
