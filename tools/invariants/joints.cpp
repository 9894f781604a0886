// Systems of joints: what is isolated keeps its momentum and energy, joints stay closed, and the
// two bodies of a joint have equal rights.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "tools/invariants/joint_families.hpp"
#include "tools/invariants/joint_systems.hpp"
#include "tools/invariants/momenta.hpp"
#include "tools/invariants/similarity.hpp"

namespace manyworlds::invariants {
namespace {

constexpr int kIsolatedSteps = 3600, kHungSteps = 600, kExchangeSteps = 60;
constexpr double kMostSpin = 1;  // rad a step

JointSystem draw_system(Space space, Random& kind, double mass_ratio) {
  JointSystem out;
  out.space = space, out.mass_ratio = kind.chance(0.3) ? 1 : mass_ratio;
  out.loop = kind.chance(0.3);
  const int least = out.loop ? 4 : 2;
  out.bodies = kind.chance(0.5) ? kind.integer(least, 5) : kind.integer(least, 20);
  return out;
}

// ---- isolated systems ---------------------------------------------------------------------------

// Changes over what is allowed of them.
struct Allowed {
  double linear = 1e-5, angular = 1e-3, energy = 1e-2;
};

// A slider takes its bodies apart for ever. Beyond this the speed of one body by the rotation of
// the other has no digit left of what is allowed in float32.
constexpr double kMostTravelOfSliders = 30;  // typical lengths

bool parted(const std::vector<Joint>& joints, double most, const std::vector<BodyNow>& bodies) {
  return std::any_of(joints.begin(), joints.end(), [&](const Joint& joint) {
    return std::holds_alternative<SliderJoint>(joint.type) &&
           std::abs(coordinate_of(joint, bodies)) > most;
  });
}

Judge isolated_judge(const Scene& scene, const Scale& scale, const Allowed& allowed) {
  return [masses = masses_of(scene), joints = scene.joints,
          most_travel = kMostTravelOfSliders * scale.length, allowed, start = Momenta(),
          ended = false](const Seen& seen) mutable {
    const bool single = seen.precision == Precision::f32;
    ended = ended || (single && parted(joints, most_travel, seen.now));
    if (ended) return 0.0;
    const Momenta now = momenta_of(masses, seen.now);
    if (seen.step == 0) start = now;
    double most = 0;
    for (const double share :
         {(now.linear - start.linear).norm() / (allowed.linear * start.linear_sum),
          (now.angular - start.angular).norm() / (allowed.angular * start.angular_sum),
          std::abs(now.kinetic - start.kinetic) / (allowed.energy * start.kinetic)}) {
      if (!std::isfinite(share)) return HUGE_VAL;
      most = std::max(most, share);
    }
    return most;
  };
}

Drawn isolated(Space space, Random& kind, Random& state, const Scale& scale, double slowest,
               double fastest, double energy, double mass_ratio) {
  Drawn out;
  out.scene = draw_joints(kind, scale, draw_system(space, kind, mass_ratio));
  set_moving(state, out.scene, state.log_uniform(slowest, fastest) / scale.dt);
  out.steps = kIsolatedSteps;
  Allowed allowed;
  allowed.energy = energy;
  out.judge = isolated_judge(out.scene, scale, allowed);
  return out;
}

// ---- joints that carry loads --------------------------------------------------------------------

// rad: by how much the frames of a joint are rotated against each other where it holds them.
double lean_of(const Joint& joint, const JointFrames& at) {
  if (std::holds_alternative<HingeJoint>(joint.type)) {
    const Vec3 z_a = at.turn_a * Vec3::UnitZ(), z_b = at.turn_b * Vec3::UnitZ();
    return std::atan2(z_a.cross(z_b).norm(), z_a.dot(z_b));
  }
  const bool locked = std::holds_alternative<FixedJoint>(joint.type) ||
                      std::holds_alternative<SliderJoint>(joint.type);
  return locked ? at.turn_a.angularDistance(at.turn_b) : 0;
}

// How far the frames of a joint are apart where it holds them, over the size of the smaller body,
// or by how many radians.
Judge closed_judge(const Scene& scene) {
  return [scene, before = initial_states(scene)](const Seen& seen) {
    double most = 0;
    for (const Joint& joint : scene.joints) {
      const JointFrames at = frames_of(joint, seen.now);
      const Vec3 apart = at.b - at.a;
      double open = apart.norm();
      if (std::holds_alternative<SliderJoint>(joint.type)) {
        const Vec3 along = at.turn_a * Vec3::UnitX();
        open = (apart - along.dot(apart) * along).norm();
      }
      if (std::holds_alternative<DistanceJoint>(joint.type)) {
        const JointFrames start = frames_of(joint, before);
        open = std::abs(apart.norm() - (start.b - start.a).norm());
      }
      double size = HUGE_VAL;
      for (const BodyId body : {joint.body_a, joint.body_b}) {
        if (body) size = std::min(size, 2 * outer_radius(scene.at(body).shapes[0].geometry));
      }
      most = std::max({most, open / size, lean_of(joint, at)});
    }
    return most;
  };
}

Drawn hung(Space space, Random& kind, Random& state, const Scale& scale, double mass_ratio) {
  Drawn out;
  JointSystem system = draw_system(space, kind, mass_ratio);
  system.hung = true;
  out.scene = draw_joints(kind, scale, system);
  out.scene.options.gravity = scene_of(space, scale).options.gravity;
  set_moving(state, out.scene, state.log_uniform(0.01, 3) / scale.time());
  out.steps = kHungSteps;
  out.judge = closed_judge(out.scene);
  return out;
}

// ---- exchanged bodies ---------------------------------------------------------------------------

class Exchanged {
 public:
  Exchanged(Scene scene, double size) : scene_(std::move(scene)), size_(size) {
    for (Joint& joint : scene_.joints) {
      if (!joint.body_a) continue;  // the world is A
      std::swap(joint.body_a, joint.body_b), std::swap(joint.frame_a, joint.frame_b);
    }
  }
  double operator()(const Seen& seen) {
    if (!world_) world_.emplace(scene_, seen.precision), world_->put(0, scene_);
    if (seen.step > 0) world_->step(1);
    double apart = 0, most = 0;
    for (std::size_t i = 0; i < seen.now.size(); ++i) {
      const BodyNow& b = seen.now[i];
      fastest_ = std::max({fastest_, b.velocity.norm(), b.spin.norm() * size_});
      apart = std::max(apart, distance(b, seen.twin[i]));
      most = std::max(most, distance(b, world_->now(0, static_cast<int>(i))));
    }
    apart /= fastest_, most /= fastest_;
    // What grows from a small difference grows from rounding, too.
    grown_ = grown_ || apart > 10 * kPerturbed;
    return grown_ ? 0 : most;
  }

