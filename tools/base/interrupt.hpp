// Ctrl-C and the like while work is done: the work ends where it stands, what was done is told, and
// what was written is whole. A second one ends the program at once.
#pragma once

#include <csignal>
#include <cstddef>
#include <exception>
#include <string>

namespace manyworlds::tools {

// While one lives, SIGINT, SIGTERM and SIGHUP are noted instead of ending the program; those that
// were ignored stay so, as nohup wants it.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

 private:
  static constexpr std::size_t kSignals = 3;
  struct sigaction before_[kSignals];
};

// The first signal that came; 0: none.
int interrupted();
std::string interrupt_name();  // "SIGINT"
int interrupt_code();          // exit code for it, 128 + its number

// For work that is worth nothing unless it is done to its end.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};
void stop_if_interrupted();  // throws Interrupted

}  // namespace manyworlds::tools
