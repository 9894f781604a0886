#include "src/plan/stiff_drives.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "src/plan/plan_data.hpp"
#include "src/plan/substeps.hpp"
#include "src/scene/joint_numbers.hpp"

namespace manyworlds {

namespace {

constexpr double kMost = 1;  // of the inertia

// kg m^2 or kg, that a drive moves of a body that is free but for its anchor.
double inertia_of(const Scene& scene, BodyId id, const Frame& frame, bool turns) {
  if (!id || scene.at(id).motion != Motion::dynamic) return std::numeric_limits<double>::infinity();
  const MassProperties of = mass_properties(scene, scene.at(id));
  if (!turns) return of.mass;
  const Vec3 axis = scene.space == Space::planar
                        ? Vec3(Vec3::UnitZ())
                        : Vec3(frame.rotation.normalized() * Vec3::UnitZ());
  const Vec3 arm = frame.position - of.center;
  return axis.dot(of.inertia * axis) + of.mass * axis.cross(arm).squaredNorm();
}

// m/s or rad/s: the fastest target of a motor, by its controls, too.
double fastest_of(const Scene& scene, JointId joint, const Drive& motor) {
  double out = std::abs(motor.target_speed);
  for (const Control& control : scene.controls) {
    if (control.kind != ControlKind::target_speed || control.joint != joint) continue;
    out = std::max({out, std::abs(control.low), std::abs(control.high)});
  }
  return out;
}

// What the drive adds to the inertia of its coordinate in a substep of h, over that inertia; of a
// motor, how much more it can do than reach its speed.
double stiffness_of(const Scene& scene, JointId id, const Drive& drive, double h) {
  const Joint& joint = scene.at(id);
  const bool turns = !std::holds_alternative<SliderJoint>(joint.type);
  const double inertia = std::min(inertia_of(scene, joint.body_a, joint.frame_a, turns),
                                  inertia_of(scene, joint.body_b, joint.frame_b, turns));
  if (!drive.spring) {
    if (std::isinf(drive.max_force)) return drive.max_force;
    const double needed = inertia * fastest_of(scene, id, drive);
    return needed > 0 ? h * drive.max_force / needed : 0;
  }
  if (drive.spring->frequency > 0) {
    const double w = 2 * std::numbers::pi * drive.spring->frequency * h;
    return w * w + 2 * drive.spring->damping_ratio * w;
  }
  return (h * drive.spring->damping + h * h * drive.spring->stiffness) / inertia;
}

}  // namespace

std::string need_of_drives(const Scene& scene, const SceneTrees& trees) {
  const double h = scene.options.dt / scene.options.substeps.value_or(kLeastSubsteps);
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    if (!trees.has_joint[j]) continue;
    const Joint& joint = scene.joints[j];
    const Drive* drive = drive_of(joint.type);
    // Wheels are light beside what they carry, and free to slide along x.
    if (drive == nullptr || std::holds_alternative<WheelJoint>(joint.type)) continue;
    const bool a_moves = joint.body_a && scene.at(joint.body_a).motion == Motion::dynamic;
    const BodyId moving = a_moves ? joint.body_a : joint.body_b;
    if (trees.joints_hanging[static_cast<std::size_t>(moving.index())] < 2) continue;
    const double stiffness = stiffness_of(scene, JointId(static_cast<int>(j)), *drive, h);
    if (stiffness <= kMost) continue;
    if (drive->spring) {
      return joint_text(j) + " has a drive that is " + short_text(stiffness) +
             " times as stiff in a substep as the inertia it moves";
    }
    return joint_text(j) + " has a motor that reaches its speed in a substep";
  }
  return {};
}

}  // namespace manyworlds
