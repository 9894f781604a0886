// The tables of hulls (data/pose_rows.hpp), row by row and through their maps.
#pragma once

#include "kernels/lane/rows.hpp"
#include "kernels/shape/convex_shape.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using HullRow = kernels::HullRow<Real>;

// `hulls`: where the tables are; nullptr: behind the pose row.
inline void load_tables(const Real* base, const std::int32_t* o, const Real* hulls, HullTables& t) {
  t.rows = hulls ? hulls : base;
  t.most_corners = t.most_faces = 0;
  t.shared = t.corners_mapped = t.faces_mapped = true;
  for (int l = 0; l < kLanes; ++l) {
    const auto& row = *reinterpret_cast<const HullRow*>(base + o[l]);
    const std::int32_t at =
        hulls ? 4 * static_cast<std::int32_t>(row.at) : o[l] + kernels::row_size<kernels::HullRow>;
    std::int32_t size[4];
    for (int k = 0; k < 4; ++k) size[k] = static_cast<std::int32_t>(t.rows[at + k]);
    t.corners[l] = size[0], t.faces[l] = size[1];
    t.first_corner[l] = at + 4;
    const int blocks = (size[0] + kernels::kCornerBlock - 1) / kernels::kCornerBlock;
    t.block[l] = t.first_corner[l] + 4 * size[0];
    t.first_face[l] = t.block[l] + 3 * kernels::kCornerBlock * blocks;
    t.corner_map[l] = size[2] > 0 ? at + 4 * size[2] : 0;
    t.face_map[l] = size[3] > 0 ? at + 4 * size[3] : 0;
    t.most_corners = size[0] > t.most_corners ? size[0] : t.most_corners;
    t.most_faces = size[1] > t.most_faces ? size[1] : t.most_faces;
    // Two that begin at the same place are the same.
    t.shared = t.shared && at + 4 == t.first_corner[0];
    t.corners_mapped = t.corners_mapped && size[2] > 0;
    t.faces_mapped = t.faces_mapped && size[3] > 0;
  }
}

// Row k of each lane's list, `width` quads wide; a lane that has fewer than that repeats its last.
MW_INLINE void row_offsets(const std::int32_t* first, const std::int32_t* count, int k, int width,
                           std::int32_t* out) {
  for (int l = 0; l < kLanes; ++l) {
    const int last = count[l] > 0 ? count[l] - 1 : 0;
    out[l] = first[l] + 4 * width * (k < last ? k : last);
  }
}
struct HullQuad {
  Float x, y, z, w;
};
MW_INLINE HullQuad load_quad(const HullTables& t, const std::int32_t* o) {
  HullQuad q;
  load_rows4(t.rows, o, q.x, q.y, q.z, q.w);
  return q;
}
// Broadcast where all lanes have the same hull.
MW_INLINE HullQuad quad_of(const HullTables& t, const std::int32_t* first,
                           const std::int32_t* count, int k, int width) {
  if (t.shared) {
    const Real* p = t.rows + first[0] + 4 * width * k;
    return {p[0], p[1], p[2], p[3]};
  }
  alignas(64) std::int32_t o[kLanes];
  row_offsets(first, count, k, width, o);
  return load_quad(t, o);
}
MW_INLINE HullQuad corner_of(const HullTables& t, int k) {
  return quad_of(t, t.first_corner, t.corners, k, 1);
}
MW_INLINE HullQuad face_of(const HullTables& t, int k) {
  return quad_of(t, t.first_face, t.faces, k, 2);
}
// Number `index` of each lane's list.
MW_INLINE HullQuad chosen_quad(const HullTables& t, const std::int32_t* first, Float index,
                               int width) {
  alignas(64) Real chosen[kLanes];
  alignas(64) std::int32_t o[kLanes];
  index.store(chosen);
  for (int l = 0; l < kLanes; ++l) {
    o[l] = first[l] + 4 * width * static_cast<std::int32_t>(chosen[l]);
  }
  return load_quad(t, o);
}

// What a map lists for a direction.
struct MapList {
  const Real* numbers;
  int count;
};
MW_INLINE MapList map_list(const Real* rows, std::int32_t map, Real x, Real y, Real z) {
  constexpr int kCells = kernels::kMapCells;
  const Real ax = x < 0 ? -x : x, ay = y < 0 ? -y : y, az = z < 0 ? -z : z;
  const int axis = ay <= ax && az <= ax ? 0 : az <= ay ? 1 : 2;
  const Real a = axis == 0 ? x : axis == 1 ? y : z, u = axis == 0 ? y : axis == 1 ? z : x;
  const Real v = axis == 0 ? z : axis == 1 ? x : y, size = a < 0 ? -a : a;
  const Real half = Real(kCells) / 2, scale = half / (size < Real(1e-30) ? Real(1e-30) : size);
  const auto cell_of = [](Real at) {  // what is no number has one, too
    return at >= 0 ? (at < kCells ? static_cast<int>(at) : kCells - 1) : 0;
  };
  const int face = 2 * axis + (a < 0 ? 1 : 0);
  const int line = cell_of(fma(v, scale, half)), column = cell_of(fma(u, scale, half));
  const Real* at = rows + map + 2 * ((face * kCells + line) * kCells + column);
  return {rows + map + 2 * 6 * kCells * kCells + static_cast<std::int32_t>(at[0]),
          static_cast<int>(at[1])};
}

// visit(row, its number) for what the map of each lane lists for a direction; `first` row and
// `width` are those of what is listed. Lanes with fewer repeat their last.
template <class Visit>
MW_INLINE void for_each_listed(const HullTables& t, const std::int32_t* map,
                               const std::int32_t* first, int width, Vec3 l, Visit visit) {
  alignas(64) Real x[kLanes], y[kLanes], z[kLanes], number[kLanes];
  alignas(64) std::int32_t o[kLanes];
  l.x.store(x), l.y.store(y), l.z.store(z);
  MapList list[kLanes];
  int most = 0;
  for (int i = 0; i < kLanes; ++i) {
    list[i] = map_list(t.rows, map[i], x[i], y[i], z[i]);
    most = list[i].count > most ? list[i].count : most;
  }
  for (int k = 0; k < most; ++k) {
    for (int i = 0; i < kLanes; ++i) {
      number[i] = list[i].numbers[k < list[i].count ? k : list[i].count - 1];
      o[i] = first[i] + 4 * width * static_cast<std::int32_t>(number[i]);
    }
    visit(load_quad(t, o), Float::load(number));
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
