#include "tools/compare/speed.hpp"

#include <mujoco/mjbatch.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "tools/base/median.hpp"

namespace manyworlds::compare {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kHeld = 5;     // steps between new controls
constexpr int kRunIn = 500;  // steps before the clock starts

// What both sides start from, and the controls that follow, drawn before the clock starts.
struct Inputs {
  std::vector<double> q;               // [world][coordinate]
  std::vector<double> v;               // [world][dof]
  std::vector<std::vector<double>> u;  // [block of steps][world][control]
};

void set_controls(Batch& batch, const std::vector<double>& u) {
  if (!u.empty()) batch.set_controls(std::span<const double>(u));
}

std::vector<double> read_all(const Batch& batch, Field field) {
  std::vector<double> out(batch.size(field));
  batch.read(field, out);
  return out;
}

Inputs draw_inputs(const Pair& pair, Batch& batch, int steps) {
  const mjModel& m = pair.mujoco();
  Random random(pair.settings().seed, 2);
  const auto worlds = static_cast<std::size_t>(batch.worlds());
  std::vector<int> phases(worlds);
  for (int& phase : phases) phase = random.integer(0, kRunIn / kHeld - 1);
  std::vector<std::uint8_t> back(worlds);
  std::vector<double> u(worlds * static_cast<std::size_t>(m.nu));
  const auto draw = [&] {
    for (std::size_t w = 0; w < worlds; ++w) {
      draw_controls(m, random, u.data() + w * static_cast<std::size_t>(m.nu));
    }
  };
  for (int block = 0; block < kRunIn / kHeld; ++block) {
    pair.pause();
    std::transform(phases.begin(), phases.end(), back.begin(),
                   [&](int phase) { return std::uint8_t{phase == block}; });
    batch.reset(back);
    draw();
    set_controls(batch, u);
    batch.step(kHeld);
  }
  Inputs inputs;
  inputs.q = read_all(batch, Field::generalized_position);
  inputs.v = read_all(batch, Field::generalized_velocity);
  for (int s = 0; s < steps; s += kHeld) draw(), inputs.u.push_back(u);
  return inputs;
}

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void run_ours(const Pair& pair, Batch& batch, const Inputs& inputs, Speed& speed) {
  batch.reset();
  batch.write(Field::generalized_position, std::span<const double>(inputs.q));
  batch.write(Field::generalized_velocity, std::span<const double>(inputs.v));
  const Clock::time_point start = Clock::now();
  for (int s = 0; s < speed.steps; s += kHeld) {
    pair.pause();
    set_controls(batch, inputs.u[static_cast<std::size_t>(s / kHeld)]);
    batch.step(std::min(kHeld, speed.steps - s));
  }
  speed.ours.push_back(speed.worlds * speed.steps / since(start));
  const std::uint64_t hash = batch.hash();
  speed.same_hash &= speed.ours.size() == 1 || hash == speed.hash;
  speed.hash = hash;
  speed.contacts = 0;
  for (int w = 0; w < speed.mujoco_worlds; ++w) {
    speed.contacts += static_cast<double>(batch.contacts(w).size()) / speed.mujoco_worlds;
  }
}

void run_mujoco(const Pair& pair, mjData& d, const Inputs& inputs, Speed& speed) {
  const mjcf::LogCapture log;
  const mjModel& m = pair.mujoco();
  speed.mujoco_contacts = 0;
  double seconds = 0;
  for (int w = 0; w < speed.mujoco_worlds; ++w) {
    pair.pause();
    mj_resetData(&m, &d);
    std::copy_n(inputs.q.begin() + static_cast<std::ptrdiff_t>(w) * m.nq, m.nq, d.qpos);
    std::copy_n(inputs.v.begin() + static_cast<std::ptrdiff_t>(w) * m.nv, m.nv, d.qvel);
    const Clock::time_point start = Clock::now();
    for (int s = 0; s < speed.steps; ++s) {
      if (s % kHeld == 0) {
        std::copy_n(inputs.u[static_cast<std::size_t>(s / kHeld)].begin() +
                        static_cast<std::ptrdiff_t>(w) * m.nu,
                    m.nu, d.ctrl);
      }
      mj_step(&m, &d);
    }
    seconds += since(start);
    mj_forward(&m, &d);
    for (int c = 0; c < d.ncon; ++c) {
      speed.mujoco_contacts += d.contact[c].exclude == 0 ? 1.0 / speed.mujoco_worlds : 0;
    }
  }
  speed.mujoco.push_back(speed.mujoco_worlds * speed.steps / seconds);
}

struct DeleteBatch {
  void operator()(mjBatch* batch) const { mjb_deleteBatch(batch); }
};
using MujocoBatch = std::unique_ptr<mjBatch, DeleteBatch>;

MujocoBatch make_mujoco_batch(const mjModel& m, int worlds, bool persistent) {
  mjBatchConfig config;
  mjb_defaultConfig(&config);
  config.nthread = 1, config.persistent = persistent;
  char error[500] = "";
  MujocoBatch batch(mjb_makeBatch(&m, worlds, &config, error, sizeof error));
  if (!batch) throw mjcf::MujocoFailure(std::string("MuJoCo could not make a batch: ") + error);
  return batch;
}

double run_mujoco_batch(const Pair& pair, mjBatch& batch, const Inputs& inputs,
                        const Speed& speed) {
  const mjcf::LogCapture log;
  mjb_reset(&batch, nullptr, 0, nullptr, mjSTAGE_NONE);
  // A row of each world's state has this component at the same place.
  const auto put = [&](int component, const std::vector<double>& from) {
    int size = 0;
    mjtNum* to = mjb_stateComponent(&batch, component, &size);
    for (int w = 0; w < speed.mujoco_worlds; ++w) {
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(w) * size, size,
                  to + static_cast<std::ptrdiff_t>(w) * mjb_nstate(&batch));
    }
  };
  put(mjSTATE_QPOS, inputs.q);
  put(mjSTATE_QVEL, inputs.v);
  const Clock::time_point start = Clock::now();
  for (int s = 0; s < speed.steps; s += kHeld) {
    pair.pause();
    put(mjSTATE_CTRL, inputs.u[static_cast<std::size_t>(s / kHeld)]);
    mjb_step(&batch, nullptr, 0, std::min(kHeld, speed.steps - s), mjSTAGE_NONE);
  }
  return speed.mujoco_worlds * speed.steps / since(start);
}

}  // namespace

