// A model in Solver::newton beside MuJoCo stepping the same model, at states that MuJoCo reaches
// under random controls.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "manyworlds/batch.hpp"
#include "manyworlds/mjcf.hpp"
#include "tests/mjcf/mujoco_reference.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

// A state, its controls, and what MuJoCo makes of them.
struct Sample {
  std::vector<double> q, v, u, a, next_q, next_v;
  int contacts = 0;        // that may push: those in the gap may not
  int rows = 0;            // of constraints
  bool uncertain = false;  // a contact is so near where contacts begin that rounding decides
};

// Errors are the largest relative to the largest number of the vector, or to 1.
struct Comparison {
  std::vector<double> acceleration, next;  // sorted
  int states = 0, contacts = 0, rows = 0;
  int other_contacts = 0;  // states in which we find another number of them
  int uncertain = 0;       // states left out, of float32
};

// Both solve until the numbers go no closer to the minimum. Costs fall with the square of what the
// accelerations are off, and only those of pyramids are exact after the last step.
inline void converge(mjModel& m) {
  m.opt.solver = mjSOL_NEWTON, m.opt.iterations = 200;
  m.opt.tolerance = m.opt.cone == mjCONE_ELLIPTIC ? 1e-26 : 1e-14;
  m.opt.ls_iterations = 100, m.opt.ls_tolerance = 1e-8;
}
inline Scene converged(const std::string& xml, Precision precision) {
  Scene scene = load_mjcf_string(xml).scene;
  SolverOptions& solver = scene.options.solver;
  const double exact = solver.cone == FrictionCone::elliptic ? 1e-26 : 1e-12;
  solver.tolerance = precision == Precision::f64 ? exact : 1e-7;
  solver.iterations = 200;
  solver.line_search_iterations = 100, solver.line_search_tolerance = 1e-6;
  return scene;
}

inline void draw_controls(const mjModel& m, Random& random, mjData& d) {
  for (int u = 0; u < m.nu; ++u) {
    const bool limited = m.actuator_ctrllimited[u] != 0;
    const double low = limited ? m.actuator_ctrlrange[2 * u] : -1;
    const double high = limited ? m.actuator_ctrlrange[2 * u + 1] : 1;
    const double beyond = 0.1 * (high - low);  // what is set there counts as the end
    d.ctrl[u] = random.uniform(low - beyond, high + beyond);
  }
}

// After up to `steps` steps from the reference pose at a random velocity, `first` at least.
inline std::vector<Sample> samples_of(const std::string& xml, Precision precision, int count,
                                      int first = 0, int steps = 300) {
  Reference reference(xml);
  mjModel& m = *reference.model;
  mjData& d = *reference.data;
  converge(m);
  const auto held = [&](const double* from, std::ptrdiff_t size) {
    std::vector<double> to(from, from + size);
    if (precision == Precision::f32) {
      for (double& x : to) x = static_cast<double>(static_cast<float>(x));
    }
    return to;
  };
  Random random(5);
  std::vector<Sample> out;
  for (int i = 0; i < count; ++i) {
    mj_resetData(&m, &d);
    for (int k = 0; k < m.nv; ++k) d.qvel[k] = random.uniform(-1, 1);
    draw_controls(m, random, d);
    const int begun = random.integer(first, steps);
    for (int s = 0; s < begun; ++s) {
      if (s % 5 == 0) draw_controls(m, random, d);
      mj_step(&m, &d);
    }
    mj_normalizeQuat(&m, d.qpos);
    Sample s;
    s.q = held(d.qpos, m.nq), s.v = held(d.qvel, m.nv), s.u = held(d.ctrl, m.nu);
    std::copy(s.q.begin(), s.q.end(), d.qpos), std::copy(s.v.begin(), s.v.end(), d.qvel);
    std::copy(s.u.begin(), s.u.end(), d.ctrl);
    mj_forward(&m, &d);
    for (int c = 0; c < d.ncon; ++c) {
      const mjContact& contact = d.contact[c];
      s.contacts += contact.exclude == 0 ? 1 : 0;
      s.uncertain |= std::abs(contact.dist - contact.includemargin) < 1e-6;
    }
    // Of Runge-Kutta ours are those of the last stage.
    s.rows = m.opt.integrator == mjINT_RK4 ? 0 : static_cast<int>(d.nefc);
    s.a.assign(d.qacc, d.qacc + m.nv);
    mj_step(&m, &d);
    s.next_q.assign(d.qpos, d.qpos + m.nq), s.next_v.assign(d.qvel, d.qvel + m.nv);
    out.push_back(std::move(s));
  }
  return out;
}

