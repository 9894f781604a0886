// `manyworlds verify`: that a world's bits depend on nothing but its plan, its initial state and
// its inputs, shown on the machine at hand. Every comparison is of one world's hash and status with
// those that the same world has in a reference batch.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "commands.hpp"
#include "job.hpp"
#include "progress.hpp"
#include "tools/base/interrupt.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"
#include "verify_output.hpp"

namespace manyworlds::cli {
namespace {

using tools::counted, tools::hex;

struct Outcome {
  std::uint64_t hash = 0;
  Status status = Status::ok;
  bool operator==(const Outcome&) const = default;
};
std::string text_of(const Outcome& o) {
  return fmt::format("hash {}, status {}", hex(o.hash), to_string(o.status));
}

std::vector<std::string> chosen_scenes(const VerifyOptions& options) {
  if (!options.scenes.empty()) return options.scenes;
  if (options.quick) return {"bin-spheres", "bin-boxes", "bin2d", "ant"};
  return {"bin-spheres", "bin-boxes",   "bin2d",   "mixed-pile", "mixed-pile2d",
          "ball3d",      "free-flight", "chain2d", "chain3d",    "pendulum",
          "hopper",      "cheetah",     "ant",     "humanoid"};
}

// A body that forces act on, or none.
BodyId first_dynamic_body(const Plan& plan) {
  for (int row = 0; row < plan.bodies(); ++row) {
    const BodyId body = plan.body_in_row(row);
    if (plan.scene().at(body).motion == Motion::dynamic) return body;
  }
  return {};
}

// All comparisons of one scene in one precision.
class Verifier {
 public:
  Verifier(const std::string& scene, Precision precision, const VerifyOptions& options)
      : seed_(options.seed), quick_(options.quick) {
    job_options_.scene = scene;
    job_options_.precision = precision;
    job_options_.audit_every = 1;
    job_options_.steps = quick_ ? 90 : 150;  // balls of the scenes touch ground after about 60
    Batch batch = batch_of(job_options_, kWorlds, 0, 1);
    is_robot_ = RandomControls::suit(batch.plan());
    steps(batch, 0, job_options_.steps);
    for (int world = 0; world < kWorlds; ++world) {
      reference_.push_back({batch.hash(world), batch.status(world)});
    }
    hash_ = batch.hash();
  }

  void compare_all() {
    for (const Isa isa : available_isas()) {
      JobOptions with_isa = job_options_;
      with_isa.isa = isa;
      if (!supports(with_isa)) continue;
      for (int world = 0; world < kWorlds; ++world) run(kAlone, with_isa, 1, world, 1);
      for (const int shift : {1, 3, 7}) run(kPosition, with_isa, kWorlds - shift, shift, 1);
      for (const int threads : {1, 2, 3, 4}) run(kThreads, with_isa, kWorlds, 0, threads);
      for (const int n : {7, with_isa.steps}) run(kCalls, with_isa, kWorlds, 0, 1, n);
      if (!is_robot_) compare_kernels(with_isa);
      compare_masks(with_isa);
      compare_saved(with_isa);
      compare_beside_frozen(with_isa);
    }
    for (int size = 1; size <= kWorlds; size += quick_ ? 3 : 1)
      run(kSize, job_options_, size, 0, 1);
    compare_reset();
    if (!is_robot_) find_diverged();  // robots are not audited
  }

  std::uint64_t hash() const { return hash_; }
  const Tally& tally() const { return tally_; }

 private:
  Batch batch_of(const JobOptions& options, int worlds, int first, int threads) const {
    const std::uint64_t seed = seed_ + static_cast<std::uint64_t>(first);
    return make_batch(prepare(options), options, worlds, seed, threads);
  }

  // Robots move by random controls, so that limits and contacts act.
  void steps(Batch& batch, int first, int count, int steps_per_call = 1) const {
    timed_steps(batch, count, steps_per_call, nullptr, controls_of(batch, first));
    tools::stop_if_interrupted();  // a batch that took fewer steps must not be compared
  }
  RandomControls controls_of(const Batch& batch, int first) const {
    if (!is_robot_) return {};
    return {batch, seed_ + static_cast<std::uint64_t>(first)};
  }

  // A build need not have every kernel in float64 on every instruction set.
  bool supports(const JobOptions& options) const {
    try {
      return batch_of(options, 1, 0, 1).isa() == *options.isa;
    } catch (const std::invalid_argument&) {
      if (options.precision == Precision::f32) throw;
      return false;
    }
  }

  // Steps worlds first .. first + worlds - 1 of the reference in a batch of their own.
  void run(Column column, const JobOptions& options, int worlds, int first, int threads,
           int steps_per_call = 1) {
    Batch batch = batch_of(options, worlds, first, threads);
    steps(batch, first, options.steps, steps_per_call);
    compare(column, batch, options, first, -1);
  }

  void compare_kernels(JobOptions options) {
    for (const auto layout :
         {ContactLayout::automatic, ContactLayout::dense, ContactLayout::rows}) {
      for (const auto broad_phase :
           {BroadPhase::all_pairs, BroadPhase::sort_and_sweep, BroadPhase::sparse}) {
        options.layout = layout;
        options.broad_phase = broad_phase;
        run(kKernels, options, kWorlds, 0, 1);
      }
    }
  }

