// Smooth dynamics and joint limits of trees against MuJoCo: accelerations at random states.
#include <mujoco/mujoco.h>
#include <catch2/catch.hpp>

#include "tests/mjcf/mujoco_reference.hpp"
#include "tests/support/random_trees.hpp"
#include "tests/support/tree_group.hpp"

namespace manyworlds::test {
namespace {

using kernels::TreeJointKind;
using Numbers = TreeTwin::Numbers;

// A walker on a free joint, an arm on the world, and a ball that hangs: each kind of joint, several
// of them on one body, off its centre; limits, springs, dampers, armature; bodies welded to others
// are left out, since MuJoCo's compiler would keep them.
constexpr const char* kTreeRobots = R"(<mujoco>
  <compiler angle="radian" autolimits="true"/>
  <option timestep="0.004" solver="Newton" tolerance="1e-14" iterations="200" ls_iterations="100"
          ls_tolerance="1e-8" gravity="0.5 -1 -9.81"><flag contact="disable"/></option>
  <default><geom type="capsule" size="0.04 0.1" density="900"/>
    <joint armature="0.01" damping="0.3"/></default>
  <worldbody>
    <body name="trunk" pos="0 0 1" euler="0.1 0.2 0.3"><freejoint/>
      <geom size="0.1 0.2" euler="0 1.57 0" pos="0.03 0 0.02"/>
      <body name="thigh" pos="0.1 0.15 -0.1" euler="0.2 0 0.1">
        <joint name="hip x" axis="1 0 0" pos="0 0 0.1" range="-0.5 0.6" stiffness="4"/>
        <joint name="hip y" axis="0 1 0.2" pos="0 0 0.1" range="-1 0.3" ref="0.2" springref="0.4" stiffness="9"/>
        <geom pos="0.01 0 -0.05"/>
        <body name="shin" pos="0 0 -0.25">
          <joint name="knee" axis="0 1 0" pos="0 0 0.12" range="-1.2 0.1" margin="0.05"
                 solreflimit="0.03 0.8" solimplimit="0.5 0.9 0.2 0.4 3"/>
          <geom/><geom type="sphere" size="0.05" pos="0.06 0 -0.12"/>
        </body>
      </body>
      <body name="tail" pos="-0.2 0 0">
        <joint name="tail" type="ball" pos="0.08 0 0" damping="0.1" range="0 0.4"/>
        <geom type="box" size="0.1 0.03 0.02"/>
        <body name="tip" pos="-0.2 0 0"><joint axis="0 0 1" range="-0.4 0.4"
              solreflimit="-800 -30"/><geom type="ellipsoid" size="0.1 0.05 0.03"/></body>
      </body>
    </body>
    <body name="cart" pos="2 0 0.5">
      <joint name="rail" type="slide" axis="1 0.1 0" range="-0.5 0.5" ref="0.1"/>
      <joint name="lift" type="slide" axis="0 0 1" stiffness="300" springref="0.05"/>
      <joint name="swivel" axis="0 0 1" pos="0.05 0.02 0"/>
      <geom type="box" size="0.2 0.1 0.05"/>
      <body name="arm" pos="0 0 0.2" euler="0 0.4 0">
        <joint name="shoulder" axis="0 1 0" range="-2 2" damping="0"/><geom pos="0 0 0.2" size="0.03 0.2"/>
        <body name="hand" pos="0 0 0.45"><joint axis="1 1 0" damping="0" armature="0"/>
          <geom type="box" size="0.05 0.08 0.02" pos="0.02 0 0.03"/></body>
      </body>
    </body>
    <body name="bob" pos="-2 0 2"><joint type="ball" pos="0 0 0.5" stiffness="20"/><geom/>
    </body>
  </worldbody>
</mujoco>)";

std::vector<TwinLink> links_of(const mjModel& m) {
  const auto vector = [](const mjtNum* v) { return Vec3(v[0], v[1], v[2]); };
  const auto rotation = [](const mjtNum* q) { return Quat(q[0], q[1], q[2], q[3]); };
  std::vector<TwinLink> out;
  for (int b = 1; b < m.nbody; ++b) {
    TwinLink link;
    link.frame.body = b - 1, link.frame.parent = m.body_parentid[b] - 1;
    link.frame.position = vector(m.body_pos + 3 * b);
    link.frame.rotation = rotation(m.body_quat + 4 * b);
    link.frame.center = vector(m.body_ipos + 3 * b);
    link.frame.principal = rotation(m.body_iquat + 4 * b);
    link.frame.mass = m.body_mass[b], link.frame.moments = vector(m.body_inertia + 3 * b);
    for (int j = m.body_jntadr[b]; j >= 0 && j < m.body_jntadr[b] + m.body_jntnum[b]; ++j) {
      constexpr TreeJointKind kKinds[] = {TreeJointKind::free, TreeJointKind::ball,
                                          TreeJointKind::slide, TreeJointKind::hinge};
      NewTreeJoint joint;
      joint.kind = kKinds[m.jnt_type[j]];
      joint.anchor = vector(m.jnt_pos + 3 * j), joint.axis = vector(m.jnt_axis + 3 * j);
      joint.armature = m.dof_armature[m.jnt_dofadr[j]];
      joint.damping = m.dof_damping[m.jnt_dofadr[j]];
      joint.stiffness = m.jnt_stiffness[j];
      if (kernels::dofs_of(joint.kind) == 1) {
        joint.reference = m.qpos0[m.jnt_qposadr[j]];
        joint.rest = m.qpos_spring[m.jnt_qposadr[j]];
      }
      if (m.jnt_limited[j]) {
        joint.range = {m.jnt_range[2 * j], m.jnt_range[2 * j + 1]};
        joint.margin = m.jnt_margin[j];
        const mjtNum *r = m.jnt_solref + mjNREF * j, *d = m.jnt_solimp + mjNIMP * j;
        joint.compliance = {r[0], r[1], d[0], d[1], d[2], d[3], d[4]};
      }
      link.joints.push_back(joint);
    }
    out.push_back(link);
  }
  return out;
}

template <class Real>
void check_against_mujoco(const kernels::Kernels<Real>& kernels, double tolerance) {
  INFO(kernels.isa);
  Reference reference(kTreeRobots);
  const mjModel& m = *reference.model;
  mjData* d = reference.data.get();
  const Vec3 gravity(m.opt.gravity[0], m.opt.gravity[1], m.opt.gravity[2]);
  const std::vector<TwinLink> links = links_of(m);
  const PlanTrees trees = trees_of(links, m.opt.timestep);
  CHECK(trees.weights.mean_inertia == Approx(m.stat.meaninertia).epsilon(1e-9));
  for (int k = 0; k < m.nv; ++k) {
    CHECK(trees.weights.dof[static_cast<std::size_t>(k)] ==
          Approx(m.dof_invweight0[k]).epsilon(1e-7));
  }
  for (std::size_t b = 0; b < links.size(); ++b) {
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(trees.weights.link[b][i] == Approx(m.body_invweight0[2 * b + 2 + i]).epsilon(1e-7));
    }
  }
  Random random(3);
  int limited = 0;
  for (int trial = 0; trial < 20; ++trial) {
    TreeGroup<Real> group(kernels, links, gravity, m.opt.timestep);
    std::vector<TreeState> states;
    for (int lane = 0; lane < group.lanes(); ++lane) {
      TreeState s{Numbers(m.nq), Numbers(m.nv)};
      for (int i = 0; i < m.nq; ++i) s.q[i] = m.qpos0[i] + random.uniform(-0.8, 0.8);
      for (int k = 0; k < m.nv; ++k) s.v[k] = random.uniform(-2, 2);
      mj_normalizeQuat(&m, s.q.data());
      group.set(lane, s.q, s.v);
      states.push_back(s);
    }
    group.step(1);
    for (int lane = 0; lane < group.lanes(); ++lane) {
      INFO("trial " << trial << ", lane " << lane);
      const TreeState& s = states[static_cast<std::size_t>(lane)];
      mj_resetData(&m, d);
      std::copy_n(s.q.data(), m.nq, d->qpos), std::copy_n(s.v.data(), m.nv, d->qvel);
      mj_forward(&m, d);
      const Numbers a = Eigen::Map<const Numbers>(d->qacc, m.nv);
      if (d->nefc > 0) {
        ++limited;
        CHECK((group.acceleration(lane) - a).cwiseAbs().maxCoeff() <
              tolerance * (1 + a.cwiseAbs().maxCoeff()));
      }
      mj_Euler(&m, d);
      const Numbers q = Eigen::Map<const Numbers>(d->qpos, m.nq);
      const Numbers v = Eigen::Map<const Numbers>(d->qvel, m.nv);
      CHECK((group.velocity(lane) - v).cwiseAbs().maxCoeff() < tolerance * (1 + v.norm()));
      CHECK((group.position(lane) - q).cwiseAbs().maxCoeff() < tolerance);
    }
  }
  CHECK(limited > 10);
}

}  // namespace

