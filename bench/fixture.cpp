#include "bench/fixture.hpp"

#include <cstring>
#include <map>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "src/base/float_mode.hpp"
#include "src/base/hash.hpp"
#include "src/dispatch/kernels.hpp"

namespace manyworlds::bench {

const char* to_string(Stage stage) {
  static constexpr const char* kNames[] = {"free_motion", "begin",   "broad_phase", "choose_layout",
                                           "enter",       "collide", "warm_start",  "bias",
                                           "advance",     "relax",   "next",        "restitute",
                                           "store",       "leave"};
  return kNames[static_cast<int>(stage)];
}

const char* to_string(kernels::Layout layout) {
  static constexpr const char* kNames[] = {"automatic", "dense", "rows"};
  return kNames[static_cast<int>(layout)];
}

std::vector<Stage> stages_of_step(const Tables& tables) {
  if (!tables.has_contacts) return {Stage::free_motion};
  std::vector<Stage> out = {Stage::begin, Stage::broad_phase, Stage::choose_layout,
                            Stage::enter, Stage::collide,     Stage::warm_start};
  for (int s = 0; s < tables.substeps; ++s) {
    if (s > 0) out.push_back(Stage::next);
    out.insert(out.end(), {Stage::bias, Stage::advance, Stage::relax});
  }
  if (tables.has_restitution) out.push_back(Stage::restitute);
  out.insert(out.end(), {Stage::store, Stage::leave});
  return out;
}

void StageRunner::run(Stage stage, const Group& group) {
  const auto inertia = static_cast<int>(tables_.inertia_kind);
  const auto& solver = kernels_.solver[inertia][layout_ == kernels::Layout::dense ? 0 : 1];
  switch (stage) {
    case Stage::free_motion: return kernels_.free_motion[inertia](tables_, group, scratch_, 1);
    case Stage::begin: return kernels_.begin(tables_, group, scratch_);
    case Stage::broad_phase: return kernels_.broad_phase(tables_, group, scratch_);
    case Stage::choose_layout:
      layout_ = kernels_.choose_layout(tables_, group, scratch_, wish_);
      return;
    case Stage::enter: return solver.enter(tables_, group, scratch_);
    case Stage::collide:
      for (int c = 0; c < tables_.classes; ++c) {
        kernels_.set_class(scratch_, c);
        const int kind = static_cast<int>(tables_.pair_class[c].kind);
        kernels_.collide[static_cast<int>(tables_.dimension)][kind](tables_, group, scratch_);
      }
      return;
    case Stage::warm_start:
      solver.apply_delta_v(tables_, group, scratch_);
      solver.warm_start(tables_, group, scratch_);
      return solver.open(tables_, group, scratch_);
    case Stage::bias: return solver.bias(tables_, group, scratch_);
    case Stage::advance: return solver.advance(tables_, group, scratch_);
    case Stage::relax: return solver.relax(tables_, group, scratch_);
    case Stage::next: return solver.next(tables_, group, scratch_);
    case Stage::restitute: return solver.restitute(tables_, group, scratch_);
    case Stage::store: return solver.store(tables_, group, scratch_);
    case Stage::leave: return solver.leave(tables_, group, scratch_);
  }
}

void StageRunner::run_before(Stage stage, const Group& group) {
  for (const Stage s : stages_of_step(tables_)) {
    if (s == stage) return;
    run(s, group);
  }
}

TypicalWorlds::TypicalWorlds(const Plan& plan, const Kernels& kernels, int steps)
    : kernels_(kernels),
      worlds_(plan, kWorlds, 0, BatchOptions{}, kernels.lanes),
      stages_(worlds_.data(), worlds_.tables(), kernels),
      scratch_memory_(kernels.scratch_bytes(worlds_.tables())),
      scratch_(kernels.make_scratch(worlds_.tables(), scratch_memory_.data())) {
  const FloatMode mode(FloatMode::flush);
  const Tables& t = tables();
  const int lanes = kernels.lanes;
  for (int g = 0; g < groups(); ++g) {
    step(g, steps, kernels::Layout::automatic);
    const Group view = group(g);
    auto& saved = saved_.emplace_back();
    save(saved, view.state, t.state_size * lanes);
    save(saved, view.status, lanes);
    for (int l = 0; l < kernels::kLists; ++l) {
      if (!view.cache[l].keys) continue;
      const int row = kernels::cache_row_size(t, static_cast<kernels::ListId>(l));
      save(saved, view.cache[l].rows, lanes * (t.capacity[l] + kernels::kFirstRow) * row);
      save(saved, view.cache[l].keys, lanes * (t.capacity[l] + 1));
    }
    step(g, 1, kernels::Layout::automatic);
  }
  for (int w = 0; w < kWorlds; ++w) {
    if (frozen(worlds_.status(w))) {
      throw std::runtime_error("world " + std::to_string(w) + " is " +
                               manyworlds::to_string(worlds_.status(w)));
    }
  }
  hash_ = current_hash();
}

template <class T>
void TypicalWorlds::save(std::vector<Saved>& to, T* live, int count) {
  auto* bytes = reinterpret_cast<unsigned char*>(live);
  to.push_back({bytes, {bytes, bytes + static_cast<std::size_t>(count) * sizeof(T)}});
}

void TypicalWorlds::restore(int group) {
  for (const Saved& s : saved_[static_cast<std::size_t>(group)]) {
    std::memcpy(s.live, s.bytes.data(), s.bytes.size());
  }
}

void TypicalWorlds::step(int index, int steps, kernels::Layout layout) const {
  step_group<float>({kernels_, tables(), stages_, layout}, group(index), scratch_, steps, nullptr);
}

std::uint64_t TypicalWorlds::current_hash() const {
  Hasher hasher;
  for (int w = 0; w < kWorlds; ++w) hasher.add(worlds_.hash(w));
  return hasher.value();
}

std::string TypicalWorlds::check(kernels::Layout layout) {
  const FloatMode mode(FloatMode::flush);
  StageRunner runner(kernels_, tables(), scratch_, layout);
  for (int g = 0; g < groups(); ++g) {
    restore(g);
    for (const Stage stage : stages_of_step(tables())) runner.run(stage, group(g));
  }
  for (int w = 0; w < kWorlds; ++w) {
    if (frozen(worlds_.status(w))) return "world " + std::to_string(w) + " froze";
  }
  return current_hash() == hash_ ? "" : "the stages gave other bits than the whole step";
}

std::vector<Isa> benched_isas() {
  std::vector<Isa> isas = available_isas();
  std::erase_if(isas, [](Isa isa) { return find_kernels<float>(isa) == nullptr; });
  return isas;
}

TypicalWorlds& typical_worlds(const Scenario& scenario, Isa isa, BroadPhase broad_phase) {
  using Key = std::tuple<std::string, Isa, BroadPhase>;
  static std::map<Key, std::unique_ptr<TypicalWorlds>> made;
  auto& worlds = made[Key(scenario.name, isa, broad_phase)];
  if (!worlds) {
    const Plan plan = compile(scenario.make(), {.broad_phase = broad_phase});
    worlds = std::make_unique<TypicalWorlds>(plan, *find_kernels<float>(isa), scenario.steps);
  }
  return *worlds;
}

}  // namespace manyworlds::bench
