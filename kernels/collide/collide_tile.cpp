// Tiles of height fields: loading, their surface's normals, spheres (collide/tile.hpp).
#include "kernels/collide/capsule_capsule.hpp"
#include "kernels/collide/tile.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

// Sine by which a normal may leave the range at an edge that sticks out: bodies at rest on the
// neighbour lean a little.
constexpr Real kNormalSlack = Real(1e-3);
// Edges with a smaller dihedral angle count as flat.
constexpr Real kFlat = Real(1e-4);

// Corners of the two triangles of a cell, and the third corners of their neighbours.
constexpr int kCorner[2][6][2] = {{{0, 0}, {1, 0}, {1, 1}, {0, -1}, {2, 1}, {0, 1}},
                                  {{0, 0}, {1, 1}, {0, 1}, {1, 0}, {1, 2}, {-1, 0}}};

int floor_of(Real x) {
  const Real most = Real(1e9);
  if (!(-most < x)) return -1000000000;
  if (!(x < most)) return 1000000000;
  const int i = static_cast<int>(x);
  return static_cast<Real>(i) > x ? i - 1 : i;
}
// The first number from `from` on that leaves this remainder.
int next_with(int from, int remainder, int divisor) {
  const int off = (remainder - from) % divisor;
  return from + (off < 0 ? off + divisor : off);
}

// What a lane sees of its tile: the corners in the field's frame.
struct CellCorners {
  alignas(64) Real x[6][kLanes], y[6][kLanes], z[6][kLanes], code[kLanes];
  std::uint32_t there = 0;
};
// `low`, `high`: of the shape, x and y in the field's frame.
void find_corners(const TileRow& row, int lane, const Real* low, const Real* high,
                  CellCorners& out) {
  const auto whole = [](Real x) { return static_cast<int>(x); };
  const Real cell_x = row.cell[0], cell_y = row.cell[1];
  const int columns = whole(row.columns), rows = whole(row.rows);
  const int first_i = floor_of(low[0] / cell_x), first_j = floor_of(low[1] / cell_y);
  int i = next_with(first_i > 0 ? first_i : 0, whole(row.column), whole(row.wide));
  int j = next_with(first_j > 0 ? first_j : 0, whole(row.row), whole(row.deep));
  // A small shape has nothing to do with the tiles that only large ones reach.
  const bool reached =
      static_cast<Real>(i) * cell_x <= high[0] && static_cast<Real>(j) * cell_y <= high[1];
  const bool there = reached && i < columns && j < rows;
  if (!there) i = j = 0;
  out.there |= static_cast<std::uint32_t>(there) << lane;
  const int half = whole(row.half);
  // Told apart from cells that are far away in the same tile.
  out.code[lane] = static_cast<Real>((i + j * columns) & 0xff);
  const Real* heights = heights_of(row);
  const auto put = [&](int k, int u, int v) {
    out.x[k][lane] = static_cast<Real>(u) * cell_x;
    out.y[k][lane] = static_cast<Real>(v) * cell_y;
    out.z[k][lane] = heights[u + v * (columns + 1)];
  };
  for (int k = 0; k < 3; ++k) put(k, i + kCorner[half][k][0], j + kCorner[half][k][1]);
  for (int k = 0; k < 3; ++k) {
    const int u = i + kCorner[half][3 + k][0], v = j + kCorner[half][3 + k][1];
    if (0 <= u && u <= columns && 0 <= v && v <= rows) {
      put(3 + k, u, v);
    } else {  // the field ends: straight down from the edge
      out.x[3 + k][lane] = out.x[k][lane];
      out.y[3 + k][lane] = out.y[k][lane];
      out.z[3 + k][lane] = out.z[k][lane] - (cell_x + cell_y);
    }
  }
}

MW_INLINE Vec3 unit(Vec3 v) {
  const Float one(Real(1));
  return v * (one / sqrt(max(dot(v, v), Real(1e-30))));
}

}  // namespace

