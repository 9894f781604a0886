// Contact points of bodies near each other: the common area of the two features that face each
// other, by clipping in the plane across the normal. Bodies that start a little apart count, since
// scenes are often written with gaps.
#include "src/plan/touching.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <variant>

#include "kernels/data/pair_keys.hpp"
#include "src/plan/plan_data.hpp"
#include "src/scene/convex.hpp"

namespace manyworlds {

namespace {

constexpr double kNearby = 0.125;  // of the lesser thickness: bodies no farther apart touch
constexpr double kFlat = 0.02;     // of the thickness: faces have points no farther back
constexpr std::size_t kMostPoints = 4;
constexpr int kDiscPoints = 8;

struct Part {
  int standing = -1;  // of `bodies`; -1: without a state
  int body = -1;
  const Shape* shape = nullptr;
  Convex convex;
  double thickness = std::numeric_limits<double>::infinity();  // m, of what moves
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

void find_extent(Part& part) {
  for (int k = 0; k < 3; ++k) {
    const Vec3 way = Vec3::Unit(k);
    part.high[k] = way.dot(part.convex.support(way)) + part.convex.radius;
    part.low[k] = way.dot(part.convex.support(-way)) - part.convex.radius;
  }
}

// The cells of a field below a box, with its prisms; all of a large field would take long.
std::optional<HeightField> cells_below(const HeightField& field, const Vec3& low, const Vec3& high,
                                       Vec3& shift) {
  const int columns = field.columns, rows = field.rows();
  const double middle_x = 0.5 * (columns - 1) * field.cell.x(),
               middle_y = 0.5 * (rows - 1) * field.cell.y();
  const auto cell = [](double x, double size, int most) {
    return static_cast<int>(std::clamp(std::floor(x / size), -1.0, static_cast<double>(most)));
  };
  const int i0 = std::max(0, cell(low.x() + middle_x, field.cell.x(), columns));
  const int j0 = std::max(0, cell(low.y() + middle_y, field.cell.y(), rows));
  const int i1 = std::min(columns - 2, cell(high.x() + middle_x, field.cell.x(), columns));
  const int j1 = std::min(rows - 2, cell(high.y() + middle_y, field.cell.y(), rows));
  if (i1 < i0 || j1 < j0) return {};
  HeightField out = field;
  out.columns = i1 - i0 + 2;
  out.heights.clear();
  for (int j = j0; j <= j1 + 1; ++j) {
    for (int i = i0; i <= i1 + 1; ++i) {
      out.heights.push_back(field.heights[static_cast<std::size_t>(i + j * columns)]);
    }
  }
  shift = {0.5 * (i0 + i1 + 1) * field.cell.x() - middle_x,
           0.5 * (j0 + j1 + 1) * field.cell.y() - middle_y, 0};
  return out;
}

// ---- areas of contact --------------------------------------------------------------------------

// The points of a feature farthest along n, counter-clockwise about it. One or two: a corner or an
// edge.
std::vector<Vec3> feature_along(const Convex& part, const Vec3& n, double flat) {
  std::vector<Vec3> all;
  if (part.radii.isZero(0)) {
    all = part.points;
  } else {
    for (const Vec3& p : part.points) {
      for (int i = 0; i < kDiscPoints; ++i) {
        const double angle = 2 * std::numbers::pi * i / kDiscPoints;
        all.push_back(p + part.axes *
                              part.radii.cwiseProduct(Vec3(std::cos(angle), std::sin(angle), 0)));
      }
    }
    all.push_back(part.support(n));
  }
  double most = -std::numeric_limits<double>::infinity();
  for (const Vec3& p : all) most = std::max(most, n.dot(p));
  std::vector<Vec3> out;
  for (const Vec3& p : all) {
    if (n.dot(p) >= most - flat) out.push_back(p);
  }
  if (out.size() < 3) return out;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : out) middle += p / static_cast<double>(out.size());
  const Vec3 x = n.unitOrthogonal(), y = n.cross(x);
  const auto angle = [&](const Vec3& p) {
    return std::atan2(y.dot(p - middle), x.dot(p - middle));
  };
  std::sort(out.begin(), out.end(),
            [&](const Vec3& p, const Vec3& q) { return angle(p) < angle(q); });
  return out;
}

// What of a polygon, an edge or a point is on the inner side of a plane.
std::vector<Vec3> cut(const std::vector<Vec3>& shape, const Vec3& outward, double offset) {
  std::vector<Vec3> out;
  const std::size_t sides = shape.size() > 2 ? shape.size() : shape.size() - 1;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const Vec3& p = shape[i];
    const double s = outward.dot(p) - offset;
    if (s <= 0) out.push_back(p);
    if (i >= sides) break;
    const Vec3& q = shape[(i + 1) % shape.size()];
    const double t = outward.dot(q) - offset;
    if ((s < 0 && t > 0) || (s > 0 && t < 0)) out.push_back(p + s / (s - t) * (q - p));
  }
  return out;
}

// Common points of a polygon or edge `by` and `shape`, seen along n; empty if an edge crosses.
std::vector<Vec3> common_area(std::vector<Vec3> shape, const std::vector<Vec3>& by, const Vec3& n) {
  if (by.size() == 2) {  // both are edges
    const Vec3 way = (by[1] - by[0]).normalized();
    if (shape.size() != 2) return {};
    const Vec3 other = (shape[1] - shape[0]).normalized();
    if (way.cross(other).norm() > 0.1) return {};
    shape = cut(shape, way, way.dot(by[1]));
    return shape.empty() ? shape : cut(shape, -way, -way.dot(by[0]));
  }
  for (std::size_t i = 0; i < by.size() && !shape.empty(); ++i) {
    const Vec3 outward = (by[(i + 1) % by.size()] - by[i]).cross(n);
    if (outward.squaredNorm() > 0) {
      shape = cut(shape, outward.normalized(), outward.normalized().dot(by[i]));
    }
  }
  return shape;
}

// Few corners of a polygon that span most of its area: again and again the corner goes that cuts
// off least.
std::vector<Vec3> spread(std::vector<Vec3> area) {
  while (area.size() > kMostPoints) {
    std::size_t flattest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < area.size(); ++i) {
      const Vec3 &before = area[(i + area.size() - 1) % area.size()],
                 &after = area[(i + 1) % area.size()];
      const double here = (before - area[i]).cross(after - area[i]).norm();
      if (here < least) least = here, flattest = i;
    }
    area.erase(area.begin() + static_cast<std::ptrdiff_t>(flattest));
  }
  return area;
}

