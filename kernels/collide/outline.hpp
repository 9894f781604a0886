// The outline of a face or an edge, in the frame of a face: what manifolds of convex shapes are
// clipped from (collide_convex.cpp).
#pragma once

#include "kernels/collide/box_faces.hpp"
#include "kernels/collide/convex.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Share of the faces' bias (half a slop) that the deepest point may be deeper than those of a face
// and be left out: manifolds of bodies that sway a little stay the same.
inline constexpr Real kClearly = Real(0.2);

// Candidate points over the reference face, as ClipPoints; each edge gives two, each corner one.
struct Clipped {
  static constexpr int kMaxPoints = 3 * kMaxCorners + 1;
  int size = 0;
  Float x[kMaxPoints], y[kMaxPoints], z[kMaxPoints];
  MW_INLINE int count() const { return size; }
  MW_INLINE void add(Float px, Float py, Float pz) {
    x[size] = px, y[size] = py, z[size] = pz;
    ++size;
  }
};

// A face as a frame: origin on it at the shape's p moved along the normal.
struct Frame {
  Vec3 n, u, v;
  Float height;  // of the face above p, along n
  MW_INLINE Vec3 local(Vec3 p) const { return {dot(u, p), dot(v, p), dot(n, p) - height}; }
};
MW_INLINE Frame frame_of(Vec3 n, Vec3 along, Float height) {
  const Vec3 out = fnma(n, dot(n, along), along);
  const Float l2 = dot(out, out);
  const Mask real = Float(Real(1e-4)) < l2;
  const Float one(Real(1));
  const Vec3 u = select(real, out * (one / sqrt(select(real, l2, one))), any_tangent(n));
  return {n, u, cross(n, u), height};
}

struct Outline {
  int count;
  Vec3 corner[kMaxCorners];  // in a frame
  Vec3 middle;
  Float extent2;  // squared distance of the farthest corner from the middle
  bool disc;      // a cylinder's cap: all within the radius of the middle
  Float radius;
};
inline void bring(const Frame& frame, const ConvexShape& shape, const Feature& f, Vec3 shift,
                  Outline& out) {
  out.count = f.count;
  out.disc = shape.kind == kernels::ShapeKind::cylinder;
  out.radius = shape.half.x;
  // Of the bounds, which corners that are repeated leave alone: how many there are depends on the
  // other lanes.
  const Float far(Real(1e30));
  Vec3 low{far, far, far}, high = -low;
  for (int i = 0; i < f.count; ++i) {
    const Vec3 c = frame.local(f.corner[i] + shift);
    out.corner[i] = c;
    low = {min(c.x, low.x), min(c.y, low.y), min(c.z, low.z)};
    high = {max(c.x, high.x), max(c.y, high.y), max(c.z, high.z)};
  }
  out.middle = (low + high) * Float(Real(0.5));
  out.extent2 = Real(0);
  for (int i = 0; i < f.count; ++i) {
    const Vec3 r = out.corner[i] - out.middle;
    out.extent2 = max(fma(r.x, r.x, r.y * r.y), out.extent2);
  }
}

// Side i of an outline: how far a point is outside of it, times the length of the side.
struct Side {
  Float nx, ny, offset;
  MW_INLINE Float outside(Float x, Float y) const { return fma(nx, x, fms(ny, y, offset)); }
};
MW_INLINE Side side_of(const Outline& o, int i, Float slack) {
  const Vec3 a = o.corner[i], b = o.corner[i + 1 < o.count ? i + 1 : 0];
  const Float nx = b.y - a.y, ny = a.x - b.x;
  // A little wider than the face, so that corners on its very edge are inside whatever rounding
  // says.
  const Float length = sqrt(fma(nx, nx, ny * ny));
  return {nx, ny, fma(nx, a.x, fma(ny, a.y, slack * length))};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
