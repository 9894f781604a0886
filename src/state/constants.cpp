#include "src/state/constants.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace manyworlds {

namespace {

template <class Real>
void copy_numbers(const Vec3& from, Real* to) {
  for (int c = 0; c < 3; ++c) to[c] = static_cast<Real>(from[c]);
}

template <class Real>
kernels::PrincipalInertia<Real> principal_of(const PlanBody& body, double dt) {
  const bool tumbles = body.inv_inertia.z() > 0;
  const Vec3 inertia = tumbles ? body.inertia : Vec3::Ones();
  const Vec3 inverse = tumbles ? body.inv_inertia : Vec3::Ones();
  kernels::PrincipalInertia<Real> out{};
  copy_numbers(inertia, out.inertia);
  copy_numbers(inverse, out.inverse);
  copy_numbers(Vec3(inverse.cwiseProduct(Vec3(dt / 2, dt / 2, dt))), out.rate);
  out.angle_bound = static_cast<Real>(dt * std::sqrt(inverse.maxCoeff()));
  return out;
}

// So that the pull of a point on itself is 0, and not 0 / 0, in float.
constexpr double kMinSoftening2 = 1e-24;  // m^2

template <class Real>
kernels::AttractorConstants<Real> attractor_constants(const Attractor& a) {
  kernels::AttractorConstants<Real> out{};
  copy_numbers(a.position, out.position);
  out.strength = static_cast<Real>(a.strength);
  out.softening2 = static_cast<Real>(std::max(a.softening * a.softening, kMinSoftening2));
  return out;
}

bool has_polygons(const PlanData& plan) {
  return std::any_of(plan.colliders.begin(), plan.colliders.end(),
                     [](const PlanCollider& c) { return !c.vertices.empty(); });
}

}  // namespace

template <class Real>
kernels::BodyConstants<Real> body_constants(const PlanData& plan, const PlanBody& b) {
  const Options& options = plan.scene.options;
  const Body& body = plan.scene.bodies[static_cast<std::size_t>(b.scene_body)];
  const double h = plan.substep_dt();
  kernels::BodyConstants<Real> out{};
  out.mass = static_cast<Real>(b.mass);
  out.inv_mass = static_cast<Real>(b.inv_mass);
  copy_numbers(b.inertia, out.inertia);
  copy_numbers(b.inv_inertia, out.inv_inertia);
  out.principal = principal_of<Real>(b, plan.pass_dt());
  out.radius = static_cast<Real>(b.radius);
  out.half_thickness = static_cast<Real>(b.inv_mass > 0 ? b.half_thickness : 0);
  out.linear_factor = out.angular_factor = 1;
  if (b.inv_mass == 0) return out;
  out.gravity_scale = static_cast<Real>(body.gravity_scale);
  copy_numbers(options.gravity * body.gravity_scale, out.gravity);
  const Vec3 g = options.gravity * body.gravity_scale + body.linear_drag * options.wind;
  copy_numbers(g, out.acceleration);
  for (int c = 0; c < (plan.scene.space == Space::planar ? 2 : 3); ++c) {
    out.delta_v[c] = static_cast<Real>(h * g[c]) + Real(0);  // never -0
  }
  out.linear_drag = static_cast<Real>(body.linear_drag);
  out.angular_drag = static_cast<Real>(body.angular_drag);
  out.linear_factor = static_cast<Real>(1 / (1 + h * body.linear_drag));
  out.angular_factor = static_cast<Real>(1 / (1 + h * body.angular_drag));
  return out;
}

template <class Real>
kernels::ShapeConstants<Real> shape_constants(const PlanData& plan, const PlanCollider& c) {
  kernels::ShapeConstants<Real> out{};
  copy_numbers(c.offset, out.offset);
  for (int k = 0; k < 9; ++k) out.rotation[k] = static_cast<Real>(c.rotation(k % 3, k / 3));
  copy_numbers(c.half, out.half);
  const bool has_thickness = c.thickness > 0 || c.kind == kernels::ShapeKind::rounded;
  out.radius = static_cast<Real>(has_thickness ? c.thickness : c.radius);
  // A speculative row holds along one normal, which is good as long as the gap is not large
  // against the shape. Round shapes keep their normals better. The newton solver has no such rows.
  const double least = min_margin(plan), cap = info(c.kind).ball ? 2 * c.radius : c.inner_radius;
  out.margin_cap = static_cast<Real>(plan.has_trees() ? least : std::max(least, cap));
  return out;
}

