// Numbers that a world of Solver::newton has of its own against those that are written into
// MuJoCo's compiled model, limits and contacts included: both keep how soft their rows are.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "manyworlds/batch.hpp"
#include "manyworlds/mjcf.hpp"
#include "tests/mjcf/mujoco_reference.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied.hpp"

namespace manyworlds::test {
namespace {

constexpr const char* kVariedRobot = R"(<mujoco><compiler angle="radian" autolimits="true"/>
  <option timestep="0.004" solver="Newton" tolerance="1e-14" iterations="200" ls_iterations="100"
          ls_tolerance="1e-8"/>
  <default><geom type="capsule" size="0.04 0.1" density="900"/>
    <joint armature="0.01" damping="0.3"/></default>
  <worldbody><geom type="plane" size="5 5 1"/>
    <body name="trunk" pos="0 0 0.14"><freejoint/><geom size="0.1 0.2" euler="0 1.57 0"/>
      <body pos="0.1 0.15 0"><joint axis="0 1 0" range="-0.2 0.3" stiffness="4" springref="0.4"/>
        <geom pos="0.1 0 0" euler="0 1.57 0"/>
        <body pos="0.2 0 0"><joint axis="0 0 1" range="-0.3 0.3" stiffness="1"/>
          <geom type="sphere" size="0.06" pos="0.06 0 0"/></body></body>
      <body pos="-0.25 0 0"><joint type="ball" range="0 0.2" stiffness="2"/><geom pos="-0.1 0 0"
        euler="0 1.57 0"/></body>
      <body pos="0 -0.2 0"><joint type="slide" axis="0 1 0" range="-0.05 0.05" stiffness="100"/>
        <geom type="sphere" size="0.08"/></body>
    </body>
  </worldbody>
  <actuator><motor joint="J0" gear="3"/><position joint="J1" kp="20" kv="0.5"/>
    <velocity joint="J3" kv="5"/></actuator></mujoco>)";

// Joints of one name each, in the order of MuJoCo's.
std::string named(std::string xml) {
  int joint = 0;
  for (std::size_t at = 0; (at = xml.find("<joint ", at)) != std::string::npos; at += 7) {
    if (xml.compare(at, 16, "<joint armature=") == 0) continue;
    xml.insert(at + 7, "name=\"J" + std::to_string(joint++) + "\" ");
  }
  return xml;
}

void write_softness(mjtNum* to_solref, mjtNum* to_solimp, const std::vector<double>& solref,
                    const std::vector<double>& solimp, std::size_t item) {
  std::copy_n(solref.begin() + static_cast<std::ptrdiff_t>(2 * item), 2, to_solref);
  std::copy_n(solimp.begin() + static_cast<std::ptrdiff_t>(3 * item), 3, to_solimp);
}

void write_into(mjModel& m, const Batch& batch, int world) {
  const auto all = [&](Parameter p) { return test::numbers(batch, p, world); };
  const auto armature = all(Parameter::armature), damping = all(Parameter::damping),
             stiffness = all(Parameter::stiffness), rest = all(Parameter::rest),
             gain = all(Parameter::gain), bias = all(Parameter::bias), mass = all(Parameter::mass),
             low = all(Parameter::limit_low), high = all(Parameter::limit_high),
             limit_solref = all(Parameter::limit_solref),
             limit_solimp = all(Parameter::limit_solimp),
             contact_solref = all(Parameter::contact_solref),
             contact_solimp = all(Parameter::contact_solimp), gear = all(Parameter::gear),
             force_low = all(Parameter::force_low), force_high = all(Parameter::force_high);
  for (int j = 1; j < m.njnt; ++j) {  // 0 is free
    const auto i = static_cast<std::size_t>(j - 1);
    const int dofs = m.jnt_type[j] == mjJNT_BALL ? 3 : 1;
    for (int k = m.jnt_dofadr[j]; k < m.jnt_dofadr[j] + dofs; ++k) {
      m.dof_armature[k] = armature[i], m.dof_damping[k] = damping[i];
    }
    m.jnt_stiffness[j] = stiffness[i];
    if (dofs == 1) m.qpos_spring[m.jnt_qposadr[j]] = rest[i];
    m.jnt_range[2 * j] = low[i], m.jnt_range[2 * j + 1] = high[i];
    write_softness(m.jnt_solref + mjNREF * j, m.jnt_solimp + mjNIMP * j, limit_solref, limit_solimp,
                   i);
  }
  for (int g = 0; g < m.ngeom; ++g) {
    write_softness(m.geom_solref + mjNREF * g, m.geom_solimp + mjNIMP * g, contact_solref,
                   contact_solimp, static_cast<std::size_t>(g));
  }
  for (int a = 0; a < m.nu; ++a) {
    const auto i = static_cast<std::size_t>(a);
    m.actuator_gear[6 * a] = gear[i];
    m.actuator_forcelimited[a] = 1;
    m.actuator_forcerange[2 * a] = force_low[i], m.actuator_forcerange[2 * a + 1] = force_high[i];
    for (int c = 0; c < 3; ++c) {
      m.actuator_gainprm[mjNGAIN * a + c] = gain[static_cast<std::size_t>(3 * a + c)];
      m.actuator_biasprm[mjNBIAS * a + c] = bias[static_cast<std::size_t>(3 * a + c)];
    }
  }
  for (int b = 1; b < m.nbody; ++b) {
    const double factor = mass[static_cast<std::size_t>(b - 1)] / m.body_mass[b];
    m.body_mass[b] *= factor;
    for (int c = 0; c < 3; ++c) m.body_inertia[3 * b + c] *= factor;
  }
}

}  // namespace

