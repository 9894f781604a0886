// narrow_phase: runs a shape pair over the candidates of a class and hands the manifolds to
// prepare. The one place that connects pairs and lists.
#pragma once

#include "kernels/collide/at_touch.hpp"
#include "kernels/collide/box_box.hpp"
#include "kernels/collide/box_capsule.hpp"
#include "kernels/collide/box_round.hpp"
#include "kernels/collide/convex_list.hpp"
#include "kernels/collide/link_pairs.hpp"
#include "kernels/collide/polygon_pairs.hpp"
#include "kernels/collide/rectangle_rectangle.hpp"
#include "kernels/collide/row_builder.hpp"
#include "kernels/collide/tile.hpp"
#include "kernels/lane/ints.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

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
