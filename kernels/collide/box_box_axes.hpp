// Box against box, first half: the separating-axis test over 3 + 3 face normals and 9 edge
// products. Returns the largest separation and the axis that has it:
//   0..2 face of A, 3..5 face of B, 6 + 3 i + j edge i of A x edge j of B
// Faces win near ties: a face of A over one of B by face_tie, a face over an edge by 5 % of the
// depth and face_bias, so that resting contacts do not flicker between descriptions.
#pragma once

#include "kernels/collide/plane_box.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct BoxAxes {
  Float separation, axis;
};

MW_INLINE BoxAxes find_box_axes(const Constants& t, const BoxPose& a, const BoxPose& b) {
  const Vec3 ra[3] = {a.r.x, a.r.y, a.r.z}, rb[3] = {b.r.x, b.r.y, b.r.z};
  const Float ha[3] = {a.half.x, a.half.y, a.half.z}, hb[3] = {b.half.x, b.half.y, b.half.z};
  const Vec3 d = b.p - a.p;
  const Float zero(Real(0)), one(Real(1)), never(Real(-1e9));
  Float c[3][3], q[3][3], p[3];
  for (int i = 0; i < 3; ++i) {
    p[i] = dot(ra[i], d);
    for (int j = 0; j < 3; ++j) {
      c[i][j] = dot(ra[i], rb[j]);
      q[i][j] = abs(c[i][j]);
    }
  }

  Float best_a = never, axis_a = zero;
  for (int i = 0; i < 3; ++i) {
    const Float s =
        abs(p[i]) - fma(hb[2], q[i][2], fma(hb[1], q[i][1], fma(hb[0], q[i][0], ha[i])));
    const Mask better = best_a < s;
    best_a = max(s, best_a);
    axis_a = select(better, Float(static_cast<Real>(i)), axis_a);
  }
  Float best_b = never, axis_b = zero;
  for (int j = 0; j < 3; ++j) {
    const Float along = fma(p[2], c[2][j], fma(p[1], c[1][j], p[0] * c[0][j]));
    const Float s =
        abs(along) - fma(ha[2], q[2][j], fma(ha[1], q[1][j], fma(ha[0], q[0][j], hb[j])));
    const Mask better = best_b < s;
    best_b = max(s, best_b);
    axis_b = select(better, Float(static_cast<Real>(3 + j)), axis_b);
  }
  const Float bias(t.face_bias);
  const Mask face_b = (best_a + Float(t.face_tie) < best_b) | (max(best_a, zero) < best_b);
  const Float face = select(face_b, best_b, best_a);
  Float axis = select(face_b, axis_b, axis_a);

  // Edges: separation s / |axis|, compared through s |s| / |axis|^2 so that only the winner needs
  // a root. Nearly parallel edges are left to the faces.
  const Float parallel(Real(0.01));
  Float best_s2 = Real(-1e12), best_l2 = one, axis_e = Real(6);
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const Float along = abs(fms(p[i2], c[i1][j], p[i1] * c[i2][j]));
      const Float s = along - fma(hb[j2], q[i][j1],
                                  fma(hb[j1], q[i][j2], fma(ha[i2], q[i1][j], ha[i1] * q[i2][j])));
      const Float l2 = fnma(c[i][j], c[i][j], one);
      const Mask usable = parallel < l2;
      const Float s2 = select(usable, s * abs(s), Real(-1e12));
      const Float safe = max(l2, parallel);
      const Mask better = best_s2 * safe < s2 * best_l2;
      best_s2 = select(better, s2, best_s2);
      best_l2 = select(better, safe, best_l2);
      axis_e = select(better, Float(static_cast<Real>(6 + 3 * i + j)), axis_e);
    }
  }
  const Float edge = copysign(sqrt(abs(best_s2) / best_l2), best_s2);
  // In overlap an edge must be clearly shallower than the face; apart it must be truly farther.
  const Mask use_edge =
      (fma(face, Real(0.95), bias) < edge) & ((edge <= zero) | (max(face, zero) < edge));
  return {select(use_edge, edge, face), select(use_edge, axis_e, axis)};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
