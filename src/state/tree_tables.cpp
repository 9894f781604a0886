#include "src/state/tree_tables.hpp"

#include <algorithm>

namespace manyworlds {

namespace {

template <class Real, std::size_t N>
void copy(const double (&from)[N], Real (&to)[N]) {
  std::transform(from, from + N, to, [](double x) { return static_cast<Real>(x); });
}

}  // namespace

template <class Real>
TreeTables<Real>::TreeTables(const PlanTrees& trees, int first_coordinate, int first_dof) {
  for (const auto& from : trees.links) {
    kernels::TreeLink<Real> to{from.body,
                               from.parent,
                               from.root,
                               from.first_joint,
                               from.joints,
                               from.first_dof,
                               from.dofs,
                               from.last_dof,
                               from.first_child,
                               from.next_child,
                               from.moves_freely,
                               {},
                               {}};
    copy(from.position, to.position), copy(from.rotation, to.rotation);
    links_.push_back(to);
  }
  for (const auto& from : trees.joints) {
    kernels::TreeJoint<Real> to{
        from.kind, from.coordinate, from.dof, {}, {}, static_cast<Real>(from.reference)};
    copy(from.anchor, to.anchor), copy(from.axis, to.axis);
    joints_.push_back(to);
  }
  dofs_ = trees.dofs;
  table_.damped = trees.damped;
  for (const auto& from : trees.limits) {
    limits_.push_back({static_cast<Real>(from.side), static_cast<Real>(from.margin),
                       static_cast<Real>(from.inverse_weight), from.power, from.first_term,
                       from.terms, from.coupled});
  }
  for (const auto& from : trees.terms) {
    terms_.push_back({from.coordinate, from.dof, static_cast<Real>(from.coefficient)});
  }
  for (const auto& from : trees.ball_limits) {
    ball_limits_.push_back({from.coordinate, from.dof, static_cast<Real>(from.margin),
                            static_cast<Real>(from.inverse_weight), from.power});
  }
  ball_springs_ = trees.ball_springs;
  actuators_ = trees.actuators;
  for (const auto& from : trees.pairs) {
    pairs_.push_back({from.link_a, from.link_b, from.only_link, from.cone, from.material_a,
                      from.material_b, static_cast<Real>(from.margin),
                      static_cast<Real>(from.inverse_weight),
                      static_cast<Real>(from.friction_weight), from.compliance, from.power,
                      from.first_dof, from.dofs, from.coupled});
  }
  pair_dofs_ = trees.pair_dofs;
  table_.has_rows = !trees.limits.empty() || !trees.ball_limits.empty() || !trees.pairs.empty();
  for (std::size_t k = 0; table_.has_rows && k < trees.dofs.size(); ++k) {
    const auto parent = static_cast<std::size_t>(trees.dofs[k].parent);
    const bool first = trees.dofs[k].parent < 0;
    ancestors_.push_back(first ? 0 : ancestors_[parent] | std::uint64_t{1} << parent);
  }
  table_.elliptic = trees.elliptic;
  table_.has_medium = !trees.drags.empty();
  table_.impedance_ratio = static_cast<Real>(trees.impedance_ratio);
  table_.stages = 1;
  table_.actuators = static_cast<std::int32_t>(actuators_.size());
  const auto& newton = trees.newton;
  table_.newton = {newton.iterations, newton.line_iterations, static_cast<Real>(newton.tolerance),
                   static_cast<Real>(newton.line_tolerance), static_cast<Real>(newton.scale)};
  table_.limits = static_cast<std::int32_t>(limits_.size());
  table_.ball_limits = static_cast<std::int32_t>(ball_limits_.size());
  table_.ball_springs = static_cast<std::int32_t>(ball_springs_.size());
  table_.links = static_cast<std::int32_t>(links_.size());
  table_.dofs = static_cast<std::int32_t>(dofs_.size());
  table_.coordinates = trees.coordinates;
  table_.entries = trees.entries;
  table_.by_links = trees.by_links;
  table_.couplings = trees.by_links ? trees.couplings : 0;
  table_.first_coordinate = first_coordinate;
  table_.first_dof = first_dof;
}

template <class Real>
kernels::TreeTable<Real> TreeTables<Real>::get() const {
  kernels::TreeTable<Real> out = table_;
  out.link = links_.data(), out.joint = joints_.data(), out.dof = dofs_.data();
  out.pair = pairs_.data(), out.pair_dof = pair_dofs_.data();
  out.ancestors = ancestors_.data();
  out.term = terms_.data();
  out.ball_limit = ball_limits_.data(), out.ball_spring = ball_springs_.data();
  out.limit = limits_.data(), out.actuator = actuators_.data();
  return out;
}

template class TreeTables<float>;
template class TreeTables<double>;

}  // namespace manyworlds
