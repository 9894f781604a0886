// Pose rows: what describes one shape of one world to the narrow phase. src/plan writes those of
// fixed shapes, the begin stage those of shapes that move (kernels/shape/); T is a number. Rows are
// loaded by fours.
#pragma once

#include <cstddef>

namespace manyworlds::kernels {

// Functions here are static: every kernel library includes this header with flags of its own, and a
// shared inline function could put one library's instructions into another's calls.

inline constexpr int kMaxVertices = 8;
inline constexpr int kMaxOutline = 64;   // vertices of a hull's face as contacts see it
inline constexpr int kFaceCodes = 4000;  // of hulls, that contacts tell apart
inline constexpr int kCornerBlock = 16;  // as many as the most lanes there are
inline constexpr int kMapCells = 16;     // of directions, along a side of a face of the cube

template <template <class> class Row>
inline constexpr int row_size = static_cast<int>(sizeof(Row<float>) / sizeof(float));

template <class T>
struct SphereRow {
  T position[3], radius;
};
template <class T>
struct CircleRow {
  T position[2], radius, pad;
};
// Also of a cylinder, whose half extents are radius, radius, half length. `margin`: how far its
// bounds reach beyond it, m.
template <class T>
struct BoxRow {
  struct Axis {
    T axis[3], position;  // a column of the rotation, and a coordinate of the origin
  } frame[3];
  T half[3], margin;
};
template <class T>
struct RectangleRow {
  T position[2], cosine, sine;
  T half[2], pad[2];
};
template <class T>
struct CapsuleRow {
  T position[3], radius;  // in the plane position[2] is unused
  T axis[3], half;        // half its length without the round ends
};
// `radius`: of the bounding circle; of a rounded polygon that of its rounding.
template <class T>
struct PolygonRow {
  T position[2], count, radius;
  T vertices[2 * kMaxVertices];  // about the position, world axes; padded by repeating the first
  T normals[2 * kMaxVertices];
};
template <class T>
struct PlaneRow {
  T normal[3], offset;
  T tangent[3], pad;
};
template <class T>
struct LinkRow {
  T position[2], axis[2];    // its middle
  T half, low, high, index;  // low and high: reach of contacts along the axis
  T before[2], after[2];     // last normals at its ends
};

// A hull in units of its half extents, so that one that is stretched has the same table. Rows of
// four numbers:
//   size                  vertices, faces, rows before the map of its vertices, and before that of
//                         its faces; 0: there is none
//   vertices              x y z 0 of each
//   the same in blocks    x of kCornerBlock vertices, then y, then z; the last is repeated
//   faces                 m.x m.y m.z c | first count 0 0 of each: m . x <= c is the hull's side of
//                         it, not unit; its outline has `count` vertices from row `first` on
//   outlines              x y z 0 of each vertex, counter-clockwise seen from outside
//   map of the vertices   which is the farthest (src/plan/hull_map.hpp), of large hulls
//   map of the faces      which looks most along a direction, of large hulls whose sizes are fixed
// It is 4 `at` numbers from SceneConstants::hulls on; that of a fixed hull follows its row.
template <class T>
struct HullRow {
  BoxRow<T> box;
  T at, pad[3];
};

// A tile of a height field (kernels/collide/tile.hpp): one triangle of a cell that recurs.
// Position: a corner of the field. The first tile of a field is followed by its heights.
template <class T>
struct TileRow {
  typename BoxRow<T>::Axis frame[3];
  T cell[2], columns, margin;  // m, of a cell; how many of them along x; m
  T rows, wide, deep, column;  // cells along y; tiles of a pattern along x and y; place in it, x
  T row, half, heights, pad;   // and y; which triangle; first height, counted from this row; m
};

inline constexpr int kDummyRow = row_size<PolygonRow>;  // fits every kind that moves

}  // namespace manyworlds::kernels
