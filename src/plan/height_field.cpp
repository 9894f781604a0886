// A height field as the narrow phase wants it: tiles, of which the first has the heights behind it.
#include <algorithm>

#include "src/plan/plan_data.hpp"

namespace manyworlds {

namespace {

// What is below the surface is solid this far down, m per length_unit.
constexpr double kDepth = 1e6;

}  // namespace

std::vector<PlanFixed> height_field_tiles(const Body& body, const Shape& shape,
                                          const TileCount& tiles, const Options& options) {
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
                  i & 4 ? *high : *low - kDepth * options.length_unit);
    bounds.extend(corner + r * at);
  }
  std::vector<PlanFixed> out;
  std::size_t before = 0;  // reals of the tiles so far
  for (int i = 0; i < tiles.count(); ++i) {
    PlanFixed f;
    f.kind = kernels::ShapeKind::tile;
    f.triangles = tiles.count(), f.triangles_before = i, f.cell = field.cell;
    f.low = bounds.min(), f.high = bounds.max();
    for (int k = 0; k < 3; ++k) {
      f.row.insert(f.row.end(), {r(0, k), r(1, k), r(2, k), corner[k]});
    }
    // See TileRow in kernels/collide/tile.hpp; the margin comes with the tables.
    f.row.insert(
        f.row.end(),
        {field.cell.x(), field.cell.y(), static_cast<double>(columns), 0, static_cast<double>(rows),
         static_cast<double>(tiles.wide), static_cast<double>(tiles.deep),
         static_cast<double>(i / 2 % tiles.wide), static_cast<double>(i / 2 / tiles.wide),
         static_cast<double>(i % 2), 0, tile_pad(options)});
    constexpr std::size_t kHeights = 22, kRow = 24;
    f.row[kHeights] = static_cast<double>(kRow) - static_cast<double>(before);
    if (i == 0) f.row.insert(f.row.end(), field.heights.begin(), field.heights.end());
    while (f.row.size() % 4 != 0) f.row.push_back(0);  // rows are loaded by fours
    before += f.row.size();
    out.push_back(std::move(f));
  }
  return out;
}

}  // namespace manyworlds