void load_tile(const Real* base, const std::int32_t* offset, const ConvexShape& b, Mask active,
               Tile& tile, ConvexShape& s) {
  BoxPose frame;
  load_pose(base, offset, frame);
  alignas(64) Real low[2][kLanes], high[2][kLanes], pad[kLanes];
  for (int l = 0; l < kLanes; ++l) pad[l] = tile_row(base, offset[l]).pad;
  const Vec3 d = b.p - frame.p;
  const Float around = b.radius + Float::load(pad);
  for (int k = 0; k < 2; ++k) {
    const Vec3 axis = k == 0 ? frame.r.x : frame.r.y;
    const Extent e = extent_along(b, axis, mask_from_bits(kAllLanes));
    const Float place = dot(axis, d);
    (place + e.low - around).store(low[k]), (place + e.high + around).store(high[k]);
  }
  CellCorners corners;
  for (int l = 0; l < kLanes; ++l) {
    const Real of_lane[4] = {low[0][l], low[1][l], high[0][l], high[1][l]};
    find_corners(tile_row(base, offset[l]), l, of_lane, of_lane + 2, corners);
  }
  tile.there = active & mask_from_bits(corners.there);
  tile.code = Float::load(corners.code);

  Vec3 at[6];
  for (int k = 0; k < 6; ++k) {
    at[k] = {Float::load(corners.x[k]), Float::load(corners.y[k]), Float::load(corners.z[k])};
  }
  const Vec3 middle = (at[0] + at[1] + at[2]) * Float(Real(1) / Real(3));
  for (int k = 0; k < 6; ++k) at[k] = mul(frame.r, at[k] - middle);
  s.kind = kernels::ShapeKind::tile;
  s.p = frame.p + mul(frame.r, middle);
  s.r = frame.r;
  s.radius = Real(0);
  s.margin = frame.margin;
  s.vertices = 3;
  const Float zero(Real(0));
  Float reach2 = zero;
  tile.normal = unit(cross(at[1] - at[0], at[2] - at[0]));
  for (int e = 0; e < 3; ++e) {
    tile.vertex[e] = s.vertex[e] = at[e];
    reach2 = max(dot(at[e], at[e]), reach2);
    const Vec3 edge = unit(at[(e + 1) % 3] - at[e]), across = at[3 + e] - at[e];
    tile.out[e] = cross(edge, tile.normal);
    tile.beside[e] = unit(cross(edge, frame.r.z));
    const Vec3 on = unit(fnma(edge, dot(edge, across), across));
    const Mask sticks_out = dot(on, tile.normal) < Float(-kFlat);
    tile.last[e] = select(sticks_out, on, tile.out[e]);
  }
  s.face_normal = tile.normal;
  const Float reach = sqrt(reach2);
  s.half = {reach, reach, reach};
}

Mask has_normal(const Tile& tile, Vec3 n) {
  const Float slack(kNormalSlack);
  Mask out = slack < dot(tile.normal, n);
  for (int e = 0; e < 3; ++e) {
    out = out & ((dot(tile.out[e], n) <= slack) | (dot(tile.last[e], n) <= slack));
  }
  return out;
}

Mask is_over(const Tile& tile, Vec3 point, Float slack) {
  Mask out = mask_from_bits(kAllLanes);
  for (int e = 0; e < 3; ++e) out = out & (dot(tile.out[e], point - tile.vertex[e]) <= slack);
  return out;
}

Mask is_below(const Tile& tile, Vec3 point) {
  const Float zero(Real(0));
  Mask out = dot(tile.normal, point - tile.vertex[0]) < zero;
  for (int e = 0; e < 3; ++e) out = out & (dot(tile.beside[e], point - tile.vertex[e]) <= zero);
  return out;
}

void collide_tile_sphere(const ConvexShape& a, const Tile& tile, const ConvexShape& b,
                         Manifold<Isotropic, 1>& m) {
  const Float zero(Real(0)), one(Real(1)), half(Real(0.5));
  const Vec3 d = b.p - a.p;
  const Float height = dot(tile.normal, d - tile.vertex[0]);
  const Mask above = zero <= height;
  const Mask over = (above & is_over(tile, d, zero)) | is_below(tile, d);
  // Beside it, the nearest of its edges.
  Vec3 nearest = tile.vertex[0];
  Float best = Real(1e30);
  for (int e = 0; e < 3; ++e) {
    const Vec3 from = d - tile.vertex[e], edge = tile.vertex[(e + 1) % 3] - tile.vertex[e];
    const Float share = clamp(dot(from, edge) / max(dot(edge, edge), Real(1e-30)), zero, one);
    const Vec3 off = fnma(edge, share, from);
    const Float d2 = dot(off, off);
    const Mask nearer = d2 < best;
    best = min(d2, best);
    nearest = select(nearer, fma(edge, share, tile.vertex[e]), nearest);
  }
  const Vec3 way = d - nearest;
  const Mask apart = Float(kTinyDistance2) < best;
  const Float distance = sqrt(select(apart, best, one));
  m.normal = select(over | !apart, tile.normal, way * (one / distance));
  const Float reach = select(over, height, select(apart, distance, zero));
  const Float separation = reach - b.radius;
  m.tangent = any_tangent(m.normal);
  m.separation[0] = separation;
  m.point_b[0] = m.normal * -fma(min(separation, zero), half, b.radius);
  m.point_a[0] = fma(m.normal, -max(separation, zero), m.point_b[0] + d);
  m.feature_x[0] = m.feature_y[0] = zero;
  m.code = tile.code * Float(kTileCodes);
  m.match_distance2 = zero;
  m.valid[0] = tile.there & (over | ((zero < height) & has_normal(tile, m.normal)));
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
