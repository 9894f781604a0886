// Motors and drives: no motor passes a limit of its joint, and drives reach their targets.
#include <algorithm>
#include <cmath>

#include "tools/invariants/joint_families.hpp"
#include "tools/invariants/joint_systems.hpp"
#include "tools/invariants/states.hpp"

namespace manyworlds::invariants {
namespace {

constexpr int kMotorSteps = 300;

bool is_slider(const Joint& joint) { return std::holds_alternative<SliderJoint>(joint.type); }

// A chain of links on hinges and sliders, from the world or a free body.
Scene draw_chain(Random& kind, Space space, const Scale& scale, int links, double mass_ratio) {
  Scene scene = free_scene(space, scale);
  const bool free = kind.chance(0.2);
  BodyId before;
  Vec3 end = Vec3::Zero();
  for (int i = 0; i < links + (free ? 1 : 0); ++i) {
    const Geometry geometry = draw_shape(kind, space, 0.5 * scale.length);
    Body body = scenes::body_of(scenes::shape_of(geometry), Vec3::Zero());
    body.shapes[0].filter.mask = 0;
    body.rotation = draw_rotation(kind, space);
    const Vec3 direction = draw_direction(kind, space);
    const double radius = outer_radius(geometry);
    // From through the axis to well off it.
    body.position = end + radius * kind.uniform(0, 1.5) * direction;
    const BodyId id = scene.add(body);
    set_mass(scene, id, unit_mass(space, scale) * kind.log_uniform(1, mass_ratio));
    if (i > 0 || !free) {
      const bool slides = kind.chance(0.3);
      scene.add(joint_at(scene, before, id, {end, draw_rotation(kind, space)},
                         slides ? JointType(SliderJoint{}) : JointType(HingeJoint{})));
    }
    before = id, end = body.position + radius * direction;
  }
  return scene;
}

// The mass or inertia that a joint moves if all beyond it is rigid and stretched out, at most,
// with sliders out by `most_travel`.
std::vector<double> most_inertia(const Scene& scene, double most_travel) {
  std::vector<double> out;
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const Joint& joint = scene.joints[j];
    double sum = 0, reach = 0;
    for (std::size_t k = j; k < scene.joints.size(); ++k) {
      const Joint& next = scene.joints[k];
      const MassProperties mass = mass_of(scene, next.body_b);
      const double arm = (mass.center - next.frame_b.position).norm();
      const double moment = mass.inertia.diagonal().maxCoeff() + mass.inertia.trace() / 2;
      sum += is_slider(joint) ? mass.mass : moment + mass.mass * (reach + arm) * (reach + arm);
      if (k > j && is_slider(next)) reach += most_travel;
      if (k + 1 < scene.joints.size()) {
        reach += (scene.joints[k + 1].frame_a.position - next.frame_b.position).norm();
      }
    }
    out.push_back(sum);
  }
  return out;
}

std::optional<Limit>& limit_of(Joint& joint) {
  if (auto* slider = std::get_if<SliderJoint>(&joint.type)) return slider->limit;
  return std::get<HingeJoint>(joint.type).limit;
}
std::optional<Drive>& drive_of(Joint& joint) {
  if (auto* slider = std::get_if<SliderJoint>(&joint.type)) return slider->drive;
  return std::get<HingeJoint>(joint.type).drive;
}

// ---- limits -------------------------------------------------------------------------------------

// Hard limits, and motors of any force that drive at them.
Drawn motors(Space space, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  out.scene = draw_chain(kind, space, scale, kind.integer(1, 4), kind.chance(0.3) ? 1 : 100);
  Scene& scene = out.scene;
  if (scene.joints.front().body_a == BodyId() && kind.chance(0.7)) {
    scene.options.gravity = scene_of(space, scale).options.gravity;
  }
  const std::vector<double> inertia = most_inertia(scene, scale.length);
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    Joint& joint = scene.joints[i];
    const double unit = is_slider(joint) ? scale.length : 1;
    limit_of(joint) = Limit{-unit * kind.log_uniform(0.01, 2), unit * kind.log_uniform(0.01, 2)};
    if (!kind.chance(0.7)) continue;
    Drive motor;
    motor.target_speed = unit * (kind.chance(0.5) ? 1 : -1) * kind.log_uniform(0.01, 1) / scale.dt;
    // As what would give it this speed in 1,000 steps or in a thousandth of one, or without bound.
    if (kind.chance(0.6)) {
      motor.max_force =
          inertia[i] * std::abs(motor.target_speed) / scale.dt * kind.log_uniform(1e-3, 1e3);
    }
    drive_of(joint) = motor;
  }
  set_moving(state, scene, state.log_uniform(0.01, 0.3) / scale.dt);
  out.steps = kMotorSteps;
  out.judge = [joints = scene.joints, scale](const Seen& seen) {
    double most = 0;
    for (Joint joint : joints) {
      const Limit& limit = *limit_of(joint);
      const double x = coordinate_of(joint, seen.now);
      const double beyond = std::max({limit.low - x, x - limit.high, 0.0});
      const double unit = is_slider(joint) ? scale.length : 1;
      most = std::max(most, beyond / std::max(0.01 * (limit.high - limit.low), 1e-3 * unit));
    }
    return most;
  };
  return out;
}

