// Operations on the state of a whole world: swap, copy, conversion to bytes and back.
#include <array>
#include <cstring>
#include <utility>

#include "kernels/data/pair_keys.hpp"
#include "src/base/bits.hpp"
#include "src/state/storage.hpp"

namespace manyworlds {

namespace {

enum class Part { state, status, keys, rows, joints, controls, rest_time, island, force };

struct Swap {
  template <class T>
  void numbers(Part, T* a, T* b, std::size_t count, std::size_t stride) const {
    for (std::size_t i = 0; a && i < count; ++i) std::swap(a[i * stride], b[i * stride]);
  }
  void bit(std::uint32_t* a, std::size_t lane_a, std::uint32_t* b, std::size_t lane_b) const {
    if (!a) return;
    const bool value = get_bit(*a, lane_a);
    put_bit(*a, lane_a, get_bit(*b, lane_b));
    put_bit(*b, lane_b, value);
  }
};

struct Copy {
  template <class T>
  void numbers(Part part, const T* from, T* to, std::size_t count, std::size_t stride) const {
    if (part == Part::force) return;  // an input of the next step, not state
    for (std::size_t i = 0; from && i < count; ++i) to[i * stride] = from[i * stride];
  }
  void bit(const std::uint32_t* from, std::size_t from_lane, std::uint32_t* to,
           std::size_t lane) const {
    if (from) put_bit(*to, lane, get_bit(*from, from_lane));
  }
};

struct Count {
  std::size_t bytes = 0;
  template <class T>
  void numbers(Part part, const T*, const T*, std::size_t count, std::size_t) {
    if (part != Part::force) bytes += count * sizeof(T);
  }
  void bit(const std::uint32_t*, std::size_t, const std::uint32_t*, std::size_t) { ++bytes; }
};

struct Write {
  std::byte* to;
  template <class T>
  void numbers(Part part, const T* from, const T*, std::size_t count, std::size_t stride) {
    if (part == Part::force) return;
    if (from == nullptr) {
      std::memset(to, 0, count * sizeof(T));
    } else if (stride == 1) {
      std::memcpy(to, from, count * sizeof(T));
    } else {
      for (std::size_t i = 0; i < count; ++i) {
        std::memcpy(to + i * sizeof(T), from + i * stride, sizeof(T));
      }
    }
    to += count * sizeof(T);
  }
  void bit(const std::uint32_t* from, std::size_t lane, const std::uint32_t*, std::size_t) {
    *to++ = static_cast<std::byte>(from && get_bit(*from, lane) ? 1 : 0);
  }
};

struct Read {
  const std::byte* from;
  template <class T>
  void numbers(Part part, T* to, T*, std::size_t count, std::size_t stride) {
    if (part == Part::force) return;
    if (to && stride == 1) {
      std::memcpy(to, from, count * sizeof(T));
    } else if (to) {
      for (std::size_t i = 0; i < count; ++i) {
        std::memcpy(to + i * stride, from + i * sizeof(T), sizeof(T));
      }
    }
    from += count * sizeof(T);
  }
  void bit(std::uint32_t* to, std::size_t lane, std::uint32_t*, std::size_t) {
    const bool value = *from++ != std::byte{0};
    if (to) put_bit(*to, lane, value);
  }
};

// Numbers that the step would use as indices must be ones that it could have made.
template <class Real>
struct Check {
  const kernels::SceneConstants<Real>& t;
  const std::byte* from;
  std::string problem;
  int list = -1;  // whose keys come next

  template <class T>
  void numbers(Part part, const T*, const T*, std::size_t count, std::size_t) {
    if (part == Part::force) return;
    if constexpr (std::is_same_v<T, std::int32_t>) {
      if (part == Part::keys) check_keys(count);
      if (part == Part::island) check_islands(count);
    }
    from += count * sizeof(T);
  }
  void bit(const std::uint32_t*, std::size_t, const std::uint32_t*, std::size_t) {
    if (*from++ > std::byte{1}) problem = "a flag is neither 0 nor 1";
  }

 private:
  std::int32_t at(std::size_t i) const {
    std::int32_t value = 0;
    std::memcpy(&value, from + i * sizeof value, sizeof value);
    return value;
  }
  void check_keys(std::size_t count) {
    do {
      ++list;
    } while (t.capacity[list] == 0);
    std::int32_t last = -1;
    for (std::size_t i = 0; i < count && at(i) != kernels::kEndOfKeys; ++i) {
      if (at(i) <= last || !is_key(t, static_cast<kernels::ListId>(list), at(i)))
        problem = "a contact is not one of the plan's";
      last = at(i);
      if (i + 1 == count) problem = "a list of contacts has no end";
    }
  }
  void check_islands(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (at(i) < 0 || at(i) >= t.bodies) problem = "an island is not one of the bodies";
    }
  }
};

}  // namespace

