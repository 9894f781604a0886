// Contacts of trees: what two materials make of one another, as MuJoCo mixes them, and which dofs
// move the links of a pair of shapes against each other.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "src/plan/compliance.hpp"
#include "src/plan/plan_data.hpp"
#include "src/plan/tree_kinematics.hpp"
#include "src/scene/checks.hpp"

namespace manyworlds {

namespace {

static_assert(detail::kMaxNewtonDofs <= kernels::kMaxTreeDofs);

using kernels::ContactCone;

constexpr double kMinWeight = 1e-15;

// Of a manifold.
int max_points(const PlanClass& c) {
  using kernels::ShapeKind;
  if (!is_multi(c.list)) return 1;
  const auto is = [&](ShapeKind a, ShapeKind b) { return c.kind == kernels::pair_of(a, b); };
  return is(ShapeKind::capsule, ShapeKind::capsule) || is(ShapeKind::box, ShapeKind::capsule) ? 2
                                                                                              : 4;
}

double share_of_first(const SoftContact& a, const SoftContact& b) {
  if (a.weight < kMinWeight && b.weight < kMinWeight) return 0.5;
  if (a.weight < kMinWeight) return 0;
  if (b.weight < kMinWeight) return 1;
  return a.weight / (a.weight + b.weight);
}

Compliance mean_compliance(const SoftContact& a, const SoftContact& b) {
  const Compliance &x = a.compliance, &y = b.compliance;
  const double share = share_of_first(a, b);
  const auto mean = [&](double Compliance::*member) {
    return share * x.*member + (1 - share) * y.*member;
  };
  Compliance out;
  const bool standard = x.time_constant > 0 && y.time_constant > 0;
  for (const auto member : {&Compliance::time_constant, &Compliance::damping_ratio}) {
    out.*member = standard ? mean(member) : std::min(x.*member, y.*member);
  }
  for (const auto member : {&Compliance::min_impedance, &Compliance::max_impedance,
                            &Compliance::width, &Compliance::midpoint, &Compliance::power}) {
    out.*member = mean(member);
  }
  return out;
}

class TreePairs {
 public:
  explicit TreePairs(PlanData& plan) : plan_(plan), trees_(plan.trees), link_(plan.bodies.size()) {
    for (std::size_t i = 0; i < trees_.links.size(); ++i) {
      link_[static_cast<std::size_t>(trees_.links[i].body)] = static_cast<int>(i);
    }
  }

  void run() {
    for (const PlanClass& c : plan_.classes) {
      for (std::size_t i = 0; i < c.a.size(); ++i) add(c, i);
    }
  }

  // Rows that couple branches, at most: of contacts between links within a tree, and between trees.
  struct Couplings {
    int within = 0, between = 0;
  };
  Couplings couplings() const {
    Couplings out;
    for (const PlanClass& c : plan_.classes) {
      for (std::size_t i = 0; i < c.a.size(); ++i) {
        const auto& pair = trees_.pairs[static_cast<std::size_t>(c.first_key) + i];
        if (pair.only_link >= 0) continue;
        constexpr int kRows[] = {1, 4, 3};  // of a cone
        const int rows = kRows[static_cast<int>(pair.cone)] * max_points(c);
        (root_of(pair.link_a) == root_of(pair.link_b) ? out.within : out.between) += rows;
      }
    }
    return out;
  }

 private:
  void add(const PlanClass& c, std::size_t i) {
    const auto a = static_cast<std::size_t>(c.a[i]), b = static_cast<std::size_t>(c.b[i]);
    const std::size_t key = static_cast<std::size_t>(c.first_key) + i;
    if (trees_.pairs.size() <= key) trees_.pairs.resize(key + 1);
    auto& out = trees_.pairs[key];
    out.link_a = is_fixed(c.list) ? -1 : link_of(a);
    out.link_b = link_of(b);
    // What is welded to the world is as the world.
    const auto stays = [&](int link) {
      return link < 0 || last_dof(trees_, trees_.links[static_cast<std::size_t>(link)]) < 0;
    };
    out.only_link = stays(out.link_a) ? out.link_b : stays(out.link_b) ? out.link_a : -1;
    const std::size_t colliders = plan_.colliders.size();
    const PlanMaterial from_a =
        is_fixed(c.list) ? material(plan_.fixed[a]) : material(plan_.colliders[a]);
    const PlanMaterial from_b = material(plan_.colliders[b]);
    const SoftContact &of_a = from_a.in(plan_.scene), &of_b = from_b.in(plan_.scene);
    const auto material_a = static_cast<std::int32_t>(is_fixed(c.list) ? colliders + a : a);
    const auto material_b = static_cast<std::int32_t>(b);
    const SoftContact* first = of_b.priority > of_a.priority ? &of_b : &of_a;
    const bool same = of_a.priority == of_b.priority;
    out.material_a = first == &of_b ? material_b : material_a;
    out.material_b = same ? material_b : out.material_a;
    const int dimensions = same ? std::max(of_a.dimensions, of_b.dimensions) : first->dimensions;
    out.cone = dimensions == 1   ? ContactCone::frictionless
               : trees_.elliptic ? ContactCone::elliptic
                                 : ContactCone::pyramidal;
    const Compliance compliance = mixed_compliance(of_a, of_b);
    out.compliance = plan_.varies.contacts ? index_of(from_a, from_b, compliance)
                                           : index_of(compiled(compliance));
    out.power = power_of(compliance);
    out.margin = of_a.margin + of_b.margin;
    const auto weight = [&](int link) {
      return link < 0 ? 0 : trees_.weights.link[static_cast<std::size_t>(link)][0];
    };
    out.inverse_weight = weight(out.link_a) + weight(out.link_b);
    out.friction_weight = out.cone == ContactCone::pyramidal ? out.inverse_weight : 0;
    add_dofs(out);
  }

