// Sweeps of one shape against another: see cast.hpp.
//
// Along the path a share of the step is known to be free, and perhaps a larger one that is not. The
// next share to look at: of the motion along the normal what the gap leaves, of the rotation a part
// of a radian, whatever that does to the gap. When shapes overlap there, the first touch is between
// the two shares. The separation along any normal is a lower bound, so shares that count as free
// are.
#include "kernels/collide/cast.hpp"

#include "kernels/collide/convex.hpp"
#include "kernels/data/pair_keys.hpp"
#include "kernels/work/half_turn.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

constexpr int kCastRounds = 64;
constexpr Real kCastTurn = Real(0.25);  // rad from one look to the next
// Shares of its half thickness by which a touching shape may sink, and a deeper one per pass.
constexpr Real kSink = Real(0.2), kSinkOn = Real(0.05);
constexpr Real kCore = Real(0.5);    // radius of the ball in a jointed body, of its half thickness
constexpr Real kPoint = Real(0.01);  // of a shape: so small a copy shows where its inside is

// Corners with a radius around them, in the plane, as a flat polyhedron about the origin. A tile's
// face is one of its sides.
template <class FlatCorners>
void put_flat(const FlatCorners& corners, Float radius, ConvexShape& s) {
  const Float zero(Real(0)), one(Real(1));
  s.kind = kernels::ShapeKind::tile;
  s.margin = zero;
  s.r = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
  s.vertices = corners.kCount;
  s.radius = radius;
  s.face_normal = in_space(corners.normal[0]);
  Float size2 = zero;
  for (int i = 0; i < corners.kCount; ++i) {
    s.vertex[i] = in_space(corners.vertex[i]);
    size2 = max(size2, dot(s.vertex[i], s.vertex[i]));
  }
  s.half = {sqrt(size2), zero, zero};
}
void load_flat(kernels::ShapeKind kind, const Real* base, const std::int32_t* at, ConvexShape& s) {
  const Float zero(Real(0)), one(Real(1));
  const auto load = [&](const auto& pose) {
    s.p = in_space(pose.p);
    if constexpr (requires { load_corners(pose); }) {
      put_flat(load_corners(pose), radius_of(pose), s);
    } else if constexpr (requires { pose.radius; }) {
      put_flat(Corners<1>{{{zero, zero}}, {{one, zero}}}, pose.radius, s);
    } else {
      const Vec2 end = pose.axis * pose.half, left = across(pose.axis);
      put_flat(Corners<2>{{end, -end}, {left, -left}}, zero, s);
    }
  };
  visit_pose(PlanarShapes{}, kind, base, at, nullptr, load) ||
      visit_pose(ShapeList<LinkPose>{}, kind, base, at, nullptr, load);
}

void load_plane(const Real* base, const std::int32_t* at, ConvexShape& s) {
  PlanePose plane;
  load_pose(base, at, plane);
  s.kind = kernels::ShapeKind::plane;
  s.face_normal = plane.normal;
  s.p = plane.normal * plane.offset;
  s.radius = s.margin = Real(0);
}

void load_any(const Constants& t, const Real* hulls, kernels::ShapeKind kind, const Real* base,
              const std::int32_t* at, ConvexShape& s) {
  if (kind == kernels::ShapeKind::plane) {
    load_plane(base, at, s);
  } else if (t.dimension == kernels::Dimension::planar) {
    load_flat(kind, base, at, s);
  } else {
    load_convex(hulls, kind, base, at, s);
  }
}

// A point inside, about which a shape is made smaller. The middle of a hull's bounds may be outside
// of it, the mean of its corners is not.
Vec3 inside_of(const ConvexShape& s) {
  if (s.kind != kernels::ShapeKind::hull) return s.p;
  alignas(64) Real counts[kLanes];
  for (int l = 0; l < kLanes; ++l) counts[l] = static_cast<Real>(s.hull.corners[l]);
  const Float count = Float::load(counts);
  Vec3 sum = zero_of<Vec3>();
  for (int i = 0; i < s.hull.most_corners; ++i) {
    // Lanes with fewer corners repeat the last one.
    const Vec3 corner = placed_corner(s, corner_of(s.hull, i));
    sum = select(Float(static_cast<Real>(i)) < count, sum + corner, sum);
  }
  return fma(sum, Float(Real(1)) / max(count, Real(1)), s.p);
}

