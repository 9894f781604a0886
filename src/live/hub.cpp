#include "src/live/hub.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace manyworlds::live {
namespace {

// Of which the last one alone counts.
bool replaces(const Command& late, const Command& early) {
  if (late.kind != early.kind || late.page != early.page || late.world != early.world) return false;
  switch (late.kind) {
    case Command::drag: return late.body == early.body;
    case Command::speed:
    case Command::controls:
    case Command::gravity:
    case Command::friction: return true;
    default: return false;
  }
}

}  // namespace

void Hub::listen(Listener listener) {
  const std::lock_guard lock(listener_mutex_);
  listener_ = std::move(listener);
}

void Hub::stop_listening() { listen({}); }

bool Hub::post(Command command) {
  {
    const std::lock_guard lock(mutex_);
    if (!commands_.empty() && replaces(command, commands_.back())) {
      commands_.back() = std::move(command);
    } else if (commands_.size() >= kMaxCommands && command.kind != Command::gone) {
      return false;
    } else {
      commands_.push_back(std::move(command));
    }
    commands_waiting_.store(true, std::memory_order_release);
    news_ = true;
  }
  posted_.notify_all();
  return true;
}

void Hub::want(int page, std::vector<int> worlds, std::uint64_t seen) {
  {
    const std::lock_guard lock(mutex_);
    wants_[page] = {std::move(worlds), seen};
    wants_waiting_.store(true, std::memory_order_release);
    news_ = true;
  }
  posted_.notify_all();
}

void Hub::forget(int page) {
  const std::lock_guard lock(mutex_);
  wants_.erase(page);
  wants_waiting_.store(!wants_.empty(), std::memory_order_release);
}

Hub::Captured Hub::newest(std::span<const int> worlds, bool older) const {
  const std::lock_guard lock(mutex_);
  if (newest_ == nullptr || newest_->has(worlds)) return newest_;
  const bool current =
      of_all_ != nullptr && of_all_->version >= newest_->version && of_all_->has(worlds);
  return current || older ? of_all_ : nullptr;
}

std::shared_ptr<const VariedSizes> Hub::sizes() const {
  const std::lock_guard lock(mutex_);
  return sizes_;
}

std::vector<Command> Hub::take() {
  const std::lock_guard lock(mutex_);
  commands_waiting_.store(false, std::memory_order_release);
  return std::exchange(commands_, {});
}

std::vector<int> Hub::take_wants(std::uint64_t version) {
  const std::lock_guard lock(mutex_);
  std::vector<int> out, both;
  for (auto page = wants_.begin(); page != wants_.end();) {
    if (page->second.seen == version) {
      ++page;
      continue;
    }
    both.clear();
    std::set_union(out.begin(), out.end(), page->second.worlds.begin(), page->second.worlds.end(),
                   std::back_inserter(both));
    out.swap(both);
    page = wants_.erase(page);
  }
  wants_waiting_.store(!wants_.empty(), std::memory_order_release);
  return out;
}

void Hub::publish(Captured capture, bool of_all) {
  {
    const std::lock_guard lock(mutex_);
    newest_ = capture;
    if (of_all) of_all_ = std::move(capture);
  }
  const std::lock_guard lock(listener_mutex_);
  if (listener_.captured) listener_.captured();
}

void Hub::say(int page, std::string text) {
  const std::lock_guard lock(listener_mutex_);
  if (listener_.said) listener_.said(page, std::move(text));
}

void Hub::resize(std::shared_ptr<const VariedSizes> sizes, bool tell) {
  {
    const std::lock_guard lock(mutex_);
    sizes_ = std::move(sizes);
  }
  const std::lock_guard lock(listener_mutex_);
  if (tell && listener_.resized) listener_.resized();
}

void Hub::wait(std::chrono::steady_clock::duration at_most) {
  std::unique_lock lock(mutex_);
  posted_.wait_for(lock, at_most, [&] { return news_; });
  news_ = false;
}

}  // namespace manyworlds::live
