// Calls a GoOn. An exception of it counts as false. rethrow() rethrows the exception when the
// caller has counted the steps taken.
#pragma once

#include <exception>
#include <functional>

namespace manyworlds {

class Asked {
 public:
  // The function must outlive this.
  explicit Asked(const std::function<bool()>& go_on) : go_on_(go_on) {}
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;

  explicit operator bool() const { return static_cast<bool>(go_on_); }  // there is one to ask
  bool operator()() noexcept {
    if (ended_ || !go_on_) return !ended_;
    try {
      ended_ = !go_on_();
    } catch (...) {
      ended_ = true;
      thrown_ = std::current_exception();
    }
    return !ended_;
  }
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  const std::function<bool()>& go_on_;
  bool ended_ = false;
  std::exception_ptr thrown_;
};

}  // namespace manyworlds
