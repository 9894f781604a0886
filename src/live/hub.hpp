// What the thread that serves and the thread that steps hand each other: commands one way, captures
// and words the other. Nothing in it waits for a page.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "src/live/capture.hpp"
#include "src/live/command.hpp"
#include "src/page/sizes.hpp"

namespace manyworlds::live {

// Of each kind, for the worlds that can be shown.
using VariedSizes = std::vector<std::vector<page::VariedSize>>;

class Hub {
 public:
  using Captured = std::shared_ptr<const Capture>;

  // ---- the thread that serves

  // What is called, on the thread that steps, when there is something new; and with words for a
  // page (0: all).
  struct Listener {
    std::function<void()> captured;
    std::function<void(int page, std::string text)> said;
    std::function<void()> resized;
  };
  void listen(Listener listener);
  void stop_listening();

  // False: there are too many that nobody has carried out yet.
  bool post(Command command);
  // A page waits for a frame of these worlds, newer than `seen`.
  void want(int page, std::vector<int> worlds, std::uint64_t seen);
  void forget(int page);
  // The newest capture where it has these worlds, or none. `older`: also the last one of all
  // worlds, which may be older.
  Captured newest(std::span<const int> worlds, bool older) const;
  std::shared_ptr<const VariedSizes> sizes() const;

  // ---- the thread that steps

  bool any_command() const { return commands_waiting_.load(std::memory_order_acquire); }
  bool any_want() const { return wants_waiting_.load(std::memory_order_acquire); }
  std::vector<Command> take();
  // The worlds that pages wait for which have not seen `version` yet; they wait no more.
  std::vector<int> take_wants(std::uint64_t version);
  void publish(Captured capture, bool of_all);
  void say(int page, std::string text);
  void resize(std::shared_ptr<const VariedSizes> sizes, bool tell);
  // Until something is posted or wanted, or `at_most` has passed.
  void wait(std::chrono::steady_clock::duration at_most);

 private:
  struct Want {
    std::vector<int> worlds;
    std::uint64_t seen;
  };
  static constexpr std::size_t kMaxCommands = 256;

  mutable std::mutex mutex_;
  std::condition_variable posted_;
  std::vector<Command> commands_;
  std::map<int, Want> wants_;
  Captured newest_, of_all_;
  std::shared_ptr<const VariedSizes> sizes_;
  bool news_ = false;  // since the last wait
  std::atomic<bool> commands_waiting_ = false, wants_waiting_ = false;
  std::mutex listener_mutex_;
  Listener listener_;
};

}  // namespace manyworlds::live
