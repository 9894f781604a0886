// Checks of one joint.
#include <cmath>

#include "src/scene/checks.hpp"
#include "src/scene/length_unit.hpp"

namespace manyworlds::detail {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Anchors farther apart than this, m per checked_unit, are a mistake and not a joint to be closed.
constexpr double kFarthest = 100;

class JointChecker {
 public:
  JointChecker(Checker checker, const Scene& scene, const Joint& joint)
      : check_(std::move(checker)), scene_(scene), joint_(joint) {}

  void run() {
    bool frames = check_frame("frame_a", joint_.frame_a);
    frames &= check_frame("frame_b", joint_.frame_b);
    const bool bodies = check_bodies();
    std::visit([this](const auto& type) { check(type); }, joint_.type);
    check_strength("break_force", joint_.break_force, "N");
    check_strength("break_torque", joint_.break_torque, "N m");
    check_dynamics(check_, joint_.dynamics);
    if (joint_.after && static_cast<std::size_t>(joint_.after.index()) >= scene_.joints.size()) {
      check_.add("after", "is " + std::to_string(joint_.after.index()) +
                              ", must be a joint, 0 to " +
                              std::to_string(scene_.joints.size() - 1));
    }
    if (bodies && frames && joins_anchors()) check_gap();
  }

 private:
  bool check_frame(const std::string& name, const Frame& frame) {
    bool good = check_.finite(name + ".position", frame.position, "m");
    good &= check_.rotation(name + ".rotation", frame.rotation);
    return good;
  }

  void check_strength(const std::string& name, double value, const std::string& unit) {
    if (value > 0) return;
    check_.add(name, "is " + number_text(value) + " " + unit + ", must be > 0");
  }

  const Body* body(BodyId id) const {
    if (!id || static_cast<std::size_t>(id.index()) >= scene_.bodies.size()) return nullptr;
    return &scene_.at(id);
  }

  bool check_bodies() {
    const int count = static_cast<int>(scene_.bodies.size());
    const int a = joint_.body_a.index(), b = joint_.body_b.index();
    bool good = true;
    if (a < -1 || a >= count) {
      check_.add("body_a", "is " + std::to_string(a) + ", must be -1 (the world) or a body, 0 to " +
                               std::to_string(count - 1));
      good = false;
    }
    if (b < 0 || b >= count) {
      check_.add("body_b",
                 "is " + std::to_string(b) + ", must be a body, 0 to " + std::to_string(count - 1));
      good = false;
    }
    if (!good) return false;
    if (a == b) {
      check_.add("body_b", "is " + std::to_string(b) + ", must be another body than body_a");
      return false;
    }
    const Motion of_a = a < 0 ? Motion::fixed : body(joint_.body_a)->motion,
                 of_b = body(joint_.body_b)->motion;
    if (of_a != Motion::dynamic && of_b != Motion::dynamic) {
      check_.add("body_b", "and body_a are both not dynamic, one of them must be");
      return false;
    }
    if (of_b == Motion::fixed) {
      check_.add("body_b", "is fixed, must be a body that moves: exchange A and B");
      return false;
    }
    return true;
  }

  bool joins_anchors() const {
    return !std::holds_alternative<DistanceJoint>(joint_.type) &&
           !std::holds_alternative<PulleyJoint>(joint_.type) &&
           !std::holds_alternative<TargetJoint>(joint_.type) &&
           !std::holds_alternative<SliderJoint>(joint_.type) &&
           !std::holds_alternative<WheelJoint>(joint_.type);
  }
  // Frames of the two bodies as they begin.
  void check_gap() {
    const double gap = (frame_in_world(scene_, joint_.body_a, joint_.frame_a).position -
                        frame_in_world(scene_, joint_.body_b, joint_.frame_b).position)
                           .norm();
    const double most = kFarthest * checked_unit(scene_.options);
    if (gap > most) {
      check_.add("frame_b.position", "is " + number_text(gap) +
                                         " m from frame_a's at the start, must be at most " +
                                         number_text(most) + " m");
    }
  }

