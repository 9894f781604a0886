// Takes contact points down while blocks are made: those of one lane as the user sees them, or the
// places of all for the observers.
#pragma once

#include "kernels/collide/manifold.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Places of the points of a block in all lanes, half way between the surfaces, and the code of its
// features: [point][component][lane], [lane].
template <class S, int N>
void record_places(const Manifold<GeometryOf<S>, N>& m, typename S::Vec origin, Real* out) {
  for (int i = 0; i < N; ++i) {
    const Float to_middle = max(m.separation[i], Real(0)) * Float(Real(-0.5));
    store(out + i * S::kDim * kLanes, fma(m.normal, to_middle, origin + m.point_b[i]));
  }
  m.code.store(out + N * S::kDim * kLanes);
}

// Writes the points of the recorder's lane.
template <class S, int N>
void record_points(Work& w, ListId list, const Manifold<GeometryOf<S>, N>& m,
                   const std::int32_t* key, const Float* impulse, typename S::Vec origin) {
  Recorder& r = *w.recorder;
  if (r.places) {
    const int id = static_cast<int>(list), block = w.blocks[id].count - 1;
    return record_places<S, N>(m, origin, r.places[id] + block * (N * S::kDim + 1) * kLanes);
  }
  const auto lane_of = [&](Float x) {
    alignas(64) Real all[kLanes];
    x.store(all);
    return all[r.lane];
  };
  // Points of a manifold are told apart by their quarter about its middle: stable when they move.
  Real middle_x = 0, middle_y = 0, points = 0;
  for (int i = 0; i < N; ++i) {
    if (!((bits(m.valid[i]) >> r.lane) & 1u)) continue;
    middle_x += lane_of(m.feature_x[i]);
    middle_y += lane_of(m.feature_y[i]);
    points += 1;
  }
  for (int i = 0; i < N && r.count < r.max; ++i) {
    if (!((bits(m.valid[i]) >> r.lane) & 1u)) continue;
    auto& out = r.out[r.count++];
    const Float to_middle = max(m.separation[i], Real(0)) * Float(Real(-0.5));
    const typename S::Vec p = fma(m.normal, to_middle, origin + m.point_b[i]);
    out.list = static_cast<std::int32_t>(list);
    out.key = key[r.lane];
    out.normal[0] = lane_of(m.normal.x), out.normal[1] = lane_of(m.normal.y);
    out.point[0] = lane_of(p.x), out.point[1] = lane_of(p.y);
    out.normal[2] = out.point[2] = Real(0);
    if constexpr (S::kDim == 3) out.normal[2] = lane_of(m.normal.z), out.point[2] = lane_of(p.z);
    out.separation = lane_of(m.separation[i]);
    out.impulse = lane_of(impulse[i]);
    const bool right = lane_of(m.feature_x[i]) * points > middle_x;
    const bool far = lane_of(m.feature_y[i]) * points > middle_y;
    out.feature = static_cast<std::int32_t>(lane_of(m.code)) * 4 + (right ? 1 : 0) + (far ? 2 : 0);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