inline std::vector<double> read(const Batch& batch, Field field, int world) {
  std::vector<double> out(batch.size(field) / static_cast<std::size_t>(batch.worlds()));
  batch.read(field, world, out);
  return out;
}

inline double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0, size = 1;
  for (std::size_t k = 0; k < a.size(); ++k) {
    most = std::max(most, std::abs(a[k] - b[k])), size = std::max(size, std::abs(b[k]));
  }
  return std::isfinite(most) && a.size() == b.size() ? most / size : 1e9;
}

inline void write(Batch& batch, const std::vector<Sample>& samples) {
  std::vector<double> q, v, u;
  const auto add = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (const Sample& s : samples) add(q, s.q), add(v, s.v), add(u, s.u);
  batch.write(Field::generalized_position, std::span<const double>(q));
  batch.write(Field::generalized_velocity, std::span<const double>(v));
  if (!u.empty()) batch.set_controls(std::span<const double>(u));
}

// One world for each sample. The acceleration is MuJoCo's where there are rows; where there are
// none it holds that with implicit dampers, which the next state tells as well.
inline Comparison compare(const Plan& plan, const std::vector<Sample>& samples,
                          const Table& table) {
  Batch batch(plan, options_of(table, static_cast<int>(samples.size())));
  write(batch, samples);
  std::vector<std::size_t> contacts;
  for (int i = 0; i < batch.worlds(); ++i) contacts.push_back(batch.contacts(i).size());
  batch.step();
  Comparison out;
  for (int i = 0; i < batch.worlds(); ++i) {
    const Sample& s = samples[static_cast<std::size_t>(i)];
    ++out.states, out.contacts += s.contacts, out.rows += s.rows;
    if (static_cast<int>(contacts[static_cast<std::size_t>(i)]) != s.contacts) {
      ++out.other_contacts;
      continue;
    }
    if (s.uncertain && table.precision == Precision::f32) {
      ++out.uncertain;
      continue;
    }
    if (s.rows > 0) {
      out.acceleration.push_back(difference(read(batch, Field::generalized_acceleration, i), s.a));
    }
    out.next.push_back(std::max(difference(read(batch, Field::generalized_position, i), s.next_q),
                                difference(read(batch, Field::generalized_velocity, i), s.next_v)));
  }
  std::sort(out.acceleration.begin(), out.acceleration.end());
  std::sort(out.next.begin(), out.next.end());
  return out;
}

inline double most(const std::vector<double>& sorted) { return sorted.empty() ? 0 : sorted.back(); }
inline double median(const std::vector<double>& sorted) {
  return sorted.empty() ? 0 : sorted[sorted.size() / 2];
}

inline std::string to_string(const Comparison& c) {
  const auto text = [](double x) {
    char out[32];
    std::snprintf(out, sizeof out, "%.2g", x);
    return std::string(out);
  };
  const auto each = [&](int count) { return text(static_cast<double>(count) / c.states); };
  return "acceleration " + text(most(c.acceleration)) + ", median " + text(median(c.acceleration)) +
         "; next state " + text(most(c.next)) + ", median " + text(median(c.next)) +
         "; contacts per state " + each(c.contacts) + ", rows " + each(c.rows) +
         ", other contacts in " + std::to_string(c.other_contacts) + " and uncertain ones in " +
         std::to_string(c.uncertain) + " of " + std::to_string(c.states);
}

}  // namespace manyworlds::test
