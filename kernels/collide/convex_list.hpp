// The candidates of a pair that only the general method knows (convex.hpp).
#pragma once

#include "kernels/collide/at_touch.hpp"
#include "kernels/collide/box_around.hpp"
#include "kernels/collide/candidate_poses.hpp"
#include "kernels/collide/convex.hpp"
#include "kernels/collide/tile.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Whether the general method has a core with a radius around it.
inline constexpr bool has_radius(kernels::ShapeKind kind) {
  return kind == kernels::ShapeKind::sphere || kind == kernels::ShapeKind::capsule;
}

template <class S, int N>
MW_INLINE void exchange_sides(Manifold<S, N>& m) {
  m.normal = -m.normal;
  for (int i = 0; i < N; ++i) {
    const auto point = m.point_a[i];
    m.point_a[i] = m.point_b[i];
    m.point_b[i] = point;
  }
}

// Lanes without a candidate may point at a shape of another kind. They look at those of a lane that
// has one, which also makes hulls the same in all lanes of a dense block.
template <bool kPair>
MW_INLINE PoseOffsets offsets_of_candidates(const Constants& t, const Work& w,
                                            const CandidateList& list, int i) {
  PoseOffsets o = pose_offsets<kPair>(t, w, list.code + i * kLanes);
  const int candidate = __builtin_ctz(list.mask[i]);
  for (int l = 0; l < kLanes; ++l) {
    if (((list.mask[i] >> l) & 1u) == 0) o.a[l] = o.a[candidate], o.b[l] = o.b[candidate];
  }
  return o;
}

// Whether a shape's margin is known here. Of trees all that move have the same.
inline bool tells_margin(const Constants& t, kernels::ShapeKind kind) {
  using K = kernels::ShapeKind;
  if (kind == K::sphere || kind == K::capsule) return t.tree.links > 0;
  return kind == K::box || kind == K::cylinder || kind == K::hull || kind == K::ellipsoid;
}
struct BoxWithMargin {
  BoxAround box;
  Float margin;
};
inline BoxWithMargin load_box(const Constants& t, kernels::ShapeKind kind, const Real* base,
                              const std::int32_t* o) {
  if (has_radius(kind)) {
    ConvexShape s;
    load_convex(nullptr, kind, base, o, s);
    return {box_around(s), Float(t.half_margin)};
  }
  BoxPose b;
  load_pose(base, o, b);
  return {{b.p, b.half, b.r}, b.margin};
}

// Of pairs with a hull, drops what the boxes around both keep apart before more is loaded.
template <bool kPair>
const CandidateList& near_boxes(const Constants& t, Work& w, kernels::ShapeKind kind_a,
                                kernels::ShapeKind kind_b) {
  using K = kernels::ShapeKind;
  CandidateList& list = w.candidates;
  const bool hull = kind_a == K::hull || kind_b == K::hull;
  if (!hull || !tells_margin(t, kind_a) || !tells_margin(t, kind_b)) return list;
  const Real* base_a = kPair ? w.pose_rows : t.fixed_rows;
  for (int i = 0; i < list.count; ++i) {
    w.keep[i] = 0;
    if (list.mask[i] == 0) continue;
    const PoseOffsets o = offsets_of_candidates<kPair>(t, w, list, i);
    const BoxWithMargin a = load_box(t, kind_a, base_a, o.a);
    const BoxWithMargin b = load_box(t, kind_b, w.pose_rows, o.b);
    const Float apart = find_axis_of_boxes(a.box, b.box).separation;
    w.keep[i] = bits(apart < a.margin + b.margin) & list.mask[i];
  }
  compact(t, w, list, w.keep, w.found);
  return w.found;
}

