// Something that steps, as a Python object holds it: it can be closed, it refuses to be used by two
// threads at a time (long calls let go of the GIL), and its memory outlives it for as long as
// others look into it.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace manyworlds::python {

template <class T>
class Held {
 public:
  using Busy = std::shared_ptr<std::atomic<bool>>;

  // `name`: of its class. What shares memory shares `busy`.
  Held(std::shared_ptr<T> held, const char* name,
       Busy busy = std::make_shared<std::atomic<bool>>(false))
      : held_(std::move(held)), busy_(std::move(busy)), name_(name) {}

  // f(T&) with the GIL: for what is over at once, or makes Python objects.
  template <class F>
  decltype(auto) with(F f) {
    const Use use(*this);
    return f(*held_);
  }
  // f(T&) without the GIL: it may touch no Python object.
  template <class F>
  decltype(auto) run(F f) {
    const Use use(*this);
    const nanobind::gil_scoped_release release;
    return f(*held_);
  }

  bool closed() const { return held_ == nullptr; }
  void close() {
    if (closed()) return;
    const Use use(*this);
    held_.reset();
  }
  // For views of its memory.
  std::shared_ptr<T> share() const { return held_; }
  const Busy& busy() const { return busy_; }

 private:
  class Use {
   public:
    explicit Use(Held& held) : busy_(*held.busy_) {
      const std::string name = held.name_;
      if (busy_.exchange(true)) {
        throw std::runtime_error("the " + lower(name) + " is in use by another thread; use one " +
                                 name + " per thread, or a lock");
      }
      if (held.closed()) {
        busy_ = false;
        throw nanobind::value_error(("the " + lower(name) + " is closed").c_str());
      }
    }
    ~Use() { busy_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    static std::string lower(std::string name) {
      if (name[0] >= 'A' && name[0] <= 'Z') name[0] = static_cast<char>(name[0] - 'A' + 'a');
      return name;
    }
    std::atomic<bool>& busy_;
  };

  std::shared_ptr<T> held_;
  Busy busy_;
  const char* name_;
};

}  // namespace manyworlds::python
