// Checks of what Solver::newton takes, and of members that are its alone.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "src/scene/checks.hpp"

namespace manyworlds::detail {
namespace {

void check_compliance(Checker& checker, const std::string& name, const Compliance& c) {
  bool good = checker.finite(name + ".time_constant", c.time_constant, "");
  good &= checker.finite(name + ".damping_ratio", c.damping_ratio, "");
  if (good && (c.time_constant > 0) != (c.damping_ratio > 0)) {
    checker.add(name + ".damping_ratio", "is " + number_text(c.damping_ratio) +
                                             ", must be > 0 as time_constant is, or "
                                             "neither (both are then -stiffness and -damping)");
  }
  checker.between(name + ".min_impedance", c.min_impedance, 0, 1);
  checker.between(name + ".max_impedance", c.max_impedance, 0, 1);
  checker.not_negative(name + ".width", c.width, "");
  checker.between(name + ".midpoint", c.midpoint, 0, 1);
  if (!(c.power >= 1 && c.power <= 100 && c.power == std::floor(c.power))) {
    checker.add(name + ".power",
                "is " + number_text(c.power) + ", must be a whole number from 1 to 100");
  }
}

class NewtonChecker {
 public:
  NewtonChecker(Checker checker, const Scene& scene) : all_(std::move(checker)), scene_(scene) {}

  // `sound`: whether the scene has no other issue.
  void run(bool sound) {
    check_options();
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) check_body(i);
    for (std::size_t i = 0; i < scene_.joints.size(); ++i) check_joint(i);
    for (std::size_t i = 0; i < scene_.controls.size(); ++i) {
      if (scene_.controls[i].kind == ControlKind::joint_force) continue;
      Checker at = all_.at(named_part("control", i, scene_.controls[i].name));
      at.add("kind", std::string("is ") + name_of(scene_.controls[i].kind) +
                         ", the newton solver supports joint_force only");
    }
    for (std::size_t i = 0; i < scene_.tendons.size(); ++i) check_tendon(i);
    if (!scene_.attractors.empty()) refuse(all_, "attractors", "are given", "none");
    for (std::size_t i = 0; i < scene_.variations.size(); ++i) check_variation(i);
    check_mixed_powers();
    if (sound) check_trees(all_, scene_);
  }

 private:
  // Two shapes of equal priority mix their powers, too (src/plan/tree_pairs.cpp).
  void check_mixed_powers() {
    std::vector<const Shape*> unlike;  // one of each kind
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const Body& body = scene_.bodies[i];
      for (std::size_t k = 0; k < body.shapes.size(); ++k) {
        const Shape& own = body.shapes[k];
        const SoftContact& a = own.material.soft;
        bool known = false;
        for (const Shape* other : unlike) {
          const SoftContact& b = other->material.soft;
          known |= a.priority == b.priority && a.weight == b.weight &&
                   a.compliance.power == b.compliance.power &&
                   own.filter.category == other->filter.category &&
                   own.filter.mask == other->filter.mask;
          const bool meet = (own.filter.category & other->filter.mask) != 0 &&
                            (other->filter.category & own.filter.mask) != 0;
          if (!meet || a.priority != b.priority || !(a.weight > 0 && b.weight > 0)) continue;
          const double power = (a.weight * a.compliance.power + b.weight * b.compliance.power) /
                               (a.weight + b.weight);
          if (a.compliance.power == b.compliance.power || power == std::floor(power)) continue;
          Checker at = all_.at(named_part("body", i, body.name)).at("shape " + std::to_string(k));
          at.add("material.soft.compliance.power",
                 "is " + number_text(a.compliance.power) + ", which mixes with another shape's " +
                     number_text(b.compliance.power) + " to " + number_text(power) +
                     ", must mix to a whole number");
          return;
        }
        if (!known) unlike.push_back(&own);
      }
    }
  }