template <class Real>
kernels::PolygonConstants<Real> polygon_constants(const PlanCollider& c) {
  kernels::PolygonConstants<Real> out{};
  for (std::size_t i = 0; i < kernels::kMaxVertices && !c.vertices.empty(); ++i) {
    const std::size_t n = c.vertices.size(), at = i < n ? i : 0;
    const Vec2 edge = c.vertices[(at + 1) % n] - c.vertices[at];
    const Vec2 normal = Vec2(edge.y(), -edge.x()).normalized();
    for (std::size_t k = 0; k < 2; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      out.vertices[2 * i + k] = static_cast<Real>(c.vertices[at][row]);
      out.normals[2 * i + k] = static_cast<Real>(normal[row]);
    }
  }
  return out;
}

// Every member is a number.
template <class Real, template <class> class Numbers>
Numbers<Real> as_real(const Numbers<double>& numbers) {
  constexpr std::size_t kNumbers = sizeof numbers / sizeof(double);
  double from[kNumbers];
  Real to[kNumbers];
  std::memcpy(from, &numbers, sizeof numbers);
  for (std::size_t i = 0; i < kNumbers; ++i) to[i] = static_cast<Real>(from[i]);
  Numbers<Real> out;
  static_assert(sizeof out == sizeof to);
  std::memcpy(&out, to, sizeof out);
  return out;
}

template <class Real>
Constants<Real>::Constants(const PlanData& plan, Parts parts, int groups, int lanes)
    : parts_(parts), lanes_(lanes) {
  const auto make = [&](Block& block, bool wanted, std::size_t items, std::size_t item_bytes) {
    if (!wanted) return;
    block.rows = items * (item_bytes / sizeof(Real));
    block.numbers = AlignedBuffer<Real>(static_cast<std::size_t>(groups) * block.rows *
                                        static_cast<std::size_t>(lanes));
  };
  // The last body is the dummy, whose numbers stay 0.
  make(bodies_, parts.bodies, plan.bodies.size() + 1, sizeof(kernels::BodyConstants<Real>));
  make(shapes_, parts.shapes, plan.colliders.size(), sizeof(kernels::ShapeConstants<Real>));
  make(polygons_, parts.shapes && has_polygons(plan), plan.colliders.size(),
       sizeof(kernels::PolygonConstants<Real>));
  make(materials_, parts.materials, plan.colliders.size() + plan.fixed.size(),
       sizeof(kernels::MaterialOf<Real>));
  make(joints_, parts.joints && !plan.parts.empty(), plan.parts.size(),
       sizeof(kernels::JointConstants<Real>));
  make(thrusts_, parts.thrusts, plan.thrusts.size(), sizeof(kernels::ThrustConstants<Real>));
  const PlanTrees& trees = plan.trees;
  make(links_, parts.links, trees.links.size(), sizeof(kernels::LinkConstants<Real>));
  make(drags_, parts.links, trees.drags.size(), sizeof(kernels::DragConstants<Real>));
  make(dofs_, parts.dofs, trees.dofs.size(), sizeof(kernels::DofConstants<Real>));
  make(actuators_, parts.actuators, trees.actuators.size(),
       sizeof(kernels::ActuatorConstants<Real>));
  make(limits_, parts.limits, trees.limit_numbers.size(), sizeof(kernels::LimitConstants<Real>));
  make(contacts_, parts.contacts, trees.compliances.size(), sizeof(kernels::Compliance<Real>));
  make(attractors_, parts.attractors, plan.scene.attractors.size(),
       sizeof(kernels::AttractorConstants<Real>));
}

template <class Real>
kernels::ConstantBlocks<Real> Constants<Real>::group(int index) const {
  const auto at = static_cast<std::size_t>(index), lanes = static_cast<std::size_t>(lanes_);
  return {bodies_.group(at, lanes),    shapes_.group(at, lanes), polygons_.group(at, lanes),
          materials_.group(at, lanes), joints_.group(at, lanes), thrusts_.group(at, lanes),
          links_.group(at, lanes),     drags_.group(at, lanes),  dofs_.group(at, lanes),
          actuators_.group(at, lanes), limits_.group(at, lanes), contacts_.group(at, lanes),
          attractors_.group(at, lanes)};
}

template <class Real>
template <class Item>
void Constants<Real>::put(Block& block, std::size_t item, const Item& value, int lane_index) {
  constexpr std::size_t kMembers = sizeof(Item) / sizeof(Real);
  Real members[kMembers];
  std::memcpy(members, &value, sizeof value);
  const auto lanes = static_cast<std::size_t>(lanes_), at = static_cast<std::size_t>(lane_index);
  Real* to = block.numbers.data() + ((at / lanes) * block.rows + item * kMembers) * lanes;
  for (std::size_t m = 0; m < kMembers; ++m) to[m * lanes + at % lanes] = members[m];
}

