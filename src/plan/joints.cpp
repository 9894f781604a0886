// Joints as parts, and their numbers.
#include <algorithm>
#include <cmath>

#include "src/base/float_mode.hpp"
#include "src/plan/joint_trees.hpp"
#include "src/plan/plan_data.hpp"
#include "src/plan/soft_constraint.hpp"

namespace manyworlds {

namespace {

using kernels::PartKind, kernels::PointHold, kernels::TurnHold;
using kernels::RowSoftness;

constexpr double kPi = 3.14159265358979323846;
constexpr double kUnlimited = 1e30;  // N s

// Where a joint's frame is on one side, as the kernels see it.
struct Side {
  int body = 0;  // state body, or the number of them: the world
  Vec3 anchor = Vec3::Zero();
  Quat frame = Quat::Identity();
};

Side side_of(const PlanData& plan, BodyId body, const Frame& frame) {
  Side out;
  out.body = static_cast<int>(plan.bodies.size());
  out.anchor = frame.position;
  out.frame = frame.rotation.normalized();
  if (!body) return out;
  const int state_body = plan.state_body[static_cast<std::size_t>(body.index())];
  if (state_body >= 0) {
    const PlanBody& b = plan.bodies[static_cast<std::size_t>(state_body)];
    out.body = state_body;
    out.anchor = b.principal.conjugate() * (frame.position - b.center);
    out.frame = b.principal.conjugate() * out.frame;
  } else {
    const Frame in_world = frame_in_world(plan.scene, body, frame);
    out.anchor = in_world.position;
    out.frame = in_world.rotation;
  }
  return out;
}

class Builder {
 public:
  Builder(PlanData& plan, int index)
      : plan_(plan),
        index_(index),
        joint_(plan.scene.joints[static_cast<std::size_t>(index)]),
        h_(plan.substep_dt()) {}

  void build() {
    const std::size_t first = plan_.parts.size();
    std::visit([this](const auto& type) { add(type); }, joint_.type);
    // What rows along and about its axes are held by.
    TurnHold turn = TurnHold::free;
    PointHold point = PointHold::free;
    for (std::size_t i = first; i < plan_.parts.size(); ++i) {
      switch (plan_.parts[i].what.kind) {
        case PartKind::lock: turn = TurnHold::lock; break;
        case PartKind::swing: turn = TurnHold::swing; break;
        case PartKind::line: point = PointHold::line; break;
        case PartKind::point: point = PointHold::point; break;
        default: break;
      }
    }
    for (std::size_t i = first; i < plan_.parts.size(); ++i) {
      plan_.parts[i].what.turn_hold = turn, plan_.parts[i].what.point_hold = point;
    }
  }

 private:
  // In the world, as the bodies begin.
  Vec3 anchor_a() const {
    return frame_in_world(plan_.scene, joint_.body_a, joint_.frame_a).position;
  }
  Vec3 anchor_b() const {
    return frame_in_world(plan_.scene, joint_.body_b, joint_.frame_b).position;
  }
  bool spatial() const { return plan_.scene.space == Space::spatial; }

  RowSoftness<double> soft(double frequency, double damping_ratio) const {
    if (frequency == 0) return {0, 0, 0};
    const SoftConstraint soft = soft_constraint(frequency, damping_ratio, h_);
    return {soft.rate, 1 / soft.gain, 0};
  }
  RowSoftness<double> hard() const {
    const Options& o = plan_.scene.options;
    if (has_hard_rows(o.solver.method) && !o.joint.frequency) {
      return {o.solver.push_out_share / h_, 0, 0};
    }
    return soft(o.joint.frequency.value_or(0.25 / h_), o.joint.damping_ratio);
  }
  RowSoftness<double> soft(const Spring& s) const {
    if (s.frequency > 0) return soft(s.frequency, s.damping_ratio);
    const double damping = s.damping + h_ * s.stiffness;
    return {s.stiffness / damping, 0, 1 / (h_ * damping)};
  }
  // How much of a target speed a spring and damper follow in a substep.
  double speed_share(const Spring& s) const {
    if (s.frequency > 0) {
      return 2 * s.damping_ratio / (2 * s.damping_ratio + h_ * 2 * kPi * s.frequency);
    }
    return s.damping / (s.damping + h_ * s.stiffness);
  }