  void refuse(Checker& checker, const char* field, const std::string& found, const char* wanted) {
    checker.add(field, found + ", the newton solver supports " + wanted);
  }

  void check_options() {
    const Options& o = scene_.options;
    if (scene_.space == Space::planar) refuse(all_, "space", "is planar", "spatial scenes only");
    const Integrator taken[] = {Integrator::symplectic_euler, Integrator::runge_kutta4,
                                Integrator::implicit_fast};
    if (std::find(std::begin(taken), std::end(taken), o.integrator) == std::end(taken)) {
      refuse(all_, "options.integrator", std::string("is ") + to_string(o.integrator),
             "symplectic-euler, runge-kutta4 and implicit-fast");
    }
    if (o.integrator == Integrator::implicit_fast && o.medium != Medium{}) {
      refuse(all_, "options.medium", "is given", "none with implicit-fast yet");
    }
    if (o.bounds) refuse(all_, "options.bounds", "are given", "none");
    if (o.contact.collision_passes.value_or(1) != 1) {
      refuse(all_, "options.contact.collision_passes",
             "is " + std::to_string(*o.contact.collision_passes),
             "1 only: it finds contacts in every substep");
    }
    if (o.contact_capacity) {
      refuse(all_, "options.contact_capacity", "is given", "none: it stores all contacts");
    }
  }

  void check_body(std::size_t i) {
    const Body& body = scene_.bodies[i];
    Checker at = all_.at(named_part("body", i, body.name));
    if (body.motion == Motion::kinematic) {
      refuse(at, "motion", "is kinematic", "dynamic and fixed bodies");
    }
    if (!body.enabled) refuse(at, "enabled", "is false", "enabled bodies only");
    if (body.linear_drag != 0) refuse(at, "linear_drag", "is not 0", "none");
    if (body.angular_drag != 0) refuse(at, "angular_drag", "is not 0", "none");
    for (std::size_t k = 0; k < body.shapes.size(); ++k) {
      Checker shape = at.at("shape " + std::to_string(k));
      if (body.shapes[k].material.restitution != 0) {
        refuse(shape, "material.restitution", "is not 0", "0 only: contacts do not bounce");
      }
      if (body.shapes[k].material.rolling_resistance != 0) {
        refuse(shape, "material.rolling_resistance", "is not 0", "0 only");
      }
      if (body.shapes[k].material.torsional_resistance != 0) {
        refuse(shape, "material.torsional_resistance", "is not 0", "0 only");
      }
    }
    if (body.motion != Motion::dynamic || !is_held(i)) return;
    if (!body.linear_velocity.isZero(0)) {
      refuse(at, "linear_velocity", "is not 0", "it for free bodies only");
    }
    if (!body.angular_velocity.isZero(0)) {
      refuse(at, "angular_velocity", "is not 0", "it for free bodies only");
    }
    if (jitters(body.jitter)) {
      refuse(at, "jitter", "is given", "it for free bodies only: jointed bodies move along");
    }
  }

  bool is_held(std::size_t body) const {
    for (const Joint& joint : scene_.joints) {
      if (joint.body_b.index() == static_cast<int>(body)) return true;
    }
    return false;
  }

