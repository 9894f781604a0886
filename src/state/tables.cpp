#include "src/state/tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "src/plan/pair_kinds.hpp"
#include "src/plan/soft_constraint.hpp"
#include "src/plan/state_layout.hpp"
#include "src/scene/length_unit.hpp"

namespace manyworlds {

namespace {

// Of gravity: impacts that these give do not bounce (ContactOptions::restitution_threshold).
constexpr double kPassesThatRest = 2;
constexpr double kSlowImpact = 1.0 / 16;  // of the push-out speed: slower is no impact
// Of impulses, in the first and in the last round after an impact (kernels/solver/strikes.hpp).
template <class Real>
constexpr double kFirstTolerance = sizeof(Real) == 4 ? 1e-5 : 1e-11;
constexpr double kLastTolerance = 1;
constexpr double kMostSag = 0.01;  // of the length unit, under what presses on fixed shapes
constexpr double kDeep = 4;        // times the speed per length unit of overlap, up to twice it

template <class Real>
kernels::Softness<Real> softness(double frequency, double damping_ratio, double h) {
  if (frequency == 0) return {0, 1, 0};
  const SoftConstraint soft = soft_constraint(frequency, damping_ratio, h);
  const double rest = 1 / (1 + soft.gain);
  return {static_cast<Real>(soft.rate), static_cast<Real>(soft.gain * rest),
          static_cast<Real>(rest)};
}

template <class Real>
void copy(const Vec3& from, Real* to) {
  for (int c = 0; c < 3; ++c) to[c] = static_cast<Real>(from[c]);
}

template <class Planned>
const Filter& filter_of(const PlanData& plan, const Planned& s) {
  return plan.scene.bodies[static_cast<std::size_t>(s.scene_body)]
      .shapes[static_cast<std::size_t>(s.shape)]
      .filter;
}

}  // namespace

template <class Real>
TablesOf<Real>::TablesOf(const PlanData& plan, const BatchOptions& options, int lanes)
    : constants_(plan, {}, 1, lanes), joints_(plan) {
  add_options(plan);
  add_flight(plan);
  add_bodies(plan);
  // Without contacts and joints nothing comes to rest, and without bodies nothing is there to.
  tables_.has_sleep = options.sleep && tables_.has_substeps &&
                      (tables_.has_contacts || tables_.has_joints) && tables_.bodies > 0 &&
                      !plan.has_trees();
  add_shapes(plan);
  joints_.put(tables_);
  add_trees(plan);
  tables_.attractors = static_cast<std::int32_t>(plan.scene.attractors.size());
  add_pairs(plan);
  if (plan.audited()) tables_.audit_every = options.audit_every;
  for (int lane = 0; lane < lanes; ++lane) constants_.fill(plan, lane);
  tables_.constants = constants_.group(0);
}

template <class Real>
void TablesOf<Real>::add_options(const PlanData& plan) {
  const Options& o = plan.scene.options;
  auto& t = tables_;
  t.dimension = plan.dimension();
  t.inertia_kind = plan.inertia_kind;
  t.passes = plan.passes();
  t.substeps = plan.pass_substeps();
  t.restitution_sweeps = o.contact.restitution_sweeps;
  t.has_orientation = plan.has(Feature::orientation);
  t.looks_ahead = plan.orientations_matter && plan.parts.empty() && !plan.has_trees();
  t.has_friction = plan.has(Feature::friction);
  t.has_restitution = plan.has(Feature::restitution);
  t.has_resistance = plan.has(Feature::resistance);
  t.has_contacts = plan.has(Feature::contacts);
  t.has_joints = !plan.parts.empty();
  t.has_substeps = plan.runs(StepStage::begin);
  t.controls = static_cast<std::int32_t>(plan.scene.controls.size());
  t.has_drag = plan.has(Feature::drag);
  t.slows = plan.slows;
  t.has_gravity = plan.has(Feature::gravity);
  t.collider_is_body = plan.collider_is_body;
  t.friction_in_bias = o.contact.friction_in_bias_pass;
  t.uniform_gravity = plan.uniform_gravity;
  t.uniform_friction = plan.uniform_friction;
  t.sweep = plan.sweep;
  t.sparse = plan.sparse;
  t.cast = plan.cast && t.has_contacts;
  t.cast_moving = o.contact.cast_between_moving && t.has_contacts;
  t.delta_v_varies = plan.varies.delta_v;
  t.drag_varies = plan.varies.drag;
  t.bodies_vary = plan.varies.masses;
  t.has_bounds = o.bounds.has_value();
  if (o.bounds) {
    copy(o.bounds->min(), t.bounds_low);
    copy(o.bounds->max(), t.bounds_high);
  }
  const double h = plan.substep_dt();
  t.step_dt = static_cast<Real>(o.dt);
  t.dt = static_cast<Real>(plan.pass_dt());
  t.h = static_cast<Real>(h);
  t.inv_h = static_cast<Real>(1 / h);
  const double frequency = *o.contact.frequency;
  t.soft_pair = softness<Real>(frequency, o.contact.damping_ratio, h);
  t.soft_fixed =
      softness<Real>(o.contact.fixed_frequency.value_or(2 * frequency), o.contact.damping_ratio, h);
  t.fixed_leak = t.soft_fixed.bias_rate * t.soft_fixed.mass_scale *
                 static_cast<Real>(kMostSag * *o.length_unit);
  add_solver(plan);
  t.push_out_speed = static_cast<Real>(*o.contact.push_out_speed);
  // Slower changes may be those of the push-out. Not by the world's own gravity: worlds whose
  // gravity varies would not have the bits of their scenes.
  t.blow_speed = t.push_out_speed;
  t.impact_sweeps = *o.contact.impact_sweeps;
  t.strike_speed = static_cast<Real>(kSlowImpact * *o.contact.push_out_speed);
  t.strike_tolerance = static_cast<Real>(kFirstTolerance<Real>);
  t.strike_growth = static_cast<Real>(
      std::pow(kLastTolerance / kFirstTolerance<Real>, 1.0 / std::max(t.impact_sweeps, 1)));
  t.push_out_rate = static_cast<Real>(kDeep * *o.contact.push_out_speed / *o.length_unit);
  t.margin = static_cast<Real>(2 * min_margin(plan));
  t.half_margin = static_cast<Real>(min_margin(plan));
  const bool by_gravity = !o.contact.restitution_threshold;
  t.restitution_threshold = static_cast<Real>(o.contact.restitution_threshold.value_or(0));
  t.restitution_time = static_cast<Real>(by_gravity ? kPassesThatRest * plan.pass_dt() : 0);
  t.sleep_speed = static_cast<Real>(*o.sleep.speed);
  t.sleep_time = static_cast<Real>(o.sleep.time);
  t.face_bias = static_cast<Real>(0.5 * *o.contact.slop);
  t.face_tie = static_cast<Real>(0.02 * *o.contact.slop);
  const StateLayout layout = state_layout(plan);
  t.bodies = layout.items[static_cast<int>(ItemKind::body)];
  t.state_stride = layout.stride[static_cast<int>(ItemKind::body)];
  t.state_size = layout.rows;
}

template <class Real>
void TablesOf<Real>::add_solver(const PlanData& plan) {
  static_assert(static_cast<int>(kernels::Solver::newton) == static_cast<int>(Solver::newton));
  const Options& o = plan.scene.options;
  auto& t = tables_;
  t.solver.kind = static_cast<kernels::Solver>(o.solver.method);
  t.solver.iterations = iterations_of(o.solver);
  t.solver.relaxation = static_cast<Real>(o.solver.method == Solver::sor ? o.solver.relaxation : 1);
  t.solver.relaxes = t.solver.relaxation != 1;
  t.solver.splits = has_hard_rows(o.solver.method) && o.solver.split_impulse;
  t.solver.push_out_share = static_cast<Real>(o.solver.push_out_share);
  if (!has_hard_rows(o.solver.method)) return;
  const double share = o.solver.split_impulse ? 0 : o.solver.push_out_share;
  t.solver.slop = static_cast<Real>(*o.contact.slop);
  const double rate = share * plan.pass_substeps() / plan.pass_dt();
  t.soft_pair = t.soft_fixed = {static_cast<Real>(rate), 1, 0};
}

template <class Real>
void TablesOf<Real>::add_flight(const PlanData& plan) {
  const Options& o = plan.scene.options;
  auto& t = tables_;
  auto& flight = t.flight;
  flight.on = has_flight(o) && !plan.has_trees();
  static_assert(static_cast<int>(kernels::Scheme::runge_kutta4) ==
                    static_cast<int>(Integrator::runge_kutta4) &&
                static_cast<int>(kernels::Rotation::exponential) ==
                    static_cast<int>(Rotation::exponential));
  flight.scheme = static_cast<kernels::Scheme>(o.integrator);
  flight.rotation = static_cast<kernels::Rotation>(o.rotation.value_or(Rotation::exponential));
  flight.momentum = o.angular_momentum;
  flight.damped = t.has_drag;
  for (const PlanPart& p : plan.parts) {
    if (!p.what.force) continue;
    ++flight.springs;
    const auto may_damp = [&](const VariedNumber& n) {
      return n.parameter == Parameter::spring_damping && n.of.joint == p.joint && n.high > 0;
    };
    flight.damped = flight.damped || p.constants.damping > 0 ||
                    std::any_of(plan.varied.begin(), plan.varied.end(), may_damp);
  }
}

// The axis of the middle one of three moments; of equal ones the later is larger.
std::uint8_t middle_axis(const Vec3& moments) {
  std::array<std::uint8_t, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(),
                   [&](std::uint8_t a, std::uint8_t b) { return moments[a] < moments[b]; });
  return axes[1];
}