// `shape` smaller by `scale` about `centre`, where its body takes it at a share of the step.
void place(const ConvexShape& shape, const CastMotion& m, Vec3 centre, Float scale, Float share,
           ConvexShape& out) {
  const Float zero(Real(0)), one(Real(1));
  const Quat now = rotate_by({one, zero, zero, zero}, -m.ahead);
  const Mat3 r = matrix(rotate_by(now, m.turn * share));
  out.p = fma(m.step, share, m.from) + mul(r, fma(shape.p - centre, scale, centre - m.from));
  out.r = {mul(r, shape.r.x), mul(r, shape.r.y), mul(r, shape.r.z)};
  out.half = shape.half * scale;
  out.radius = shape.radius * scale;
  out.face_normal = mul(r, shape.face_normal);
  for (int i = 0; i < shape.vertices; ++i) out.vertex[i] = mul(r, shape.vertex[i]) * scale;
}

struct Gap {
  Vec3 normal;  // from the wall
  Float gap;
};
Gap gap_of(const Constants& t, const ConvexShape& wall, ConvexShape& shape, Float far,
           Mask active) {
  if (wall.kind == kernels::ShapeKind::plane) {
    const Vec3 n = wall.face_normal;
    return {n, dot(n, shape.p - wall.p) + extent_along(shape, n, mask_from_bits(kAllLanes)).low -
                   shape.radius};
  }
  shape.margin = far + wall.radius + shape.radius;
  ConvexAxis axis;
  find_convex_axis(t, wall, shape, active, axis);
  return {axis.normal, axis.separation - wall.radius - shape.radius};
}

struct Sweep {
  const Constants& t;
  const CastMotion& motion;
  Float way, turn;   // |step|, |turn|
  Float arm;         // how fast the body's reach along a fixed direction changes as it turns, m
  Float near, core;  // m
};

// Share of the motion of a shape before it touches the wall. Lanes beyond `through` are left out if
// the shape touches already.
Float free_share(const Sweep& s, const ConvexShape& wall, const ConvexShape& shape, Vec3 centre,
                 Mask fast, Mask through, Mask held) {
  const Float zero(Real(0)), one(Real(1)), tiny(Real(1e-30));
  const CastMotion& m = s.motion;
  const Float far = fma(s.arm, s.turn, s.way) + s.near;
  const bool below = wall.kind == kernels::ShapeKind::plane;
  ConvexShape now = shape;
  place(shape, m, centre, one, zero, now);
  Gap at = gap_of(s.t, wall, now, far, fast);
  Mask moving = fast & (at.gap < far) & (through | (s.near < at.gap));
  if (!any(moving)) return one;
  Float scale = one, near = s.near;
  // Against what is solid below contacts look ahead, and sweeps are for what they miss.
  const Mask touches = moving & ((at.gap <= s.near) | held | mask_from_bits(below ? kAllLanes : 0));
  if (any(touches)) {
    place(shape, m, centre, kPoint, zero, now);
    const Gap point = gap_of(s.t, wall, now, far, touches);
    const Float low_end =
        extent_along(now, point.normal, mask_from_bits(kAllLanes)).low - now.radius;
    const Vec3 inside =
        m.from + rotate(rotate_by({one, zero, zero, zero}, -m.ahead), centre - m.from);
    const Float part = dot(point.normal, inside - now.p) - low_end;  // of the reach
    const Float reach = max(part * Float(Real(1) / kPoint), tiny), height = point.gap + part;
    const Float left = max(fnma(s.core, Float(kSinkOn), height), height * Float(Real(0.5)));
    const Float small = min(fnma(s.core, Float(kSink), reach), left) / reach;
    scale = select(touches, clamp(small, kPoint, one), one);
    at.normal = select(touches, point.normal, at.normal);
    at.gap = select(touches, fnma(scale, reach, height), at.gap);
    near = select(touches, min(near, at.gap * Float(Real(0.1))), near);
  }
  moving = moving & (zero < at.gap);
  // Parts of the step: known to be free, known not to be, and what overlaps there.
  Float low = zero, high = Float(Real(2)), depth = zero;
  Mask stopped = zero < zero;
  const Mask swept = moving;
  const Float stride = Float(kCastTurn) / max(s.turn, tiny);
  for (int round = 0; round < kCastRounds && any(moving); ++round) {
    const Float closing = -dot(at.normal, m.step);
    const Vec3 tilt = cross(at.normal, m.turn);
    const Float turning = s.arm * sqrt(dot(tilt, tilt));
    const Float room = fnma(near, Float(Real(0.5)), at.gap), rest = one - low;
    const Mask hits = at.gap < max(closing + turning, zero) * rest;
    stopped = stopped | (moving & hits & (at.gap < near));
    moving = moving & !stopped;
    if (!any(moving)) break;
    const Float straight = select(zero < closing, room / max(closing, tiny), one);
    const Float certain = max(room, zero) / max(closing + turning, tiny);
    const Float ahead =
        low + max(min(straight, stride), select(zero < closing + turning, certain, one));
    const Float between =
        low + (high - low) * clamp(room / max(at.gap + depth, tiny), Real(0.1), Real(0.9));
    const Float next = min(select(high < Float(Real(1.5)), between, ahead), one);
    place(shape, m, centre, scale, next, now);
    const Gap there = gap_of(s.t, wall, now, far, moving);
    const Mask free = moving & (zero < there.gap), over = moving & !free;
    low = select(free, next, low);
    at.gap = select(free, there.gap, at.gap);
    at.normal = select(free, there.normal, at.normal);
    high = select(over, next, high);
    depth = select(over, -there.gap, depth);
    moving = moving & (low < one);
  }
  return select(swept, low, one);
}

