// The law of bits for trees: a lane's numbers depend neither on which lane it is, nor on what is in
// the lanes beside it, nor on the instruction set.
#pragma once

#include <cstring>

#include <catch2/catch.hpp>

#include "tests/support/random_trees.hpp"
#include "tests/support/tree_group.hpp"

namespace manyworlds::test {

// The same 16 states in every instruction set, each in some lane with others beside it.
template <class Real>
void check_bits(const std::vector<TwinLink>& links, const std::vector<TreeState>& states,
                int steps) {
  const int count = static_cast<int>(states.size());
  std::vector<TreeTwin::Numbers> first(states.size());
  for_each_isa<Real>([&](const kernels::Kernels<Real>& k) {
    for (int i = 0; i < count; ++i) {
      INFO(k.isa << ", state " << i);
      TreeGroup<Real> group(k, links, {0, 0, -9.81}, 0.002);
      const int lane = i % group.lanes();
      for (int l = 0; l < group.lanes(); ++l) {
        const TreeState& s = states[static_cast<std::size_t>((i + l - lane + count) % count)];
        group.set(l, s.q, s.v);
      }
      group.step(steps);
      const auto q = group.position(lane), v = group.velocity(lane), a = group.acceleration(lane);
      TreeTwin::Numbers end(q.size() + v.size() + a.size());
      end << q, v, a;
      TreeTwin::Numbers& expected = first[static_cast<std::size_t>(i)];
      if (expected.size() == 0) expected = end;
      CHECK(std::memcmp(expected.data(), end.data(),
                        static_cast<std::size_t>(end.size()) * sizeof(double)) == 0);
    }
  });
}

}  // namespace manyworlds::test
