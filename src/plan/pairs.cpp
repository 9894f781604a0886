// Candidate pairs: which shapes can ever touch, in which kernel, and in which order the solver
// will see them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "kernels/data/pair_keys.hpp"
#include "src/plan/pair_kinds.hpp"

namespace manyworlds {

namespace {

using kernels::ListId;
using kernels::ShapeKind;

class Collector {
 public:
  explicit Collector(PlanData& plan)
      : plan_(plan), joined_(joined_bodies(plan.scene)), last_dof_(plan.bodies.size(), -1) {
    for (const auto& link : plan.trees.links) {
      last_dof_[static_cast<std::size_t>(link.body)] = last_dof(plan.trees, link);
    }
  }

  void moving(int i, int j) {
    const PlanCollider& a = plan_.colliders[static_cast<std::size_t>(i)];
    const PlanCollider& b = plan_.colliders[static_cast<std::size_t>(j)];
    if (a.body == b.body) return;
    const KindOfPair k = kind_of_pair(a.kind, b.kind, false);
    const bool apart = !joined_.count(std::minmax(a.scene_body, b.scene_body)) &&
                       !(plan_.has_trees() && last_dof_of(a) == last_dof_of(b));
    const bool may_touch = apart && (plan_.bodies[static_cast<std::size_t>(a.body)].inv_mass > 0 ||
                                     plan_.bodies[static_cast<std::size_t>(b.body)].inv_mass > 0);
    k.swapped ? add(k, j, i, shape(b), shape(a), may_touch)
              : add(k, i, j, shape(a), shape(b), may_touch);
  }
  void fixed(int f, int j) {
    const PlanFixed& a = plan_.fixed[static_cast<std::size_t>(f)];
    const PlanCollider& b = plan_.colliders[static_cast<std::size_t>(j)];
    add(kind_of_pair(a.kind, b.kind, true), f, j, shape(a), shape(b),
        !joined_.count(std::minmax(a.scene_body, b.scene_body)) &&
            plan_.bodies[static_cast<std::size_t>(b.body)].inv_mass > 0 &&
            !(plan_.has_trees() && last_dof_of(b) < 0));
  }

  void finish() {
    int key = 0;
    for (auto& [id, c] : classes_) {
      if (c.a.empty() && c.culled == 0) continue;
      c.first_key = key;
      c.keys = c.candidates = static_cast<int>(c.a.size());
      key += c.keys;
      plan_.classes.push_back(std::move(c));
    }
  }

 private:
  const Shape& shape(const PlanCollider& c) const {
    return plan_.scene.bodies[static_cast<std::size_t>(c.scene_body)]
        .shapes[static_cast<std::size_t>(c.shape)];
  }
  const Shape& shape(const PlanFixed& f) const {
    return plan_.scene.bodies[static_cast<std::size_t>(f.scene_body)]
        .shapes[static_cast<std::size_t>(f.shape)];
  }
  void add(const KindOfPair& pair, int a, int b, const Shape& shape_a, const Shape& shape_b,
           bool may_touch) {
    PlanClass& c = classes_[pair.place()];
    c.kind = pair.kind;
    c.list = pair.list;
    const Filter &of_a = shape_a.filter, &of_b = shape_b.filter;
    if (!may_touch || !kernels::filters_agree(of_a.category, of_a.mask, of_b.category, of_b.mask)) {
      ++c.culled;
      return;
    }
    c.a.push_back(a);
    c.b.push_back(b);
  }

  // Links that it moves alike are rigidly joined, -1 to the world.
  int last_dof_of(const PlanCollider& c) const {
    return last_dof_[static_cast<std::size_t>(c.body)];
  }