std::vector<Vec3> points_between(const Part& a, const Part& b, const Separation& s, double flat,
                                 Space space) {
  const Vec3 n = s.normal;
  const std::vector<Vec3> of_b = feature_along(b.convex, -n, flat);
  std::vector<Vec3> area;
  if (a.convex.half_space) {
    area = of_b;
  } else {
    const std::vector<Vec3> of_a = feature_along(a.convex, n, flat);
    if (of_a.size() == 1 || of_b.size() == 1) {
      area = {s.point_b};
    } else if (space == Space::planar) {
      area = common_area({of_b.front(), of_b.back()}, {of_a.front(), of_a.back()}, n);
    } else if (of_a.size() > 2) {
      area = common_area(of_b, of_a, n);
    } else {
      area = common_area(of_a, of_b, -n);
    }
  }
  if (area.empty()) area = {s.point_b};
  const double level = n.dot(s.point_a + s.point_b) / 2;
  for (Vec3& p : area) p += (level - n.dot(p)) * n;
  return spread(std::move(area));
}

// m, the least radius of curvature of a round surface where its normal is n. That of an ellipsoid
// follows from its support function h(n) = |D n|, whose second derivative is (D^2 - x x^T) / h with
// x = D^2 n / h.
double roundness(const Convex& part, const Vec3& n) {
  if ((part.radii.array() <= 0).any()) return part.radius;
  const Vec3 squares = part.radii.cwiseAbs2(), local = part.axes.transpose() * n;
  const double h = part.radii.cwiseProduct(local).norm();
  const Vec3 x = squares.cwiseProduct(local) / h;
  const Mat3 all = (Mat3(squares.asDiagonal()) - x * x.transpose()) / h;
  const Vec3 u = local.unitOrthogonal(), v = local.cross(u);
  const double uu = u.dot(all * u), uv = u.dot(all * v), vv = v.dot(all * v);
  return (uu + vv) / 2 - std::hypot((uu - vv) / 2, uv) + part.radius;
}