  // A joint that is nothing but this spring may be a force to the plan's integrator.
  void force(PlanPart& p, const Spring& s) const {
    if (!has_flight(plan_.scene.options) || s.frequency > 0) return;
    if (may_break(joint_)) return;
    p.what.force = true;
    p.constants.stiffness = s.stiffness, p.constants.damping = s.damping;
  }

  PlanPart& part(PartKind kind) {
    PlanPart& out = plan_.parts.emplace_back();
    const Side a = side_of(plan_, joint_.body_a, joint_.frame_a),
               b = side_of(plan_, joint_.body_b, joint_.frame_b);
    out.joint = index_;
    out.what.kind = kind;
    out.what.joint = index_;
    out.what.position_control = out.what.speed_control = -1;
    out.what.body_a = a.body;
    out.what.body_b = b.body;
    put(a.anchor, out.constants.anchor_a);
    put(b.anchor, out.constants.anchor_b);
    put(a.frame, out.constants.frame_a);
    put(b.frame, out.constants.frame_b);
    out.constants.soft = hard();
    const Options& o = plan_.scene.options;
    out.constants.pull = std::min(o.joint.pull_speed * *o.length_unit, kUnlimited);
    out.constants.angular_pull = std::min(o.joint.pull_speed, kUnlimited);
    out.constants.slack = kUnlimited;
    out.constants.limit_soft = hard();
    out.constants.max_impulse = kUnlimited;
    out.constants.ratio = 1;
    out.constants.max_force = joint_.break_force * plan_.pass_dt();
    out.constants.max_torque = joint_.break_torque * plan_.pass_dt();
    return out;
  }
  static void put(const Vec3& from, double* to) { std::copy_n(from.data(), 3, to); }
  void put(const Quat& q, double* to) const {
    if (spatial()) {
      to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z();
    } else {
      const double angle = 2 * std::atan2(q.z(), q.w());
      to[0] = std::cos(angle), to[1] = std::sin(angle);
    }
  }

  void limit(PlanPart& p, const std::optional<Limit>& limit) const {
    if (!limit) return;
    p.what.low = std::isfinite(limit->low);
    p.what.high = std::isfinite(limit->high);
    if (p.what.low) p.constants.low = limit->low;
    if (p.what.high) p.constants.high = limit->high;
    if (!limit->spring) return;
    p.constants.limit_soft = soft(*limit->spring);
    p.what.soft_limit = true;
  }
  void drive(PlanPart& p, const std::optional<Drive>& drive) const {
    if (!drive) return;
    p.what.drive = true;
    p.what.springy = drive->spring.has_value();
    p.constants.target_position = drive->target_position;
    p.constants.target_speed = drive->target_speed;
    p.constants.speed_share = 1;
    if (drive->spring) {
      p.constants.drive_soft = soft(*drive->spring);
      p.constants.speed_share = speed_share(*drive->spring);
    }
    p.constants.max_impulse = std::min(h_ * drive->max_force, kUnlimited);
  }

  void add(const BallJoint& j) {
    if (j.cone && spatial()) {
      PlanPart& p = part(PartKind::cone);
      limit(p, Limit{-std::numeric_limits<double>::infinity(), *j.cone, std::nullopt});
    }
    if (j.twist) limit(part(spatial() ? PartKind::twist : PartKind::angle), j.twist);
    part(PartKind::point);
  }
  void add(const HingeJoint& j) {
    if (j.limit || j.drive) {
      PlanPart& p = part(PartKind::angle);
      limit(p, j.limit), drive(p, j.drive);
    }
    if (spatial()) part(PartKind::swing);
    part(PartKind::point);
  }
  void add(const SliderJoint& j) {
    if (j.limit || j.drive) {
      PlanPart& p = part(PartKind::slide);
      limit(p, j.limit), drive(p, j.drive);
    }
    part(PartKind::lock);
    part(PartKind::line);
  }
  void add(const FixedJoint&) {
    part(PartKind::lock);
    part(PartKind::point);
  }
  void add(const DistanceJoint& j) {
    const double length = j.length.value_or((anchor_b() - anchor_a()).norm());
    PlanPart& p = part(PartKind::distance);
    p.what.equality = !j.limit && !j.spring;
    p.constants.rest = length;
    if (j.spring) drive(p, Drive{length, 0, j.spring});
    if (j.spring && !j.limit) force(p, *j.spring);
    limit(p, j.limit);
  }
  void add(const WheelJoint& j) {
    PlanPart& s = part(PartKind::slide);
    drive(s, Drive{0, 0, j.suspension}), limit(s, j.travel);
    if (j.drive) drive(part(PartKind::angle), j.drive);
    if (spatial()) part(PartKind::swing);
    part(PartKind::line);
  }
  void add(const PulleyJoint& j) {
    const Vec3 a = anchor_a(), b = anchor_b();
    PlanPart& p = part(PartKind::pulley);
    p.what.equality = true;
    put(j.ground_a, p.constants.ground_a);
    put(j.ground_b, p.constants.ground_b);
    p.constants.ratio = j.ratio;
    p.constants.rest =
        j.length.value_or((a - j.ground_a).norm() + j.ratio * (b - j.ground_b).norm());
  }
  void add(const TargetJoint& j) {
    PlanPart& p = part(PartKind::point);
    p.what.spring = true;
    p.constants.soft = soft(j.spring);
    p.constants.max_impulse = std::min(h_ * j.max_force, kUnlimited);
    if (std::isinf(j.max_force)) force(p, j.spring);
  }