template <int N>
MW_INLINE void collide_tile(const Constants& t, const ConvexShape& a, const Tile& tile,
                            const ConvexShape& b, Mask active, Manifold<Isotropic, N>& m) {
  if constexpr (N == 1) {
    if (b.kind == kernels::ShapeKind::sphere) return collide_tile_sphere(a, tile, b, m);
    collide_convex_point(t, a, &tile, b, active, m);
  } else {
    collide_convex_pair(t, a, &tile, b, active, m);
  }
  m.code = fma(tile.code, Float(kTileCodes), m.code);
}

template <int N, bool kPair>
void collide_convex_list(const Constants& t, const Group& g, Work& w) {
  using kernels::ShapeKind;
  const auto& pairs = t.pair_class[w.class_index];
  const ShapeKind kind_a = shape_a(pairs.kind), kind_b = shape_b(pairs.kind);
  const Real* base_a = kPair ? w.pose_rows : t.fixed_rows;
  const CandidateList& list = near_boxes<kPair>(t, w, kind_a, kind_b);
  const bool exchanged = has_radius(kind_a);  // the method wants what is round as B
  const RowBuilder<Isotropic> rows = row_builder<Isotropic>(t, w);
  AddContact<Isotropic, N>* const add_contact = rows.template add<N>(kPair);
  const bool search = !kPair && searches_touch(t, w, rows);
  ConvexShape a, b;
  for (int i = 0; i < list.count; ++i) {
    if (list.mask[i] == 0) continue;  // its lanes had too many candidates
    const std::int32_t* code = list.code + i * kLanes;
    const PoseOffsets o = offsets_of_candidates<kPair>(t, w, list, i);
    const Mask active = mask_from_bits(list.mask[i]);
    load_convex(t.hulls, kind_b, w.pose_rows, o.b, b);
    Manifold<Isotropic, N> m;
    Vec3 origin_a;
    // B is moved for the search, and back.
    const auto at_touch = [&](auto&& collide_now) {
      const Vec3 origin_b = b.p;
      Mask lanes = active;
      TouchSearch<Isotropic, N> touch;
      if (search) {
        touch.start(t, rows.velocity(t, w, code, origin_b), active, kind_b == ShapeKind::sphere);
      }
      for (;;) {
        collide_now(lanes);
        if (!search || !touch.go_on(m)) break;
        b.p = origin_b + touch.way();
        lanes = touch.going();
      }
      b.p = origin_b;
    };
    if (!kPair && kind_a == ShapeKind::plane) {
      PlanePose plane;
      load_pose(base_a, o.a, plane);
      origin_a = zero_of<Vec3>();
      if constexpr (N == 1) {
        collide_plane_point(plane, b, m);
      } else {
        collide_plane_convex(t, plane, b, m);
      }
    } else if (!kPair && kind_a == ShapeKind::tile) {
      Tile tile;
      load_tile(base_a, o.a, b, active, tile, a);
      if (!any(tile.there)) continue;
      origin_a = a.p;
      at_touch([&](Mask lanes) { collide_tile<N>(t, a, tile, b, lanes, m); });
    } else {
      load_convex(kPair ? t.hulls : nullptr, kind_a, base_a, o.a, a);
      origin_a = a.p;
      const ConvexShape &first = exchanged ? b : a, &second = exchanged ? a : b;
      at_touch([&](Mask lanes) {
        if constexpr (N == 1) {
          collide_convex_point(t, first, nullptr, second, lanes, m);
        } else {
          collide_convex_pair(t, first, nullptr, second, lanes, m);
        }
        if (exchanged) exchange_sides(m);
      });
    }
    add_contact(t, g, w, pairs.list, pairs, m, active, code, list.key + i * kLanes, origin_a, b.p);
  }
}

inline void collide_convex(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  const ListId list = t.pair_class[w.class_index].list;
  list_candidates(t, w);
  if (is_multi(list)) {
    is_fixed(list) ? collide_convex_list<4, false>(t, g, w) : collide_convex_list<4, true>(t, g, w);
  } else {
    is_fixed(list) ? collide_convex_list<1, false>(t, g, w) : collide_convex_list<1, true>(t, g, w);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