// ---- drives -------------------------------------------------------------------------------------

// All joints driven, at least critically damped: with stiffness k I and damping 2 z sqrt(k) I no
// motion of n joints is faster than damped if z^2 >= n, as x'M x <= n x'diag(I) x. The slowest
// decays with a time constant of 2 z / sqrt(k).
Drawn drives(Space space, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  const int links = kind.integer(1, 4);
  out.scene = draw_chain(kind, space, scale, links, kind.chance(0.3) ? 1 : 100);
  Scene& scene = out.scene;
  const auto count = static_cast<double>(scene.joints.size());
  const double z = std::sqrt(count) * kind.uniform(1, 3);
  const double k = kind.log_uniform(1e-3, 1e6) / (scale.dt * scale.dt);
  const double time = 2 * z / std::sqrt(k);
  const std::vector<double> inertia = most_inertia(scene, scale.length);
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    Joint& joint = scene.joints[i];
    const double unit = is_slider(joint) ? scale.length : 1;
    Drive drive;
    drive.target_position = unit * kind.uniform(-0.7, 0.7);
    drive.spring = Spring{k * inertia[i], 2 * z * std::sqrt(k) * inertia[i]};
    drive_of(joint) = drive;
    if (kind.chance(0.5)) limit_of(joint) = Limit{-unit, unit};
  }
  const double slow = 0.1 / std::max(time, scale.dt);
  set_moving(state, scene, state.chance(0.5) ? 0 : state.log_uniform(0.01, 1) * slow);
  const double steps = std::ceil(10 * time / scale.dt);
  out.steps = static_cast<int>(std::clamp(steps, 30.0, 4000.0));
  out.judge = [joints = scene.joints, scale,
               before = std::vector<double>()](const Seen& seen) mutable {
    double most = 0;
    std::vector<double> now;
    for (Joint joint : joints) {
      const double unit = is_slider(joint) ? scale.length : 1;
      const double x = coordinate_of(joint, seen.now);
      now.push_back(x);
      if (!seen.last) continue;
      const double target = drive_of(joint)->target_position;
      most = std::max(most, std::abs(x - target) / unit / 0.01);
      most = std::max(most, std::abs(x - before[now.size() - 1]) / unit / 0.001);
    }
    before = now;
    return most;
  };
  return out;
}

}  // namespace

std::vector<Family> joint_motor_families() {
  Family limits;
  limits.id = "motors at limits", limits.law = Law::joints;
  limits.title = "chains of hinges and sliders with hard limits and motors of any force";
  limits.criterion =
      "distance beyond a limit, over the larger of 1 % of the range, 1e-3 rad and 1e-3 of a length";
  limits.limit = 1;
  Family servos;
  servos.id = "drives", servos.law = Law::joints;
  servos.title = "chains of hinges and sliders with damped drives of any stiffness, no gravity";
  servos.criterion =
      "after ten time constants: distance from the target over 0.01 rad or lengths, or motion in "
      "the last step over 0.001";
  servos.limit = 1;
  std::vector<Family> out = in_both_spaces(limits, motors);
  for (Family& f : in_both_spaces(servos, drives)) out.push_back(std::move(f));
  return out;
}

}  // namespace manyworlds::invariants
