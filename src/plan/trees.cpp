#include "src/plan/trees.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace manyworlds {

namespace {

void put(const Vec3& from, double* to) { std::copy_n(from.data(), 3, to); }
void put(const Quat& from, double* to) {
  const Quat q = from.normalized();
  to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z();
}
int count_of(const auto& list) { return static_cast<int>(list.size()); }
bool is_sprung(const NewTreeJoint& joint) { return joint.sprung || joint.stiffness != 0; }

}  // namespace

int last_dof(const PlanTrees& trees, const kernels::TreeLink<double>& link) {
  const auto* at = &link;
  while (at->dofs == 0 && at->parent >= 0) at = &trees.links[static_cast<std::size_t>(at->parent)];
  return at->dofs == 0 ? -1 : at->first_dof + at->dofs - 1;
}

int TreeBuilder::add(const NewLink& link) {
  const int index = count_of(trees_.links);
  auto& out = trees_.links.emplace_back();
  out.body = link.body;
  out.parent = link.parent;
  out.root = link.parent < 0 ? index : trees_.links[static_cast<std::size_t>(link.parent)].root;
  out.first_joint = count_of(trees_.joints);
  out.first_dof = count_of(trees_.dofs);
  put(link.position, out.position), put(link.rotation, out.rotation);
  trees_.link_numbers.push_back(link_numbers(link.center, link.principal));
  links_.push_back(link);
  return index;
}

void TreeBuilder::add(const NewTreeJoint& joint) {
  const int index = count_of(trees_.links) - 1;
  auto& link = trees_.links.back();
  auto& out = trees_.joints.emplace_back();
  out.kind = joint.kind;
  out.coordinate = trees_.coordinates;
  out.dof = count_of(trees_.dofs);
  out.reference = joint.reference;
  put(joint.anchor, out.anchor), put(joint.axis.normalized(), out.axis);
  for (int i = 0; i < kernels::dofs_of(joint.kind); ++i) {
    const int parent = last_dof(trees_, link);
    auto& dof = trees_.dofs.emplace_back();
    dof.link = index;
    dof.parent = parent;
    dof.depth = parent < 0 ? 0 : trees_.dofs[static_cast<std::size_t>(parent)].depth + 1;
    dof.entry = trees_.entries;
    dof.coordinate = out.coordinate;
    dof.sprung = kernels::dofs_of(joint.kind) == 1 && is_sprung(joint);
    trees_.dof_numbers.push_back({joint.armature, joint.damping, joint.stiffness, joint.rest});
    trees_.damped = trees_.damped || joint.damped || joint.damping > 0;
    trees_.entries += dof.depth + 1;
    ++link.dofs;
  }
  const int own = count_of(trees_.joints) - 1;
  if (joint.kind == kernels::TreeJointKind::ball) {
    add_ball(joint, own);
  } else if (joint.range) {
    limited_joints_.push_back(
        {{{out.coordinate, out.dof, 1}}, *joint.range, joint.margin, joint.compliance, own});
  }
  ++link.joints;
  trees_.coordinates += kernels::coordinates_of(joint.kind);
}

void TreeBuilder::add_ball(const NewTreeJoint& joint, int own) {
  const auto [coordinate, dof] =
      std::pair(trees_.joints.back().coordinate, trees_.joints.back().dof);
  if (is_sprung(joint)) trees_.ball_springs.push_back({coordinate, dof});
  // Beyond half a turn there is no angle.
  if (!joint.range) return;
  if ((*joint.range)[1] - joint.margin > std::numbers::pi && !joint.limited) return;
  limited_balls_.push_back(
      {{{coordinate, dof, 1}}, *joint.range, joint.margin, joint.compliance, own});
}

void TreeBuilder::add_drag(const Medium& medium) {
  for (const NewLink& link : links_) {
    trees_.drags.push_back(drag_numbers(medium, link.mass, link.moments));
  }
}

