// What joints of trees carry, against MuJoCo's cfrc_int, from states that it reaches.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <mujoco/mujoco.h>
#include <catch2/catch.hpp>

#include "tests/mjcf/newton_comparison.hpp"
#include "tests/support/paths.hpp"

namespace manyworlds::test {
namespace {

// Without implicit dampers, so that MuJoCo's accelerations are those of the step.
std::string scene_with_explicit_dampers(const std::string& name) {
  std::stringstream text;
  const auto folder = std::filesystem::path(kSourceFolder) / "scenes" / "mjcf";
  text << std::ifstream(folder / (name + ".xml")).rdbuf();
  std::string xml = text.str();
  return xml.insert(xml.find("<worldbody"), "<option><flag eulerdamp='disable'/></option>");
}

// Force and torque about its anchor of each joint of the scene, as MuJoCo has them.
std::vector<double> loads_of(const compare::Pair& pair, mjData& d, const Scene& scene,
                             const compare::Sample& s) {
  const mjModel& m = pair.mujoco();
  mj_resetData(&m, &d);
  std::copy(s.q.begin(), s.q.end(), d.qpos), std::copy(s.v.begin(), s.v.end(), d.qvel);
  std::copy(s.u.begin(), s.u.end(), d.ctrl);
  mj_forward(&m, &d);
  mj_rnePostConstraint(&m, &d);
  const auto vector = [](const mjtNum* v) { return Vec3(v[0], v[1], v[2]); };
  std::vector<double> forces, torques;
  for (const Joint& joint : scene.joints) {
    const auto link = std::find_if(pair.links().begin(), pair.links().end(),
                                   [&](const auto& l) { return l.body == joint.body_b; });
    REQUIRE(link != pair.links().end());
    const int body = link->mujoco, j = mj_name2id(&m, mjOBJ_JOINT, joint.name.c_str());
    const mjtNum* load = d.cfrc_int + 6 * body;  // about the tree's centre of mass
    Vec3 anchor;
    if (std::holds_alternative<FixedJoint>(joint.type)) {
      const mjtNum* q = d.xquat + 4 * body;
      anchor = vector(d.xpos + 3 * body) + Quat(q[0], q[1], q[2], q[3]) * joint.frame_b.position;
    } else {
      REQUIRE(j >= 0);
      anchor = vector(d.xanchor + 3 * j);
    }
    if (std::holds_alternative<SliderJoint>(joint.type)) {  // its anchor in MuJoCo does not move
      const int q = m.jnt_qposadr[j];
      anchor += (d.qpos[q] - m.qpos0[q]) * vector(d.xaxis + 3 * j);
    }
    const Vec3 force = vector(load + 3), center = vector(d.subtree_com + 3 * m.body_rootid[body]);
    const Vec3 torque = vector(load) + (center - anchor).cross(force);
    forces.insert(forces.end(), force.data(), force.data() + 3);
    torques.insert(torques.end(), torque.data(), torque.data() + 3);
  }
  forces.insert(forces.end(), torques.begin(), torques.end());
  return forces;
}

}  // namespace

TEST_CASE("joints carry what MuJoCo's cfrc_int says", "[mjcf][robots]") {
  const std::string model =
      GENERATE("robot_hopper", "robot_cheetah", "robot_ant", "robot_humanoid");
  const compare::Pair pair = pair_of(scene_with_explicit_dampers(model));
  const auto data = pair.make_data();
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    const Scene scene = pair.scene(precision);
    const auto samples = compare::draw_samples(pair, precision, 60);
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      BatchOptions options = options_of(table);
      options.observe.what = {Observer::joint_loads};
      Batch batch(compile(scene), options);
      int pushed = 0;
      for (const compare::Sample& s : samples) {
        if (s.uncertain || s.other_points) continue;
        batch.write(Field::generalized_position, 0, s.q);
        batch.write(Field::generalized_velocity, 0, s.v);
        batch.set_controls(0, s.u);
        batch.step();
        const std::size_t count = batch.size(Observed::joint_force);
        std::vector<double> loads(2 * count);
        batch.read(Observed::joint_force, 0, std::span(loads).first(count));
        batch.read(Observed::joint_torque, 0, std::span(loads).subspan(count));
        INFO(model << ", " << name(table) << ", " << s.rows << " rows, " << s.touches.size()
                   << " contacts");
        CHECK(compare::difference(loads, loads_of(pair, *data, scene, s)) <
              pick(table, 2e-3, 1e-9));
        if (!s.touches.empty()) ++pushed;
      }
      CHECK(pushed > 3);
    }
  }
}

}  // namespace manyworlds::test
