// A Batch as a Python object holds it: it can be closed, it refuses to be used by two threads at a
// time (a Batch is not thread safe, and long calls let go of the GIL), and its memory outlives it
// for as long as arrays look into it.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <utility>

#include "manyworlds/batch.hpp"

namespace manyworlds::python {

class HeldBatch {
 public:
  HeldBatch(Plan plan, const BatchOptions& options)
      : batch_(std::make_shared<Batch>(std::move(plan), options)) {}

  // f(Batch&) with the GIL: for what is over at once, or makes Python objects.
  template <class F>
  decltype(auto) with(F f) {
    const Use use(*this);
    return f(*batch_);
  }
  // f(Batch&) without the GIL: it may touch no Python object.
  template <class F>
  decltype(auto) run(F f) {
    const Use use(*this);
    const nanobind::gil_scoped_release release;
    return f(*batch_);
  }

  bool closed() const { return batch_ == nullptr; }
  void close() {
    if (closed()) return;
    const Use use(*this);
    batch_.reset();
  }
  // For those who look into its memory.
  std::shared_ptr<Batch> share() const { return batch_; }

 private:
  class Use {
   public:
    explicit Use(HeldBatch& held) : held_(held) {
      if (held_.busy_.exchange(true)) {
        throw std::runtime_error(
            "the batch is in use by another thread; use one Batch per thread, or a lock");
      }
      if (held_.closed()) {
        held_.busy_ = false;
        throw nanobind::value_error("the batch is closed");
      }
    }
    ~Use() { held_.busy_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    HeldBatch& held_;
  };

  std::shared_ptr<Batch> batch_;
  std::atomic<bool> busy_ = false;
};

}  // namespace manyworlds::python