  void check_joint(std::size_t i) {
    const Joint& joint = scene_.joints[i];
    Checker at = all_.at(named_part("joint", i, joint.name));
    std::visit([&](const auto& type) { check_type(at, type); }, joint.type);
    if (std::isfinite(joint.break_force)) refuse(at, "break_force", "is given", "none");
    if (std::isfinite(joint.break_torque)) refuse(at, "break_torque", "is given", "none");
    const JointDynamics& d = joint.dynamics;
    const bool single = std::holds_alternative<HingeJoint>(joint.type) ||
                        std::holds_alternative<SliderJoint>(joint.type);
    if (std::holds_alternative<BallJoint>(joint.type)) {
      if (d.reference != 0 || d.rest != 0) {
        refuse(at, "dynamics", "have a rest or reference", "them for hinges and sliders only");
      }
    } else if (!single && (d.stiffness != 0 || d.reference != 0 || d.rest != 0)) {
      refuse(at, "dynamics", "have a spring or reference", "them for hinges and sliders only");
    }
    if (std::holds_alternative<FixedJoint>(joint.type) && (d.armature != 0 || d.damping != 0)) {
      refuse(at, "dynamics", "have armature or damping", "none for a fixed joint");
    }
  }
  void check_type(Checker& at, const BallJoint& j) {
    if (j.cone) refuse(at, "cone", "is given", "BallJoint::limit instead");
    if (j.twist) refuse(at, "twist", "is given", "BallJoint::limit instead");
    if (j.limit && j.limit->spring) {
      refuse(at, "limit.spring", "is given", "Limit::compliance instead");
    }
  }
  template <class Single>
  requires requires(const Single& j) {
    j.drive, j.limit;
  } &&(!requires(const Single& j) { j.travel; }) void check_type(Checker& at, const Single& j) {
    if (j.drive) {
      refuse(at, "drive", "is given", "Joint::dynamics and controls of kind joint_force instead");
    }
    if (j.limit && j.limit->spring) {
      refuse(at, "limit.spring", "is given", "Limit::compliance instead");
    }
  }
  void check_type(Checker&, const FixedJoint&) {}
  void check_type(Checker& at, const DistanceJoint&) { refuse_type(at, "distance"); }
  void check_type(Checker& at, const WheelJoint&) { refuse_type(at, "wheel"); }
  void check_type(Checker& at, const PulleyJoint&) { refuse_type(at, "pulley"); }
  void check_type(Checker& at, const TargetJoint&) { refuse_type(at, "target"); }
  void refuse_type(Checker& at, const char* name) {
    refuse(at, "type", std::string("is ") + name, "hinge, slider, ball and fixed");
  }

  void check_tendon(std::size_t i) {
    const Tendon& tendon = scene_.tendons[i];
    Checker at = all_.at(named_part("tendon", i, tendon.name));
    if (tendon.terms.empty()) at.add("terms", "are empty, must have at least one");
    for (std::size_t k = 0; k < tendon.terms.size(); ++k) {
      const std::string name = element_name("terms", k);
      const TendonTerm& term = tendon.terms[k];
      at.finite(name + ".coefficient", term.coefficient, "");
      const int joint = term.joint.index();
      const bool there = 0 <= joint && static_cast<std::size_t>(joint) < scene_.joints.size();
      const auto moves = [&](const JointType& type) {
        return std::holds_alternative<HingeJoint>(type) ||
               std::holds_alternative<SliderJoint>(type);
      };
      if (!there || !moves(scene_.at(term.joint).type)) {
        at.add(name + ".joint", "is " + std::to_string(joint) + ", must be a hinge or slider");
      }
      for (std::size_t other = 0; there && other < k; ++other) {
        if (tendon.terms[other].joint != term.joint) continue;
        at.add(name + ".joint", "is " + std::to_string(joint) + " again, must be another");
      }
    }
    if (!tendon.limit) return;
    const Limit& limit = *tendon.limit;
    if (!(limit.low <= limit.high)) {
      at.add("limit", "is from " + number_text(limit.low) + " to " + number_text(limit.high) +
                          ", low must not be above high");
    }
    if (limit.spring) refuse(at, "limit.spring", "is given", "Limit::compliance instead");
    check_soft_limit(at, "limit", limit);
  }

  void check_variation(std::size_t i) {
    const Parameter p = scene_.variations[i].parameter;
    const Parameter refused[] = {Parameter::restitution, Parameter::rolling_resistance,
                                 Parameter::torsional_resistance, Parameter::linear_drag,
                                 Parameter::angular_drag};
    if (std::find(std::begin(refused), std::end(refused), p) == std::end(refused)) return;
    Checker at = all_.at("variation " + std::to_string(i));
    refuse(at, "parameter", std::string("is ") + info(p).name,
           "all but restitution, rolling_resistance, torsional_resistance, linear_drag and "
           "angular_drag");
  }