  static constexpr double kPerturbed = 1e-7;

 private:
  double distance(const BodyNow& a, const BodyNow& b) const {
    return std::max((a.velocity - b.velocity).norm(), (a.spin - b.spin).norm() * size_);
  }

  Scene scene_;
  double size_, fastest_ = 1e-300;
  bool grown_ = false;
  std::optional<SideWorlds> world_;
};

Drawn exchange(Space space, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  JointSystem system = draw_system(space, kind, 100);
  system.hung = kind.chance(0.5);
  out.scene = draw_joints(kind, scale, system);
  if (system.hung) out.scene.options.gravity = scene_of(space, scale).options.gravity;
  set_moving(state, out.scene, state.log_uniform(0.01, 0.3) / scale.dt);
  out.steps = kExchangeSteps;
  out.twin = out.scene;
  for (Body& body : out.twin->bodies) {
    body.linear_velocity *= 1 + Exchanged::kPerturbed,
        body.angular_velocity *= 1 + Exchanged::kPerturbed;
  }
  auto other = std::make_shared<Exchanged>(out.scene, scale.length);
  out.judge = [other](const Seen& seen) { return (*other)(seen); };
  return out;
}

}  // namespace

std::vector<Family> joint_families() {
  std::vector<Family> out;
  const auto add = [&](const char* id, const char* title, const char* criterion, double limit,
                       bool required, const DrawInSpace& draw) {
    Family f;
    f.id = id, f.law = Law::joints, f.title = title, f.criterion = criterion;
    f.limit = limit, f.required = required;
    for (Family& in_space : in_both_spaces(f, draw)) out.push_back(std::move(in_space));
  };
  const auto add_isolated = [&](const char* id, const char* title, double slowest, double fastest,
                                double energy, double ratio, bool required) {
    add(id, title,
        energy < 0.02
            ? "largest change of momentum (1e-5 of the sum of m |v|), angular momentum (1e-3) and "
              "energy (1 %) in 3,600 steps, as a share of what is allowed"
            : "largest change of momentum (1e-5 of the sum of m |v|), angular momentum (1e-3) and "
              "energy (5 %) in 3,600 steps, as a share of what is allowed",
        1, required, [=](Space space, Random& kind, Random& state, const Scale& scale) {
          return isolated(space, kind, state, scale, slowest, fastest, energy, ratio);
        });
  };
  add_isolated("free joints", "trees and loops of 2 to 20 bodies that move freely", 0.01, kMostSpin,
               0.01, 100, true);
  add_isolated("fast joints", "the same with spins of 1 to 5 rad a step", kMostSpin, 5, 0.05, 100,
               true);
  add_isolated("free joints to 1e4", "the same with masses up to 1e4 apart", 0.01, kMostSpin, 0.01,
               1e4, false);
  const auto add_hung = [&](const char* id, const char* title, double ratio, bool required) {
    add(id, title,
        "distance of a joint's frames over the size of the smaller body, or rotation in rad", 0.01,
        required, [=](Space space, Random& kind, Random& state, const Scale& scale) {
          return hung(space, kind, state, scale, ratio);
        });
  };
  add_hung("hung joints", "trees and loops of 2 to 20 bodies that swing from a joint", 100, true);
  add_hung("hung joints to 1e4", "the same with masses up to 1e4 apart", 1e4, false);
  add("exchanged joints", "trees and loops, and the same with the bodies of each joint exchanged",
      "difference of velocities, relative to the largest speed", 1e-4, true, exchange);
  for (Family& family : joint_motor_families()) out.push_back(std::move(family));
  return out;
}

}  // namespace manyworlds::invariants
