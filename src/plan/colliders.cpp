// Shapes as the narrow phase takes them: relative to centre of mass and principal axes when they
// move, as finished pose rows when they are fixed.
#include <algorithm>
#include <cmath>
#include <limits>

#include "src/plan/plan_data.hpp"

namespace manyworlds {

namespace {

using kernels::ShapeKind;

// A polygon of four vertices with equal diagonals that bisect each other.
bool is_rectangle(const std::vector<Vec2>& v) {
  if (v.size() != 4) return false;
  const double size = (v[2] - v[0]).norm();
  return ((v[0] + v[2]) - (v[1] + v[3])).norm() <= 1e-12 * size &&
         std::abs(size - (v[3] - v[1]).norm()) <= 1e-12 * size;
}

// Stretched along the axes of its frame it stays one.
bool is_upright(const std::vector<Vec2>& v) {
  const Vec2 edge = v[1] - v[0];
  return edge.x() == 0 || edge.y() == 0;
}

bool all_rectangles(const PlanData& plan) {
  for (const Body& body : plan.scene.bodies) {
    for (const Shape& shape : body.shapes) {
      const auto* polygon = std::get_if<Polygon>(&shape.geometry);
      if (polygon && (!is_rectangle(polygon->vertices) || polygon->radius > 0)) return false;
    }
  }
  for (const VariedNumber& n : plan.varied) {
    if (n.parameter != Parameter::size) continue;
    const Shape& shape = plan.scene.bodies[static_cast<std::size_t>(n.of.body)]
                             .shapes[static_cast<std::size_t>(n.of.shape)];
    const auto* polygon = std::get_if<Polygon>(&shape.geometry);
    if (polygon && !is_upright(polygon->vertices)) return false;
  }
  return true;
}

bool any_rounded(const PlanData& plan) {
  for (const Body& body : plan.scene.bodies) {
    for (const Shape& shape : body.shapes) {
      const auto* polygon = std::get_if<Polygon>(&shape.geometry);
      if (polygon && polygon->radius > 0) return true;
    }
  }
  return false;
}

std::vector<Vec2> edge_normals(const std::vector<Vec2>& v) {
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Vec2 e = v[(i + 1) % v.size()] - v[i];
    out.push_back(Vec2(e.y(), -e.x()).normalized());
  }
  return out;
}

// A shape in its body's frame: origin, axes, sizes.
PlanCollider local_collider(const Shape& shape, const PlanData& plan) {
  PlanCollider c;
  static_cast<ShapeForm&>(c) =
      traits_of(shape.geometry).form(shape.geometry, {plan.rectangles, plan.rounded});
  c.material = shape.material;
  Mat3 rotation = shape.rotation.normalized().toRotationMatrix();
  if (shape.rotation.vec().isZero(0)) rotation.setIdentity();
  c.offset = c.offset.isZero(0) ? shape.position : Vec3(shape.position + rotation * c.offset);
  c.rotation = c.rotation.isIdentity(0) ? rotation : Mat3(rotation * c.rotation);
  return c;
}

void set_hull(const HullCorners& corners, PlanCollider& c) {
  c.kind = ShapeKind::hull;
  c.half = corners.half;
  if (!corners.middle.isZero(0)) c.offset += c.rotation * corners.middle;
  c.radius = corners.radius;
  c.inner_radius = corners.inner_radius;
}

// Whether some worlds have another size of a shape.
bool is_stretched(const PlanData& plan, int body, int shape) {
  return std::any_of(plan.varied.begin(), plan.varied.end(), [&](const VariedNumber& n) {
    return n.parameter == Parameter::size && n.of.body == body && n.of.shape == shape;
  });
}

PlanFixed fixed_plane(const Vec3& normal, double offset, const Vec3& x, const Mat3& r) {
  const Vec3 n = r * normal;
  PlanFixed f;
  f.kind = ShapeKind::plane;
  f.plane = {n.x(), n.y(), n.z(), offset + n.dot(x)};
  const Vec3 side = std::abs(n.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 t = (side - n * n.dot(side)).normalized();
  append_row(kernels::PlaneRow<double>{{n.x(), n.y(), n.z()}, f.plane[3], {t.x(), t.y(), t.z()}, 0},
             f.row);
  return f;
}

// What lies where a box does, in a row like that of one.
void put_box(const PlanCollider& c, const Vec3& x, const Mat3& r, PlanFixed& f) {
  kernels::BoxRow<double> row{};
  for (int k = 0; k < 3; ++k) row.frame[k] = {{r(0, k), r(1, k), r(2, k)}, x[k]};
  for (int k = 0; k < 3; ++k) row.half[k] = c.half[k];
  append_row(row, f.row);
  const Vec3 e = r.cwiseAbs() * c.half;
  f.low = x - e, f.high = x + e;
}

void put_polygon(const PlanCollider& c, const Vec3& x, const Mat3& r, PlanFixed& f) {
  kernels::PolygonRow<double> row{{x.x(), x.y()},
                                  static_cast<double>(c.vertices.size()),
                                  c.kind == ShapeKind::rounded ? c.thickness : c.radius,
                                  {},
                                  {}};
  std::vector<Vec2> v;
  f.low.setConstant(std::numeric_limits<double>::max());
  f.high = -f.low;
  for (const Vec2& p : c.vertices) {
    v.push_back((r * Vec3(p.x(), p.y(), 0)).head<2>());
    const Vec3 at = x + Vec3(v.back().x(), v.back().y(), 0);
    f.low = f.low.cwiseMin(at), f.high = f.high.cwiseMax(at);
  }
  f.low.array() -= c.thickness, f.high.array() += c.thickness;
  const auto pad = [](const std::vector<Vec2>& list, double* out) {
    for (std::size_t i = 0; i < kernels::kMaxVertices; ++i) {
      const Vec2& p = list[i < list.size() ? i : 0];
      out[2 * i] = p.x(), out[2 * i + 1] = p.y();
    }
  };
  pad(v, row.vertices), pad(edge_normals(v), row.normals);
  append_row(row, f.row);
}

// The pose row of a fixed shape, and its bounds.
PlanFixed fixed_shape(const Body& body, const Shape& shape, const PlanData& plan) {
  const Mat3 body_rotation = body.rotation.normalized().toRotationMatrix();
  const auto plane = [&](const Vec3& normal, double offset) {
    return fixed_plane(shape.rotation.normalized() * normal, offset,
                       body.position + body_rotation * shape.position, body_rotation);
  };
  if (const auto* p = std::get_if<Plane>(&shape.geometry)) {
    return plane(p->normal.normalized(), p->offset);
  }
  if (const auto* p = std::get_if<HalfPlane>(&shape.geometry)) {
    const Vec2 n = p->normal.normalized();
    return plane({n.x(), n.y(), 0}, p->offset);
  }
  PlanCollider c = local_collider(shape, plan);
  HullCorners corners;
  if (const auto* hull = std::get_if<Hull>(&shape.geometry)) {
    corners = hull_corners(*hull, false);
    set_hull(corners, c);
  }
  const Vec3 x = body.position + body_rotation * c.offset;
  const Mat3 r = body_rotation * c.rotation;
  PlanFixed f;
  f.kind = c.kind;
  f.low = x.array() - c.radius, f.high = x.array() + c.radius;
  switch (c.kind) {
    case ShapeKind::sphere:
      append_row(kernels::SphereRow<double>{{x.x(), x.y(), x.z()}, c.radius}, f.row);
      break;
    case ShapeKind::circle:
      append_row(kernels::CircleRow<double>{{x.x(), x.y()}, c.radius, 0}, f.row);
      break;
    case ShapeKind::capsule: {
      const Vec3 axis = r.col(plan.scene.space == Space::planar ? 1 : 2);
      append_row(
          kernels::CapsuleRow<double>{
              {x.x(), x.y(), x.z()}, c.thickness, {axis.x(), axis.y(), axis.z()}, c.half.x()},
          f.row);
      const Vec3 e = axis.cwiseAbs() * c.half.x() + Vec3::Constant(c.thickness);
      f.low = x - e, f.high = x + e;
      break;
    }
    case ShapeKind::rectangle: {
      append_row(
          kernels::RectangleRow<double>{
              {x.x(), x.y()}, r(0, 0), r(1, 0), {c.half.x(), c.half.y()}, {0, 0}},
          f.row);
      const Vec3 e = r.cwiseAbs() * c.half;
      f.low = x - e, f.high = x + e;
      break;
    }
    case ShapeKind::polygon:
    case ShapeKind::rounded: put_polygon(c, x, r, f); break;
    default: put_box(c, x, r, f);
  }
  if (c.kind == ShapeKind::hull) {
    f.row.insert(f.row.end(), {0, 0, 0, 0});
    f.row.insert(f.row.end(), corners.rows.begin(), corners.rows.end());
  }
  return f;
}

std::vector<PlanFixed> parts_of(const Body& body, const Shape& shape, const PlanData& plan) {
  if (std::holds_alternative<Terrain>(shape.geometry)) return terrain_links(body, shape);
  if (const auto* field = std::get_if<HeightField>(&shape.geometry)) {
    return height_field_tiles(body, shape, tiles_of(*field, plan.scene), plan.scene);
  }
  return {fixed_shape(body, shape, plan)};
}

// Whether a body can rotate through a plane before contacts, which look ahead along straight lines,
// see it. Casts decide it for each world.
bool has_thin_bodies(const PlanData& plan) {
  constexpr double kThin = 0.999 * kernels::kThinBody;  // whatever rounds
  return std::any_of(plan.bodies.begin(), plan.bodies.end(), [&](const PlanBody& b) {
    const bool varies = plan.varies.shapes || b.reshaped || b.shifted;
    return b.inv_mass > 0 && !b.jointed && (varies || b.radius > kThin * b.half_thickness);
  });
}

}  // namespace

void choose_polygons(PlanData& plan) {
  plan.rectangles = all_rectangles(plan);
  plan.rounded = any_rounded(plan);
}

void collect_colliders(PlanData& plan) {
  plan.hulls.clear();
  for (PlanBody& owner : plan.bodies) {
    const Body& body = plan.scene.bodies[static_cast<std::size_t>(owner.scene_body)];
    owner.half_thickness = 0;
    for (std::size_t k = 0; k < body.shapes.size(); ++k) {
      PlanCollider c = local_collider(body.shapes[k], plan);
      double half_thickness = c.inner_radius;
      if (const auto* hull = std::get_if<Hull>(&body.shapes[k].geometry)) {
        const HullCorners corners =
            hull_corners(*hull, is_stretched(plan, owner.scene_body, static_cast<int>(k)));
        set_hull(corners, c);
        half_thickness = corners.half_thickness;
        c.hull = put_corners(plan, corners);
      }
      c.body = plan.state_body[static_cast<std::size_t>(owner.scene_body)];
      c.scene_body = owner.scene_body, c.shape = static_cast<int>(k);
      if (!owner.aligned) {
        const Mat3 to_principal = owner.principal.conjugate().toRotationMatrix();
        c.offset = to_principal * (c.offset - owner.center);
        c.rotation = to_principal * c.rotation;
      }
      // The centre of a symmetric compound comes out of sums: what is only rounding is zero.
      if (c.offset.norm() <= 1e-14 * c.radius) c.offset.setZero();
      owner.radius = std::max(owner.radius, c.offset.norm() + c.radius);
      if (body.shapes[k].filter.mask != 0) {
        const bool first = owner.half_thickness == 0;
        owner.half_thickness =
            first ? half_thickness : std::min(owner.half_thickness, half_thickness);
      }
      plan.colliders.push_back(std::move(c));
    }
  }
  // Pose rows hold the place of a table as a number of float32.
  constexpr std::size_t kMostRows = 1 << 24;
  if (plan.hulls.size() / 4 > kMostRows) {
    throw SceneError(
        {{"shapes", "have hulls whose tables take " + std::to_string(plan.hulls.size() / 4) +
                        " rows, must be at most " + std::to_string(kMostRows)}});
  }
  for (const Joint& joint : plan.scene.joints) {
    for (const BodyId body : {joint.body_a, joint.body_b}) {
      const int row = body ? plan.state_body[static_cast<std::size_t>(body.index())] : -1;
      if (row >= 0) plan.bodies[static_cast<std::size_t>(row)].jointed = true;
    }
  }
}

void collect_fixed(PlanData& plan) {
  for (std::size_t i = 0; i < plan.scene.bodies.size(); ++i) {
    const Body& body = plan.scene.bodies[i];
    for (std::size_t k = 0; body.motion == Motion::fixed && k < body.shapes.size(); ++k) {
      const Shape& shape = body.shapes[k];
      std::vector<PlanFixed> parts = parts_of(body, shape, plan);
      for (PlanFixed& f : parts) {
        f.scene_body = static_cast<int>(i), f.shape = static_cast<int>(k);
        f.material = shape.material;
        plan.fixed.push_back(std::move(f));
      }
    }
  }
}

void lay_out_shapes(PlanData& plan) {
  plan.collider_is_body = plan.colliders.size() == plan.bodies.size();
  for (std::size_t i = 0; i < plan.colliders.size(); ++i) {
    PlanCollider& c = plan.colliders[i];
    plan.collider_is_body = plan.collider_is_body && c.body == static_cast<int>(i) &&
                            c.offset.isZero(0) && !plan.bodies[i].shifted &&
                            (info(c.kind).ball || c.rotation.isIdentity(0));
    c.row = plan.row_block;
    plan.row_block += info(c.kind).row;
  }
  plan.row_block += kernels::kDummyRow;
  // Whole cache lines per lane keep every row of every lane aligned.
  plan.row_block = (plan.row_block + 15) / 16 * 16;
  int offset = 0;
  for (PlanFixed& f : plan.fixed) {
    f.row_offset = offset;
    offset += static_cast<int>(f.row.size());
    plan.cast = plan.cast || f.kind != ShapeKind::plane || has_thin_bodies(plan);
  }
  plan.cast = plan.cast && plan.scene.options.contact.cast_against_fixed;
}

double min_margin(const PlanData& plan) {
  const double slop = *plan.scene.options.contact.slop;
  if (!plan.has_trees()) return 2 * slop;
  double most = 0;
  for (const Body& body : plan.scene.bodies) {
    for (const Shape& shape : body.shapes) most = std::max(most, shape.material.soft.margin);
  }
  constexpr double kRounding = 0.02;  // of slop: what just touches is found
  return most + kRounding * slop;
}

}  // namespace manyworlds
