// Bytes that stand for those of a file at some places: what has not been written to it yet.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace manyworlds::record {

class Overlay {
 public:
  using Pieces = std::map<std::uint64_t, std::vector<std::byte>>;  // by place; none overlap

  // Nothing has changed where it throws std::bad_alloc.
  void put(std::uint64_t at, std::span<const std::byte> bytes) {
    std::uint64_t begin = at, end = at + bytes.size();
    const auto [first, last] = touching(begin, end);
    if (first != last) {
      begin = std::min(begin, first->first);
      const auto newest = std::prev(last);
      end = std::max(end, newest->first + newest->second.size());
    }
    if (first != last && std::next(first) == last && first->second.size() == end - begin) {
      overwrite(at, bytes);
      return;
    }
    Pieces merged;
    std::vector<std::byte>& all = merged[begin];
    all.resize(end - begin);
    for (auto old = first; old != last; ++old) copy(old->second, all, old->first - begin);
    copy(bytes, all, at - begin);
    pieces_.erase(first, last);
    pieces_.merge(merged);
  }

  // Only where there is something already.
  void overwrite(std::uint64_t at, std::span<const std::byte> bytes) noexcept {
    const auto [first, last] = touching(at, at + bytes.size());
    for (auto piece = first; piece != last; ++piece) {
      exchange(at, bytes.size(), *piece, [&](std::size_t there, std::size_t here, std::size_t n) {
        std::memcpy(piece->second.data() + there, bytes.data() + here, n);
      });
    }
  }

  // Puts what there is over `bytes`, which the file has at `at`.
  void cover(std::uint64_t at, std::span<std::byte> bytes) const noexcept {
    auto piece = pieces_.upper_bound(at);
    if (piece != pieces_.begin()) --piece;
    for (; piece != pieces_.end() && piece->first < at + bytes.size(); ++piece) {
      exchange(at, bytes.size(), *piece, [&](std::size_t there, std::size_t here, std::size_t n) {
        std::memcpy(bytes.data() + here, piece->second.data() + there, n);
      });
    }
  }

  const Pieces& pieces() const { return pieces_; }
  void clear() { pieces_.clear(); }

 private:
  static void copy(std::span<const std::byte> from, std::vector<std::byte>& to, std::uint64_t at) {
    std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(at));
  }

  // do(place in the piece, place in [at, at + size), count) for what both have.
  template <class Do>
  static void exchange(std::uint64_t at, std::size_t size, const Pieces::value_type& piece,
                       Do what) {
    const std::uint64_t begin = std::max(at, piece.first);
    const std::uint64_t end = std::min(at + size, piece.first + piece.second.size());
    if (begin < end) what(begin - piece.first, begin - at, end - begin);
  }

  std::pair<Pieces::iterator, Pieces::iterator> touching(std::uint64_t begin, std::uint64_t end) {
    auto first = pieces_.upper_bound(begin);
    if (first != pieces_.begin()) {
      const auto before = std::prev(first);
      if (before->first + before->second.size() > begin) first = before;
    }
    return {first, pieces_.lower_bound(end)};
  }

  Pieces pieces_;
};

}  // namespace manyworlds::record
