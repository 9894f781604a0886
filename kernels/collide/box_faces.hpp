// Face against face: an incident face is clipped against a reference face. Clipping has 12 fixed
// candidates, so every lane runs the same code: where each of the four incident edges enters and
// leaves the reference rectangle, and the four reference corners that lie inside the incident face.
// Candidates that do not exist get a separation out of reach. Four are kept: the deepest, the
// farthest from it, and the farthest to either side of that line.
#pragma once

#include "kernels/collide/box_box_axes.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kOutOfReach = Real(1e6);
// Share of an edge by which a corner may be outside and still count, so that rounding does not lose
// the corners of faces that coincide.
inline constexpr Real kEdgeSlack = sizeof(Real) == 4 ? Real(2e-6) : Real(1e-9);

// Candidate points over the reference face: x, y in it, z the height above it.
struct ClipPoints {
  static constexpr int kCount = 12;
  static constexpr int count() { return kCount; }
  Float x[kCount], y[kCount], z[kCount];
};

// Divisor that keeps its sign and never vanishes against what is usual for it.
MW_INLINE Float safe_divisor(Float a, Float usual) {
  const Float least = usual * (sizeof(Real) == 4 ? Real(1e-7) : Real(1e-13));
  return select(abs(a) < least, copysign(least, a), a);
}

// c, e1, e2: centre and half edges of the incident face in the reference frame (x, y, z).
MW_INLINE void clip_face(Vec3 c, Vec3 e1, Vec3 e2, Float half_x, Float half_y, ClipPoints& out) {
  const Float zero(Real(0)), one(Real(1)), two(Real(2)), out_of_reach(kOutOfReach);
  const Float inside = Real(1) + kEdgeSlack;  // corners on the very edge count
  const Vec3 corner[4] = {c + e1 + e2, c - e1 + e2, c - e1 - e2, c + e1 - e2};
  const Float size = half_x + half_y;
  const auto inverse = [&](Float edge) { return one / safe_divisor(edge * -two, size); };
  const Float inv_1x = inverse(e1.x), inv_1y = inverse(e1.y);
  const Float inv_2x = inverse(e2.x), inv_2y = inverse(e2.y);
  for (int i = 0; i < 4; ++i) {
    const bool along_1 = i % 2 == 0;  // corners go round: -2 e1, -2 e2, +2 e1, +2 e2
    const Float way = i < 2 ? -two : two;
    const Vec3 step = (along_1 ? e1 : e2) * way;
    Float inv_x = along_1 ? inv_1x : inv_2x, inv_y = along_1 ? inv_1y : inv_2y;
    if (i >= 2) inv_x = -inv_x, inv_y = -inv_y;
    // |corner.x + t step.x| <= half_x, the same in y.
    const Float mid_x = -(corner[i].x * inv_x), mid_y = -(corner[i].y * inv_y);
    const Float span_x = abs(half_x * inv_x), span_y = abs(half_y * inv_y);
    // Clamped to the edge, so that candidates that do not exist have harmless places.
    const Float enter = min(max(zero, max(mid_x - span_x, mid_y - span_y)), one);
    const Float leave = max(min(one, min(mid_x + span_x, mid_y + span_y)), zero);
    const Mask crosses = enter < leave;
    out.x[2 * i] = fma(step.x, enter, corner[i].x);
    out.y[2 * i] = fma(step.y, enter, corner[i].y);
    out.z[2 * i] = select(crosses, fma(step.z, enter, corner[i].z), out_of_reach);
    out.x[2 * i + 1] = fma(step.x, leave, corner[i].x);
    out.y[2 * i + 1] = fma(step.y, leave, corner[i].y);
    out.z[2 * i + 1] = select(crosses, fma(step.z, leave, corner[i].z), out_of_reach);
  }
  const Float inv_det = one / safe_divisor(fms(e1.x, e2.y, e1.y * e2.x), size * size);
  for (int i = 0; i < 4; ++i) {
    const Float x = i == 0 || i == 3 ? half_x : -half_x, y = i < 2 ? half_y : -half_y;
    const Float rx = x - c.x, ry = y - c.y;
    const Float s1 = fms(rx, e2.y, ry * e2.x) * inv_det, s2 = fms(e1.x, ry, e1.y * rx) * inv_det;
    const Mask covered = max(abs(s1), abs(s2)) < inside;
    out.x[8 + i] = x;
    out.y[8 + i] = y;
    out.z[8 + i] = select(covered, fma(e2.z, s2, fma(e1.z, s1, c.z)), out_of_reach);
  }
}

struct KeptPoints {
  Float x[4], y[4], z[4];
  Mask valid[4], guard[4];
};

// How far beyond the limit points are kept, in the size of the smaller face, and what they count
// against those within the margin of it, which count the less the nearer to it they are. Counted
// alike, far points above an edge that carries displaced its other corners, and what lay on the
// edge stood on other corners in every step.
inline constexpr Real kKeptBeyond = Real(1), kBeyondCounts = Real(1e-3);

// Points that are as far out, or as deep but for `level`, m, are told apart by their place and
// order: were it by rounding, what rests would stand on other points in every step, and creep.
inline constexpr Real kLevel = Real(1.0 / 64);  // of the margin
inline constexpr Real kClearlyMore = Real(1.001);