  // A third of the worlds takes some steps, then the others take theirs.
  void compare_masks(const JobOptions& options) {
    Batch batch = batch_of(options, kWorlds, 0, 2);
    RandomControls controls = controls_of(batch, 0);
    std::vector<std::uint8_t> some(kWorlds), others(kWorlds);
    for (std::size_t world = 0; world < kWorlds; ++world) {
      some[world] = world % 3 == 0;
      others[world] = world % 3 != 0;
    }
    for (int step = 0; step < options.steps; step += RandomControls::kPeriod) {
      const int count = std::min(RandomControls::kPeriod, options.steps - step);
      controls.apply(batch, step);
      tools::stop_if_interrupted();
      batch.step(some, count);
      batch.step(others, count);
    }
    compare(kMasks, batch, options, 0, -1);
  }

  // The reference half way, in a batch of other seeds and threads.
  void compare_saved(const JobOptions& options) {
    const int half = options.steps / 2;
    Batch first_half = batch_of(job_options_, kWorlds, 0, 1);
    steps(first_half, 0, half);
    Batch batch = batch_of(options, kWorlds, 2 * kWorlds, 2);
    batch.restore(Snapshot::from_bytes(first_half.save().bytes()));
    steps(batch, 0, options.steps - half);
    compare(kSaved, batch, options, 0, -1);
  }

  // One world gets a force that is not a number, half way: it must freeze, the others must not
  // notice.
  void compare_beside_frozen(const JobOptions& options) {
    constexpr int kVictim = 5;
    Batch batch = batch_of(options, kWorlds, 0, 1);
    const BodyId body = first_dynamic_body(batch.plan());
    if (!body) return;
    const int half = options.steps / 2;
    steps(batch, 0, half);
    batch.add_force(kVictim, body, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    steps(batch, 0, options.steps - half);
    compare(kFrozen, batch, options, 0, kVictim);
    ++tally_.compared[kFrozen];
    if (frozen(batch.status(kVictim))) return;
    note(kFrozen, fmt::format("{}: a NaN force did not freeze world {} (status {})",
                              describe(batch, options), kVictim, to_string(batch.status(kVictim))));
  }

  void compare_reset() {
    Batch batch = batch_of(job_options_, kWorlds, 0, 1);
    steps(batch, 0, job_options_.steps / 3);
    batch.reset();
    steps(batch, 0, job_options_.steps);
    compare(kReset, batch, job_options_, 0, -1);
  }

  // Worlds of the reference that gained energy from nothing.
  void find_diverged() {
    for (std::size_t world = 0; world < reference_.size(); ++world) {
      ++tally_.compared[kEnergy];
      const Status status = reference_[world].status;
      if (!has(status, Status::diverged)) continue;
      note(kEnergy,
           fmt::format("world {} (seed {}) is {}", world, seed_ + world, to_string(status)));
    }
  }

  void compare(Column column, const Batch& batch, const JobOptions& options, int first, int skip) {
    for (int world = 0; world < batch.worlds(); ++world) {
      if (world == skip) continue;
      ++tally_.compared[column];
      const Outcome expected = reference_[static_cast<std::size_t>(first + world)];
      const Outcome found{batch.hash(world), batch.status(world)};
      if (found == expected) continue;
      note(column,
           fmt::format("{}: world {} (seed {}) has {}, the reference {}", describe(batch, options),
                       world, seed_ + static_cast<std::uint64_t>(first + world), text_of(found),
                       text_of(expected)));
    }
  }

  std::string describe(const Batch& batch, const JobOptions& options) const {
    return fmt::format("{}, {}, {}, layout {}, broad phase {}", batch.kernel_table(),
                       counted(batch.worlds(), "world"), counted(batch.threads(), "thread"),
                       option_name(options.layout), option_name(options.broad_phase));
  }

  void note(Column column, const std::string& difference) {
    if (tally_.different[column]++ > 0) return;
    tally_.differences.push_back(
        fmt::format("{}: {}: {}", job_options_.scene, kNames[column], difference));
  }

  JobOptions job_options_;
  std::uint64_t seed_;
  bool quick_;
  bool is_robot_ = false;
  std::vector<Outcome> reference_;  // [world]
  std::uint64_t hash_ = 0;          // of all of them
  Tally tally_;
};

}  // namespace

int verify_command(const VerifyOptions& options) {
  const std::vector<std::string> names = chosen_scenes(options);
  for (const std::string& name : names) {
    JobOptions probe;
    probe.scene = name;
    prepare(probe);  // every name is checked before the first line
  }
  if (!options.json) print_head(options);

  Progress progress("verify", 2 * static_cast<std::int64_t>(names.size()));
  const tools::Interruptible interruptible;
  VerifyTotals totals;
  for (const std::string& name : names) {
    for (const Precision precision : {Precision::f32, Precision::f64}) {
      if (tools::interrupted() != 0) break;
      progress.set_label(fmt::format("verify {} {}", name, to_string(precision)));
      std::optional<Verifier> verifier;
      try {
        verifier.emplace(name, precision, options);
        verifier->compare_all();
        progress.erase();
        totals.rows.push_back({name, precision, verifier->tally(), verifier->hash()});
        if (!options.json) print_row(totals.rows.back());
        progress.advance(1);
      } catch (const tools::Interrupted&) {  // comparisons made until then count
      }
      if (verifier) totals.add(verifier->tally());
    }
  }
  progress.erase();
  totals.whole = totals.rows.size() == 2 * names.size();
  if (options.json) {
    print_json(options, totals);
  } else {
    print_sum(totals);
  }
  if (!totals.whole) {
    tools::tell("manyworlds: interrupted by {} after {} of {}\n", tools::interrupt_name(),
                totals.rows.size(), counted(static_cast<long long>(2 * names.size()), "row"));
    return tools::interrupt_code();
  }
  return totals.different == 0 ? kOk : kWorldLost;
}

}  // namespace manyworlds::cli