  // Where materials vary each two have their own.
  std::int32_t index_of(const PlanMaterial& a, const PlanMaterial& b,
                        const Compliance& compliance) {
    const auto next = static_cast<std::int32_t>(trees_.mixed.size());
    const auto [at, is_new] = mixed_.emplace(std::pair(a, b), next);
    if (is_new) {
      trees_.mixed.emplace_back(a, b);
      trees_.compliances.push_back(compiled(compliance));
    }
    return at->second;
  }
  // Else most pairs have the same one.
  std::int32_t index_of(const kernels::Compliance<double>& compliance) {
    std::array<double, sizeof compliance / sizeof(double)> numbers{};
    std::memcpy(numbers.data(), &compliance, sizeof compliance);
    const auto next = static_cast<std::int32_t>(trees_.compliances.size());
    const auto [at, is_new] = seen_.emplace(numbers, next);
    if (is_new) trees_.compliances.push_back(compliance);
    return at->second;
  }
  int root_of(int link) const { return trees_.links[static_cast<std::size_t>(link)].root; }
  int link_of(std::size_t collider) const {
    return link_[static_cast<std::size_t>(plan_.colliders[collider].body)];
  }
  template <class Planned>
  static PlanMaterial material(const Planned& s) {
    return {s.scene_body, s.shape};
  }
  kernels::Compliance<double> compiled(const Compliance& compliance) const {
    return compile(compliance, plan_.scene.options.dt / *plan_.scene.options.substeps);
  }

  std::vector<int> dofs_of(int link) const {  // the last one first; -1: the world
    std::vector<int> out;
    if (link < 0) return out;
    for_each_dof_of(trees_, static_cast<std::size_t>(link),
                    [&](std::size_t k) { out.push_back(static_cast<int>(k)); });
    return out;
  }
  void add_dofs(kernels::TreePair<double>& out) {
    const std::vector<int> a = dofs_of(out.link_a), b = dofs_of(out.link_b);
    const auto in = [](const std::vector<int>& list, int k) {
      return std::find(list.begin(), list.end(), k) != list.end();
    };
    std::vector<std::pair<int, bool>> own;  // whether it moves A
    for (const int k : a) {
      if (!in(b, k)) own.emplace_back(k, true);
    }
    for (const int k : b) {
      if (!in(a, k)) own.emplace_back(k, false);
    }
    std::sort(own.begin(), own.end(),
              [](const auto& x, const auto& y) { return x.first > y.first; });
    out.first_dof = static_cast<std::int32_t>(trees_.pair_dofs.size());
    out.dofs = static_cast<std::int32_t>(own.size());
    for (const auto& [k, moves_a] : own) {
      trees_.pair_dofs.push_back(moves_a ? ~k : k);
      out.coupled |= std::uint64_t{1} << k;
    }
  }

  PlanData& plan_;
  PlanTrees& trees_;
  std::vector<int> link_;  // [body with state]
  std::map<std::array<double, sizeof(kernels::Compliance<double>) / sizeof(double)>, std::int32_t>
      seen_;
  std::map<std::pair<PlanMaterial, PlanMaterial>, std::int32_t> mixed_;
};

// Newton steps by links take time for each link, and for each row that acts and couples branches;
// in joint space for each pair of dofs, of which few robots in the plane have many. Links of a tree
// seldom touch, trees that can touch do.
void choose_space(PlanTrees& trees, const TreePairs::Couplings& of_contacts) {
  constexpr int kMaxCouplings = 1024, kRowsPerDof = 4, kFewDofs = 10;
  const int dofs = static_cast<int>(trees.dofs.size());
  trees.couplings += of_contacts.within + of_contacts.between;
  trees.by_links = dofs > kFewDofs && trees.couplings <= kMaxCouplings &&
                   of_contacts.between <= kRowsPerDof * dofs;
}

}  // namespace

Compliance mixed_compliance(const SoftContact& a, const SoftContact& b) {
  if (a.priority == b.priority) return mean_compliance(a, b);
  return a.priority > b.priority ? a.compliance : b.compliance;
}

void collect_tree_pairs(PlanData& plan) {
  if (!plan.has_trees()) return;
  const SolverOptions& solver = plan.scene.options.solver;
  plan.trees.impedance_ratio = solver.impedance_ratio;
  plan.trees.elliptic = solver.cone == FrictionCone::elliptic;
  TreePairs pairs(plan);
  pairs.run();
  choose_space(plan.trees, pairs.couplings());
}

}  // namespace manyworlds
