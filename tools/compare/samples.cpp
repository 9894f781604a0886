#include <algorithm>
#include <cmath>

#include "tools/compare/states.hpp"

namespace manyworlds::compare {
namespace {

// As numbers of that precision hold them.
std::vector<double> held(const mjtNum* from, std::ptrdiff_t size, Precision precision) {
  std::vector<double> to(from, from + size);
  if (precision == Precision::f32) {
    for (double& x : to) x = static_cast<double>(static_cast<float>(x));
  }
  return to;
}

void read_contacts(const Pair& pair, const mjData& d, Precision precision, Sample& s) {
  const double rounding = precision == Precision::f64 ? 1e-12 : 1e-6;  // m
  for (int c = 0; c < d.ncon; ++c) {
    const mjContact& contact = d.contact[c];
    s.uncertain |= std::abs(contact.dist - contact.includemargin) < rounding;
    if (contact.exclude != 0) continue;
    s.other_points |= !pair.same_points(contact.geom[0], contact.geom[1]);
    s.touches.push_back({Vec3(contact.pos[0], contact.pos[1], contact.pos[2]),
                         Vec3(contact.frame[0], contact.frame[1], contact.frame[2]), contact.dist});
  }
}

// After mj_forward.
void read_links(const Pair& pair, mjData& d, Sample& s) {
  const mjModel& m = pair.mujoco();
  for (const Pair::Link& link : pair.links()) {
    const int b = link.mujoco;
    s.position.insert(s.position.end(), d.xpos + 3 * b, d.xpos + 3 * b + 3);
    s.rotation.insert(s.rotation.end(), d.xquat + 4 * b, d.xquat + 4 * b + 4);
    mjtNum velocity[6];
    mj_objectVelocity(&m, &d, mjOBJ_BODY, b, velocity, 0);
    s.speed.insert(s.speed.end(), velocity, velocity + 6);
  }
  mj_energyVel(&m, &d);
  s.kinetic = d.energy[1];
  for (int k = 0; k < m.nv; ++k) s.kinetic -= 0.5 * m.dof_armature[k] * d.qvel[k] * d.qvel[k];
}

}  // namespace

std::vector<Sample> draw_samples(const Pair& pair, Precision precision, int count, int first,
                                 int steps) {
  const mjcf::LogCapture log;
  const mjcf::DataPtr data = pair.make_data();
  const mjModel& m = pair.mujoco();
  mjData& d = *data;
  Random random(pair.settings().seed, 0);
  std::vector<Sample> out;
  for (int i = 0; i < count; ++i) {
    pair.pause();
    mj_resetData(&m, &d);
    for (int k = 0; k < m.nv; ++k) d.qvel[k] = random.uniform(-1, 1);
    draw_controls(m, random, d.ctrl);
    const int begun = random.integer(first, steps);
    for (int s = 0; s < begun; ++s) {
      if (s % 5 == 0) draw_controls(m, random, d.ctrl);
      mj_step(&m, &d);
    }
    mj_normalizeQuat(&m, d.qpos);
    Sample s;
    s.q = held(d.qpos, m.nq, precision), s.v = held(d.qvel, m.nv, precision);
    s.u = held(d.ctrl, m.nu, precision);
    std::copy(s.q.begin(), s.q.end(), d.qpos), std::copy(s.v.begin(), s.v.end(), d.qvel);
    std::copy(s.u.begin(), s.u.end(), d.ctrl);
    mj_forward(&m, &d);
    read_contacts(pair, d, precision, s);
    read_links(pair, d, s);
    s.rows = static_cast<int>(d.nefc);
    const std::vector<double> a(d.qacc, d.qacc + m.nv);
    mj_step(&m, &d);
    s.next_q.assign(d.qpos, d.qpos + m.nq), s.next_v.assign(d.qvel, d.qvel + m.nv);
    // Of Runge-Kutta ours is that of the last stage. Without rows ours has the implicit dampers.
    if (m.opt.integrator != mjINT_RK4) {
      s.a = a;
      for (int k = 0; s.rows == 0 && k < m.nv; ++k) {
        const auto at = static_cast<std::size_t>(k);
        s.a[at] = (s.next_v[at] - s.v[at]) / m.opt.timestep;
      }
    }
    out.push_back(std::move(s));
  }
  return out;
}

}  // namespace manyworlds::compare
