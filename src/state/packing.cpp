// Packing: worlds in which something moves go into as few groups as they fill, since a group costs
// the same whether one of its lanes moves or all do. A world in its lane is nothing but numbers, so
// moving it changes no bit of what it computes.
#include <algorithm>
#include <bit>

#include "src/state/worlds.hpp"

namespace manyworlds {

template <class Real>
void Worlds<Real>::move(int from, int to) {
  storage_.swap(from, to);
  auto& a = world_in_[static_cast<std::size_t>(from)];
  auto& b = world_in_[static_cast<std::size_t>(to)];
  std::swap(a, b);
  if (a >= 0) lane_index_[static_cast<std::size_t>(a)] = from;
  if (b >= 0) lane_index_[static_cast<std::size_t>(b)] = to;
}

template <class Real>
void Worlds<Real>::pack() {
  if (!tables().has_sleep) return;
  const int lanes = storage_.lanes(), groups = storage_.groups();
  const auto moving = [&](int g) { return storage_.moving_lanes(g); };
  int active = 0, movers = 0;
  for (int g = 0; g < groups; ++g) {
    active += moving(g) != 0 ? 1 : 0;
    movers += std::popcount(moving(g));
  }
  const int enough = (movers + lanes - 1) / lanes;
  if (active <= enough) return;
  // Groups with something to do, by how many of their worlds do it. A counting sort by passes: no
  // allocation, and the same order everywhere.
  int used = 0;
  for (int count = 1; count <= lanes; ++count) {
    for (int g = 0; g < groups; ++g) {
      if (std::popcount(moving(g)) == count) by_count_[static_cast<std::size_t>(used++)] = g;
    }
  }
  int emptiest = 0, fullest = used - 1;
  while (used - emptiest > enough && emptiest < fullest) {
    const int from = by_count_[static_cast<std::size_t>(emptiest)];
    const int to = by_count_[static_cast<std::size_t>(fullest)];
    const std::uint32_t leaving = moving(from);
    const std::uint32_t holes = ~moving(to) & ((1u << lanes) - 1);
    if (leaving == 0) {
      ++emptiest;
    } else if (holes == 0) {
      --fullest;
    } else {
      move(from * lanes + std::countr_zero(leaving), to * lanes + std::countr_zero(holes));
    }
  }
}

#define MW_INSTANTIATE(Real)                  \
  template void Worlds<Real>::move(int, int); \
  template void Worlds<Real>::pack();
MW_INSTANTIATE(float)
MW_INSTANTIATE(double)
#undef MW_INSTANTIATE

}  // namespace manyworlds
