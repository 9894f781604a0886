// What a Batch consists of, for the files that implement it.
#pragma once

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "src/api/batch_core.hpp"
#include "src/base/asked.hpp"
#include "src/base/enum_names.hpp"
#include "src/base/index_check.hpp"
#include "src/base/pimpl.hpp"
#include "src/dispatch/kernels.hpp"

namespace manyworlds {

[[noreturn]] inline void reject(const std::string& what) { throw std::invalid_argument(what); }

inline Isa checked_isa(const BatchOptions& options) {
  if (!options.isa) return default_isa();
  checked_enum(*options.isa);
  require_isa(*options.isa, "isa");
  return *options.isa;
}

struct Batch::Impl {
  static constexpr const char* kName = "Batch";

  std::vector<Kind> kinds;
  std::vector<int> first_world;  // of each kind, and the total
  BatchOptions options;
  std::shared_ptr<Executor> executor;
  std::unique_ptr<BatchCore> core;
  std::int64_t steps = 0;
  double dt = 0;
  double clock = 0;                        // of step_to
  std::vector<std::uint64_t> fingerprint;  // of each kind's plan
  std::vector<std::weak_ptr<BatchListener>> listeners;
  double slowest_step = 0;  // s, of all worlds, as far as it was measured

  Impl(std::vector<Kind> all, const BatchOptions& o) : kinds(std::move(all)), options(o) {
    if (kinds.empty()) reject("a batch needs at least one kind of world");
    checked_enum(options.precision);
    checked_enum(options.layout);
    if (options.threads < 0 || options.threads > kMaxThreads) {
      reject("threads is " + std::to_string(options.threads) + ", must be 0 to " +
             std::to_string(kMaxThreads));
    }
    if (options.threads != 0 && options.executor) {
      reject("threads is " + std::to_string(options.threads) + ", must be 0 with an executor");
    }
    if (options.audit_every < 0 || options.audit_every > kernels::kMaxAuditEvery) {
      reject("audit_every is " + std::to_string(options.audit_every) + ", must be 0 to " +
             std::to_string(kernels::kMaxAuditEvery));
    }
    check_observers(options.observe);
    int worlds = 0;
    constexpr int kMaxWorlds = std::numeric_limits<int>::max();
    for (const Kind& k : kinds) {
      fingerprint.push_back(k.plan.fingerprint());
      if (k.worlds < 1) reject("worlds is " + std::to_string(k.worlds) + ", must be >= 1");
      if (k.worlds > kMaxWorlds - worlds) {
        reject("worlds of all kinds are " + std::to_string(std::int64_t{worlds} + k.worlds) +
               " or more, must be at most " + std::to_string(kMaxWorlds));
      }
      if (k.plan.scene().space != kinds.front().plan.scene().space) {
        reject("kinds of one batch must be all planar or all spatial");
      }
      if (k.plan.scene().options.dt != kinds.front().plan.scene().options.dt) {
        reject("kinds of one batch must have the same dt");
      }
      check_observers(options.observe, k.plan);
      check_rays(options.observe.rays, k.plan);
      check_points(options.observe.points, k.plan);
      first_world.push_back(worlds);
      worlds += k.worlds;
    }
    first_world.push_back(worlds);
    dt = kinds.front().plan.scene().options.dt;
    executor = options.executor ? options.executor : make_executor(options.threads);
    if (executor->threads() < 1 || executor->threads() > kMaxThreads) {
      reject("the executor has " + std::to_string(executor->threads()) + " threads, must be 1 to " +
             std::to_string(kMaxThreads));
    }
    make_core_within_memory();
  }
  // Throws std::invalid_argument that says how much memory would be needed.
  void make_core_within_memory();

  // Steps, all worlds or those of a mask, with questions between them unless `go_on` is empty;
  // returns how many. What `go_on` threw is rethrown by the caller, who first counts the steps.
  int step(int n, std::span<const std::uint8_t> mask, Asked& go_on, const Visit& visit = {});
  int step_all(const Batch& batch, int n, Asked& go_on);  // counted, and reported to listeners

  // Told after the change; see batch_listen.cpp.
  void tell(const Batch& batch, Input input, int world, BodyId body = {},
            std::initializer_list<Vec3> vectors = {}) const;
  void tell(const Batch& batch, Input input, int world, JointId joint) const;
  template <class Number>
  void tell_write(const Batch& batch, Field field, std::span<const Number> in) const;
  void tell_write(const Batch& batch, Field field, int world, std::span<const double> in) const;
  void tell_spawn(const Batch& batch, int world, BodyId body, const BodyState& state) const;
  void tell_controls(const Batch& batch, int world, std::span<const double> in) const;
  void tell_step(const Batch& batch, int n) const;

