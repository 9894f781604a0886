// narrow_phase: runs a shape pair over the candidates of a class and hands the manifolds to
// prepare. The one place that connects pairs and lists.
#pragma once

#include "kernels/collide/at_touch.hpp"
#include "kernels/collide/box_box.hpp"
#include "kernels/collide/box_capsule.hpp"
#include "kernels/collide/box_round.hpp"
#include "kernels/collide/convex.hpp"
#include "kernels/collide/link_pairs.hpp"
#include "kernels/collide/polygon_pairs.hpp"
#include "kernels/collide/rectangle_rectangle.hpp"
#include "kernels/collide/row_builder.hpp"
#include "kernels/collide/tile.hpp"
#include "kernels/lane/ints.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Offsets of the pose rows of both shapes of a block; of a fixed A in the rows of fixed shapes.
struct PoseOffsets {
  alignas(64) std::int32_t a[kLanes], b[kLanes];
};

template <bool kPair>
MW_INLINE PoseOffsets pose_offsets(const Constants& t, const Work& w, const std::int32_t* code) {
  PoseOffsets o;
  const Ints shapes = Ints::load(code), base = Ints::load(w.pose_base);
  (base + gather(t.collider_row, high_half(shapes))).store(o.b);
  if constexpr (kPair) {
    (base + gather(t.collider_row, low_half(shapes))).store(o.a);
  } else {
    constexpr auto kStride = static_cast<std::int32_t>(sizeof(*t.fixed) / sizeof(std::int32_t));
    gather(&t.fixed->row, low_half(shapes) * Ints(kStride)).store(o.a);
  }
  return o;
}

// Planes are fixed and have no origin that anchors are measured from.
template <class S, class Pose>
MW_INLINE typename S::Vec origin_of(const Pose& pose) {
  if constexpr (std::is_same_v<Pose, PlanePose>) {
    return zero_of<typename S::Vec>();
  } else {
    return pose.p;
  }
}

// Whether the contacts with a fixed A are those of the moment of touch (at_touch.hpp). A plane has
// one normal, and balls against balls have a closed form (rows/touch.hpp).
template <class Pose>
inline constexpr bool kIsBall =
    std::is_same_v<Pose, SpherePose> || std::is_same_v<Pose, CirclePose>;
template <class Pair>
inline constexpr bool kTurnsToTouch = !std::is_same_v<typename Pair::A, PlanePose> &&
                                      !(kIsBall<typename Pair::A> && kIsBall<typename Pair::B>);

template <class S>
MW_INLINE bool searches_touch(const Constants& t, const Work& w, const RowBuilder<S>& rows) {
  const bool asked = w.recorder && !w.recorder->places;
  return t.seams && rows.velocity && !asked;
}

// Not inlined, since it runs for few contacts.
inline __attribute__((noinline)) Float axis_of_boxes(const Constants& t, const BoxPose& a,
                                                     const BoxPose& b) {
  return find_box_axes(t, a, b).axis;
}

template <class S, class Pair, bool kPair>
void collide_list(const Constants& t, const Group& g, Work& w, const CandidateList& list) {
  const RowBuilder<S> rows = row_builder<S>(t, w);
  AddContact<S, Pair::kPoints>* const add_contact = rows.template add<Pair::kPoints>(kPair);
  const auto& pairs = t.pair_class[w.class_index];
  const Real* base_a = kPair ? w.pose_rows : t.fixed_rows;
  constexpr bool kSearches = !kPair && kTurnsToTouch<Pair>;
  const bool search = kSearches && searches_touch(t, w, rows);
  for (int i = 0; i < list.count; ++i) {
    const std::int32_t* code = list.code + i * kLanes;
    const PoseOffsets o = pose_offsets<kPair>(t, w, code);
    typename Pair::A a;
    typename Pair::B b;
    load_pose(base_a, o.a, a);
    load_pose(w.pose_rows, o.b, b);
    Manifold<S, Pair::kPoints> m;
    Float axis = Float::load(list.axis + i * kLanes);
    const Mask active = mask_from_bits(list.mask[i]);
    typename Pair::B moved = b;
    [[maybe_unused]] TouchSearch<S, Pair::kPoints> touch;
    if (search) {
      touch.start(t, rows.velocity(t, w, code, b.p), active, kIsBall<typename Pair::B>);
    }
    for (;;) {
      Pair::collide(t, a, moved, axis, m);
      if constexpr (kSearches) {
        if (search && touch.go_on(m)) {
          moved.p = b.p + touch.way();
          if constexpr (std::is_same_v<Pair, BoxBox<S>>) axis = axis_of_boxes(t, a, moved);
          continue;
        }
      }
      break;
    }
    add_contact(t, g, w, pairs.list, pairs, m, active, code, list.key + i * kLanes, origin_of<S>(a),
                b.p);
  }
}