template <class Real>
void TablesOf<Real>::add_bodies(const PlanData& plan) {
  auto& t = tables_;
  const std::size_t dim = plan.scene.space == Space::planar ? 2 : 3;
  const auto row = static_cast<std::size_t>(kernels::velocity_row_size(t.dimension));
  // Padded as the rows of a lane are (kernels/work.cpp): up to one register more.
  delta_v_rows_ = AlignedBuffer<Real>((plan.bodies.size() + 2) * row + 16);
  factor_rows_ = AlignedBuffer<Real>((plan.bodies.size() + 2) * row + 16);
  for (std::size_t i = 0; i < factor_rows_.size(); ++i) factor_rows_[i] = 1;
  std::vector<bool> rotated(plan.bodies.size() + 1);  // the last: the world
  const bool joints = plan.runs(StepStage::joints);
  for (const PlanPart& part : plan.parts) {
    rotated[static_cast<std::size_t>(part.what.body_a)] = joints;
    rotated[static_cast<std::size_t>(part.what.body_b)] = joints;
  }
  for (std::size_t i = 0; i < plan.bodies.size(); ++i) {
    const PlanBody& b = plan.bodies[i];
    bodies_.push_back({b.inv_mass == 0, b.jointed, rotated[i], middle_axis(b.inertia)});
    const auto numbers = body_constants<Real>(plan, b);
    for (std::size_t c = 0; c < dim; ++c) delta_v_rows_[i * row + c] = numbers.delta_v[c];
    for (std::size_t c = 0; c < row; ++c) {
      factor_rows_[i * row + c] = c < dim ? numbers.linear_factor : numbers.angular_factor;
    }
  }
  t.body = bodies_.data();
  t.delta_v_rows = delta_v_rows_.data();
  t.factor_rows = factor_rows_.data();
}

