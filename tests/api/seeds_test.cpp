// Seeds of worlds, and what resets draw from them.
#include <catch2/catch.hpp>

#include <cstdint>
#include <vector>

#include "tests/support/crowd.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

TEST_CASE("a reset with the seeds that worlds have repeats their first episode", "[fast][batch]") {
  const Plan plan = compile(crowd(Space::spatial));
  BatchOptions options = options_of(widest_tables().front(), 5);
  options.seed = 7;
  Batch batch(plan, options);
  std::vector<std::uint64_t> first, seeds;
  const auto hashes = [&batch] {
    std::vector<std::uint64_t> out;
    for (int w = 0; w < 5; ++w) out.push_back(batch.hash(w));
    return out;
  };
  first = hashes();
  const std::vector<std::uint8_t> all(5, 1), one = {0, 1, 0, 0, 0};
  for (int w = 0; w < 5; ++w) seeds.push_back(batch.seed_of(w));
  CHECK(seeds == std::vector<std::uint64_t>{7, 8, 9, 10, 11});
  batch.reset(all);
  const std::vector<std::uint64_t> second = hashes();
  for (std::size_t w = 0; w < 5; ++w) CHECK(second[w] != first[w]);
  batch.reset(all, seeds);
  CHECK(hashes() == first);
  batch.reset(all);
  CHECK(hashes() == second);
  seeds[1] = 100;
  batch.reset(one, seeds);
  CHECK(batch.seed_of(1) == 100);
  CHECK(batch.seed_of(2) == 9);
  const std::uint64_t of_100 = batch.hash(1);
  batch.reset();
  CHECK(batch.hash(1) == of_100);
  CHECK(batch.hash(2) == first[2]);
  CHECK_THROWS_AS(batch.seed_of(5), std::invalid_argument);
}

}  // namespace manyworlds::test
