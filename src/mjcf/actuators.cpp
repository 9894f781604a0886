#include "src/mjcf/actuators.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "src/mjcf/pose.hpp"

namespace manyworlds::mjcf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The words of MJCF.
const char* transmission_name(int type) {
  switch (type) {
    case mjTRN_SLIDERCRANK: return "a slider-crank";
    case mjTRN_TENDON: return "a tendon";
    case mjTRN_SITE: return "a site";
    case mjTRN_BODY: return "a body";
    case mjTRN_SO3: return "the orientation of a site";
    default: return "an unknown transmission";
  }
}
const char* dynamics_name(int type) {
  switch (type) {
    case mjDYN_INTEGRATOR: return "integrator";
    case mjDYN_FILTER: return "filter";
    case mjDYN_FILTEREXACT: return "filterexact";
    case mjDYN_MUSCLE: return "muscle";
    case mjDYN_DCMOTOR: return "dcmotor";
    case mjDYN_PID: return "pid";
    default: return "user";
  }
}
const char* gain_name(int type) {
  switch (type) {
    case mjGAIN_MUSCLE: return "muscle";
    case mjGAIN_DCMOTOR: return "dcmotor";
    case mjGAIN_SO3: return "so3";
    case mjGAIN_PID: return "pid";
    default: return "user";
  }
}
const char* bias_name(int type) {
  switch (type) {
    case mjBIAS_MUSCLE: return "muscle";
    case mjBIAS_DCMOTOR: return "dcmotor";
    case mjBIAS_SO3: return "so3";
    default: return "user";
  }
}

// A hinge or a slide has one axis, which is the same in its parent's frame.
bool acts_on_joint(const mjModel& m, int actuator) {
  const int type = m.actuator_trntype[actuator];
  return type == mjTRN_JOINT || type == mjTRN_JOINTINPARENT;
}

// One problem at most: what a muscle is differs in many ways.
std::string law_problem(const mjModel& m, int i) {
  const int dynamics = m.actuator_dyntype[i];
  const int gain = m.actuator_gaintype[i], bias = m.actuator_biastype[i];
  const auto text = [](const std::string& what, const char* expected) {
    return what + ", which is not simulated yet; expected " + expected;
  };
  if (dynamics != mjDYN_NONE) {
    return text(std::string("has an activation, of dyntype ") + dynamics_name(dynamics),
                "dyntype none");
  }
  if (gain != mjGAIN_FIXED && gain != mjGAIN_AFFINE) {
    return text(std::string("has gaintype ") + gain_name(gain), "fixed or affine");
  }
  if (bias != mjBIAS_NONE && bias != mjBIAS_AFFINE) {
    return text(std::string("has biastype ") + bias_name(bias), "none or affine");
  }
  return "";
}

std::string target_problem(const mjModel& m, int i) {
  const std::string expected = "; expected a hinge or a slide joint";
  if (!acts_on_joint(m, i)) {
    return std::string("acts on ") + transmission_name(m.actuator_trntype[i]) +
           ", which is not simulated yet" + expected;
  }
  const int joint = m.jnt_type[m.actuator_trnid[2 * i]];
  if (joint == mjJNT_HINGE || joint == mjJNT_SLIDE) return "";
  return std::string("acts on a ") + joint_type_name(joint) + ", which is not simulated yet" +
         expected;
}

bool is_off(const mjModel& m, int i) {
  const int group = m.actuator_group[i];
  return group >= 0 && group < 31 && ((m.opt.disableactuator >> group) & 1) != 0;
}

Actuator law_of(const mjModel& m, int i) {
  const mjtNum* gain = m.actuator_gainprm + mjNGAIN * i;
  Actuator law;
  law.gear = m.actuator_gear[6 * m.actuator_outadr[i]];
  law.gain = m.actuator_gaintype[i] == mjGAIN_AFFINE ? vec3(gain) : Vec3(gain[0], 0, 0);
  law.bias = m.actuator_biastype[i] == mjBIAS_AFFINE ? vec3(m.actuator_biasprm + mjNBIAS * i)
                                                     : Vec3::Zero().eval();
  if (m.actuator_forcelimited[i]) {
    law.low = m.actuator_forcerange[2 * i], law.high = m.actuator_forcerange[2 * i + 1];
  }
  return law;
}

}  // namespace

void check_actuators(const Model& model, std::vector<std::string>& problems) {
  const mjModel& m = *model.compiled;
  if (!model.articulated) return;
  for (int i = 0; i < m.nactuator; ++i) {
    const auto add = [&](const std::string& problem) {
      if (!problem.empty()) problems.push_back(model.actuator_place(i) + ": " + problem);
    };
    const auto refuse = [&](bool found, const std::string& what, const char* expected) {
      if (found) add(what + " is not simulated yet; expected " + expected);
    };
    add(target_problem(m, i));
    add(law_problem(m, i));
    refuse(m.actuator_damping[i] != 0 || any_nonzero(m.actuator_dampingpoly + mjNPOLY * i, mjNPOLY),
           "damping of an actuator", "0");
    refuse(m.actuator_armature[i] != 0, "armature of an actuator", "0");
    refuse(m.actuator_delay[i] != 0, "delay", "0");
    refuse(is_off(m, i), "its disabled group (actuatorgroupdisable)", "all groups enabled");
  }
}

void add_actuators(const Model& model, const std::vector<JointId>& scene_joint, Scene& scene) {
  const mjModel& m = *model.compiled;
  const bool clamps = (m.opt.disableflags & mjDSBL_CLAMPCTRL) == 0;
  for (int i = 0; i < m.nactuator; ++i) {
    const int c = m.actuator_ctrladr[i];
    Control control;
    control.name = model.name(mjOBJ_ACTUATOR, i);
    control.kind = ControlKind::joint_force;
    control.joint = scene_joint[static_cast<std::size_t>(m.actuator_trnid[2 * i])];
    const bool limited = clamps && m.actuator_ctrllimited[c];
    control.low = limited ? m.actuator_ctrlrange[2 * c] : -kInfinity;
    control.high = limited ? m.actuator_ctrlrange[2 * c + 1] : kInfinity;
    control.initial = std::max(control.low, std::min(0.0, control.high));
    control.actuator = law_of(m, i);
    scene.add(std::move(control));
  }
}

}  // namespace manyworlds::mjcf
