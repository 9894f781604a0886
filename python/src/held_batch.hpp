// A Batch as a Python object holds it.
#pragma once

#include "held.hpp"
#include "manyworlds/batch.hpp"

namespace manyworlds::python {

class HeldBatch : public Held<Batch> {
 public:
  HeldBatch(Plan plan, const BatchOptions& options)
      : Held(std::make_shared<Batch>(std::move(plan), options), "Batch") {}
  // That of another object, with which it is used in turns.
  HeldBatch(std::shared_ptr<Batch> batch, Busy busy)
      : Held(std::move(batch), "Batch", std::move(busy)) {}
};

}  // namespace manyworlds::python
