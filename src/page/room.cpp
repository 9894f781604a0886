#include "src/page/room.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "manyworlds/fields.hpp"
#include "src/page/joints.hpp"

namespace manyworlds::page {
namespace {

constexpr double kOutliers = 0.005;  // of the bodies, at either end, that do not count there

// Of planes, the feet of the corners of the room, where they are near.
void add_ground(const Body& body, double extent, Room& room) {
  for (const Shape& shape : body.shapes) {
    Vec3 n;
    double offset;
    if (const auto* plane = std::get_if<Plane>(&shape.geometry)) {
      n = plane->normal, offset = plane->offset;
    } else if (const auto* half = std::get_if<HalfPlane>(&shape.geometry)) {
      n = {half->normal.x(), half->normal.y(), 0}, offset = half->offset;
    } else {
      continue;
    }
    const Quat turn = body.rotation.normalized();
    n = turn * (shape.rotation.normalized() * n);
    offset += n.dot(turn * shape.position + body.position);
    const Room was = room;
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner(i & 1 ? was.high.x() : was.low.x(), i & 2 ? was.high.y() : was.low.y(),
                        i & 4 ? was.high.z() : was.low.z());
      const double above = n.dot(corner) - offset;
      if (above > 0 && above < extent / 2) room.add(corner - above * n);
    }
  }
}

}  // namespace

std::vector<double> drawn_radii(const Scene& scene) {
  std::vector<double> out = radii_of(scene, 0);
  double largest = 0;
  for (const double r : out) largest = std::max(largest, r);
  for (double& r : out) r = r > 0 ? r : largest > 0 ? largest : 1;
  return out;
}

Room room_of(const Plan& plan, const std::vector<double>& radii,
             std::span<const double> positions) {
  const Scene& scene = plan.scene();
  const auto width = static_cast<std::size_t>(components(Field::position, scene.space));
  std::vector<double> along[3];
  for (std::size_t n = 0; n < positions.size(); ++n) {
    if (std::abs(positions[n]) < 1e9) along[n % width].push_back(positions[n]);
  }
  double radius = 0;
  for (int row = 0; row < plan.bodies(); ++row) {
    radius = std::max(radius, radii[static_cast<std::size_t>(plan.body_in_row(row).index())]);
  }
  Room room;
  room.low.setZero(), room.high.setZero();
  for (std::size_t c = 0; c < width; ++c) {
    std::vector<double>& values = along[c];
    if (values.empty()) continue;
    const auto last = static_cast<double>(values.size() - 1);
    const auto quantile = [&](double q) {
      const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::lround(q * last));
      std::nth_element(values.begin(), at, values.end());
      return *at;
    };
    const auto axis = static_cast<Eigen::Index>(c);
    room.low[axis] = quantile(kOutliers), room.high[axis] = quantile(1 - kOutliers);
  }
  const double margin = std::max(radius, 1e-3);
  room.low.array() -= margin, room.high.array() += margin;
  Room fixed = fixed_room(scene);
  for (const Vec3& anchor : fixed_anchors(scene)) fixed.add(anchor);
  const double extent = (room.high - room.low).maxCoeff();
  if (!fixed.empty()) {
    room.low = room.low.cwiseMin(fixed.low.cwiseMax((room.low.array() - 2 * extent).matrix()));
    room.high = room.high.cwiseMax(fixed.high.cwiseMin((room.high.array() + 2 * extent).matrix()));
  }
  for (const Body& body : scene.bodies) add_ground(body, extent, room);
  const Vec3 more = Vec3::Constant(0.01 * extent);
  room.low -= more, room.high += more;
  return room;
}

}  // namespace manyworlds::page
