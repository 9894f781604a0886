// Candidate pairs: which shapes can ever touch, in which kernel, and in which order the solver
// will see them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "src/plan/pair_kinds.hpp"

namespace manyworlds {

namespace {

using kernels::ListId;
using kernels::PairKind;
using kernels::ShapeKind;

// The kernel of a pair, and whether its A is the second shape.
struct Match {
  PairKind kind;
  bool swapped;
};

Match match(ShapeKind a, ShapeKind b) {
  static const std::map<std::pair<ShapeKind, ShapeKind>, PairKind> kKernels = {
      {{ShapeKind::sphere, ShapeKind::sphere}, PairKind::sphere_sphere},
      {{ShapeKind::box, ShapeKind::sphere}, PairKind::box_sphere},
      {{ShapeKind::box, ShapeKind::box}, PairKind::box_box},
      {{ShapeKind::plane, ShapeKind::sphere}, PairKind::plane_sphere},
      {{ShapeKind::plane, ShapeKind::box}, PairKind::plane_box},
      {{ShapeKind::circle, ShapeKind::circle}, PairKind::circle_circle},
      {{ShapeKind::rectangle, ShapeKind::circle}, PairKind::rectangle_circle},
      {{ShapeKind::rectangle, ShapeKind::rectangle}, PairKind::rectangle_rectangle},
      {{ShapeKind::polygon, ShapeKind::circle}, PairKind::polygon_circle},
      {{ShapeKind::polygon, ShapeKind::polygon}, PairKind::polygon_polygon},
      {{ShapeKind::plane, ShapeKind::circle}, PairKind::plane_circle},
      {{ShapeKind::plane, ShapeKind::rectangle}, PairKind::plane_rectangle},
      {{ShapeKind::plane, ShapeKind::polygon}, PairKind::plane_polygon},
      {{ShapeKind::capsule, ShapeKind::sphere}, PairKind::capsule_sphere},
      {{ShapeKind::capsule, ShapeKind::circle}, PairKind::capsule_circle},
      {{ShapeKind::capsule, ShapeKind::capsule}, PairKind::capsule_capsule},
      {{ShapeKind::box, ShapeKind::capsule}, PairKind::box_capsule},
      {{ShapeKind::rectangle, ShapeKind::capsule}, PairKind::rectangle_capsule},
      {{ShapeKind::polygon, ShapeKind::capsule}, PairKind::polygon_capsule},
      {{ShapeKind::plane, ShapeKind::capsule}, PairKind::plane_capsule},
      {{ShapeKind::link, ShapeKind::circle}, PairKind::link_circle},
      {{ShapeKind::link, ShapeKind::rectangle}, PairKind::link_rectangle},
      {{ShapeKind::link, ShapeKind::polygon}, PairKind::link_polygon},
      {{ShapeKind::link, ShapeKind::capsule}, PairKind::link_capsule},
      {{ShapeKind::plane, ShapeKind::cylinder}, PairKind::plane_cylinder},
      {{ShapeKind::plane, ShapeKind::hull}, PairKind::plane_hull},
      {{ShapeKind::cylinder, ShapeKind::sphere}, PairKind::cylinder_sphere},
      {{ShapeKind::cylinder, ShapeKind::capsule}, PairKind::cylinder_capsule},
      {{ShapeKind::box, ShapeKind::cylinder}, PairKind::box_cylinder},
      {{ShapeKind::cylinder, ShapeKind::cylinder}, PairKind::cylinder_cylinder},
      {{ShapeKind::hull, ShapeKind::sphere}, PairKind::hull_sphere},
      {{ShapeKind::hull, ShapeKind::capsule}, PairKind::hull_capsule},
      {{ShapeKind::hull, ShapeKind::box}, PairKind::hull_box},
      {{ShapeKind::hull, ShapeKind::cylinder}, PairKind::hull_cylinder},
      {{ShapeKind::hull, ShapeKind::hull}, PairKind::hull_hull},
      {{ShapeKind::tile, ShapeKind::sphere}, PairKind::tile_sphere},
      {{ShapeKind::tile, ShapeKind::capsule}, PairKind::tile_capsule},
      {{ShapeKind::tile, ShapeKind::box}, PairKind::tile_box},
      {{ShapeKind::tile, ShapeKind::cylinder}, PairKind::tile_cylinder},
      {{ShapeKind::tile, ShapeKind::hull}, PairKind::tile_hull},
      {{ShapeKind::plane, ShapeKind::rounded}, PairKind::plane_rounded},
      {{ShapeKind::rounded, ShapeKind::circle}, PairKind::rounded_circle},
      {{ShapeKind::rounded, ShapeKind::rounded}, PairKind::rounded_rounded},
      {{ShapeKind::rounded, ShapeKind::capsule}, PairKind::rounded_capsule},
      {{ShapeKind::link, ShapeKind::rounded}, PairKind::link_rounded},
  };
  const auto straight = kKernels.find({a, b});
  if (straight != kKernels.end()) return {straight->second, false};
  return {kKernels.at({b, a}), true};
}

// A fixed sphere under a moving box: the kernel wants the box as A, but the fixed shape must be A.
// Such pairs have kernels of their own order.
PairKind reversed(PairKind kind) {
  switch (kind) {
    case PairKind::box_sphere: return PairKind::sphere_box;
    case PairKind::rectangle_circle: return PairKind::circle_rectangle;
    case PairKind::polygon_circle: return PairKind::circle_polygon;
    case PairKind::capsule_sphere: return PairKind::sphere_capsule;
    case PairKind::capsule_circle: return PairKind::circle_capsule;
    case PairKind::box_capsule: return PairKind::capsule_box;
    case PairKind::rectangle_capsule: return PairKind::capsule_rectangle;
    case PairKind::polygon_capsule: return PairKind::capsule_polygon;
    case PairKind::cylinder_sphere: return PairKind::sphere_cylinder;
    case PairKind::cylinder_capsule: return PairKind::capsule_cylinder;
    case PairKind::box_cylinder: return PairKind::cylinder_box;
    case PairKind::hull_sphere: return PairKind::sphere_hull;
    case PairKind::rounded_circle: return PairKind::circle_rounded;
    case PairKind::rounded_capsule: return PairKind::capsule_rounded;
    case PairKind::hull_capsule: return PairKind::capsule_hull;
    case PairKind::hull_box: return PairKind::box_hull;
    case PairKind::hull_cylinder: return PairKind::cylinder_hull;
    default: return kind;
  }
}

bool is_single(PairKind kind) {
  switch (kind) {
    case PairKind::sphere_sphere:
    case PairKind::box_sphere:
    case PairKind::plane_sphere:
    case PairKind::circle_circle:
    case PairKind::rectangle_circle:
    case PairKind::polygon_circle:
    case PairKind::plane_circle:
    case PairKind::sphere_box:
    case PairKind::circle_rectangle:
    case PairKind::circle_polygon:
    case PairKind::capsule_sphere:
    case PairKind::capsule_circle:
    case PairKind::sphere_capsule:
    case PairKind::circle_capsule:
    case PairKind::link_circle:
    case PairKind::rounded_circle:
    case PairKind::circle_rounded:
    case PairKind::cylinder_sphere:
    case PairKind::hull_sphere:
    case PairKind::sphere_cylinder:
    case PairKind::tile_sphere:
    case PairKind::sphere_hull: return true;
    default: return false;
  }
}

ListId list_of(PairKind kind, bool fixed) {
  const bool single = is_single(kind);
  return fixed ? (single ? ListId::fixed_single : ListId::fixed_multi)
               : (single ? ListId::pair_single : ListId::pair_multi);
}

bool filters_agree(const Filter& a, const Filter& b) {
  return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

class Collector {
 public:
  explicit Collector(PlanData& plan) : plan_(plan), joined_(joined_bodies(plan.scene)) {}

  void moving(int i, int j) {
    const PlanCollider& a = plan_.colliders[static_cast<std::size_t>(i)];
    const PlanCollider& b = plan_.colliders[static_cast<std::size_t>(j)];
    if (a.body == b.body) return;
    const Match m = match(a.kind, b.kind);
    const bool apart = !joined_.count(std::minmax(a.scene_body, b.scene_body));
    const bool may_touch = apart && (plan_.bodies[static_cast<std::size_t>(a.body)].inv_mass > 0 ||
                                     plan_.bodies[static_cast<std::size_t>(b.body)].inv_mass > 0);
    m.swapped ? add(m.kind, false, j, i, shape(b), shape(a), may_touch)
              : add(m.kind, false, i, j, shape(a), shape(b), may_touch);
  }
  void fixed(int f, int j) {
    const PlanFixed& a = plan_.fixed[static_cast<std::size_t>(f)];
    const PlanCollider& b = plan_.colliders[static_cast<std::size_t>(j)];
    const Match m = match(a.kind, b.kind);
    add(m.swapped ? reversed(m.kind) : m.kind, true, f, j, shape(a), shape(b),
        !joined_.count(std::minmax(a.scene_body, b.scene_body)) &&
            plan_.bodies[static_cast<std::size_t>(b.body)].inv_mass > 0);
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
  void add(PairKind kind, bool fixed, int a, int b, const Shape& shape_a, const Shape& shape_b,
           bool may_touch) {
    const ListId list = list_of(kind, fixed);
    PlanClass& c = classes_[{static_cast<int>(list), static_cast<int>(kind)}];
    c.kind = kind;
    c.list = list;
    if (!may_touch || !filters_agree(shape_a.filter, shape_b.filter)) {
      ++c.culled;
      return;
    }
    c.a.push_back(a);
    c.b.push_back(b);
  }

  PlanData& plan_;
  std::set<std::pair<int, int>> joined_;
  std::map<std::pair<int, int>, PlanClass> classes_;
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

}  // namespace

KindOfPair kind_of_pair(ShapeKind a, ShapeKind b, bool fixed) {
  const Match m = match(a, b);
  const PairKind kind = fixed && m.swapped ? reversed(m.kind) : m.kind;
  return {kind, list_of(kind, fixed), m.swapped};
}

namespace {

void list_pairs(PlanData& plan) {
  Collector collector(plan);
  const int n = static_cast<int>(plan.colliders.size());
  // A tournament (circle method): pairs of a round share no shape, so neighbouring rows of the
  // solver do not wait for each other's velocities.
  const int seats = n + n % 2;
  for (int round = 0; round + 1 < seats; ++round) {
    for (int table = 0; table < seats / 2; ++table) {
      const int i = table == 0 ? seats - 1 : (round + table) % (seats - 1);
      const int j = (round + seats - 1 - table) % (seats - 1);
      if (i < n && j < n) collector.moving(std::min(i, j), std::max(i, j));
    }
  }
  // Shape by shape of the fixed ones: again neighbours are about different bodies.
  for (int f = 0; f < static_cast<int>(plan.fixed.size()); ++f) {
    for (int j = 0; j < n; ++j) collector.fixed(f, j);
  }
  collector.finish();
}

// Moving shapes up to which there are tables of pairs, and pairs with fixed shapes that are not
// planes: a table is faster than a search as long as it is short.
constexpr int kMostInTables = 64;
constexpr int kMostPairsWithFixed = 1 << 15;

bool is_large(const PlanData& plan) {
  std::int64_t fixed = 0;
  for (const PlanFixed& f : plan.fixed) fixed += f.kind != ShapeKind::plane ? 1 : 0;
  const auto moving = static_cast<std::int64_t>(plan.colliders.size());
  return moving > kMostInTables || moving * fixed > kMostPairsWithFixed;
}

}  // namespace

void collect_pairs(PlanData& plan) {
  const BroadPhase wish = plan.options.broad_phase;
  plan.sparse = wish == BroadPhase::sparse || (wish == BroadPhase::automatic && is_large(plan));
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
    plan.capacity[static_cast<std::size_t>(l)] =
        std::min(candidates[static_cast<std::size_t>(l)], limit);
  }

  // Shapes from which sort and sweep is the default. Up to 512 balls the two are within 11 % of
  // each other (docs/architecture.md), but the sweep's cost grows more slowly.
  constexpr int kSweepFrom = 48;
  plan.sweep =
      plan.options.broad_phase == BroadPhase::sort_and_sweep ||
      (plan.options.broad_phase == BroadPhase::automatic && !plan.sparse && n >= kSweepFrom);
}

}  // namespace manyworlds