// Boxes first drop the candidates that a separating axis keeps apart.
template <bool kPair>
void find_axes(const Constants& t, Work& w) {
  const Real* base_a = kPair ? w.pose_rows : t.fixed_rows;
  CandidateList& list = w.candidates;
  for (int i = 0; i < list.count; ++i) {
    const PoseOffsets o = pose_offsets<kPair>(t, w, list.code + i * kLanes);
    BoxPose a, b;
    load_pose(base_a, o.a, a);
    load_pose(w.pose_rows, o.b, b);
    const BoxAxes found = find_box_axes(t, a, b);
    found.axis.store(list.axis + i * kLanes);
    const Mask near = found.separation < a.margin + b.margin;
    w.keep[i] = bits(near) & list.mask[i];
  }
  compact(t, w, list, w.keep, w.found);
}

// Shape pairs whose A is always fixed.
template <class Pair>
inline constexpr bool kOnlyFixed =
    std::is_same_v<typename Pair::A, PlanePose> || std::is_same_v<typename Pair::A, LinkPose>;
template <class S, class Reverse>
inline constexpr bool kOnlyFixed<Reversed<S, Reverse>> = true;

template <class S, class Pair>
void collide(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  const bool fixed = is_fixed(t.pair_class[w.class_index].list);
  list_candidates(t, w);
  const CandidateList* list = &w.candidates;
  if constexpr (std::is_same_v<Pair, BoxBox<S>>) {
    fixed ? find_axes<false>(t, w) : find_axes<true>(t, w);
    list = &w.found;
  }
  if (fixed) {
    collide_list<S, Pair, false>(t, g, w, *list);
  } else if constexpr (!kOnlyFixed<Pair>) {
    collide_list<S, Pair, true>(t, g, w, *list);
  }
}