TEST_CASE("robots move as in MuJoCo's model with the same numbers written into it",
          "[mjcf][robots][parameters]") {
  const std::string xml = named(kVariedRobot);
  Scene scene = load_mjcf_string(xml).scene;
  const auto of = [](Variation v, int control) {
    v.control = ControlId(control);
    return v;
  };
  scene.variations = {vary(Parameter::mass, 0.3, 30, Draw::log_uniform),
                      vary(Parameter::armature, 0.002, 0.05),
                      vary(Parameter::damping, 0.05, 1),
                      vary(Parameter::stiffness, 0.5, 60),
                      vary(Parameter::rest, -0.4, 0.4),
                      of(vary(Parameter::gain, 0.5, 2), 0),
                      of(vary(Parameter::kp, 5, 60), 1),
                      of(vary(Parameter::kv, 0.1, 2), 1),
                      of(vary(Parameter::kv, 1, 10), 2),
                      vary(Parameter::force_low, -4, -0.5),
                      vary(Parameter::force_high, 0.5, 4)};
  for (const Parameter end : {Parameter::limit_low, Parameter::limit_high}) {
    vary_around(scene, end, 0.03);
  }
  for (const Parameter p : {Parameter::limit_solref, Parameter::contact_solref, Parameter::gear}) {
    vary_by_share(scene, p, 0.3);
  }
  for (const Parameter p : {Parameter::limit_solimp, Parameter::contact_solimp}) {
    vary_by_share(scene, p, 0.04);
  }
  scene.options.solver.tolerance = 1e-26, scene.options.solver.iterations = 200;
  scene.options.solver.line_search_iterations = 100;
  scene.options.solver.line_search_tolerance = 1e-8;
  const Plan plan = compile(scene);
  const Table table = double_table();
  if (!has_table(table)) return;
  constexpr int kWorlds = 24;
  Batch batch(plan, options_of(table, kWorlds));
  std::vector<Reference> references;
  for (int w = 0; w < kWorlds; ++w) {
    references.emplace_back(xml);
    write_into(*references.back().model, batch, w);
  }
  int rows = 0, contacts = 0;
  double largest = 0;
  for (int s = 0; s < 60; ++s) {
    for (int w = 0; w < kWorlds; ++w) {
      const mjModel& m = *references[static_cast<std::size_t>(w)].model;
      mjData* d = references[static_cast<std::size_t>(w)].data.get();
      Random random(static_cast<std::uint64_t>(100 * w + s / 10));
      std::vector<double> u(static_cast<std::size_t>(m.nu));
      for (double& x : u) x = random.uniform(-1, 1);
      batch.set_controls(w, u);
      std::copy(u.begin(), u.end(), d->ctrl);
      // Both from the same state.
      batch.write(Field::generalized_position, w, std::vector<double>(d->qpos, d->qpos + m.nq));
      batch.write(Field::generalized_velocity, w, std::vector<double>(d->qvel, d->qvel + m.nv));
      mj_step(&m, d);
      rows += d->nefc, contacts += d->ncon;
    }
    batch.step();
    for (int w = 0; w < kWorlds; ++w) {
      const mjModel& m = *references[static_cast<std::size_t>(w)].model;
      const mjData* d = references[static_cast<std::size_t>(w)].data.get();
      std::vector<double> v(static_cast<std::size_t>(m.nv));
      batch.read(Field::generalized_velocity, w, v);
      for (int k = 0; k < m.nv; ++k) {
        const double own = v[static_cast<std::size_t>(k)];
        largest = std::max(largest, std::abs(own - d->qvel[k]) / std::max(1.0, std::abs(own)));
      }
    }
  }
  CHECK(contacts > 500);
  CHECK(rows > 4 * contacts + 200);  // limits, too
  CHECK(largest < 1e-9);
}

}  // namespace manyworlds::test
