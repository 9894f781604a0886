// Which worlds of a batch are lost, have diverged or overflowed, why, and the command that shows
// one again.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "manyworlds/batch.hpp"

#include "job.hpp"
#include "options.hpp"

namespace manyworlds::cli {

struct LostWorld {
  std::int64_t world = 0;  // index over the whole job
  std::uint64_t seed = 0;  // that makes it world 0 of a batch
  Status status = Status::ok;
};

class LostWorlds {
 public:
  // Looks at every world of `batch`, whose world 0 is world `first` of the job and draws from
  // `seed`.
  void collect(const Batch& batch, std::int64_t first, std::uint64_t seed);

  const std::vector<LostWorld>& lost() const { return lost_; }
  // Worlds that ran out of contact capacity; they still step.
  std::int64_t overflowed() const { return overflowed_; }
  // Status -> number of lost worlds.
  std::map<std::string, std::int64_t> by_reason() const;

 private:
  std::vector<LostWorld> lost_;
  std::int64_t overflowed_ = 0;
};

// A command that runs this world alone, with the same bits.
std::string reproduce_command(const JobOptions& options, int steps, std::uint64_t seed);

// One line for each of the first `most` lost worlds on standard error.
void print_lost(const LostWorlds& worlds, const JobOptions& options, int steps, std::size_t most);

}  // namespace manyworlds::cli
