// Height fields: a ray against one, lane by lane. It goes from cell to cell below its way and
// compares its height with the triangles there. The first tile of the field (collide/tile.hpp)
// stands for all of it. Also a tile as a convex shape.
#pragma once

#include "kernels/shape/box.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using TileRow = kernels::TileRow<Real>;
// Number `offset` of a row on.
MW_INLINE const TileRow& tile_row(const Real* base, std::int32_t offset) {
  return *reinterpret_cast<const TileRow*>(base + offset);
}
MW_INLINE const Real* heights_of(const TileRow& row) {
  return reinterpret_cast<const Real*>(&row) + static_cast<int>(row.heights);
}

struct FieldPose {
  static constexpr auto kKind = kernels::ShapeKind::tile;
  const Real* base;
  const std::int32_t* offset;

  // collide/tile.hpp makes a convex shape of the triangle that is near.
  static MW_INLINE Extent extent(const ConvexShape& s, Vec3 n) { return extent_of_vertices(s, n); }
  static MW_INLINE Vec3 support(const ConvexShape& s, Vec3 n) { return support_of_vertices(s, n); }
  static MW_INLINE void feature(const ConvexShape& s, Vec3 n, Real tie, Feature& f);
};

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, FieldPose& f) { f = {base, o}; }

// The plane of a triangle over (x, y), in the field's frame: z = height + slope_x x + slope_y y.
struct FieldPlane {
  Real height, slope_x, slope_y;
};
MW_INLINE FieldPlane field_plane(const TileRow& row, int i, int j, bool upper) {
  const int columns = static_cast<int>(row.columns);
  const Real* at = heights_of(row) + i + j * (columns + 1);
  const Real low = at[0], side = at[1], up = at[columns + 1], high = at[columns + 2];
  FieldPlane out;
  out.slope_x = (upper ? high - up : side - low) / row.cell[0];
  out.slope_y = (upper ? up - low : high - side) / row.cell[1];
  out.height = low - out.slope_x * (static_cast<Real>(i) * row.cell[0]) -
               out.slope_y * (static_cast<Real>(j) * row.cell[1]);
  return out;
}

// In the field's frame: where from, which way (unit); and what is hit.
struct FieldRay {
  Real from[3], way[3];
  Real distance = 0, normal[3] = {0, 0, 1};  // not unit
  bool inside = false;                       // it begins in the solid
};

MW_INLINE Real height_above(const FieldRay& ray, const FieldPlane& p, Real s) {
  const Real x = ray.from[0] + s * ray.way[0], y = ray.from[1] + s * ray.way[1];
  return ray.from[2] + s * ray.way[2] - (p.height + p.slope_x * x + p.slope_y * y);
}

// The part of the ray over the grid: enters through a border across axis `wall`, -1: begins there.
struct OverGrid {
  Real enter, leave;
  int wall;
  bool any;
};
inline OverGrid over_grid(const TileRow& row, const FieldRay& ray) {
  OverGrid out{0, kRayFar, -1, true};
  for (int k = 0; k < 2; ++k) {
    const Real size = row.cell[k] * (k == 0 ? row.columns : row.rows);
    const Real x = ray.from[k], way = ray.way[k];
    if (way == 0) {
      out.any = out.any && 0 <= x && x <= size;
      continue;
    }
    const Real in = ((way > 0 ? 0 : size) - x) / way, end = ((way > 0 ? size : 0) - x) / way;
    if (in > out.enter) out.enter = in, out.wall = k;
    if (end < out.leave) out.leave = end;
  }
  out.any = out.any && out.enter <= out.leave;
  return out;
}

