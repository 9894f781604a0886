// Which bodies and joints of a page's worlds are there, sample by sample.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "manyworlds/record.hpp"
#include "src/page/frames.hpp"

namespace manyworlds::record {

class Presence {
 public:
  // Of a kind the first so many worlds.
  struct Kind {
    const Plan* plan;
    int first_world;
    std::size_t worlds;
  };
  explicit Presence(std::vector<Kind> kinds) : kinds_(std::move(kinds)) {}

  // It is in no field of a recording: where some come and go, or break, the recording is simulated
  // again by `batch`, which is at its start. False: go_on returned false.
  bool find(const Recording& recording, Batch& batch, std::int64_t every, std::size_t samples,
            const GoOn& go_on);

  bool any_body_gone() const { return !bodies_.empty(); }
  bool any_joint_gone() const { return !joints_.empty(); }
  // Of a kind, samples from `first` on: [world][row] and [world][joint], where any is gone.
  void write_bodies(std::size_t kind, std::size_t first, std::size_t count,
                    page::ChunkWriter& chunk) const;
  void write_joints(std::size_t kind, std::size_t first, std::size_t count,
                    page::ChunkWriter& chunk) const;

 private:
  using Flags = std::vector<bool>;  // [sample][kind][world][item]; empty: all are there

  static std::size_t rows_of(const Kind& kind);
  static std::size_t joints_of(const Kind& kind);
  Flags bodies_in(const Batch& batch) const;
  Flags joints_in(const Batch& batch) const;
  void write(const Flags& flags, std::size_t (*items)(const Kind&), std::size_t kind,
             std::size_t first, std::size_t count, page::ChunkWriter& chunk) const;

  std::vector<Kind> kinds_;
  Flags bodies_, joints_;
};

}  // namespace manyworlds::record