template <class Real>
template <class Visit>
void Storage<Real>::for_each_part(int a, int b, Visit&& visit) const {
  const auto& t = tables_;
  const std::size_t lanes = index(lanes_);
  const auto in_lanes = [&](Part part, auto& buffer, std::size_t per_world) {
    const auto at = [&](int lane_index) {
      const std::size_t offset = group_of(lane_index) * per_world * lanes + lane_of(lane_index);
      return buffer.empty() ? nullptr : buffer.data() + offset;
    };
    visit.numbers(part, at(a), at(b), per_world, lanes);
  };
  in_lanes(Part::state, state_, index(t.state_size));
  visit.numbers(Part::status, status_.data() + a, status_.data() + b, 1, std::size_t{1});
  for (std::size_t l = 0; l < kernels::kLists; ++l) {
    if (cache_keys_[l].empty()) continue;
    const std::size_t capacity = index(t.capacity[l]);
    const std::size_t row = index(kernels::cache_row_size(t, static_cast<kernels::ListId>(l)));
    in_lanes(Part::keys, cache_keys_[l], capacity + 1);
    Real *rows_a = rows_of(a, l), *rows_b = rows_of(b, l);
    for (std::size_t i = 0; i < capacity; ++i, rows_a += lanes * row, rows_b += lanes * row) {
      visit.numbers(Part::rows, rows_a, rows_b, row, std::size_t{1});
    }
  }
  in_lanes(Part::joints, joint_impulse_, index(t.parts) * kernels::kPartImpulses);
  in_lanes(Part::controls, control_, index(t.controls));
  in_lanes(Part::rest_time, rest_time_, index(t.bodies));
  in_lanes(Part::island, island_, index(t.bodies));
  in_lanes(Part::force, force_, index(t.bodies) * 6);
  const auto bit = [&](AlignedBuffer<std::uint32_t>& masks, std::size_t in_a, std::size_t in_b) {
    std::uint32_t* words = masks.empty() ? nullptr : masks.data();
    visit.bit(words ? words + in_a : nullptr, lane_of(a), words ? words + in_b : nullptr,
              lane_of(b));
  };
  for (int body = 0; body < t.bodies; ++body) {
    bit(asleep_, body_at(a, body), body_at(b, body));
    bit(absent_, body_at(a, body), body_at(b, body));
  }
  bit(resting_, group_of(a), group_of(b));
  for (int joint = 0; joint < t.joints; ++joint) {
    bit(disabled_joints_, joint_at(a, joint), joint_at(b, joint));
  }
}

template <class Real>
void Storage<Real>::swap(int a, int b) {
  if (a == b) return;
  for_each_part(a, b, Swap{});
  constants_.swap(a, b);
  if (!has_activity()) return;
  find_idle_in(group_of(a));
  find_idle_in(group_of(b));
}

template <class Real>
void Storage<Real>::copy(int from, int to) {
  if (from == to) return;
  for_each_part(from, to, Copy{});
  constants_.copy(from, to);
  if (has_activity()) find_idle_in(group_of(to));
}

template <class Real>
std::size_t Storage<Real>::world_bytes() const {
  Count count;
  for_each_part(0, 0, count);
  return count.bytes;
}

template <class Real>
void Storage<Real>::write_world(int lane_index, std::byte* to) const {
  for_each_part(lane_index, lane_index, Write{to});
}

template <class Real>
std::string Storage<Real>::check_world(const std::byte* from) const {
  Check<Real> check{tables_, from, {}};
  for_each_part(0, 0, check);
  return check.problem;
}

template <class Real>
void Storage<Real>::read_world(int lane_index, const std::byte* from) {
  make_activity();  // the world may have disabled bodies
  if (tables_.joints > 0) make_disabled_joints();
  for_each_part(lane_index, lane_index, Read{from});
  for (int b = 0; !tables_.has_sleep && b < tables_.bodies; ++b) {
    put_bit(asleep_[body_at(lane_index, b)], lane_of(lane_index), false);  // where no body sleeps
  }
  find_idle_in(group_of(lane_index));
}

template <class Real>
void Storage<Real>::restore_lane(int lane_index, const std::byte* from) {
  for_each_part(lane_index, lane_index, Read{from});
  if (has_activity()) find_idle_in(group_of(lane_index));
}

#define MW_INSTANTIATE(Real)                                        \
  template void Storage<Real>::swap(int, int);                      \
  template void Storage<Real>::copy(int, int);                      \
  template std::size_t Storage<Real>::world_bytes() const;          \
  template void Storage<Real>::write_world(int, std::byte*) const;  \
  template void Storage<Real>::read_world(int, const std::byte*);   \
  template void Storage<Real>::restore_lane(int, const std::byte*); \
  template std::string Storage<Real>::check_world(const std::byte*) const;
MW_INSTANTIATE(float)
MW_INSTANTIATE(double)
#undef MW_INSTANTIATE

}  // namespace manyworlds