  Checker all_;
  const Scene& scene_;
};

}  // namespace

void check_soft_contact(Checker& checker, const SoftContact& c) {
  if (c.dimensions != 1 && c.dimensions != 3) {
    checker.add("material.soft.dimensions",
                "is " + std::to_string(c.dimensions) + ", must be 1 or 3");
  }
  check_compliance(checker, "material.soft.compliance", c.compliance);
  checker.not_negative("material.soft.margin", c.margin, "m");
  checker.not_negative("material.soft.gap", c.gap, "m");
  checker.not_negative("material.soft.weight", c.weight, "");
}

void check_soft_limit(Checker& checker, const std::string& name, const Limit& limit) {
  check_compliance(checker, name + ".compliance", limit.compliance);
  checker.not_negative(name + ".margin", limit.margin, "");
}

void check_dynamics(Checker& checker, const JointDynamics& d) {
  checker.not_negative("dynamics.armature", d.armature, "");
  checker.not_negative("dynamics.damping", d.damping, "");
  checker.not_negative("dynamics.stiffness", d.stiffness, "");
  checker.finite("dynamics.rest", d.rest, "");
  checker.finite("dynamics.reference", d.reference, "");
}

void check_actuator(Checker& checker, const Actuator& a) {
  checker.finite("actuator.gear", a.gear, "");
  for (int c = 0; c < 3; ++c) {
    const std::string axis(1, "xyz"[c]);
    checker.finite("actuator.gain." + axis, a.gain[c], "");
    checker.finite("actuator.bias." + axis, a.bias[c], "");
  }
  if (!(a.low <= a.high)) {
    checker.add("actuator.low", "is " + number_text(a.low) + ", must not be above high, which is " +
                                    number_text(a.high));
  }
}

void check_newton(Checker checker, const Scene& scene, bool sound) {
  if (scene.options.solver.method == Solver::newton) {
    return NewtonChecker(std::move(checker), scene).run(sound);
  }
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const Joint& joint = scene.joints[i];
    Checker at = checker.at(named_part("joint", i, joint.name));
    const auto needs = [&](const char* field) {
      at.add(field, std::string("is given, which requires the newton solver, not ") +
                        to_string(scene.options.solver.method));
    };
    if (joint.after) needs("after");
    if (joint.dynamics != JointDynamics{}) needs("dynamics");
    const auto limit = [&](const auto& type) {
      if constexpr (requires { type.cone; }) {
        if (type.limit) needs("limit");
      } else if constexpr (requires { type.limit->margin; }) {
        if (type.limit && type.limit->margin != 0) needs("limit.margin");
        if (type.limit && type.limit->compliance != Compliance{}) needs("limit.compliance");
      }
    };
    std::visit(limit, joint.type);
  }
  const Options& o = scene.options;
  if (o.integrator == Integrator::implicit_fast) {
    checker.add("options.integrator",
                std::string("is implicit-fast, which requires the newton solver, not ") +
                    to_string(o.solver.method));
  }
  if (o.medium != Medium{}) {
    checker.add("options.medium", std::string("is given, which requires the newton solver, not ") +
                                      to_string(o.solver.method));
  }
  if (!scene.tendons.empty()) {
    checker.add("tendons", std::string("are given, which require the newton solver, not ") +
                               to_string(scene.options.solver.method));
  }
  for (std::size_t i = 0; i < scene.controls.size(); ++i) {
    if (scene.controls[i].kind != ControlKind::joint_force) continue;
    checker.at(named_part("control", i, scene.controls[i].name))
        .add("kind", std::string("is joint_force, which requires the newton solver, not ") +
                         to_string(scene.options.solver.method));
  }
}

}  // namespace manyworlds::detail
