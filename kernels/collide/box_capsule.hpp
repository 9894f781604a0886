// Box against capsule. Where the axis is outside of the box, the normal is along the shortest line
// between the two; where it runs through the box, along the shallowest of three face normals and
// three products of the axis with an edge (faces win near ties).
//
// The distance from the box of the place t on the axis is a convex function; half the derivative of
// its square, sum over k of u_k out_k(t), is piecewise linear and never falls, with corners only
// where the axis crosses the planes of the faces. So its zero is found without a search: it lies
// between the last corner where it is not positive and the first where it is not negative.
//
// One point at that place, or two where the axis runs along a face or, within kParallel2, along an
// edge: at the ends of its stretch over that feature. Their features are their places on the axis.
#pragma once

#include "kernels/collide/box_box_axes.hpp"
#include "kernels/collide/capsule_capsule.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// A capsule's axis in the frame of a box: p + t u, |t| <= half.
struct LocalAxis {
  Vec3 p, u;
  Float half;
  Vec3 inv_u;
  MW_INLINE Vec3 at(Float t) const { return fma(u, t, p); }
};

MW_INLINE Float nonzero(Float a) {
  const Float least(sizeof(Real) == 4 ? Real(1e-7) : Real(1e-13));
  return copysign(max(abs(a), least), a);
}

MW_INLINE Vec3 outside_of(Vec3 half, Vec3 x) {
  return {x.x - clamp(x.x, -half.x, half.x), x.y - clamp(x.y, -half.y, half.y),
          x.z - clamp(x.z, -half.z, half.z)};
}

// The place on the axis nearest to the box; the middle of them where several are.
MW_INLINE Float nearest_place(Vec3 box, const LocalAxis& axis) {
  const Float zero(Real(0)), one(Real(1)), half(Real(0.5)), far(Real(1e30));
  const auto crossing = [&](Float p, Float side, Float inv) {
    return clamp((side - p) * inv, -axis.half, axis.half);
  };
  const Float corner[8] = {-axis.half,
                           axis.half,
                           crossing(axis.p.x, -box.x, axis.inv_u.x),
                           crossing(axis.p.x, box.x, axis.inv_u.x),
                           crossing(axis.p.y, -box.y, axis.inv_u.y),
                           crossing(axis.p.y, box.y, axis.inv_u.y),
                           crossing(axis.p.z, -box.z, axis.inv_u.z),
                           crossing(axis.p.z, box.z, axis.inv_u.z)};
  Float low = -far, low_slope = -far, high = far, high_slope = far;
  for (int i = 0; i < 8; ++i) {
    const Float slope = dot(axis.u, outside_of(box, axis.at(corner[i])));
    const Mask later = (slope <= zero) & (low < corner[i]);
    const Mask earlier = (zero <= slope) & (corner[i] < high);
    low = select(later, corner[i], low), low_slope = select(later, slope, low_slope);
    high = select(earlier, corner[i], high), high_slope = select(earlier, slope, high_slope);
  }
  // Flat between high and low, in that order, when both slopes vanish.
  const Float climb = high_slope - low_slope;
  const Mask steep = zero < climb;
  const Float share = select(steep, -low_slope / select(steep, climb, one), half);
  const Float between = clamp(fma(high - low, share, low), -axis.half, axis.half);
  // Rising or falling all the way.
  return select(low == -far, -axis.half, select(high == far, axis.half, between));
}

struct BoxAxis {
  Vec3 normal;  // from the box, its frame
  Float place;  // on the capsule's axis
  Mask edge;
};

// For an axis that runs through the box.
MW_INLINE BoxAxis shallowest_axis(const Constants& t, Vec3 box, const LocalAxis& axis) {
  const Float zero(Real(0)), one(Real(1)), usable(Real(1e-3));
  const auto face = [&](Float p, Float u, Float half) {
    return abs(p) - fma(axis.half, abs(u), half);
  };
  const Float sx = face(axis.p.x, axis.u.x, box.x), sy = face(axis.p.y, axis.u.y, box.y),
              sz = face(axis.p.z, axis.u.z, box.z);
  const Mask y_wins = sx < sy, z_wins = max(sx, sy) < sz;
  const Float best_face = max(max(sx, sy), sz);
  BoxAxis out;
  out.normal = select(z_wins, Vec3{zero, zero, copysign(one, axis.p.z)},
                      select(y_wins, Vec3{zero, copysign(one, axis.p.y), zero},
                             Vec3{copysign(one, axis.p.x), zero, zero}));
  out.place = zero;
  out.edge = zero < zero;
  Float best = best_face + Float(t.face_bias);
  const auto try_edge = [&](Vec3 product, Float px, Float py, Float ux, Float uy) {
    const Float l2 = dot(product, product);
    const Mask real = usable < l2;
    const Vec3 n = product * (one / sqrt(select(real, l2, one)));
    const Float along = dot(n, axis.p);
    const Float s = abs(along) - fma(abs(n.z), box.z, fma(abs(n.y), box.y, abs(n.x) * box.x));
    const Mask better = real & (best < s);
    const Vec3 oriented = n * copysign(one, along);
    best = select(better, s, best);
    out.normal = select(better, oriented, out.normal);
    out.edge = out.edge | better;
    // Nearest to the edge, seen along it; px, py are from the edge.
    const Float nearest = -fma(ux, px, uy * py) / max(fma(ux, ux, uy * uy), usable);
    out.place = select(better, clamp(nearest, -axis.half, axis.half), out.place);
  };
  // The edge that the normal points past has the signs of the normal in the other two coordinates.
  const auto side = [&](Float n, Float along, Float half) {
    return copysign(half, n * copysign(one, along));
  };
  {
    const Vec3 n{zero, -axis.u.z, axis.u.y};
    const Float along = dot(n, axis.p);
    try_edge(n, axis.p.y - side(n.y, along, box.y), axis.p.z - side(n.z, along, box.z), axis.u.y,
             axis.u.z);
  }
  {
    const Vec3 n{axis.u.z, zero, -axis.u.x};
    const Float along = dot(n, axis.p);
    try_edge(n, axis.p.x - side(n.x, along, box.x), axis.p.z - side(n.z, along, box.z), axis.u.x,
             axis.u.z);
  }
  {
    const Vec3 n{-axis.u.y, axis.u.x, zero};
    const Float along = dot(n, axis.p);
    try_edge(n, axis.p.x - side(n.x, along, box.x), axis.p.y - side(n.y, along, box.y), axis.u.x,
             axis.u.y);
  }
  return out;
}