int TreeBuilder::dof_of(int coordinate) const {
  const auto at = std::find_if(trees_.dofs.begin(), trees_.dofs.end(),
                               [&](const auto& dof) { return dof.coordinate == coordinate; });
  return static_cast<int>(at - trees_.dofs.begin());
}

void TreeBuilder::add(const NewLength& tendon) {
  tendons_.push_back(tendon);
  auto& terms = tendons_.back().terms;
  std::sort(terms.begin(), terms.end(), [](const auto& a, const auto& b) { return a.dof > b.dof; });
}

void TreeBuilder::add_limits(const NewLength& length, double inverse_weight, double dt) {
  for (const int side : {1, -1}) {
    kernels::TreeLimit<double> limit{};
    limit.side = side;
    const double end = length.range[side > 0 ? 0 : 1];
    if (!std::isfinite(end)) continue;
    limit.margin = length.margin;
    limit.inverse_weight = inverse_weight;
    limit.power = power_of(length.compliance);
    trees_.limit_numbers.push_back(limit_numbers(end, length.compliance, dt));
    trees_.limited_joints.push_back(length.joint);
    limit.first_term = count_of(trees_.terms);
    limit.terms = count_of(length.terms);
    for (const auto& term : length.terms) limit.coupled |= std::uint64_t{1} << term.dof;
    trees_.terms.insert(trees_.terms.end(), length.terms.begin(), length.terms.end());
    trees_.limits.push_back(limit);
  }
}

PlanTrees TreeBuilder::finish(double dt, const kernels::NewtonOptions<double>& newton) {
  trees_.weights = weights_of(trees_, links_);
  for (const NewLength& joint : limited_joints_) {
    add_limits(joint, trees_.weights.dof[static_cast<std::size_t>(joint.terms[0].dof)], dt);
  }
  for (const NewLength& tendon : tendons_) {
    double weight = 0;
    for (const auto& a : tendon.terms) {
      for (const auto& b : tendon.terms) {
        weight += a.coefficient * b.coefficient * trees_.weights.inverse(a.dof, b.dof);
      }
    }
    add_limits(tendon, weight, dt);
  }
  for (const NewLength& ball : limited_balls_) {
    const auto [coordinate, dof, one] = ball.terms[0];
    trees_.ball_limits.push_back({coordinate, dof, ball.margin,
                                  trees_.weights.dof[static_cast<std::size_t>(dof)],
                                  power_of(ball.compliance)});
    trees_.limit_numbers.push_back(limit_numbers(ball.range[1], ball.compliance, dt));
    trees_.limited_joints.push_back(ball.joint);
  }
  for (auto& link : trees_.links) link.first_child = link.next_child = -1;
  for (int i = count_of(trees_.links) - 1; i >= 0; --i) {
    auto& link = trees_.links[static_cast<std::size_t>(i)];
    link.last_dof = last_dof(trees_, link);
    if (link.parent < 0) continue;
    auto& parent = trees_.links[static_cast<std::size_t>(link.parent)];
    link.next_child = parent.first_child, parent.first_child = i;
  }
  for (auto& link : trees_.links) {
    link.moves_freely = link.joints == 1 &&
                        trees_.joints[static_cast<std::size_t>(link.first_joint)].kind ==
                            kernels::TreeJointKind::free &&
                        std::none_of(trees_.dofs.begin(), trees_.dofs.end(), [&](const auto& d) {
                          return d.parent == link.first_dof + link.dofs - 1;
                        });
  }
  const auto several = [](const auto& limit) { return limit.terms > 1; };
  trees_.couplings =
      count_of(trees_.ball_limits) +
      static_cast<int>(std::count_if(trees_.limits.begin(), trees_.limits.end(), several));
  trees_.newton = newton;
  const double dofs = std::max<double>(1, static_cast<double>(trees_.dofs.size()));
  trees_.newton.scale = 1 / (trees_.weights.mean_inertia * dofs);
  return std::move(trees_);
}

}  // namespace manyworlds
