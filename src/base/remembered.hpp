// The last results of a function that takes long and is often called with the same arguments.
#pragma once

#include <cstring>
#include <deque>
#include <memory>
#include <mutex>
#include <type_traits>
#include <utility>
#include <vector>

namespace manyworlds {

// By lists of numbers or vectors, to the last bit. Any thread may ask.
template <class Element, class Result>
class Remembered {
 public:
  // `most`: elements of all lists together.
  explicit Remembered(std::size_t most) : most_(most) {}

  template <class Make>
  std::shared_ptr<const Result> get(const std::vector<Element>& list, Make&& make) {
    if (auto found = find(list)) return found;
    auto made = std::make_shared<const Result>(std::forward<Make>(make)());
    put(list, made);
    return made;
  }

 private:
  struct Entry {
    std::vector<Element> list;
    std::shared_ptr<const Result> result;
  };
  std::shared_ptr<const Result> find(const std::vector<Element>& list) {
    const std::lock_guard lock(mutex_);
    for (const Entry& e : entries_) {
      if (e.list.size() == list.size() &&
          std::memcmp(e.list.data(), list.data(), list.size() * sizeof(Element)) == 0) {
        return e.result;
      }
    }
    return nullptr;
  }
  void put(const std::vector<Element>& list, std::shared_ptr<const Result> result) {
    if (list.size() > most_ / 4) return;
    const std::lock_guard lock(mutex_);
    entries_.push_front({list, std::move(result)});
    size_ += list.size();
    constexpr std::size_t kMostEntries = 256;
    while (size_ > most_ || entries_.size() > kMostEntries) {
      size_ -= entries_.back().list.size();
      entries_.pop_back();
    }
  }

  std::size_t most_, size_ = 0;
  std::mutex mutex_;
  std::deque<Entry> entries_;  // the last first
};

}  // namespace manyworlds
