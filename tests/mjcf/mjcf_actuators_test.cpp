// Actuators as controls: their law, judged by MuJoCo's forces.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "manyworlds/mjcf.hpp"
#include "tests/mjcf/mujoco_reference.hpp"
#include "tests/support/random.hpp"

namespace manyworlds::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string model(const std::string& actuators, const std::string& option = "") {
  return "<mujoco><compiler angle='radian'/>" + option +
         "<worldbody><body><joint name='h' axis='0 1 0' ref='0.3'/><geom size='.1' pos='.2 0 0'/>"
         "<body pos='.5 0 0'><joint name='s' type='slide' axis='1 0 0' range='-1 1'/>"
         "<geom size='.1'/></body></body></worldbody><actuator>" +
         actuators + "</actuator></mujoco>";
}

const std::string kAll = model(R"(
  <motor name="motor" joint="h" gear="5" ctrlrange="-1 2" forcerange="-0.5 0.4"/>
  <position name="position" joint="h" kp="20" kv="3" ctrlrange="0.2 1.5"/>
  <position name="servo" joint="s" kp="7" gear="-2" forcerange="-3 30" inheritrange="1"/>
  <velocity name="velocity" jointinparent="s" kv="4" gear="0.5"/>
  <damper name="damper" joint="s" kv="2" ctrlrange="0 3"/>
  <general name="general" joint="h" gaintype="affine" gainprm="2 -1 0.5" biastype="affine"
           biasprm="0.3 -4 -0.2" gear="3" actearly="true"/>)");

double force_of(const Control& control, double u, double q, double v) {
  const Actuator& a = control.actuator;
  const Eigen::Vector3d state(1, a.gear * q, a.gear * v);
  u = std::clamp(u, control.low, control.high);
  return a.gear * std::clamp(a.gain.dot(state) * u + a.bias.dot(state), a.low, a.high);
}

}  // namespace

TEST_CASE("actuators are controls in their order", "[mjcf][robots][fast]") {
  const MjcfResult result = load_mjcf_string(kAll);
  CHECK(result.warnings.empty());
  const Scene& scene = result.scene;
  std::vector<std::string> names;
  for (const Control& control : scene.controls) {
    names.push_back(control.name);
    CHECK(control.kind == ControlKind::joint_force);
  }
  CHECK(names ==
        std::vector<std::string>{"motor", "position", "servo", "velocity", "damper", "general"});
  const auto named = [&](const char* name) { return scene.at(scene.control(name)); };
  CHECK(named("motor").joint == scene.joint("h"));
  CHECK(named("motor").low == -1);
  CHECK(named("motor").high == 2);
  CHECK(named("motor").initial == 0);
  CHECK(named("motor").actuator ==
        Actuator{.gear = 5, .gain = {1, 0, 0}, .bias = {0, 0, 0}, .low = -0.5, .high = 0.4});
  CHECK(named("position").actuator == Actuator{.gain = {20, 0, 0}, .bias = {0, -20, -3}});
  CHECK(named("position").initial == 0.2);
  CHECK(named("servo").joint == scene.joint("s"));
  CHECK(named("servo").low == -1);
  CHECK(named("velocity").joint == scene.joint("s"));
  CHECK(named("velocity").low == -kInfinity);
  CHECK(named("velocity").high == kInfinity);
  CHECK(named("velocity").actuator == Actuator{.gear = 0.5, .gain = {4, 0, 0}, .bias = {0, 0, -4}});
  CHECK(named("damper").actuator.gain == Eigen::Vector3d(0, 0, -2));

  const Scene free = load_mjcf_string(model("<motor joint='h' ctrlrange='1 2'/>",
                                            "<option><flag clampctrl='disable'/></option>"))
                         .scene;
  CHECK(free.controls.at(0).low == -kInfinity);
  CHECK(free.controls.at(0).initial == 0);
}

TEST_CASE("the law of an actuator gives MuJoCo's force", "[mjcf][robots][fast]") {
  const Scene scene = load_mjcf_string(kAll).scene;
  const Reference reference(kAll);
  const mjModel& m = *reference.model;
  mjData* d = reference.data.get();
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    for (int i = 0; i < m.nv; ++i) {
      d->qpos[i] = random.uniform(-1, 1), d->qvel[i] = random.uniform(-2, 2);
    }
    std::vector<double> force(static_cast<std::size_t>(m.nv), 0.0);
    for (int i = 0; i < m.nu; ++i) {
      d->ctrl[i] = random.uniform(-4, 4);
      const Control& control = scene.controls[static_cast<std::size_t>(i)];
      const auto j = static_cast<std::size_t>(control.joint.index());
      force[j] += force_of(control, d->ctrl[i], d->qpos[j], d->qvel[j]);
    }
    mj_forward(&m, d);
    for (int i = 0; i < m.nv; ++i) {
      CHECK(force[static_cast<std::size_t>(i)] == Approx(d->qfrc_actuator[i]).epsilon(1e-12));
    }
  }
}

}  // namespace manyworlds::test