template <class Real>
void Constants<Real>::fill(const PlanData& plan, int lane_index) {
  for (std::size_t b = 0; parts_.bodies && b < plan.bodies.size(); ++b) {
    put(bodies_, b, body_constants<Real>(plan, plan.bodies[b]), lane_index);
  }
  for (std::size_t c = 0; c < plan.colliders.size(); ++c) {
    const PlanCollider& shape = plan.colliders[c];
    if (parts_.shapes) put(shapes_, c, shape_constants<Real>(plan, shape), lane_index);
    if (!polygons_.numbers.empty()) put(polygons_, c, polygon_constants<Real>(shape), lane_index);
  }
  for (std::size_t p = 0; !joints_.numbers.empty() && p < plan.parts.size(); ++p) {
    put(joints_, p, as_real<Real>(plan.parts[p].constants), lane_index);
  }
  for (std::size_t i = 0; !thrusts_.numbers.empty() && i < plan.thrusts.size(); ++i) {
    kernels::ThrustConstants<Real> value{};
    copy_numbers(plan.thrusts[i].point, value.point);
    copy_numbers(plan.thrusts[i].direction, value.direction);
    put(thrusts_, i, value, lane_index);
  }
  const auto put_all = [&](Block& block, const auto& items) {
    for (std::size_t i = 0; !block.numbers.empty() && i < items.size(); ++i) {
      put(block, i, as_real<Real>(items[i]), lane_index);
    }
  };
  put_all(links_, plan.trees.link_numbers), put_all(drags_, plan.trees.drags);
  put_all(dofs_, plan.trees.dof_numbers), put_all(actuators_, plan.trees.actuator_numbers);
  put_all(limits_, plan.trees.limit_numbers), put_all(contacts_, plan.trees.compliances);
  for (std::size_t i = 0; !attractors_.numbers.empty() && i < plan.scene.attractors.size(); ++i) {
    put(attractors_, i, attractor_constants<Real>(plan.scene.attractors[i]), lane_index);
  }
  const auto material = [&](std::size_t item, const Material& m) {
    const kernels::MaterialOf<Real> value{
        static_cast<Real>(m.friction), static_cast<Real>(m.restitution),
        static_cast<Real>(m.rolling_resistance), static_cast<Real>(m.torsional_resistance)};
    put(materials_, item, value, lane_index);
  };
  if (!parts_.materials) return;
  for (std::size_t c = 0; c < plan.colliders.size(); ++c) material(c, plan.colliders[c].material);
  for (std::size_t f = 0; f < plan.fixed.size(); ++f) {
    material(plan.colliders.size() + f, plan.fixed[f].material);
  }
}

template <class Real>
void Constants<Real>::swap(int first, int second) {
  const auto lanes = static_cast<std::size_t>(lanes_);
  const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(second);
  for_each_block(*this, [&](Block& block) {
    if (block.numbers.empty()) return;
    Real* in_a = block.numbers.data() + (a / lanes) * block.rows * lanes + a % lanes;
    Real* in_b = block.numbers.data() + (b / lanes) * block.rows * lanes + b % lanes;
    for (std::size_t r = 0; r < block.rows; ++r) std::swap(in_a[r * lanes], in_b[r * lanes]);
  });
}

template <class Real>
void Constants<Real>::copy(int from, int to) {
  const auto lanes = static_cast<std::size_t>(lanes_);
  const auto a = static_cast<std::size_t>(from), b = static_cast<std::size_t>(to);
  for_each_block(*this, [&](Block& block) {
    if (block.numbers.empty()) return;
    const Real* source = block.numbers.data() + (a / lanes) * block.rows * lanes + a % lanes;
    Real* target = block.numbers.data() + (b / lanes) * block.rows * lanes + b % lanes;
    for (std::size_t r = 0; r < block.rows; ++r) target[r * lanes] = source[r * lanes];
  });
}

template <class Real>
std::size_t Constants<Real>::bytes() const {
  std::size_t numbers = 0;
  for_each_block(*this, [&](const Block& block) { numbers += block.numbers.size(); });
  return numbers * sizeof(Real);
}

#define MW_INSTANTIATE(Real)                                                                    \
  template class Constants<Real>;                                                               \
  template kernels::BodyConstants<Real> body_constants<Real>(const PlanData&, const PlanBody&); \
  template kernels::ShapeConstants<Real> shape_constants<Real>(const PlanData&,                 \
                                                               const PlanCollider&);            \
  template kernels::PolygonConstants<Real> polygon_constants<Real>(const PlanCollider&);
MW_INSTANTIATE(float)
MW_INSTANTIATE(double)
#undef MW_INSTANTIATE

}  // namespace manyworlds
