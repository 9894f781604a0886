// Worlds with numbers of their own have the bits of scenes that have these numbers, and the same
// ones whatever is around them.
#pragma once

#include <catch2/catch.hpp>

#include <string>

#include "tests/support/hashes.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/varied.hpp"

namespace manyworlds::test {

// World by world in every table, after `steps`. inspect(batch, world, alone): what else is the
// same.
template <class SceneOf, class Inspect>
void check_worlds_are_those_of_scenes(Scene scene, const std::string& what, int worlds, int steps,
                                      SceneOf scene_of, Inspect inspect) {
  // A lone world's plan would choose by its own numbers.
  scene.options = compile(scene).resolved();
  for (const Table& table : all_tables()) {
    BatchOptions options = options_of(table, worlds);
    options.seed = 5;
    Batch batch(compile(scene), options);
    std::vector<Batch> alone = each_alone(batch, table, options.seed, scene_of);
    batch.step(steps);
    for (int w = 0; w < batch.worlds(); ++w) {
      Batch& one = alone[static_cast<std::size_t>(w)];
      one.step(steps);
      INFO(name(table) << " world " << w << " " << what);
      CHECK(state(batch, w) == state(one, 0));
      inspect(batch, w, one);
    }
  }
}
inline void check_worlds_are_those_of_scenes(const Scene& scene, const std::string& what,
                                             int worlds, int steps) {
  check_worlds_are_those_of_scenes(scene, what, worlds, steps, built_with,
                                   [](const Batch&, int, const Batch&) {});
}

// In batches of other sizes, on other threads and instruction sets, and where a world takes the
// place of another with its numbers, of which `looked_at` is one.
inline void check_bits_of_varied_worlds(const Scene& scene, Parameter looked_at) {
  for (const Precision precision : {Precision::f32, Precision::f64}) {
    std::vector<std::uint64_t> expected;
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      for (const int threads : {1, 3}) {
        Batch batch(compile(scene), options_of(table, 21, threads));
        batch.step(25);
        batch.restore(batch.save(), 4, 5);
        batch.step(5);
        const auto worlds = hashes(batch);
        CHECK(worlds[4] == worlds[5]);
        CHECK(numbers(batch, looked_at, 4) == numbers(batch, looked_at, 5));
        if (expected.empty()) expected = worlds;
        CHECK(worlds == expected);
      }
      Batch fewer(compile(scene), options_of(table, 3));
      fewer.step(30);
      for (std::size_t w = 0; w < 3; ++w) CHECK(hashes(fewer)[w] == expected[w]);
    }
  }
}

}  // namespace manyworlds::test