// ---- pairs -------------------------------------------------------------------------------------

class Finder {
 public:
  explicit Finder(const Scene& scene) : scene_(scene), joined_(joined_bodies(scene)) {
    std::vector<bool> on_joint(scene.bodies.size(), false);
    for (const Joint& joint : scene.joints) {
      if (joint.body_a) on_joint[at(joint.body_a.index())] = true;
      on_joint[at(joint.body_b.index())] = true;
    }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      if (!body.enabled) continue;
      int standing = -1;
      if (body.motion == Motion::dynamic && !on_joint[i]) {
        standing = static_cast<int>(out_.bodies.size());
      }
      add_body(static_cast<int>(i), standing);
    }
  }

  TouchingBodies find() {
    std::sort(parts_.begin(), parts_.end(),
              [](const Part& a, const Part& b) { return a.low.x() < b.low.x(); });
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Part& a = parts_[i];
      for (const Part& ground : grounds_) look_at(ground, a);
      for (const auto& [ground, field] : fields_) look_at_field(ground, *field, a);
      for (std::size_t j = i + 1; j < parts_.size() && parts_[j].low.x() <= a.high.x(); ++j) {
        if (((a.low - parts_[j].high).array() > 0).any()) continue;
        if (((parts_[j].low - a.high).array() > 0).any()) continue;
        a.standing < 0 ? look_at(a, parts_[j]) : look_at(parts_[j], a);
      }
    }
    return std::move(out_);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  void add_body(int index, int standing) {
    const Body& body = scene_.bodies[at(index)];
    const Vec3 down = scene_.options.gravity;
    const Pose pose{body.position, body.rotation};
    double highest = -std::numeric_limits<double>::infinity();
    StandingBody out;
    for (const Shape& shape : body.shapes) {
      if (shape.filter.mask == 0) continue;
      Part whole{standing, index, &shape, {}};
      if (const auto* field = std::get_if<HeightField>(&shape.geometry)) {
        fields_.push_back({whole, field});
        continue;
      }
      for (Convex& convex : convex_parts(shape, pose, scene_.space)) {
        Part part = whole;
        part.convex = std::move(convex);
        if (part.convex.half_space) {
          grounds_.push_back(std::move(part));
          continue;
        }
        find_extent(part);
        if (body.motion == Motion::dynamic) {
          part.thickness = 2 * half_widths(part.convex, scene_.space).least;
          part.low.array() -= kNearby * part.thickness;
          part.high.array() += kNearby * part.thickness;
          const Vec3 top = part.convex.support(-down) - part.convex.radius * down.normalized();
          if (-down.dot(top) > highest) highest = -down.dot(top), out.top = top;
        }
        parts_.push_back(std::move(part));
      }
    }
    if (standing < 0) return;
    const MassProperties mass = mass_properties(scene_, body);
    const Mat3 turn = body.rotation.normalized().toRotationMatrix();
    out.body = index, out.mass = mass.mass, out.gravity_scale = body.gravity_scale;
    out.center = body.position + turn * mass.center;
    out.inertia = turn * mass.inertia * turn.transpose();
    Body solid;
    for (Shape shape : body.shapes) shape.density = 1, solid.shapes.push_back(std::move(shape));
    const double volume = solid.shapes.empty() ? 0 : mass_properties(scene_, solid).mass;
    out.size = scene_.space == Space::planar ? std::sqrt(volume) : std::cbrt(volume);
    out_.bodies.push_back(out);
  }

  void look_at_field(const Part& ground, const HeightField& field, const Part& part) {
    if (part.standing < 0) return;
    const Body& body = scene_.bodies[at(ground.body)];
    const Quat turn = body.rotation.normalized() * ground.shape->rotation.normalized();
    const Vec3 origin = body.position + body.rotation.normalized() * ground.shape->position;
    Vec3 low = Vec3::Constant(1e300), high = -low, shift = Vec3::Zero();
    for (int i = 0; i < 8; ++i) {
      Vec3 corner = part.low;
      for (int k = 0; k < 3; ++k) {
        if (i >> k & 1) corner[k] = part.high[k];
      }
      const Vec3 local = turn.conjugate() * (corner - origin);
      low = low.cwiseMin(local), high = high.cwiseMax(local);
    }
    const std::optional<HeightField> below = cells_below(field, low, high, shift);
    if (!below) return;
    Shape cells = *ground.shape;
    cells.geometry = *below;
    cells.position += ground.shape->rotation.normalized() * shift;
    Part prism = ground;
    for (Convex& convex : convex_parts(cells, {body.position, body.rotation}, scene_.space)) {
      prism.convex = std::move(convex);
      look_at(prism, part);
    }
  }

  // Only b has a state for sure.
  void look_at(const Part& a, const Part& b) {
    if (b.standing < 0 || a.body == b.body) return;
    if (joined_.count(std::minmax(a.body, b.body)) > 0) return;
    const Filter &f = a.shape->filter, &g = b.shape->filter;
    if (!kernels::filters_agree(f.category, f.mask, g.category, g.mask)) return;
    const double thickness = std::min(a.thickness, b.thickness);
    const Separation s = separation(a.convex, b.convex);
    if (!(std::abs(s.distance) <= kNearby * thickness)) return;  // nor if it is not finite
    Touching out;
    out.a = a.standing, out.b = b.standing, out.normal = s.normal;
    out.fixed = scene_.bodies[at(a.body)].motion != Motion::dynamic;
    out.friction = std::sqrt(a.shape->material.friction * b.shape->material.friction);
    out.round_a = roundness(a.convex, s.normal), out.round_b = roundness(b.convex, -s.normal);
    for (const Vec3& p : points_between(a, b, s, kFlat * thickness, scene_.space)) {
      const double inverse = inverse_mass(a, p, s.normal) + inverse_mass(b, p, s.normal);
      if (inverse > 0) out.points.push_back({p, 1 / inverse});
    }
    if (!out.points.empty()) out_.touchings.push_back(std::move(out));
  }

  double inverse_mass(const Part& part, const Vec3& point, const Vec3& n) const {
    if (part.standing < 0) {
      const Body& body = scene_.bodies[at(part.body)];
      return body.motion == Motion::dynamic ? 1 / mass_properties(scene_, body).mass : 0;
    }
    const StandingBody& body = out_.bodies[at(part.standing)];
    const Vec3 turn = (point - body.center).cross(n);
    if (scene_.space == Space::planar) {
      return 1 / body.mass + turn.z() * turn.z() / body.inertia(2, 2);
    }
    return 1 / body.mass + turn.dot(body.inertia.inverse() * turn);
  }

  const Scene& scene_;
  std::set<std::pair<int, int>> joined_;
  std::vector<Part> parts_, grounds_;
  std::vector<std::pair<Part, const HeightField*>> fields_;
  TouchingBodies out_;
};

}  // namespace

TouchingBodies touching_bodies(const Scene& scene) { return Finder(scene).find(); }

}  // namespace manyworlds