template <class S>
struct BoxCapsule {
  using A = BoxPose;
  using B = CapsulePose<Vec3>;
  static constexpr int kPoints = 4;
  static MW_INLINE void collide(const Constants& t, const A& a, const B& b, Float,
                                Manifold<S, 4>& m) {
    const Float zero(Real(0)), one(Real(1));
    const Vec3 d = b.p - a.p;
    LocalAxis axis{mul_transposed(a.r, d), mul_transposed(a.r, b.axis), b.half, {}};
    axis.inv_u = {one / nonzero(axis.u.x), one / nonzero(axis.u.y), one / nonzero(axis.u.z)};

    Float place = nearest_place(a.half, axis);
    const Vec3 out = outside_of(a.half, axis.at(place));
    const Float out2 = dot(out, out);
    // Nearer than this the direction is mostly rounding.
    const Float touching = dot(a.half, a.half) * (sizeof(Real) == 4 ? Real(1e-10) : Real(1e-24));
    const Mask outside = touching < out2;
    Vec3 n = out * (one / sqrt(select(outside, out2, one)));
    Mask through_edge = zero < zero;
    if (!all(outside)) {
      const BoxAxis inside = shallowest_axis(t, a.half, axis);
      n = select(outside, n, inside.normal);
      place = select(outside | !inside.edge, place, inside.place);
      through_edge = !outside & inside.edge;
    }

    // Over a face the normal has one coordinate, over an edge two. Along the others the feature is
    // as wide as the box.
    const Float flat(Real(1e-3));
    const Mask free_x = abs(n.x) < flat, free_y = abs(n.y) < flat, free_z = abs(n.z) < flat;
    const Float parallel(Real(1) - kParallel2);
    const Mask along_edge = (free_x & (parallel < square(axis.u.x))) |
                            (free_y & (parallel < square(axis.u.y))) |
                            (free_z & (parallel < square(axis.u.z)));
    const Mask face = (free_x & free_y) | (free_y & free_z) | (free_z & free_x);
    Float low = -b.half, high = b.half;
    const auto clip = [&](Mask clipped, Float p, Float inv, Float half) {
      const Float middle = -(p * inv), span = abs(half * inv);
      low = select(clipped, max(low, middle - span), low);
      high = select(clipped, min(high, middle + span), high);
    };
    clip(free_x, axis.p.x, axis.inv_u.x, a.half.x);
    clip(free_y, axis.p.y, axis.inv_u.y, a.half.y);
    clip(free_z, axis.p.z, axis.inv_u.z, a.half.z);
    const Mask two = (face | along_edge) & !through_edge & (low < high);

    m.normal = mul(a.r, n);
    m.tangent = tangent_along(b.axis, m.normal);
    const Float height = fma(abs(n.z), a.half.z, fma(abs(n.y), a.half.y, abs(n.x) * a.half.x));
    const Float at[2] = {select(two, low, place), select(two, high, place)};
    for (int i = 0; i < 2; ++i) {
      const Vec3 q = axis.at(at[i]);
      const Float gap = dot(n, q) - height;
      put_point(m, i, mul(a.r, fnma(n, gap, q)), zero, gap - b.radius, d);
      m.feature_x[i] = at[i];
      m.feature_y[i] = zero;
    }
    const Float limit = Float(t.margin) + max(min(m.separation[0], m.separation[1]), zero);
    m.valid[0] = m.separation[0] < limit;
    const Mask second = two & (m.separation[1] < limit);
    leave_out_points(m, 2);
    m.valid[1] = second;
    // Which face, edge or corner: 0, 1 or 2 for each coordinate of the normal.
    const auto sign_of = [&](Float x, Mask free) {
      return select(free, zero, select(zero < x, one, Float(Real(2))));
    };
    const Float three(Real(3));
    m.code =
        fma(fma(sign_of(n.z, free_z), three, sign_of(n.y, free_y)), three, sign_of(n.x, free_x)) +
        select(two, Float(Real(27)), zero);
    m.match_distance2 = select(two, match_distance2(b.half), square(b.half + b.half));
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