// ---- pairs of the general method
// -----------------------------------------------------------------

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
  const CandidateList& list = w.candidates;
  const bool exchanged = has_radius(kind_a);  // the method wants what is round as B
  const RowBuilder<Isotropic> rows = row_builder<Isotropic>(t, w);
  AddContact<Isotropic, N>* const add_contact = rows.template add<N>(kPair);
  const bool search = !kPair && searches_touch(t, w, rows);
  ConvexShape a, b;
  for (int i = 0; i < list.count; ++i) {
    if (list.mask[i] == 0) continue;  // its lanes had too many candidates
    const std::int32_t* code = list.code + i * kLanes;
    PoseOffsets o = pose_offsets<kPair>(t, w, code);
    // Lanes without a candidate point at some fixed shape, of another kind perhaps: they look at
    // that of a lane that has one.
    const int candidate = __builtin_ctz(list.mask[i]);
    for (int l = 0; !kPair && l < kLanes; ++l) {
      if (((list.mask[i] >> l) & 1u) == 0) o.a[l] = o.a[candidate];
    }
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

template <class S>
void fill_narrow_phase(kernels::Stage<Real>* out) {
  using K = kernels::ShapeKind;
  const auto at = [out](K a, K b) -> kernels::Stage<Real>& {
    return out[static_cast<int>(kernels::pair_of(a, b))];
  };
  at(K::plane, K::capsule) = collide<S, PlaneCapsule<S>>;
  if constexpr (S::kDim == 3) {
    at(K::sphere, K::sphere) = collide<S, SphereSphere<S>>;
    at(K::box, K::sphere) = collide<S, BoxSphere<S>>;
    at(K::box, K::box) = collide<S, BoxBox<S>>;
    at(K::plane, K::sphere) = collide<S, PlaneSphere<S>>;
    at(K::plane, K::box) = collide<S, PlaneBox<S>>;
    at(K::sphere, K::box) = collide<S, Reversed<S, BoxSphere<S>>>;
    using CapsuleSphere = CapsuleRound<S, SpherePose>;
    at(K::capsule, K::sphere) = collide<S, CapsuleSphere>;
    at(K::capsule, K::capsule) = collide<S, CapsuleCapsule<S>>;
    at(K::box, K::capsule) = collide<S, BoxCapsule<S>>;
    at(K::sphere, K::capsule) = collide<S, Reversed<S, CapsuleSphere>>;
    at(K::capsule, K::box) = collide<S, Reversed<S, BoxCapsule<S>>>;
    // Whatever has a shape that only the general method knows.
    for (int i = 0; i < kernels::kPairKinds; ++i) {
      const auto kind = static_cast<kernels::PairKind>(i);
      const auto &a = info(shape_a(kind)), &b = info(shape_b(kind));
      if (a.planar || b.planar || b.ground) continue;
      if (a.general || b.general || is_tile(kind)) out[i] = collide_convex;
    }
  } else {
    at(K::circle, K::circle) = collide<S, CircleCircle<S>>;
    at(K::rectangle, K::circle) = collide<S, RectangleCircle<S>>;
    at(K::rectangle, K::rectangle) = collide<S, RectangleRectangle<S>>;
    at(K::polygon, K::circle) = collide<S, PolygonCircle<S>>;
    at(K::polygon, K::polygon) = collide<S, PolygonPolygon<S>>;
    at(K::plane, K::circle) = collide<S, PlaneCircle<S>>;
    at(K::plane, K::rectangle) = collide<S, PlaneRectangle<S>>;
    at(K::plane, K::polygon) = collide<S, PlanePolygon<S>>;
    at(K::circle, K::rectangle) = collide<S, Reversed<S, RectangleCircle<S>>>;
    at(K::circle, K::polygon) = collide<S, Reversed<S, PolygonCircle<S>>>;
    using CapsuleCircle = CapsuleRound<S, CirclePose>;
    using RectangleCapsule = EdgesCapsule<S, RectanglePose>;
    using PolygonCapsule = EdgesCapsule<S, PolygonPose>;
    at(K::capsule, K::circle) = collide<S, CapsuleCircle>;
    at(K::capsule, K::capsule) = collide<S, EdgesCapsule<S, CapsulePose<Vec2>>>;
    at(K::rectangle, K::capsule) = collide<S, RectangleCapsule>;
    at(K::polygon, K::capsule) = collide<S, PolygonCapsule>;
    at(K::circle, K::capsule) = collide<S, Reversed<S, CapsuleCircle>>;
    at(K::capsule, K::rectangle) = collide<S, Reversed<S, RectangleCapsule>>;
    at(K::capsule, K::polygon) = collide<S, Reversed<S, PolygonCapsule>>;
    using RoundedCapsule = EdgesCapsule<S, RoundedPose>;
    at(K::plane, K::rounded) = collide<S, PlaneOutline<S, RoundedPose>>;
    at(K::rounded, K::circle) = collide<S, RoundedCircle<S>>;
    at(K::rounded, K::rounded) = collide<S, RoundEdges<S, RoundedPose, RoundedPose>>;
    at(K::rounded, K::capsule) = collide<S, RoundedCapsule>;
    at(K::circle, K::rounded) = collide<S, Reversed<S, RoundedCircle<S>>>;
    at(K::capsule, K::rounded) = collide<S, Reversed<S, RoundedCapsule>>;
    at(K::link, K::rounded) = collide<S, LinkEdges<S, RoundedPose>>;
    at(K::link, K::circle) = collide<S, LinkCircle<S>>;
    at(K::link, K::rectangle) = collide<S, LinkEdges<S, RectanglePose>>;
    at(K::link, K::polygon) = collide<S, LinkEdges<S, PolygonPose>>;
    at(K::link, K::capsule) = collide<S, LinkEdges<S, CapsulePose<Vec2>>>;
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
