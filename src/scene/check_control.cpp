// Checks of one control.
#include <cmath>

#include "src/scene/checks.hpp"
#include "src/scene/joint_numbers.hpp"

namespace manyworlds::detail {
namespace {

std::string index_text(int index, std::size_t count, const char* what) {
  std::string text = "is " + std::to_string(index) + ", must be a " + what;
  if (count > 0) return text + ", 0 to " + std::to_string(count - 1);
  return text + ", but the scene has none";
}

bool in(int index, std::size_t count) {
  return index >= 0 && static_cast<std::size_t>(index) < count;
}

void check_thrust(Checker& checker, const Scene& scene, const Control& control) {
  if (!in(control.body.index(), scene.bodies.size())) {
    checker.add("body", index_text(control.body.index(), scene.bodies.size(), "body"));
  } else if (scene.at(control.body).motion != Motion::dynamic) {
    checker.add("body", "is " + std::to_string(control.body.index()) + ", must be a dynamic body");
  }
  const bool axial = control.kind == ControlKind::torque;
  if (!axial) checker.finite("point", control.point, "m");
  const bool good = axial ? checker.finite_axial("direction", control.direction, "")
                          : checker.finite("direction", control.direction, "");
  if (good && !(control.direction.norm() > 1e-12)) {
    checker.add("direction", "is zero, must have a length");
  }
}

void check_joint_force(Checker& checker, const Scene& scene, const Control& control) {
  check_actuator(checker, control.actuator);
  if (!in(control.joint.index(), scene.joints.size())) {
    checker.add("joint", index_text(control.joint.index(), scene.joints.size(), "joint"));
    return;
  }
  const JointType& type = scene.at(control.joint).type;
  if (std::holds_alternative<HingeJoint>(type) || std::holds_alternative<SliderJoint>(type)) return;
  checker.add("joint",
              "is " + std::to_string(control.joint.index()) + ", must be a hinge or slider");
}

void check_target(Checker& checker, const Scene& scene, std::size_t index) {
  const Control& control = scene.controls[index];
  if (!in(control.joint.index(), scene.joints.size())) {
    checker.add("joint", index_text(control.joint.index(), scene.joints.size(), "joint"));
    return;
  }
  const std::string is = "is " + std::to_string(control.joint.index()) + ", ";
  const Drive* drive = drive_of(scene.at(control.joint).type);
  if (drive == nullptr) {
    checker.add("joint", is + "must be a joint with a drive");
  } else if (control.kind == ControlKind::target_position && !drive->spring) {
    checker.add("joint",
                is + "must be a joint whose drive has a spring: a motor does not hold a position");
  }
  for (std::size_t i = 0; i < index; ++i) {
    const Control& other = scene.controls[i];
    if (other.kind != control.kind || other.joint != control.joint) continue;
    checker.add("joint", is + "must be a joint whose target is not already control " +
                             std::to_string(i) + "'s");
    break;
  }
}

}  // namespace

void check_control(Checker checker, const Scene& scene, std::size_t index) {
  const Control& control = scene.controls[index];
  if (!checker.named("kind", control.kind)) return;
  if (control.kind == ControlKind::thrust || control.kind == ControlKind::torque) {
    check_thrust(checker, scene, control);
  } else if (control.kind == ControlKind::joint_force) {
    check_joint_force(checker, scene, control);
  } else {
    check_target(checker, scene, index);
  }
  const auto check_end = [&](const char* name, double end) {
    const bool open = control.kind == ControlKind::joint_force && std::isinf(end);
    return open || checker.finite(name, end, "");
  };
  bool range = check_end("low", control.low);
  range &= check_end("high", control.high);
  if (!range) return;
  if (control.low > control.high) {
    checker.add("low", "is " + number_text(control.low) + ", must not be above high, which is " +
                           number_text(control.high));
  } else {
    checker.between("initial", control.initial, control.low, control.high);
  }
}

}  // namespace manyworlds::detail