  PlanData& plan_;
  int index_;
  const Joint& joint_;
  double h_;
};

// A pass solves the only joint of its bodies exactly. With others it does not, and what one of them
// then does before the motion, and another after it, may give energy.
void find_curved(PlanData& plan) {
  if (plan.scene.options.solver.method != Solver::tgs_soft) return;
  std::vector<std::set<int>> joints(plan.bodies.size() + 1);  // the last: the world
  for (const PlanPart& part : plan.parts) {
    joints[static_cast<std::size_t>(part.what.body_a)].insert(part.joint);
    joints[static_cast<std::size_t>(part.what.body_b)].insert(part.joint);
  }
  const auto alone = [&](std::int32_t body) {
    const auto i = static_cast<std::size_t>(body);
    return i == plan.bodies.size() || plan.bodies[i].inv_mass == 0 || joints[i].size() == 1;
  };
  const auto closes = [](const kernels::JointPart& what) {
    switch (what.kind) {
      case PartKind::point: return !what.spring;
      case PartKind::distance: return what.equality;
      default:
        return what.kind == PartKind::lock || what.kind == PartKind::swing ||
               what.kind == PartKind::line;
    }
  };
  for (PlanPart& part : plan.parts) {
    part.what.curved = closes(part.what) && !part.what.direct && alone(part.what.body_a) &&
                       alone(part.what.body_b);
  }
}

}  // namespace

void collect_joints(PlanData& plan) {
  plan.parts.clear();
  if (plan.has_trees()) return;
  for (std::size_t i = 0; i < plan.scene.joints.size(); ++i) {
    Builder(plan, static_cast<int>(i)).build();
  }
  collect_joint_trees(plan);
  find_curved(plan);
}

std::set<std::pair<int, int>> joined_bodies(const Scene& scene) {
  std::set<std::pair<int, int>> out;
  for (const Joint& j : scene.joints) {
    if (j.collide || !j.body_a) continue;
    out.insert(std::minmax(j.body_a.index(), j.body_b.index()));
  }
  for (const Exclusion& e : scene.exclusions) {
    out.insert(std::minmax(e.body_a.index(), e.body_b.index()));
  }
  return out;
}

Frame frame_in_world(const Scene& scene, BodyId body, const Frame& frame) {
  const FloatMode mode;
  const Quat rotation = frame.rotation.normalized();
  if (!body) return {frame.position, rotation};
  const Body& b = scene.at(body);
  const Quat of_body = b.rotation.normalized();
  return {b.position + of_body * frame.position, of_body * rotation};
}

Joint joint_at(const Scene& scene, BodyId body_a, BodyId body_b, const Frame& frame,
               JointType type) {
  const FloatMode mode;
  const auto on = [&](BodyId body) {
    if (!body) return frame;
    const Body& b = scene.at(body);
    const Quat back = b.rotation.normalized().conjugate();
    return Frame{back * (frame.position - b.position), back * frame.rotation};
  };
  Joint out;
  out.type = std::move(type);
  out.body_a = body_a, out.body_b = body_b;
  out.frame_a = on(body_a), out.frame_b = on(body_b);
  return out;
}

}  // namespace manyworlds