inline bool cast_at_field(const TileRow& row, FieldRay& ray) {
  const OverGrid over = over_grid(row, ray);
  if (!over.any) return false;
  const int most[2] = {static_cast<int>(row.columns) - 1, static_cast<int>(row.rows) - 1};
  int cell[2];
  for (int k = 0; k < 2; ++k) {
    const Real at = (ray.from[k] + over.enter * ray.way[k]) / row.cell[k];
    cell[k] = at > 0 ? static_cast<int>(at) : 0;
    if (cell[k] > most[k]) cell[k] = most[k];
  }
  Real s = over.enter;
  for (bool first = true;; first = false) {
    // Where it leaves the cell.
    Real leave = over.leave;
    int through = -1;
    for (int k = 0; k < 2; ++k) {
      if (ray.way[k] == 0) continue;
      const int border = cell[k] + (ray.way[k] > 0 ? 1 : 0);
      const Real at = (static_cast<Real>(border) * row.cell[k] - ray.from[k]) / ray.way[k];
      if (at < leave) leave = at, through = k;
    }
    if (leave < s) leave = s;
    // How far the ray is on the side of low y of the diagonal, in cells, and how that changes.
    const auto below_diagonal = [&](Real at) {
      const Real u = (ray.from[0] + at * ray.way[0]) / row.cell[0];
      const Real v = (ray.from[1] + at * ray.way[1]) / row.cell[1];
      return (u - static_cast<Real>(cell[0])) - (v - static_cast<Real>(cell[1]));
    };
    const Real change = ray.way[0] / row.cell[0] - ray.way[1] / row.cell[1];
    const Real here = below_diagonal(s);
    const bool upper = here < 0 || (here == 0 && change < 0);
    Real crossing = leave;
    if ((here < 0 && change > 0) || (here > 0 && change < 0)) {
      const Real at = s - here / change;
      if (at > s && at < leave) crossing = at;
    }
    for (int part = 0; part < (crossing < leave ? 2 : 1); ++part) {
      const FieldPlane p = field_plane(row, cell[0], cell[1], part == 0 ? upper : !upper);
      const Real from = part == 0 ? s : crossing, end = part == 0 ? crossing : leave;
      const Real height = height_above(ray, p, from);
      const Real rise = ray.way[2] - p.slope_x * ray.way[0] - p.slope_y * ray.way[1];
      Real hit = from;
      if (height > 0) {
        if (!(rise < 0)) continue;
        hit = from - height / rise;
        if (hit > end) continue;
      }
      ray.distance = hit;
      ray.normal[0] = -p.slope_x, ray.normal[1] = -p.slope_y, ray.normal[2] = 1;
      if (first && part == 0 && height <= 0) {
        ray.inside = over.wall < 0;
        if (over.wall >= 0) {  // through the border, below the surface
          for (int k = 0; k < 3; ++k) ray.normal[k] = 0;
          ray.normal[over.wall] = ray.way[over.wall] > 0 ? Real(-1) : Real(1);
        }
      }
      return true;
    }
    if (through < 0) return false;
    cell[through] += ray.way[through] > 0 ? 1 : -1;
    if (cell[through] < 0 || cell[through] > most[through]) return false;
    s = leave;
  }
}

inline RayHit<Vec3> cast(const RayOf<Vec3>& ray, const FieldPose& field) {
  BoxPose frame;
  load_pose(field.base, field.offset, frame);
  const Vec3 from = mul_transposed(frame.r, ray.from - frame.p),
             way = mul_transposed(frame.r, ray.way);
  alignas(64) Real numbers[6][kLanes], distance[kLanes], normal[3][kLanes];
  store(numbers[0], from), store(numbers[3], way);
  std::uint32_t hits = 0, inside = 0;
  for (int l = 0; l < kLanes; ++l) {
    const TileRow& row = tile_row(field.base, field.offset[l]);
    FieldRay one;
    for (int k = 0; k < 3; ++k) one.from[k] = numbers[k][l], one.way[k] = numbers[3 + k][l];
    const bool first = row.column == 0 && row.row == 0 && row.half == 0;
    if (first && cast_at_field(row, one)) hits |= 1u << l;
    inside |= static_cast<std::uint32_t>(one.inside) << l;
    distance[l] = one.distance;
    for (int k = 0; k < 3; ++k) normal[k][l] = one.normal[k];
  }
  const auto n = load_as<Vec3>(normal[0]);
  RayHit<Vec3> h;
  h.distance = Float::load(distance);
  h.normal = mul(frame.r, n * (Float(Real(1)) / sqrt(dot(n, n))));
  h.hit = mask_from_bits(hits);
  return begin_inside(ray, mask_from_bits(inside), h);
}

MW_INLINE void FieldPose::feature(const ConvexShape& s, Vec3, Real, Feature& f) {
  f.count = 3;
  for (int i = 0; i < 3; ++i) f.corner[i] = s.vertex[i];
  f.normal = s.face_normal;
  const Vec3 edge = s.vertex[1] - s.vertex[0];
  f.along = edge * (Float(Real(1)) / sqrt(max(dot(edge, edge), Real(1e-30))));
  f.code = Real(0);
  f.face = mask_from_bits(kAllLanes);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
