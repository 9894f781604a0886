// A terrain as the narrow phase takes it: one fixed link per segment, each with what it has to know
// of its neighbours (kernels/collide/link_pairs.hpp).
#include <algorithm>

#include "src/plan/plan_data.hpp"

namespace manyworlds {

namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }
Vec2 left_of(const Vec2& a) { return {-a.y(), a.x()}; }

// What a link stores of the neighbour at one of its ends: the last normal that a contact there may
// have, and how far the link reaches beyond the end.
struct LinkEnd {
  Vec2 normal;
  double reach;
};
// `bend`: cross product of the unit directions before and after the end, negative where the terrain
// sticks out; where it hardly does it counts as flat, so that no place is between two links.
// `out`: unit, along the link out of this end. `away`: the neighbour, from the end on.
LinkEnd link_end(const Vec2& normal, const Vec2& next_normal, double bend, const Vec2& out,
                 const Vec2& away) {
  constexpr double kFlat = 1e-4;
  if (bend < -kFlat) return {next_normal, 0};
  return {normal, std::max(0.0, out.dot(away))};
}

}  // namespace

std::vector<PlanFixed> terrain_links(const Body& body, const Shape& shape) {
  const auto& terrain = std::get<Terrain>(shape.geometry);
  const Quat body_rotation = body.rotation.normalized(),
             shape_rotation = shape.rotation.normalized();
  std::vector<Vec2> at;
  for (const Vec2& p : terrain.points) {
    const Vec3 in_body = shape.position + shape_rotation * Vec3(p.x(), p.y(), 0);
    at.push_back((body.position + body_rotation * in_body).head<2>());
  }
  const std::size_t n = at.size(), links = terrain.loop ? n : n - 1;
  std::vector<PlanFixed> out;
  for (std::size_t i = 0; i < links; ++i) {
    const Vec2 &from = at[i], &to = at[(i + 1) % n];
    const Vec2 axis = (to - from).normalized(), normal = left_of(axis);
    const double half = (to - from).norm() / 2;
    // At an open end the solid falls off at a right angle.
    LinkEnd before{-axis, 0}, after{axis, 0};
    if (terrain.loop || i > 0) {
      const Vec2 along = from - at[(i + n - 1) % n], unit = along.normalized();
      before = link_end(normal, left_of(unit), cross(unit, axis), -axis, -along);
    }
    if (terrain.loop || i + 1 < links) {
      const Vec2 along = at[(i + 2) % n] - to, unit = along.normalized();
      after = link_end(normal, left_of(unit), cross(axis, unit), axis, along);
    }
    const Vec2 middle = (from + to) / 2;
    PlanFixed f;
    f.kind = kernels::ShapeKind::link;
    f.length = 2 * half;
    const auto put = [](const Vec2& v, double* out_xy) { out_xy[0] = v.x(), out_xy[1] = v.y(); };
    kernels::LinkRow<double> row{};
    put(middle, row.position), put(axis, row.axis);
    row.half = half, row.low = -half - before.reach, row.high = half + after.reach;
    row.index = static_cast<double>(i);
    put(before.normal, row.before), put(after.normal, row.after);
    append_row(row, f.row);
    f.low.head<2>() = from.cwiseMin(to);
    f.high.head<2>() = from.cwiseMax(to);
    out.push_back(std::move(f));
  }
  return out;
}

}  // namespace manyworlds
