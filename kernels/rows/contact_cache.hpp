// Stored impulses, one row per manifold and lane, for warm starting the next step:
//   planar, one point   l fx fy m
//   planar, two points  x0 x1 l0 l1 | code f m 0
//   spatial, one point  l fx fy fz
//   spatial, four       x0..x3 | y0..y3 | l0..l3 | code f1 f2 twist
// and in space, of plans with resistance, mx my mz 0, which four points round up to 8 numbers.
// l: along the normal; f, m: friction and the moment of resistance, as world vectors of one point.
// Normal impulses of an impact in the last substep are negative (solver/strikes.hpp).
// x, y is the place of a point on the reference feature. Rows lie in the order of their keys, so
// the format does not depend on the layout that made them.
#pragma once

#include "kernels/rows/resistance.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

class CacheWriter {
 public:
  CacheWriter(const Constants& t, const Group& g, const Work& w) : t_(t), g_(g), w_(w) {
    for (auto& list : place_) {
      for (auto& n : list) n = 0;
    }
  }

  template <class S, int N>
  void put(const ContactBlock<S, N>& s, const Resistance<S>* resistance, ListId list) {
    const int id = static_cast<int>(list);
    const int row = kernels::cache_row_size(t_, list);
    const std::uint32_t mask = s.mask & ~w_.frozen;
    const Ints lanes = Ints::lanes(), place = Ints::load(place_[id]);
    // Lanes without this contact write to a row that nobody reads.
    const Ints to =
        select(mask, place + Ints(kernels::kFirstRow * kLanes), Ints(kernels::kSpillRow * kLanes));
    alignas(64) std::int32_t o[kLanes];
    ((to + lanes) * Ints(row)).store(o);
    scatter(Ints::load(s.key), mask, g_.cache[id].keys, place + lanes);
    (place + select(mask, Ints(kLanes), Ints(0))).store(place_[id]);
    Float amount[S::kAng];
    for (int i = 0; i < S::kAng; ++i) {
      amount[i] = resistance ? Float::load(resistance->impulse[i]) : Float(Real(0));
    }
    Real* const rows = g_.cache[id].rows;
    if constexpr (S::kDim == 2) {
      write(s, amount[0], rows, o);
    } else {
      write(s, rows, o);
      if (!resistance) return;
      const Vec3 moment = moment_of(load_as<Vec3>(s.normal[0]), *resistance, amount);
      store_rows4(rows + kMomentRow<S, N>, o, moment.x, moment.y, moment.z, Real(0));
    }
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
    const int row = kernels::cache_row_size(t_, static_cast<ListId>(id));
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

  template <class S, int N>
  static Float impulse_of(const ContactBlock<S, N>& s, int i) {
    const Float x = Float::load(s.impulse[i]);
    return s.struck == 0 ? x : select(mask_from_bits(s.struck), -x, x);
  }

  void write(const ContactBlock<Planar, 1>& s, Float moment, Real* rows, const std::int32_t* o) {
    const Vec2 p = t_.has_friction ? load_as<Vec2>(s.tangent[0]) * Float::load(s.tangent_impulse[0])
                                   : zero_of<Vec2>();
    store_rows4(rows, o, impulse_of(s, 0), p.x, p.y, moment);
  }
  template <class S>
  void write(const ContactBlock<S, 1>& s, Real* rows, const std::int32_t* o) {
    Vec3 p = zero_of<Vec3>();
    if (t_.has_friction) {
      const auto n = load_as<Vec3>(s.normal[0]), t = load_as<Vec3>(s.tangent[0]);
      const Float first = Float::load(s.tangent_impulse[0]);
      p = fma(cross(n, t), Float::load(s.tangent_impulse[1]), t * first);
    }
    store_rows4(rows, o, impulse_of(s, 0), p.x, p.y, p.z);
  }
  void write(const ContactBlock<Planar, 2>& s, Float moment, Real* rows, const std::int32_t* o) {
    const Float zero(Real(0));
    const Float f = t_.has_friction ? Float::load(s.tangent_impulse[0]) : zero;
    store_rows4(rows, o, Float::load(s.feature_x[0]), Float::load(s.feature_x[1]), impulse_of(s, 0),
                impulse_of(s, 1));
    store_rows4(rows + 4, o, Float::load(s.code), f, moment, zero);
  }
  template <class S>
  void write(const ContactBlock<S, 4>& s, Real* rows, const std::int32_t* o) {
    const Float zero(Real(0));
    const bool friction = t_.has_friction;
    store_rows8(rows, o, Float::load(s.feature_x[0]), Float::load(s.feature_x[1]),
                Float::load(s.feature_x[2]), Float::load(s.feature_x[3]),
                Float::load(s.feature_y[0]), Float::load(s.feature_y[1]),
                Float::load(s.feature_y[2]), Float::load(s.feature_y[3]));
    store_rows8(rows + 8, o, impulse_of(s, 0), impulse_of(s, 1), impulse_of(s, 2), impulse_of(s, 3),
                Float::load(s.code), friction ? Float::load(s.tangent_impulse[0]) : zero,
                friction ? Float::load(s.tangent_impulse[1]) : zero,
                friction ? Float::load(s.twist_impulse) : zero);
  }

  const Constants& t_;
  const Group& g_;
  const Work& w_;
  alignas(64) std::int32_t place_[kLists][kLanes];  // manifolds so far, times kLanes
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
