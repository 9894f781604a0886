// Holds tests with the tag [one_thread] to what it says: they start no thread, so ThreadSanitizer
// has nothing to see in them, and its build leaves them out (CMakePresets.json).
#define CATCH_CONFIG_EXTERNAL_INTERFACES
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

namespace {

auto threads() {
  namespace fs = std::filesystem;
  return std::distance(fs::directory_iterator("/proc/self/task"), fs::directory_iterator());
}

// oneTBB's threads stay when a test ends. Those of an earlier test do not count.
class OneThread : public Catch::TestEventListenerBase {
 public:
  using TestEventListenerBase::TestEventListenerBase;

  void testCaseStarting(const Catch::TestCaseInfo& test) override {
    TestEventListenerBase::testCaseStarting(test);
    before_ = threads();
  }
  void testCaseEnded(const Catch::TestCaseStats& stats) override {
    TestEventListenerBase::testCaseEnded(stats);
    const auto& tags = stats.testInfo.lcaseTags;
    const auto more = threads() - before_;
    if (more <= 0 || std::find(tags.begin(), tags.end(), "one_thread") == tags.end()) return;
    std::cerr << "'" << stats.testInfo.name << "' is tagged [one_thread], but started " << more
              << '\n';
    std::exit(1);
  }

 private:
  std::ptrdiff_t before_ = 0;
};

CATCH_REGISTER_LISTENER(OneThread)

}  // namespace