TEST_CASE("trees move as in MuJoCo: smooth dynamics and limits", "[mjcf][robots][fast]") {
  for_each_isa<double>([](const auto& k) { check_against_mujoco<double>(k, 1e-9); });
  for_each_isa<float>([](const auto& k) { check_against_mujoco<float>(k, 1e-3); });
}

TEST_CASE("trees follow MuJoCo's path for 1,000 steps", "[mjcf][robots][fast]") {
  Reference reference(kTreeRobots);
  mjModel& m = *reference.model;
  m.opt.disableflags |= mjDSBL_LIMIT;
  mjData* d = reference.data.get();
  std::vector<TwinLink> links = links_of(m);
  for (TwinLink& link : links) {
    for (NewTreeJoint& joint : link.joints) joint.range.reset();
  }
  const Vec3 gravity(m.opt.gravity[0], m.opt.gravity[1], m.opt.gravity[2]);
  for_each_isa<double>([&](const auto& k) {
    INFO(k.isa);
    TreeGroup<double> group(k, links, gravity, m.opt.timestep);
    mj_resetData(&m, d);
    const Numbers q0 = Eigen::Map<const Numbers>(d->qpos, m.nq);
    for (int lane = 0; lane < group.lanes(); ++lane) group.set(lane, q0, Numbers::Zero(m.nv));
    for (int i = 0; i < 1000; ++i) mj_step(&m, d);
    group.step(1000);
    const Numbers q = Eigen::Map<const Numbers>(d->qpos, m.nq);
    CHECK((group.position(0) - q).cwiseAbs().maxCoeff() < 1e-9 * (1 + q.norm()));
  });
}

}  // namespace manyworlds::test
