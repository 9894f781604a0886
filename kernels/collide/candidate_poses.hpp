// Where the shapes of candidates are, and whether contacts are looked for at the moment of touch.
#pragma once

#include "kernels/collide/row_builder.hpp"
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

template <class S>
MW_INLINE bool searches_touch(const Constants& t, const Work& w, const RowBuilder<S>& rows) {
  const bool asked = w.recorder && !w.recorder->places;
  return t.seams && rows.velocity && !asked;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
