// The boxes around two shapes: along which of their 15 axes they are farthest apart. What they keep
// apart does not touch, and where they overlap least the search for a normal begins.
#pragma once

#include "kernels/shape/box.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct BoxAround {
  Vec3 p, half;
  Mat3 r;
};
MW_INLINE BoxAround box_around(const ConvexShape& s) {
  return {s.p, {s.half.x + s.radius, s.half.y + s.radius, s.half.z + s.radius}, s.r};
}

struct AxisOfBoxes {
  Vec3 normal;  // from A to B
  Float separation;
};

// Edge products as s |s| / |axis|^2, so that only the best needs a root. Nearly parallel edges are
// left to the faces.
MW_INLINE AxisOfBoxes find_axis_of_boxes(const BoxAround& a, const BoxAround& b) {
  const Vec3 ra[3] = {a.r.x, a.r.y, a.r.z}, rb[3] = {b.r.x, b.r.y, b.r.z};
  const Float ha[3] = {a.half.x, a.half.y, a.half.z}, hb[3] = {b.half.x, b.half.y, b.half.z};
  const Float one(Real(1)), never(Real(-1e30)), parallel(Real(1e-3));
  const Vec3 d = b.p - a.p;
  Float cosine[3][3], size[3][3], place[3];
  for (int i = 0; i < 3; ++i) {
    place[i] = dot(ra[i], d);
    for (int j = 0; j < 3; ++j) {
      cosine[i][j] = dot(ra[i], rb[j]);
      size[i][j] = abs(cosine[i][j]);
    }
  }
  const auto take = [](Vec3 axis, Float along, Float reach, Vec3& normal, Float& best) {
    const Float s = abs(along) - reach;
    normal = select(best < s, axis * copysign(Float(Real(1)), along), normal);
    best = max(s, best);
  };
  AxisOfBoxes out{ra[0], never};
  for (int i = 0; i < 3; ++i) {
    const Float reach = fma(hb[2], size[i][2], fma(hb[1], size[i][1], hb[0] * size[i][0]));
    take(ra[i], place[i], ha[i] + reach, out.normal, out.separation);
  }
  for (int j = 0; j < 3; ++j) {
    const Float reach = fma(ha[2], size[2][j], fma(ha[1], size[1][j], ha[0] * size[0][j]));
    take(rb[j], dot(rb[j], d), hb[j] + reach, out.normal, out.separation);
  }

  Float best_square = never, best_length2 = one;
  Vec3 best_axis = out.normal;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const Float along = fms(place[i2], cosine[i1][j], place[i1] * cosine[i2][j]);
      const Float reach =
          fma(hb[j2], size[i][j1],
              fma(hb[j1], size[i][j2], fma(ha[i2], size[i1][j], ha[i1] * size[i2][j])));
      const Float s = abs(along) - reach, length2 = fnma(cosine[i][j], cosine[i][j], one);
      const Float square = select(parallel < length2, s * abs(s), never);
      const Float safe = max(length2, parallel);
      const Mask better = best_square * safe < square * best_length2;
      best_square = select(better, square, best_square);
      best_length2 = select(better, safe, best_length2);
      best_axis = select(better, cross(ra[i], rb[j]) * copysign(one, along), best_axis);
    }
  }
  const Float edge = copysign(sqrt(abs(best_square) / best_length2), best_square);
  const Mask by_edge = out.separation < edge;
  out.normal = select(by_edge, best_axis * (one / sqrt(best_length2)), out.normal);
  out.separation = max(edge, out.separation);
  return out;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
