#include "tools/invariants/similarity.hpp"

namespace manyworlds::invariants {
namespace {

BatchOptions options_of(Precision precision, int worlds) {
  BatchOptions options;
  options.worlds = worlds, options.threads = 1, options.precision = precision;
  return options;
}

}  // namespace

SideWorlds::SideWorlds(const Scene& plan, Precision precision, int worlds)
    : batch_(compile(plan), options_of(precision, worlds)),
      now_(static_cast<std::size_t>(worlds), initial_states(plan)) {
  read();
}

void SideWorlds::put(int world, const Scene& initial) {
  put_state(batch_, world, initial);
  read();
}

void SideWorlds::step(int steps) {
  batch_.step(steps);
  read();
}

void SideWorlds::read() {
  states_.read(batch_);
  for (int w = 0; w < batch_.worlds(); ++w) {
    states_.copy(batch_, w, now_[static_cast<std::size_t>(w)]);
  }
}

}  // namespace manyworlds::invariants
