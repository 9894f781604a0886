// Runs families: the worlds of a kind side by side in the lanes of one batch.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

#include "tools/base/interrupt.hpp"
#include "tools/invariants/states.hpp"

namespace manyworlds::invariants {
namespace {

// FNV-1a, so that families draw apart from one another.
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return h;
}
// SplitMix64: neighbouring seeds give unrelated numbers.
std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = a + (b + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

BatchOptions batch_options(const Drawn& drawn, const RunOptions& options, int worlds) {
  BatchOptions out;
  out.worlds = worlds, out.threads = 1, out.precision = options.precision, out.sleep = drawn.sleep;
  if (drawn.contacts) out.observe.what = {Observer::contacts};
  return out;
}

struct Result {
  double worst = 0;
  Status status = Status::ok;
};

// All worlds of one kind. `values` gets every value of world `traced` of the kind.
std::vector<Result> run_kind(const Family& family, const RunOptions& options, int kind,
                             int traced = -1, std::vector<double>* values = nullptr) {
  std::vector<Drawn> drawn;
  for (int i = 0; i < kWorldsPerKind; ++i) {
    drawn.push_back(draw_world(family, options, kind * kWorldsPerKind + i));
  }
  const bool twins = drawn[0].twin.has_value();
  Batch batch(compile(drawn[0].scene),
              batch_options(drawn[0], options, kWorldsPerKind * (twins ? 2 : 1)));
  std::vector<Seen> seen(kWorldsPerKind);
  std::vector<Result> results(kWorldsPerKind);
  States states;
  for (int w = 0; w < kWorldsPerKind; ++w) {
    const auto i = static_cast<std::size_t>(w);
    put_state(batch, w, drawn[i].scene);
    seen[i].precision = options.precision;
    seen[i].now = initial_states(drawn[i].scene);
    if (!twins) continue;
    put_state(batch, kWorldsPerKind + w, *drawn[i].twin);
    seen[i].twin = initial_states(*drawn[i].twin);
  }
  const double dt = drawn[0].scene.options.dt;
  for (int step = 0; step <= drawn[0].steps; ++step) {
    if (step > 0) batch.step();
    states.read(batch);
    for (int w = 0; w < kWorldsPerKind; ++w) {
      const auto i = static_cast<std::size_t>(w);
      Seen& s = seen[i];
      s.step = step, s.last = step == drawn[0].steps, s.time = step * dt;
      s.before = s.now;
      states.copy(batch, w, s.now);
      s.energy = batch.energy(w), s.hash = batch.hash(w);
      if (drawn[0].contacts && step > 0) s.contacts = batch.step_contacts(w);
      if (drawn[0].sleep) s.asleep = batch.asleep(w);
      if (twins) {
        states.copy(batch, kWorldsPerKind + w, s.twin);
        s.twin_hash = batch.hash(kWorldsPerKind + w);
      }
      if (step == 0) s.before = s.now;
      double value = drawn[i].judge(s);
      if (!std::isfinite(value)) value = std::numeric_limits<double>::infinity();
      results[i].worst = std::max(results[i].worst, value);
      if (w == traced) values->push_back(value);
    }
    if (tools::interrupted() != 0) break;
  }
  for (int w = 0; w < kWorldsPerKind; ++w) {
    results[static_cast<std::size_t>(w)].status = batch.status(w);
  }
  return results;
}

}  // namespace

Drawn draw_world(const Family& family, const RunOptions& options, int world) {
  const std::uint64_t seed = mix(options.seed, hash_of(family.id));
  const std::uint64_t kind_seed = mix(seed, static_cast<std::uint64_t>(world / kWorldsPerKind));
  Random kind(kind_seed), state(mix(kind_seed, static_cast<std::uint64_t>(world % kWorldsPerKind)));
  const Scale scale = draw_scale(kind, options.units);
  Drawn out = family.draw(kind, state, scale);
  out.scene.name = family.id;
  return out;
}

Batch batch_of(const Family& family, const RunOptions& options, int world) {
  const Drawn first = draw_world(family, options, world - world % kWorldsPerKind);
  BatchOptions alone = batch_options(first, options, 1);
  alone.observe.what = {Observer::contacts};
  Batch batch(compile(first.scene), alone);
  put_state(batch, 0, draw_world(family, options, world).scene);
  return batch;
}

std::vector<double> values_of(const Family& family, const RunOptions& options, int world) {
  std::vector<double> values;
  run_kind(family, options, world / kWorldsPerKind, world % kWorldsPerKind, &values);
  tools::stop_if_interrupted();
  return values;
}

Outcome run(const Family& family, const RunOptions& options) {
  std::vector<std::vector<Result>> results(static_cast<std::size_t>(options.kinds));
  std::atomic<int> next = 0;
  std::exception_ptr failure;  // an exception that leaves a thread would end the program
  std::mutex failing;
  {
    std::vector<std::jthread> threads;
    const int count =
        std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, options.kinds);
    for (int t = 0; t < count; ++t) {
      threads.emplace_back([&] {
        for (int i = next++; i < options.kinds && tools::interrupted() == 0; i = next++) {
          try {
            results[static_cast<std::size_t>(i)] =
                run_kind(family, options, options.first_kind + i);
          } catch (...) {
            const std::lock_guard lock(failing);
            failure = std::current_exception();
            next = options.kinds;
          }
        }
      });
    }
  }
  if (failure) std::rethrow_exception(failure);
  tools::stop_if_interrupted();
  const double limit =
      options.precision == Precision::f64 && family.limit_f64 > 0 ? family.limit_f64 : family.limit;
  Outcome out;
  int world = options.first_kind * kWorldsPerKind;
  for (const auto& kind : results) {
    for (const Result& r : kind) {
      ++out.worlds;
      if (r.worst > limit)
        ++out.broken;
      else if (lost(r.status))
        ++out.lost;
      if (r.worst > 10 * limit && r.status == Status::ok) ++out.silent;
      if (r.worst > out.worst) out.worst = r.worst, out.worst_world = world;
      ++world;
    }
  }
  return out;
}

}  // namespace manyworlds::invariants