  void check(const Spring& s, const std::string& name) {
    bool good = check_.not_negative(name + ".stiffness", s.stiffness, "");
    good &= check_.not_negative(name + ".damping", s.damping, "");
    good &= check_.not_negative(name + ".frequency", s.frequency, "Hz");
    good &= check_.not_negative(name + ".damping_ratio", s.damping_ratio, "");
    if (!good) return;
    const bool by_force = s.stiffness > 0 || s.damping > 0;
    if (by_force && (s.frequency > 0 || s.damping_ratio > 0)) {
      check_.add(name, "has both a stiffness or damping and a frequency, must have one of them");
    } else if (!by_force && s.frequency == 0) {
      check_.add(name, "is zero, must have a stiffness, a damping or a frequency");
    }
  }
  // `angle`: of a rotation.
  void check(const Limit& l, const std::string& name, bool angle) {
    bool good = true;
    const auto in_range = [&](const std::string& field, double value) {
      const bool within_pi = angle && scene_.options.solver.method != Solver::newton;
      if (std::isnan(value) || (within_pi && std::abs(value) > kPi && std::isfinite(value))) {
        check_.add(field, "is " + number_text(value) + (angle ? " rad" : " m") +
                              (angle ? ", must be between -pi and pi" : ", must be a number"));
        good = false;
      }
    };
    in_range(name + ".low", l.low);
    in_range(name + ".high", l.high);
    if (good && l.low > l.high) {
      check_.add(name, "is from " + number_text(l.low) + " to " + number_text(l.high) +
                           ", low must not be above high");
    }
    if (l.spring) check(*l.spring, name + ".spring");
    check_soft_limit(check_, name, l);
  }
  void check(const Drive& d, const std::string& name) {
    check_.finite(name + ".target_position", d.target_position, "");
    check_.finite(name + ".target_speed", d.target_speed, "");
    if (!(d.max_force >= 0)) {
      check_.add(name + ".max_force", "is " + number_text(d.max_force) + ", must be >= 0");
    }
    if (d.spring) check(*d.spring, name + ".spring");
  }

  void check(const BallJoint& j) {
    if (scene_.space == Space::planar) {
      check_.add("type", "is a ball, must be a hinge in a planar scene");
      return;
    }
    if (j.cone) check_.between("cone", *j.cone, 0, kPi);
    if (j.twist) check(*j.twist, "twist", true);
    if (!j.limit) return;
    check(*j.limit, "limit", true);
    if (j.limit->low != 0) {
      check_.add("limit.low", "is " + number_text(j.limit->low) +
                                  " rad, must be 0: the angle of a rotation has no sign");
    }
  }
  void check(const HingeJoint& j) {
    if (j.limit) check(*j.limit, "limit", true);
    if (j.drive) check(*j.drive, "drive");
  }
  void check(const SliderJoint& j) {
    if (j.limit) check(*j.limit, "limit", false);
    if (j.drive) check(*j.drive, "drive");
  }
  void check(const FixedJoint&) {}
  void check(const DistanceJoint& j) {
    if (j.length) check_.not_negative("length", *j.length, "m");
    if (j.limit) check(*j.limit, "limit", false);
    if (j.spring) check(*j.spring, "spring");
  }
  void check(const WheelJoint& j) {
    check(j.suspension, "suspension");
    if (j.travel) check(*j.travel, "travel", false);
    if (j.drive) check(*j.drive, "drive");
  }
  void check(const PulleyJoint& j) {
    check_.finite("ground_a", j.ground_a, "m");
    check_.finite("ground_b", j.ground_b, "m");
    check_.positive("ratio", j.ratio, "", kMinSize, kLargestSize);
    if (j.length) check_.not_negative("length", *j.length, "m");
    const Body* a = body(joint_.body_a);
    if (joint_.body_a == BodyId() || (a && a->motion == Motion::fixed)) {
      check_.add("body_a", "does not move, must be a moving body at the end of the rope");
    }
  }
  void check(const TargetJoint& j) {
    check(j.spring, "spring");
    if (!(j.max_force >= 0)) {
      check_.add("max_force", "is " + number_text(j.max_force) + " N, must be >= 0");
    }
  }

  Checker check_;
  const Scene& scene_;
  const Joint& joint_;
};

}  // namespace

void check_joint(Checker checker, const Scene& scene, const Joint& joint) {
  JointChecker(std::move(checker), scene, joint).run();
}

}  // namespace manyworlds::detail