// Does the body come near the bounds of a fixed shape?
Mask comes_near(const Constants& t, const Real* lows, const Real* highs, const CastMotion& m,
                Float reach) {
  const Float half(Real(0.5));
  Mask out = mask_from_bits(kAllLanes);
  const auto along = [&](int c, Float from, Float step) {
    const Float middle = fma(step, half, from), room = fma(abs(step), half, reach);
    out = out & (middle - room < Float(highs[c])) & (Float(lows[c]) < middle + room);
  };
  along(0, m.from.x, m.step.x), along(1, m.from.y, m.step.y);
  if (t.dimension == kernels::Dimension::spatial) along(2, m.from.z, m.step.z);
  return out;
}

// The plane of a height field where the way of the body's centre, and its radius on, hits it.
// Returns the lanes in which it does.
Mask plane_ahead(const Constants& t, const std::int32_t* at, const Sweep& s, Float radius,
                 Mask fast, ConvexShape& wall, Mask& through) {
  const Float one(Real(1)), zero(Real(0));
  const Mask moves = fast & (zero < s.way);
  const Vec3 way =
      select(moves, s.motion.step * (one / select(moves, s.way, one)), Vec3{one, zero, zero});
  FieldPose field;
  load_pose(t.fixed_rows, at, field);
  const RayHit<Vec3> hit = cast(RayOf<Vec3>{s.motion.from, way}, field);
  const Mask hits = moves & hit.hit & (zero < hit.distance);
  wall.kind = kernels::ShapeKind::plane;
  wall.face_normal = hit.normal;
  wall.p = fma(way, hit.distance, s.motion.from);
  wall.radius = wall.margin = zero;
  through = hits & (hit.distance < s.way);
  return hits & (hit.distance < s.way + radius);
}

Sweep sweep_of(const Constants& t, const Group& g, int body, const CastMotion& m) {
  const auto& constants = constants_of_body(g, body);
  const Float core = constants.half_thickness, radius = constants.radius;
  return {
      t, m, sqrt(dot(m.step, m.step)), sqrt(dot(m.turn, m.turn)),
      // Of a ball it does not change; of others the point that reaches farthest is so far aside.
      sqrt(max(fms(radius, radius, core * core), Real(0))), cast_gap(t, core), core};
}

// A ball in a shape that joints hold, which may sink: one that stopped where it first touches while
// the other bodies of its joints go on would stretch these.
void load_core(const Constants& t, Vec3 centre, Float radius, ConvexShape& s) {
  if (t.dimension == kernels::Dimension::planar) {
    put_flat(Corners<1>{{{Real(0), Real(0)}}, {{Real(1), Real(0)}}}, radius, s);
    s.p = centre;
  } else {
    s.kind = kernels::ShapeKind::sphere;
    set_round(s, centre, {Real(0), Real(0), Real(1)}, radius, Real(0));
  }
}