Speed compare_speed(Pair& pair, const Kernels& kernels, const Effort& effort, int worlds,
                    int mujoco_worlds, int steps, int rounds) {
  Speed speed;
  speed.kernels = kernels, speed.worlds = worlds, speed.steps = steps, speed.rounds = rounds;
  speed.mujoco_worlds = std::min(mujoco_worlds, worlds);
  speed.effort = effort;
  const Effort kept = pair.effort();
  pair.set_effort(effort);
  Batch batch(compile(pair.scene(kernels.precision)), options_of(kernels, worlds));
  const mjcf::DataPtr data = pair.make_data();
  // With an mjData for each world, and with one for all: which is faster depends on the model.
  MujocoBatch batches[2];
  for (const bool persistent : {false, true}) {
    batches[persistent] = make_mujoco_batch(pair.mujoco(), speed.mujoco_worlds, persistent);
  }
  std::vector<double> by_batch[2];
  const Inputs inputs = draw_inputs(pair, batch, steps);
  for (int round = 0; round < rounds; ++round) {
    run_ours(pair, batch, inputs, speed);
    run_mujoco(pair, *data, inputs, speed);
    for (int i = 0; i < 2; ++i) {
      by_batch[i].push_back(run_mujoco_batch(pair, *batches[i], inputs, speed));
    }
  }
  speed.mujoco_batch = *std::max_element(by_batch, by_batch + 2, [](const auto& a, const auto& b) {
    return tools::median(a) < tools::median(b);
  });
  pair.set_effort(kept);
  return speed;
}

}  // namespace manyworlds::compare
