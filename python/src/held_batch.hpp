// A Batch as a Python object holds it.
#pragma once

#include <string>
#include <vector>

#include "held.hpp"
#include "manyworlds/batch.hpp"

namespace manyworlds::python {

// The worlds of one kind lie one after the other.
struct KindRange {
  int kind, first, worlds;
};

class HeldBatch : public Held<Batch> {
 public:
  HeldBatch(const std::vector<Batch::Kind>& kinds, const BatchOptions& options)
      : Held(std::make_shared<Batch>(kinds, options), "Batch") {
    int first = 0;
    for (const Batch::Kind& kind : kinds) {
      ranges_.push_back({static_cast<int>(ranges_.size()), first, kind.worlds});
      first += kind.worlds;
    }
  }
  // That of another object, of one kind, with which it is used alternately.
  HeldBatch(std::shared_ptr<Batch> batch, Busy busy)
      : Held(std::move(batch), "Batch", std::move(busy)), ranges_{{0, 0, share()->worlds()}} {}

  int kinds() const { return static_cast<int>(ranges_.size()); }
  const KindRange& range(int kind) const {
    if (kind < 0 || kind >= kinds()) {
      throw nanobind::index_error(
          ("kind is " + std::to_string(kind) + ", must be 0 to " + std::to_string(kinds() - 1))
              .c_str());
    }
    return ranges_[static_cast<std::size_t>(kind)];
  }
  // The batch's index of a world of a kind.
  int world_of(const KindRange& range, int world) const {
    if (world < 0 || world >= range.worlds) {
      throw std::invalid_argument("world is " + std::to_string(world) + ", must be 0 to " +
                                  std::to_string(range.worlds - 1));
    }
    return range.first + world;
  }

 private:
  std::vector<KindRange> ranges_;
};

}  // namespace manyworlds::python