template <class Real>
void TablesOf<Real>::add_shapes(const PlanData& plan) {
  auto& t = tables_;
  for (const PlanCollider& c : plan.colliders) {
    const Filter& filter = filter_of(plan, c);
    const auto vertices = static_cast<std::int32_t>(c.vertices.size());
    colliders_.push_back({c.kind, c.body, c.row, filter.category, filter.mask, vertices, c.hull});
    collider_row_.push_back(c.row);
    collider_body_.push_back(c.body);
  }
  collider_row_.push_back(plan.row_block - kernels::kDummyRow);
  collider_body_.push_back(t.bodies);
  for (int body = 0, i = 0; body <= t.bodies; ++body) {
    while (i < static_cast<int>(colliders_.size()) &&
           collider_body_[static_cast<std::size_t>(i)] < body)
      ++i;
    first_collider_.push_back(i);
  }

  std::size_t rows = 0;
  for (const PlanFixed& f : plan.fixed) rows += f.row.size();
  fixed_rows_ = AlignedBuffer<Real>(rows);
  for (const PlanFixed& f : plan.fixed) {
    kernels::FixedTable<Real> out{};
    out.kind = f.kind;
    out.row = f.row_offset;
    const Filter& filter = filter_of(plan, f);
    out.body = t.bodies + 1 + f.scene_body;
    out.category = filter.category;
    out.mask = filter.mask;
    copy(f.low, out.low);
    copy(f.high, out.high);
    for (std::size_t k = 0; k < 4; ++k) out.plane[k] = static_cast<Real>(f.plane[k]);
    for (std::size_t k = 0; k < f.row.size(); ++k) {
      fixed_rows_[static_cast<std::size_t>(f.row_offset) + k] = static_cast<Real>(f.row[k]);
    }
    if (info(f.kind).margin >= 0) {
      fixed_rows_[static_cast<std::size_t>(f.row_offset + info(f.kind).margin)] =
          static_cast<Real>(min_margin(plan));
    }
    fixed_.push_back(out);
  }
  t.colliders = static_cast<std::int32_t>(colliders_.size());
  t.fixed_shapes = static_cast<std::int32_t>(fixed_.size());
  t.collider = colliders_.data();
  t.collider_row = collider_row_.data();
  t.collider_body = collider_body_.data();
  t.first_collider = first_collider_.data();
  t.fixed = fixed_.data();
  const auto planes = std::count_if(fixed_.begin(), fixed_.end(), [](const auto& f) {
    return f.kind == kernels::ShapeKind::plane;
  });
  t.seams = t.fixed_shapes - planes > 1;
  t.fixed_rows = fixed_rows_.data();
  hulls_ = AlignedBuffer<Real>(plan.hulls.size());
  for (std::size_t i = 0; i < plan.hulls.size(); ++i) {
    hulls_[i] = static_cast<Real>(plan.hulls[i]);
  }
  t.hulls = hulls_.data();
  t.row_block = plan.row_block;
}

