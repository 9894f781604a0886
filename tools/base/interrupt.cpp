#include "tools/base/interrupt.hpp"

#include <atomic>

namespace manyworlds::tools {

namespace {

constexpr int kSignalNumbers[] = {SIGINT, SIGTERM, SIGHUP};
constexpr const char* kSignalNames[] = {"SIGINT", "SIGTERM", "SIGHUP"};

std::atomic<int> first_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal's handler may touch nothing else");

extern "C" void note_signal(int number) {
  int none = 0;
  if (first_signal.compare_exchange_strong(none, number)) return;
  // The second one.
  std::signal(number, SIG_DFL);
  std::raise(number);
}

}  // namespace

Interruptible::Interruptible() {
  struct sigaction noting {};
  noting.sa_handler = note_signal;
  noting.sa_flags = SA_RESTART;
  sigemptyset(&noting.sa_mask);
  for (std::size_t i = 0; i < kSignals; ++i) {
    sigaction(kSignalNumbers[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) sigaction(kSignalNumbers[i], &noting, nullptr);
  }
}
Interruptible::~Interruptible() {
  for (std::size_t i = 0; i < kSignals; ++i) sigaction(kSignalNumbers[i], &before_[i], nullptr);
}

int interrupted() { return first_signal.load(); }

std::string interrupt_name() {
  for (std::size_t i = 0; i < std::size(kSignalNumbers); ++i) {
    if (kSignalNumbers[i] == interrupted()) return kSignalNames[i];
  }
  return {};
}
int interrupt_code() { return 128 + interrupted(); }

void stop_if_interrupted() {
  if (interrupted() != 0) throw Interrupted();
}

}  // namespace manyworlds::tools