  template <class Number>
  void set_controls(const Batch& batch, std::span<const Number> in);
  template <class Number>
  void read_controls(std::span<Number> out) const;
  template <class Number>
  void read_observed(Observed what, std::size_t wanted, std::span<Number> out) const;

  // Whether the scene of a kind has the keyframe; throws std::invalid_argument.
  void check_keyframe(int kind, KeyframeId keyframe) const {
    const int keyframes = static_cast<int>(plan(kind).scene().keyframes.size());
    if (keyframe && keyframe.index() < keyframes) return;
    reject("keyframe is " + std::to_string(keyframe.index()) +
           (keyframes == 0 ? ", but scene '" + plan(kind).scene().name + "' has none"
                           : ", must be 0 to " + std::to_string(keyframes - 1)));
  }
  // What the keyframe gives, into a world that was reset.
  void begin_at(int kind, int in_kind, KeyframeId keyframe);

  // Does world `from` of a snapshot fit this kind of world? Throws SnapshotError.
  void check_snapshot_world(const Snapshot& snapshot, std::size_t from, int kind) const;

  struct Place {
    int kind, world;
  };
  Place find(int world) const {
    check_index("world", world, static_cast<std::size_t>(first_world.back()));
    int kind = 0;
    while (world >= first_world[static_cast<std::size_t>(kind) + 1]) ++kind;
    return {kind, world - first_world[static_cast<std::size_t>(kind)]};
  }
  void check_kind(int kind) const { check_index("kind", kind, kinds.size()); }
  WorldsBase& worlds(int kind) const { return core->worlds(kind); }
  const Plan& plan(int kind) const { return kinds[static_cast<std::size_t>(kind)].plan; }
  struct BodyPlace {
    int kind, world;
    int row;  // of the body; -1: fixed
  };
  BodyPlace find_any_body(int world, BodyId body) const {
    const Place p = find(world);
    return {p.kind, p.world, plan(p.kind).find_row(body).value_or(-1)};
  }
  // Bodies of trees are where the coordinates of their joints put them.
  void reject_in_trees(int kind, const char* what) const {
    if (!kinds[static_cast<std::size_t>(kind)].plan.data().has_trees()) return;
    reject(std::string(what) +
           ": with the newton solver, bodies are always enabled; set generalized_position " +
           "and generalized_velocity to move them");
  }
  void check_written(Field field, int kind) const {
    if (info(field).item == ItemKind::body) reject_in_trees(kind, info(field).name);
  }
  void check_written(Field field) const {
    for (std::size_t k = 0; k < kinds.size(); ++k) check_written(field, static_cast<int>(k));
  }
  // Of one that is not fixed; `why` that would make no sense.
  BodyPlace find_body(int world, BodyId body, const char* why) const {
    const BodyPlace p = find_any_body(world, body);
    if (p.row < 0) reject(body_text(plan(p.kind).scene(), body) + " is fixed: " + why);
    return p;
  }
  Place find_joint(int world, JointId joint) const {
    const Place p = find(world);
    check_index("joint", joint.index(), plan(p.kind).scene().joints.size());
    return p;
  }
  std::size_t world_size(Field field, int kind) const { return plan(kind).numbers(field); }
  template <class What>
  void check_size(What what, std::size_t got, std::size_t wanted) const {
    if (got != wanted) {
      reject(std::string(info(what).name) + " has " + std::to_string(wanted) +
             " values, the buffer has " + std::to_string(got));
    }
  }
  std::size_t world_size(Parameter parameter, int kind) const {
    return worlds(kind).parameter_size(checked_enum(parameter));
  }
  void check_mask(std::span<const std::uint8_t> mask) const {
    if (mask.size() != static_cast<std::size_t>(first_world.back())) {
      reject("the mask has " + std::to_string(mask.size()) + " entries, the batch has " +
             std::to_string(first_world.back()) + " worlds");
    }
  }
  // visit(kind, world in kind, world)
  template <class Visit>
  void for_each_masked(std::span<const std::uint8_t> mask, Visit visit) const {
    check_mask(mask);
    for (int w = 0; w < first_world.back(); ++w) {
      if (mask[static_cast<std::size_t>(w)] == 0) continue;
      const Place p = find(w);
      visit(p.kind, p.world, w);
    }
  }
  // Of all worlds.
  template <class What>
  std::size_t size(What what) const {
    std::size_t total = 0;
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      total += world_size(what, static_cast<int>(k)) * static_cast<std::size_t>(kinds[k].worlds);
    }
    return total;
  }
  // visit(kind, world in kind, offset in the canonical array of a field or a parameter)
  template <class What, class Visit>
  void for_each_world(What what, Visit visit) const {
    std::size_t at = 0;
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const int kind = static_cast<int>(k);
      for (int w = 0; w < kinds[k].worlds; ++w) {
        visit(kind, w, at);
        at += world_size(what, kind);
      }
    }
  }
};

}  // namespace manyworlds