  PlanData& plan_;
  std::set<std::pair<int, int>> joined_;
  std::vector<int> last_dof_;  // [body with state]
  std::map<KindOfPair::Place, PlanClass> classes_;
};

// Triangles of height fields that the shapes can lie over.
int manifolds_on_tiles(const PlanData& plan) {
  double near = 0;
  for (const PlanFixed& f : plan.fixed) {
    if (f.kind != ShapeKind::tile || f.triangles_before > 0) continue;
    for (const PlanCollider& c : plan.colliders) {
      const double wide = 2 * c.radius / f.cell.x() + 1, deep = 2 * c.radius / f.cell.y() + 1;
      near += std::min(std::ceil(2 * wide * deep), static_cast<double>(f.triangles));
    }
  }
  return static_cast<int>(near);
}

// One for each fixed shape; of a terrain's links as many as the shapes can lie over, with their
// speculative margins, were all links as short as the shortest, and twice that for rough ground.
int fixed_manifolds(const PlanData& plan) {
  double shortest = std::numeric_limits<double>::max();
  int links = 0;
  for (const PlanFixed& f : plan.fixed) {
    if (f.kind != ShapeKind::link) continue;
    ++links;
    shortest = std::min(shortest, f.length);
  }
  double near = 0;
  for (const PlanCollider& c : plan.colliders) near += 2 * (4 * c.radius / shortest + 4);
  const auto tiles = std::count_if(plan.fixed.begin(), plan.fixed.end(),
                                   [](const PlanFixed& f) { return f.kind == ShapeKind::tile; });
  const int others = static_cast<int>(plan.fixed.size()) - links - static_cast<int>(tiles);
  return others + manifolds_on_tiles(plan) +
         static_cast<int>(std::min(near, static_cast<double>(links)));
}

void list_pairs(PlanData& plan) {
  Collector collector(plan);
  const int n = static_cast<int>(plan.colliders.size());
  // Pairs of a round share no shape, so neighbouring rows of the solver do not wait for each
  // other's velocities.
  const auto places = static_cast<int>(kernels::places_of_tournament(n));
  for (int place = 0; place < places; ++place) {
    const kernels::PairOfKey pair = kernels::tournament_pair(n, place);
    if (pair.b < n) collector.moving(pair.a, pair.b);
  }
  // Shape by shape of the fixed ones: again neighbours are about different bodies.
  for (int f = 0; f < static_cast<int>(plan.fixed.size()); ++f) {
    for (int j = 0; j < n; ++j) collector.fixed(f, j);
  }
  collector.finish();
}

// Moving shapes up to which there are tables of pairs, and pairs with fixed shapes that are not
// planes. Measured from 78 to 496 boxes, balls and squares (docs/kernels.md): a search
// takes 1.4 to 2 times as long as a table of up to 200 shapes, and as long in the plane from 500
// on.
constexpr int kMaxInTables = 512;
constexpr int kMaxPairsWithFixed = 1 << 15;

bool is_large(const PlanData& plan) {
  std::int64_t fixed = 0;
  for (const PlanFixed& f : plan.fixed) fixed += f.kind != ShapeKind::plane ? 1 : 0;
  const auto moving = static_cast<std::int64_t>(plan.colliders.size());
  return moving > kMaxInTables || moving * fixed > kMaxPairsWithFixed;
}

}  // namespace

void collect_pairs(PlanData& plan) {
  const BroadPhase wish = plan.options.broad_phase;
  // Trees have rows for the pairs of a table.
  plan.sparse = !plan.has_trees() &&
                (wish == BroadPhase::sparse || (wish == BroadPhase::automatic && is_large(plan)));
  plan.sparse ? count_pairs(plan) : list_pairs(plan);

  // Manifolds per world. Equal spheres can touch 12 neighbours and equal circles 6, each pair
  // shared by two; piles of mixed sizes stay well below.
  std::array<int, kernels::kLists> candidates{};
  for (const PlanClass& c : plan.classes) {
    candidates[static_cast<std::size_t>(c.list)] += c.candidates;
  }
  const int n = static_cast<int>(plan.colliders.size());
  const int pairs = plan.scene.options.contact_capacity.value_or(
      (plan.scene.space == Space::spatial ? 4 : 3) * n + 8);
  const int fixed = 2 * n + 8 + fixed_manifolds(plan);
  for (int l = 0; l < kernels::kLists; ++l) {
    const int limit = is_fixed(static_cast<ListId>(l)) ? fixed : pairs;
    const int all = candidates[static_cast<std::size_t>(l)];
    plan.capacity[static_cast<std::size_t>(l)] = plan.has_trees() ? all : std::min(all, limit);
  }

  // Shapes from which sort and sweep is the default in the plane, where it wins or ties. In space
  // most shapes of a pile overlap along any one axis.
  constexpr int kSweepFrom = 48;
  plan.sweep = plan.options.broad_phase == BroadPhase::sort_and_sweep ||
               (plan.options.broad_phase == BroadPhase::automatic && !plan.sparse &&
                n >= kSweepFrom && plan.scene.space == Space::planar);
}

}  // namespace manyworlds