template <class Real>
void TablesOf<Real>::add_trees(const PlanData& plan) {
  if (!plan.has_trees()) return;
  const StateLayout layout = state_layout(plan);
  trees_.emplace(plan.trees, layout.first[static_cast<int>(ItemKind::coordinate)],
                 layout.first[static_cast<int>(ItemKind::dof)]);
  tables_.tree = trees_->get();
  const Options& o = plan.scene.options;
  tables_.tree.stages = o.integrator == Integrator::runge_kutta4 ? 4 : 1;
  tables_.tree.implicit = o.integrator == Integrator::implicit_fast;
  tables_.tree.damped &= tables_.tree.stages == 1 && o.solver.implicit_damping;
  tables_.tree.damped |= tables_.tree.implicit;
  for (int i = 0; i < 3; ++i) tables_.tree.wind[i] = static_cast<Real>(o.wind[i]);
}

template <class Real>
void TablesOf<Real>::add_pairs(const PlanData& plan) {
  auto& t = tables_;
  const auto n = static_cast<std::size_t>(t.colliders);
  if (plan.sweep) pair_of_.assign(n * n, -1);
  for (const PlanClass& c : plan.classes) {
    if (c.candidates == 0) continue;
    kernels::PairClass<Real> out{};
    out.kind = c.kind;
    out.list = c.list;
    out.count = c.keys;
    out.first_key = c.first_key;
    classes_.push_back(out);
    if (plan.sparse) continue;
    classes_.back().a = c.a.data();
    classes_.back().b = c.b.data();
    if (!plan.sweep || is_fixed(c.list)) continue;
    for (std::size_t i = 0; i < c.a.size(); ++i) {
      const auto a = static_cast<std::size_t>(c.a[i]), b = static_cast<std::size_t>(c.b[i]);
      pair_of_[a * n + b] = pair_of_[b * n + a] = c.first_key + static_cast<std::int32_t>(i);
    }
  }
  t.classes = static_cast<std::int32_t>(classes_.size());
  t.pair_class = classes_.data();
  t.pair_of = pair_of_.data();
  if (plan.sparse) add_pair_classes(plan);
  for (std::size_t l = 0; l < kernels::kLists; ++l) t.capacity[l] = plan.capacity[l];
}

// Which class the kinds of two shapes lead to.
template <class Real>
void TablesOf<Real>::add_pair_classes(const PlanData& plan) {
  const auto at = [](kernels::ShapeKind kind) { return static_cast<std::size_t>(kind); };
  const auto class_of = [&](const KindOfPair& wanted) {
    for (int i = 0; i < tables_.classes; ++i) {
      const auto& c = tables_.pair_class[i];
      if (c.kind == wanted.kind && c.list == wanted.list) return i;
    }
    return -1;
  };
  for (auto& row : tables_.moving_class) std::fill(std::begin(row), std::end(row), -2);
  for (auto& row : tables_.fixed_class) std::fill(std::begin(row), std::end(row), -1);
  std::set<kernels::ShapeKind> moving, fixed;
  for (const PlanCollider& c : plan.colliders) moving.insert(c.kind);
  for (const PlanFixed& f : plan.fixed) fixed.insert(f.kind);
  for (const auto b : moving) {
    for (const auto a : moving) {
      const KindOfPair kind = kind_of_pair(a, b, false);
      tables_.moving_class[at(a)][at(b)] = 2 * class_of(kind) + (kind.swapped ? 1 : 0);
    }
    for (const auto a : fixed) {
      tables_.fixed_class[at(a)][at(b)] = class_of(kind_of_pair(a, b, true));
    }
  }
}

template class TablesOf<float>;
template class TablesOf<double>;

}  // namespace manyworlds
