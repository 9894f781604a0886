// Keyframes of MJCF files: worlds that are reset to them are where MuJoCo is.
#include <algorithm>

#include <catch2/catch.hpp>

#include "manyworlds/batch.hpp"
#include "manyworlds/mjcf.hpp"
#include "tests/mjcf/mujoco_reference.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Each kind of joint, in a tree with branches, and two trees.
constexpr const char* kRobot = R"(<mujoco><compiler angle="radian" autolimits="true"/>
  <option timestep="0.004"/>
  <default><geom type="capsule" size="0.04 0.1"/><joint damping="0.2" armature="0.01"/></default>
  <worldbody><geom type="plane" size="5 5 1"/>
    <body name="trunk" pos="0 0 1"><freejoint/><geom/>
      <body pos="0.2 0 0"><joint name="a" axis="0 1 0" ref="0.1"/><geom/>
        <body pos="0.2 0 0"><joint name="b" type="ball"/><geom/></body></body>
      <body pos="-0.2 0 0"><joint name="c" type="slide" axis="1 0 0"/>
        <joint name="d" axis="0 0 1"/><geom/></body></body>
    <body pos="2 0 1"><joint name="e" axis="1 0 0"/><geom/></body>
  </worldbody>
  <actuator><motor joint="d" ctrlrange="-1 1"/><position joint="a" kp="5"/></actuator>
  <keyframe>
    <key name="squat" qpos="0.1 0.2 0.9 0.6 0 0.8 0 0.3 0.5 0.5 -0.5 0.5 0.05 -0.4 0.7"
         qvel="1 2 3 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 -1" ctrl="0.25 -1.5"/>
    <key qvel="0 0 0 0 0 0 0 0 0 0 0 0 2"/>
    <key name="unnormalised" qpos="0 0 2 2 0 0 0 0 0 0 3 0 0 0 0"/>
    <key name="late" time="3" ctrl="1 0"/>
  </keyframe></mujoco>)";

void check_reset(const std::string& xml) {
  const MjcfResult result = load_mjcf_string(xml);
  const Plan plan = compile(result.scene);
  Reference reference(xml);
  const mjModel& m = *reference.model;
  mjData* d = reference.data.get();
  REQUIRE(plan.scene().keyframes.size() == static_cast<std::size_t>(m.nkey));
  for (const Table& table : all_tables()) {
    Batch batch(plan, options_of(table, 2));
    const double tolerance = pick(table, 1e-6, 1e-12);
    for (int k = 0; k < m.nkey; ++k) {
      INFO(name(table) << ", key " << k);
      mj_resetDataKeyframe(&m, d, k);
      batch.step(3);
      batch.reset(KeyframeId(k));
      const auto check = [&](Field field, const mjtNum* expected, int count) {
        std::vector<double> found(plan.numbers(field));
        REQUIRE(found.size() == static_cast<std::size_t>(count));
        batch.read(field, 1, found);
        for (int i = 0; i < count; ++i) {
          CHECK(found[static_cast<std::size_t>(i)] == approx(expected[i], tolerance));
        }
      };
      check(Field::generalized_position, d->qpos, static_cast<int>(m.nq));
      check(Field::generalized_velocity, d->qvel, static_cast<int>(m.nv));
      std::vector<double> controls(static_cast<std::size_t>(2 * m.nu));
      batch.read_controls(controls);
      for (int i = 0; i < m.nu; ++i) {
        CHECK(controls[static_cast<std::size_t>(m.nu + i)] == approx(d->ctrl[i], tolerance));
      }
      // And it goes on as MuJoCo does.
      mj_step(&m, d);
      batch.step();
      std::vector<double> q(plan.numbers(Field::generalized_position));
      batch.read(Field::generalized_position, 1, q);
      for (std::size_t i = 0; i < q.size(); ++i) {
        CHECK(q[i] == approx(d->qpos[i], pick(table, 1e-5, 1e-7)));
      }
    }
  }
}

}  // namespace

TEST_CASE("worlds reset to a file's keyframe are where MuJoCo is", "[mjcf][robots][fast]") {
  check_reset(kRobot);
}

TEST_CASE("keyframes keep their names, and what is not theirs is said", "[mjcf][robots][fast]") {
  const MjcfResult result = load_mjcf_string(kRobot);
  std::vector<std::string> names;
  for (const Keyframe& keyframe : result.scene.keyframes) names.push_back(keyframe.name);
  CHECK(names == std::vector<std::string>{"squat", "", "unnormalised", "late"});
  CHECK(result.warnings ==
        std::vector<std::string>{"key 'late': time is ignored; worlds have no separate clocks"});
}

}  // namespace manyworlds::test
