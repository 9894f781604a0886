// A height field as the narrow phase takes it: tiles, of which the first has the heights behind it.
#include <algorithm>

#include "src/plan/plan_data.hpp"
#include "src/scene/length_unit.hpp"

namespace manyworlds {

namespace {

// What is below the surface is solid this far down, m per length_unit.
constexpr double kDepth = 1e6;

}  // namespace

std::vector<PlanFixed> height_field_tiles(const Body& body, const Shape& shape,
                                          const TileCount& tiles, const Scene& scene) {
  const auto& field = std::get<HeightField>(shape.geometry);
  const Mat3 of_body = body.rotation.normalized().toRotationMatrix();
  const Mat3 r = of_body * shape.rotation.normalized().toRotationMatrix();
  const int columns = field.columns - 1, rows = field.rows() - 1;
  const Vec3 half(0.5 * columns * field.cell.x(), 0.5 * rows * field.cell.y(), 0);
  const Vec3 corner = body.position + of_body * shape.position - r * half;

  const auto [low, high] = std::minmax_element(field.heights.begin(), field.heights.end());
  Eigen::AlignedBox3d bounds;
  for (int i = 0; i < 8; ++i) {
    const Vec3 at(i & 1 ? 2 * half.x() : 0, i & 2 ? 2 * half.y() : 0,
                  i & 4 ? *high : *low - kDepth * length_unit_of(scene));
    bounds.extend(corner + r * at);
  }
  std::vector<PlanFixed> out;
  std::size_t before = 0;  // reals of the tiles so far
  for (int i = 0; i < tiles.count(); ++i) {
    PlanFixed f;
    f.kind = kernels::ShapeKind::tile;
    f.triangles = tiles.count(), f.triangles_before = i, f.cell = field.cell;
    f.low = bounds.min(), f.high = bounds.max();
    // The margin comes with the tables.
    kernels::TileRow<double> row{};
    for (int k = 0; k < 3; ++k) row.frame[k] = {{r(0, k), r(1, k), r(2, k)}, corner[k]};
    row.cell[0] = field.cell.x(), row.cell[1] = field.cell.y();
    row.columns = columns, row.rows = rows, row.wide = tiles.wide, row.deep = tiles.deep;
    row.column = i / 2 % tiles.wide, row.row = i / 2 / tiles.wide, row.half = i % 2;
    constexpr std::size_t kNumbers = kernels::row_size<kernels::TileRow>;
    row.heights = static_cast<double>(kNumbers) - static_cast<double>(before);
    row.pad = tile_pad(scene);
    append_row(row, f.row);
    if (i == 0) f.row.insert(f.row.end(), field.heights.begin(), field.heights.end());
    while (f.row.size() % 4 != 0) f.row.push_back(0);  // rows are loaded by fours
    before += f.row.size();
    out.push_back(std::move(f));
  }
  return out;
}

}  // namespace manyworlds
