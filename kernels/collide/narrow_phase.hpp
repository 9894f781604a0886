// narrow_phase: runs a shape pair over the candidates of a class and hands the manifolds to
// prepare. The one place that connects pairs, layouts and lists.
#pragma once

#include "kernels/collide/box_box.hpp"
#include "kernels/collide/box_capsule.hpp"
#include "kernels/collide/box_round.hpp"
#include "kernels/collide/link_pairs.hpp"
#include "kernels/collide/polygon_pairs.hpp"
#include "kernels/collide/rectangle_rectangle.hpp"
#include "kernels/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Offsets of the pose rows of both shapes of a slot.
struct PoseOffsets {
  alignas(64) std::int32_t a[kLanes], b[kLanes];
};

template <bool kPair>
MW_INLINE PoseOffsets pose_offsets(const Tables& t, const Work& w, const std::int32_t* code) {
  PoseOffsets o;
  for (int l = 0; l < kLanes; ++l) {
    const std::int32_t a = code[l] & 0xffff, b = (code[l] >> 16) & 0xffff;
    o.a[l] = kPair ? w.pose_base[l] + t.collider_row[a] : t.fixed[a].row;
    o.b[l] = w.pose_base[l] + t.collider_row[b];
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

template <class S, class Pair, bool kPair, bool kDense>
void collide_list(const Tables& t, const Group& g, Work& w, const CandidateList& list) {
  const auto& pairs = t.pair_class[w.class_index];
  const Real* base_a = kPair ? w.pose_rows : t.fixed_rows;
  for (int i = 0; i < list.count; ++i) {
    const std::int32_t* code = list.code + i * kLanes;
    const PoseOffsets o = pose_offsets<kPair>(t, w, code);
    typename Pair::A a;
    typename Pair::B b;
    load_pose(base_a, o.a, a);
    load_pose(w.pose_rows, o.b, b);
    Manifold<S, Pair::kPoints> m;
    Pair::collide(t, a, b, Float::load(list.axis + i * kLanes), m);
    add_slot<S, Pair::kPoints, kPair, kDense>(t, g, w, pairs.list, pairs, m,
                                              mask_from_bits(list.mask[i]), code,
                                              list.key + i * kLanes, origin_of<S>(a), b.p);
  }
}

// Boxes first drop the candidates that a separating axis keeps apart.
template <bool kPair>
void find_axes(const Tables& t, Work& w) {
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

template <class S, class Pair, bool kDense>
void collide(const Tables& t, const Group& g, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  const bool fixed = is_fixed(t.pair_class[w.class_index].list);
  list_candidates(t, w);
  const CandidateList* list = &w.candidates;
  if constexpr (std::is_same_v<Pair, BoxBox<S>>) {
    fixed ? find_axes<false>(t, w) : find_axes<true>(t, w);
    list = &w.found;
  }
  if (fixed) {
    collide_list<S, Pair, false, kDense>(t, g, w, *list);
  } else if constexpr (!kOnlyFixed<Pair>) {
    collide_list<S, Pair, true, kDense>(t, g, w, *list);
  }
}

template <class S, bool kDense>
void fill_narrow_phase(kernels::Stage<Real>* out) {
  using kernels::PairKind;
  const auto at = [out](PairKind kind) -> kernels::Stage<Real>& {
    return out[static_cast<int>(kind)];
  };
  at(PairKind::plane_capsule) = collide<S, PlaneCapsule<S>, kDense>;
  if constexpr (S::kDim == 3) {
    at(PairKind::sphere_sphere) = collide<S, SphereSphere<S>, kDense>;
    at(PairKind::box_sphere) = collide<S, BoxSphere<S>, kDense>;
    at(PairKind::box_box) = collide<S, BoxBox<S>, kDense>;
    at(PairKind::plane_sphere) = collide<S, PlaneSphere<S>, kDense>;
    at(PairKind::plane_box) = collide<S, PlaneBox<S>, kDense>;
    at(PairKind::sphere_box) = collide<S, Reversed<S, BoxSphere<S>>, kDense>;
    using CapsuleSphere = CapsuleRound<S, SpherePose>;
    at(PairKind::capsule_sphere) = collide<S, CapsuleSphere, kDense>;
    at(PairKind::capsule_capsule) = collide<S, CapsuleCapsule<S>, kDense>;
    at(PairKind::box_capsule) = collide<S, BoxCapsule<S>, kDense>;
    at(PairKind::sphere_capsule) = collide<S, Reversed<S, CapsuleSphere>, kDense>;
    at(PairKind::capsule_box) = collide<S, Reversed<S, BoxCapsule<S>>, kDense>;
  } else {
    at(PairKind::circle_circle) = collide<S, CircleCircle<S>, kDense>;
    at(PairKind::rectangle_circle) = collide<S, RectangleCircle<S>, kDense>;
    at(PairKind::rectangle_rectangle) = collide<S, RectangleRectangle<S>, kDense>;
    at(PairKind::polygon_circle) = collide<S, PolygonCircle<S>, kDense>;
    at(PairKind::polygon_polygon) = collide<S, PolygonPolygon<S>, kDense>;
    at(PairKind::plane_circle) = collide<S, PlaneCircle<S>, kDense>;
    at(PairKind::plane_rectangle) = collide<S, PlaneRectangle<S>, kDense>;
    at(PairKind::plane_polygon) = collide<S, PlanePolygon<S>, kDense>;
    at(PairKind::circle_rectangle) = collide<S, Reversed<S, RectangleCircle<S>>, kDense>;
    at(PairKind::circle_polygon) = collide<S, Reversed<S, PolygonCircle<S>>, kDense>;
    using CapsuleCircle = CapsuleRound<S, CirclePose>;
    using RectangleCapsule = EdgesCapsule<S, RectanglePose>;
    using PolygonCapsule = EdgesCapsule<S, PolygonPose>;
    at(PairKind::capsule_circle) = collide<S, CapsuleCircle, kDense>;
    at(PairKind::capsule_capsule) = collide<S, EdgesCapsule<S, CapsulePose<Vec2>>, kDense>;
    at(PairKind::rectangle_capsule) = collide<S, RectangleCapsule, kDense>;
    at(PairKind::polygon_capsule) = collide<S, PolygonCapsule, kDense>;
    at(PairKind::circle_capsule) = collide<S, Reversed<S, CapsuleCircle>, kDense>;
    at(PairKind::capsule_rectangle) = collide<S, Reversed<S, RectangleCapsule>, kDense>;
    at(PairKind::capsule_polygon) = collide<S, Reversed<S, PolygonCapsule>, kDense>;
    at(PairKind::link_circle) = collide<S, LinkCircle<S>, kDense>;
    at(PairKind::link_rectangle) = collide<S, LinkEdges<S, RectanglePose>, kDense>;
    at(PairKind::link_polygon) = collide<S, LinkEdges<S, PolygonPose>, kDense>;
    at(PairKind::link_capsule) = collide<S, LinkEdges<S, CapsulePose<Vec2>>, kDense>;
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