// Calls visit(shape, a point inside) for the shapes of a body that touches(collider).
template <class Touches, class Visit>
void for_each_shape(const Constants& t, const Work& w, int body, Float half_thickness,
                    Touches touches, Visit visit) {
  alignas(64) std::int32_t at[kLanes];
  ConvexShape shape;
  for (int i = t.first_collider[body]; i < t.first_collider[body + 1]; ++i) {
    if (!touches(i)) continue;
    for (int l = 0; l < kLanes; ++l) at[l] = w.pose_base[l] + t.collider[i].row;
    load_any(t, t.hulls, t.collider[i].kind, w.pose_rows, at, shape);
    const Vec3 centre = inside_of(shape);
    if (t.body[body].jointed) load_core(t, centre, half_thickness * kCore, shape);
    visit(shape, centre);
  }
}

}  // namespace

Float free_share_of_fixed(const Constants& t, const Group& g, const Work& w, int body,
                          const CastMotion& motion, Mask fast, Mask held) {
  const Float one(Real(1));
  const Sweep sweep = sweep_of(t, g, body, motion);
  const Float room = Float(constants_of_body(g, body).radius) + sweep.near;
  const bool jointed = t.body[body].jointed;
  const Mask holds = jointed ? mask_from_bits(0) : held;  // joints always do
  alignas(64) std::int32_t at_wall[kLanes];
  ConvexShape wall;
  Float share = one;
  for (int f = 0; f < t.fixed_shapes; ++f) {
    const auto& fixed = t.fixed[f];
    using kernels::ShapeKind;
    if (jointed && (fixed.kind == ShapeKind::tile || fixed.kind == ShapeKind::plane)) continue;
    Mask near = fast;
    if (fixed.kind == ShapeKind::tile) {  // the first stands for the whole field
      const TileRow& tile = tile_row(t.fixed_rows, fixed.row);
      if (tile.column != 0 || tile.row != 0 || tile.half != 0) continue;
    } else if (fixed.kind == ShapeKind::plane) {
      const Float thin = sweep.core * Real(kernels::kThinBody);
      near = fast & (thin < Float(constants_of_body(g, body).radius));
    } else {
      near = fast & comes_near(t, fixed.low, fixed.high, motion, room);
    }
    if (!any(near)) continue;
    for (int l = 0; l < kLanes; ++l) at_wall[l] = fixed.row;
    // Beside the way a field may bend, so there only shapes that are apart from its plane stop.
    Mask through = near;
    if (fixed.kind == ShapeKind::tile) {
      near = plane_ahead(t, at_wall, sweep, room, near, wall, through);
      if (!any(near)) continue;
    } else {
      load_any(t, nullptr, fixed.kind, t.fixed_rows, at_wall, wall);
    }
    const auto touches = [&](int own) { return kernels::may_touch_fixed(t, f, own); };
    for_each_shape(t, w, body, sweep.core, touches, [&](const ConvexShape& shape, Vec3 centre) {
      Mask in_front = near;
      if (fixed.kind == ShapeKind::link) {  // what is behind a link is solid
        in_front = near & (Float(Real(0)) < dot(wall.face_normal, centre - wall.p));
      }
      share = min(share, free_share(sweep, wall, shape, centre, in_front, through, holds));
    });
  }
  return share;
}

Float free_share_of_moving(const Constants& t, const Group& g, const Work& w, int body, int other,
                           const CastMotion& motion, Mask fast, Mask held) {
  const Sweep sweep = sweep_of(t, g, body, motion);
  alignas(64) std::int32_t at_wall[kLanes];
  ConvexShape wall;
  const Mask holds = t.body[body].jointed ? mask_from_bits(0) : held;
  const auto& c = t.collider[other];
  for (int l = 0; l < kLanes; ++l) at_wall[l] = w.pose_base[l] + c.row;
  load_any(t, t.hulls, c.kind, w.pose_rows, at_wall, wall);
  Float share(Real(1));
  const auto touches = [&](int own) { return kernels::may_touch(t, other, own); };
  for_each_shape(t, w, body, sweep.core, touches, [&](const ConvexShape& shape, Vec3 centre) {
    share = min(share, free_share(sweep, wall, shape, centre, fast, fast, holds));
  });
  return share;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