// extent2: of the smaller of the two faces, m^2; says what counts as a distance or an area.
template <class Points>
MW_INLINE void keep_four(Points& p, Float margin, Float level, Float extent2, KeptPoints& out) {
  const Float zero(Real(0)), one(Real(1)), clearly(kClearlyMore), size = sqrt(extent2);
  // Among equally deep points the farthest along a line: a corner, not the middle of an edge.
  const Float along_x = -(level / max(size, Real(1e-30))), along_y = along_x * Real(0.37);
  Float x = p.x[0], y = p.y[0], z = p.z[0];
  Float least_key = fma(y, along_y, fma(x, along_x, z));
  for (int i = 1; i < p.count(); ++i) {
    const Float key = fma(p.y[i], along_y, fma(p.x[i], along_x, p.z[i]));
    const Mask deeper = key < least_key;
    least_key = min(key, least_key);
    x = select(deeper, p.x[i], x), y = select(deeper, p.y[i], y), z = select(deeper, p.z[i], z);
  }
  // What is as near as the deepest point, or within the margin, may exert a force. What is not may
  // come down in the same step when the bodies turn about the deepest point.
  const Float limit = margin + max(z, zero);
  const Float beyond = fma(size, Float(kKeptBeyond), limit), per_margin = one / margin;
  out.x[0] = x, out.y[0] = y, out.z[0] = z;
  out.valid[0] = z < Float(kOutOfReach);
  const Float x0 = x, y0 = y;

  // From here on x, y are relative to the first point; what does not count collapses onto it.
  Float best = extent2 * Float(Real(2e-6)), far_x = zero, far_y = zero, far_z = Real(kOutOfReach);
  const auto counts = [&](Float height) __attribute__((always_inline)) {
    return min(max((limit - height) * per_margin, Float(kBeyondCounts)), one);
  };
  for (int i = 0; i < p.count(); ++i) {
    const Mask near = p.z[i] < beyond;
    p.x[i] = select(near, p.x[i], x0) - x0;
    p.y[i] = select(near, p.y[i], y0) - y0;
    const Float r2 = fma(p.x[i], p.x[i], p.y[i] * p.y[i]) * counts(p.z[i]);
    const Mask farther = best * clearly < r2;
    best = select(farther, r2, best);
    far_x = select(farther, p.x[i], far_x), far_y = select(farther, p.y[i], far_y);
    far_z = select(farther, p.z[i], far_z);
  }
  out.x[1] = far_x + x0, out.y[1] = far_y + y0, out.z[1] = far_z;
  out.valid[1] = far_z < beyond;

  Float most = extent2 * Float(Real(2e-5)), least = -most;
  Float left_x = zero, left_y = zero, left_z = Real(kOutOfReach);
  Float right_x = zero, right_y = zero, right_z = Real(kOutOfReach);
  for (int i = 0; i < p.count(); ++i) {
    const Float area = fms(far_x, p.y[i], far_y * p.x[i]) * counts(p.z[i]);
    const Mask is_left = most * clearly < area, is_right = area < least * clearly;
    most = select(is_left, area, most);
    left_x = select(is_left, p.x[i], left_x), left_y = select(is_left, p.y[i], left_y);
    left_z = select(is_left, p.z[i], left_z);
    least = select(is_right, area, least);
    right_x = select(is_right, p.x[i], right_x), right_y = select(is_right, p.y[i], right_y);
    right_z = select(is_right, p.z[i], right_z);
  }
  out.x[2] = left_x + x0, out.y[2] = left_y + y0, out.z[2] = left_z;
  out.valid[2] = left_z < beyond;
  out.x[3] = right_x + x0, out.y[3] = right_y + y0, out.z[3] = right_z;
  out.valid[3] = right_z < beyond;
  // Rows are solved in this order: the deepest comes first.
  for (int i = 1; i < 4; ++i) {
    const Mask deeper = out.valid[i] & (out.z[i] < out.z[0]);
    const auto swap = [&](Float * of) __attribute__((always_inline)) {
      const Float first = of[0];
      of[0] = select(deeper, of[i], first), of[i] = select(deeper, first, of[i]);
    };
    swap(out.x), swap(out.y), swap(out.z);
  }
  for (int i = 0; i < 4; ++i) out.guard[i] = out.valid[i] & (limit <= out.z[i]);
}

MW_INLINE BoxPose select(Mask m, const BoxPose& a, const BoxPose& b) {
  return {{select(m, a.r.x, b.r.x), select(m, a.r.y, b.r.y), select(m, a.r.z, b.r.z)},
          select(m, a.p, b.p),
          select(m, a.half, b.half),
          select(m, a.margin, b.margin)};
}

// Face of the box at +sign along `axis`, as a frame: n outward, u and v spanning it.
struct FaceFrame {
  Vec3 n, u, v;
  Float height, half_u, half_v;
};
MW_INLINE FaceFrame face_frame(const BoxPose& box, Float axis, Vec3 towards) {
  const Float zero(Real(0)), one(Real(1)), two(Real(2));
  const Float axis_u = select(axis == two, zero, axis + one);
  const Float axis_v = select(axis == zero, two, axis - one);
  const Vec3 along = pick(axis, box.r);
  const Float sign = copysign(one, dot(along, towards));
  return {along * sign,
          pick(axis_u, box.r),
          pick(axis_v, box.r),
          pick(axis, box.half.x, box.half.y, box.half.z),
          pick(axis_u, box.half.x, box.half.y, box.half.z),
          pick(axis_v, box.half.x, box.half.y, box.half.z)};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
