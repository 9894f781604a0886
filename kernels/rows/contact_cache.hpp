// Stored impulses, one row per manifold and lane, for warm starting the next step:
//   one point           normal impulse, friction impulse as a world vector
//   planar, two points  x0 x1 l0 l1 | code f 0 0
//   spatial, four       x0..x3 | y0..y3 | l0..l3 | code f1 f2 twist
// x, y is the place of a point on the reference feature. Rows lie in the order of their keys, so
// the format does not depend on the layout that made them.
#pragma once

#include "kernels/rows/contact_block.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

class CacheWriter {
 public:
  CacheWriter(const Constants& t, const Group& g, const Work& w) : t_(t), g_(g), w_(w) {
    for (auto& list : place_) {
      for (auto& n : list) n = 0;
    }
  }

  template <class S, int N>
  void put(const ContactBlock<S, N>& s, ListId list) {
    const int id = static_cast<int>(list);
    const int row = kernels::cache_row_size(t_.dimension, list);
    const std::uint32_t mask = s.mask & ~w_.frozen;
    const Ints lanes = Ints::lanes(), place = Ints::load(place_[id]);
    // Lanes without this contact write to a row that nobody reads.
    const Ints to =
        select(mask, place + Ints(kernels::kFirstRow * kLanes), Ints(kernels::kSpillRow * kLanes));
    alignas(64) std::int32_t o[kLanes];
    ((to + lanes) * Ints(row)).store(o);
    scatter(Ints::load(s.key), mask, g_.cache[id].keys, place + lanes);
    (place + select(mask, Ints(kLanes), Ints(0))).store(place_[id]);
    write(s, g_.cache[id].rows, o);
  }

  // Ends every lane's keys, after merging in those of sleeping pairs.
  void close() {
    for (int id = 0; id < kLists; ++id) {
      if (t_.capacity[id] == 0) continue;
      if ((w_.partly_asleep | w_.untouched) != 0) {
        close_sleeping_lanes(id);
        continue;
      }
      for (int l = 0; l < kLanes; ++l) end(id, l);
    }
  }

 private:
  void close_sleeping_lanes(int id) {
    for (int l = 0; l < kLanes; ++l) {
      if ((w_.untouched >> l) & 1u) continue;
      if ((w_.partly_asleep >> l) & 1u) merge_kept(id, l);
      end(id, l);
    }
  }
  void end(int id, int l) { g_.cache[id].keys[place_[id][l] + l] = kernels::kEndOfKeys; }

  // Two ascending lists into one, from the back, in the place of the first.
  void merge_kept(int id, int l) {
    const int capacity = t_.capacity[id];
    const int row = kernels::cache_row_size(t_.dimension, static_cast<ListId>(id));
    std::int32_t* keys = g_.cache[id].keys + l;
    Real* rows = g_.cache[id].rows + (kernels::kFirstRow * kLanes + l) * row;
    const std::int32_t* kept_keys = w_.kept_keys[id] + l * capacity;
    const Real* kept_rows = w_.kept_rows[id] + l * capacity * row;
    int fresh = place_[id][l] / kLanes, kept = w_.kept[id][l];
    place_[id][l] += kept * kLanes;
    while (kept > 0) {
      const bool from_fresh = fresh > 0 && keys[(fresh - 1) * kLanes] > kept_keys[kept - 1];
      const int to = (fresh + kept - 1) * kLanes;
      const Real* from = from_fresh ? rows + --fresh * kLanes * row : kept_rows + --kept * row;
      keys[to] = from_fresh ? keys[fresh * kLanes] : kept_keys[kept];
      for (int i = 0; i < row; ++i) rows[to * row + i] = from[i];
    }
  }

  template <class S>
  void write(const ContactBlock<S, 1>& s, Real* rows, const std::int32_t* o) {
    const auto t = load_as<typename S::Vec>(s.tangent[0]);
    const Float f = Float::load(s.tangent_impulse[0]);
    if (!t_.has_friction) {
      store_rows4(rows, o, Float::load(s.impulse[0]), Real(0), Real(0), Real(0));
    } else if constexpr (S::kDim == 2) {
      store_rows4(rows, o, Float::load(s.impulse[0]), t.x * f, t.y * f, Real(0));
    } else {
      const auto n = load_as<Vec3>(s.normal[0]);
      const Vec3 p = fma(cross(n, t), Float::load(s.tangent_impulse[1]), t * f);
      store_rows4(rows, o, Float::load(s.impulse[0]), p.x, p.y, p.z);
    }
  }
  void write(const ContactBlock<Planar, 2>& s, Real* rows, const std::int32_t* o) {
    const Float zero(Real(0));
    const Float f = t_.has_friction ? Float::load(s.tangent_impulse[0]) : zero;
    store_rows4(rows, o, Float::load(s.feature_x[0]), Float::load(s.feature_x[1]),
                Float::load(s.impulse[0]), Float::load(s.impulse[1]));
    store_rows4(rows + 4, o, Float::load(s.code), f, zero, zero);
  }
  template <class S>
  void write(const ContactBlock<S, 4>& s, Real* rows, const std::int32_t* o) {
    const Float zero(Real(0));
    const bool friction = t_.has_friction;
    store_rows8(rows, o, Float::load(s.feature_x[0]), Float::load(s.feature_x[1]),
                Float::load(s.feature_x[2]), Float::load(s.feature_x[3]),
                Float::load(s.feature_y[0]), Float::load(s.feature_y[1]),
                Float::load(s.feature_y[2]), Float::load(s.feature_y[3]));
    store_rows8(rows + 8, o, Float::load(s.impulse[0]), Float::load(s.impulse[1]),
                Float::load(s.impulse[2]), Float::load(s.impulse[3]), Float::load(s.code),
                friction ? Float::load(s.tangent_impulse[0]) : zero,
                friction ? Float::load(s.tangent_impulse[1]) : zero,
                friction ? Float::load(s.twist_impulse) : zero);
  }

  const Constants& t_;
  const Group& g_;
  const Work& w_;
  alignas(64) std::int32_t place_[kLists][kLanes];  // manifolds so far, times kLanes
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
