// Height fields.
#include <algorithm>
#include <cmath>

#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

using detail::Checker;

void check_height_field(Checker& checker, const HeightField& field) {
  constexpr std::size_t kMaxPoints = 1000000;
  const std::size_t n = field.heights.size();
  checker.size("cell.x", field.cell.x());
  checker.size("cell.y", field.cell.y());
  if (field.columns < 2) {
    checker.add("columns", "is " + std::to_string(field.columns) + ", must be at least 2");
  } else if (n % static_cast<std::size_t>(field.columns) != 0 || field.rows() < 2) {
    checker.add("heights", "are " + std::to_string(n) + ", must be two rows or more of " +
                               std::to_string(field.columns));
  }
  if (n > kMaxPoints) {
    checker.add("heights",
                "are " + std::to_string(n) + ", must be at most " + std::to_string(kMaxPoints));
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    detail::check_coordinate(checker, detail::element_name("heights", i), field.heights[i]);
  }
}

// What is below a triangle, counter-clockwise seen from above, down to a level.
Convex prism_of(const std::array<Vec3, 3>& top, double level, const Vec3& x, const Mat3& r) {
  Convex c;
  for (const bool lower : {false, true}) {
    for (const Vec3& p : top) c.points.push_back(x + r * Vec3(p.x(), p.y(), lower ? level : p.z()));
  }
  const auto point = [&](int i) { return c.points[static_cast<std::size_t>(i)]; };
  const auto face = [&](const Vec3& normal, const Vec3& on) {
    c.normals.push_back(normal.normalized());
    c.reach.push_back(c.normals.back().dot(on));
  };
  const auto edge = [&](int from, int to) {
    c.edges.push_back({from, to});
    c.directions.push_back((point(to) - point(from)).normalized());
  };
  face((point(1) - point(0)).cross(point(2) - point(0)), point(0));
  face(-r.col(2), point(3));
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    face((point(next) - point(i)).cross(r.col(2)), point(i));
    edge(i, next), edge(3 + i, 3 + next), edge(i, 3 + i);
  }
  return c;
}

// Point of a field in the shape frame.
Vec3 point_of(const HeightField& field, int i, int j) {
  const double z = field.heights[static_cast<std::size_t>(i + j * field.columns)];
  return {i * field.cell.x() - (field.columns - 1) * field.cell.x() / 2,
          j * field.cell.y() - (field.rows() - 1) * field.cell.y() / 2, z};
}

// What is below each triangle of a surface, as deep as the field is wide below its lowest point.
std::vector<Convex> prisms_of(const HeightField& field, const Vec3& x, const Mat3& r) {
  const int columns = field.columns - 1, rows = field.rows() - 1;
  const double wide = columns * field.cell.x(), deep = rows * field.cell.y();
  const double level =
      *std::min_element(field.heights.begin(), field.heights.end()) - std::hypot(wide, deep);
  const auto corner = [&](int i, int j) { return point_of(field, i, j); };
  std::vector<Convex> out;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const Vec3 low = corner(i, j), high = corner(i + 1, j + 1);
      out.push_back(prism_of({low, corner(i + 1, j), high}, level, x, r));
      out.push_back(prism_of({low, high, corner(i, j + 1)}, level, x, r));
    }
  }
  return out;
}

class HeightFieldTraits final : public TraitsOf<HeightField> {
 public:
  HeightFieldTraits() : TraitsOf({.name = "height field", .in_space = true, .ground = true}) {}

 protected:
  void examine(Checker& checker, const HeightField& field) const override {
    check_height_field(checker, field);
  }
  std::vector<Convex> parts_of(const HeightField& field, const Vec3& x, const Mat3& r,
                               Space) const override {
    return prisms_of(field, x, r);
  }
  // Normals are those of the cells around a point, so that the ground looks as smooth as bodies
  // find it.
  Surface surface_of(const HeightField& field, const SurfaceOptions&) const override {
    const int columns = field.columns, rows = field.rows();
    const auto at = [&](int i, int j) { return i + j * columns; };
    Surface out;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) out.points.push_back(point_of(field, i, j));
    }
    out.normals.assign(out.points.size(), Vec3::Zero());
    for (int j = 0; j + 1 < rows; ++j) {
      for (int i = 0; i + 1 < columns; ++i) {
        out.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        out.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
    const auto index = [](int i) { return static_cast<std::size_t>(i); };
    for (const auto& [a, b, c] : out.triangles) {
      const Vec3 &p = out.points[index(a)], &q = out.points[index(b)], &r = out.points[index(c)];
      const Vec3 area = (q - p).cross(r - p);
      for (const int i : {a, b, c}) out.normals[index(i)] += area;
    }
    for (Vec3& n : out.normals) n.normalize();
    std::vector<Vec3> border;
    for (int i = 0; i < columns; ++i) border.push_back(point_of(field, i, 0));
    for (int j = 1; j < rows; ++j) border.push_back(point_of(field, columns - 1, j));
    for (int i = columns - 2; i >= 0; --i) border.push_back(point_of(field, i, rows - 1));
    for (int j = rows - 2; j > 0; --j) border.push_back(point_of(field, 0, j));
    out.lines.push_back(detail::closed(std::move(border)));
    return out;
  }
};

}  // namespace

MW_GEOMETRY(HeightField)

}  // namespace manyworlds
