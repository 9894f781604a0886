// Candidate pairs of plans without tables of them. Shapes that are alike, but for their place and
// size, are counted together, so the time follows the number of shapes and not of pairs.
#include <limits>
#include <map>
#include <tuple>

#include "kernels/data/pair_keys.hpp"
#include "src/plan/pair_kinds.hpp"

namespace manyworlds {

namespace {

using kernels::ListId;
using kernels::PairKind;
using kernels::ShapeKind;

struct Alike {
  ShapeKind kind{};
  bool dynamic = false;
  Filter filter;
  bool rough = false, bouncy = false, resists = false;
  auto key() const {
    return std::tuple(kind, dynamic, filter.category, filter.mask, rough, bouncy, resists);
  }
};
struct Flock {
  Alike what;
  std::vector<int> members;
};

bool may_touch(const Alike& a, const Alike& b) {
  return (a.dynamic || b.dynamic) && (a.filter.category & b.filter.mask) != 0 &&
         (b.filter.category & a.filter.mask) != 0;
}

class Counter {
 public:
  explicit Counter(PlanData& plan) : plan_(plan), extreme_(extremes(plan).back()) {
    for (const PlanCollider& c : plan.colliders) {
      const bool dynamic = plan.bodies[static_cast<std::size_t>(c.body)].inv_mass > 0;
      flock_.push_back(put(moving_, alike(c, dynamic)));
    }
    for (const PlanFixed& f : plan.fixed) put(fixed_, alike(f, false));
  }

  void run() {
    count_same_body();
    for (std::size_t g = 0; g < moving_.size(); ++g) {
      for (std::size_t h = g; h < moving_.size(); ++h) add_moving(g, h);
    }
    for (const Flock& fixed : fixed_) {
      for (const Flock& moving : moving_) {
        add(fixed.what, moving.what, true, count(fixed) * count(moving), fixed.members[0],
            moving.members[0]);
      }
    }
    finish();
  }

 private:
  template <class Planned>
  Alike alike(const Planned& s, bool dynamic) const {
    const Shape& shape = extreme_.bodies[static_cast<std::size_t>(s.scene_body)]
                             .shapes[static_cast<std::size_t>(s.shape)];
    const Material& m = shape.material;
    return {s.kind, dynamic, shape.filter, m.friction > 0, m.restitution > 0, resists(m)};
  }
  std::size_t put(std::vector<Flock>& flocks, const Alike& what) {
    auto& places = &flocks == &moving_ ? place_of_moving_ : place_of_fixed_;
    int& shapes = &flocks == &moving_ ? shapes_ : fixed_shapes_;
    const auto [at, fresh] = places.try_emplace(what.key(), flocks.size());
    if (fresh) flocks.push_back({what, {}});
    flocks[at->second].members.push_back(shapes++);
    return at->second;
  }
  static std::int64_t count(const Flock& flock) {
    return static_cast<std::int64_t>(flock.members.size());
  }
  int body_of(int collider) const {
    return plan_.colliders[static_cast<std::size_t>(collider)].body;
  }

  void count_same_body() {
    for (std::size_t i = 0; i < flock_.size(); ++i) {
      for (std::size_t j = i + 1; j < flock_.size(); ++j) {  // a body's shapes follow one another
        if (body_of(static_cast<int>(i)) != body_of(static_cast<int>(j))) break;
        ++same_body_[std::minmax(flock_[i], flock_[j])];
      }
    }
  }

  void add_moving(std::size_t g, std::size_t h) {
    const Flock &a = moving_[g], &b = moving_[h];
    std::int64_t pairs = g == h ? count(a) * (count(a) - 1) / 2 : count(a) * count(b);
    const auto same = same_body_.find({g, h});
    if (same != same_body_.end()) pairs -= same->second;
    if (pairs == 0) return;
    for (const int i : a.members) {
      for (const int j : b.members) {
        if (body_of(i) == body_of(j)) continue;
        return add(a.what, b.what, false, pairs, i, j);
      }
    }
  }

  void add(const Alike& a, const Alike& b, bool fixed, std::int64_t pairs, int i, int j) {
    const KindOfPair k = kind_of_pair(a.kind, b.kind, fixed);
    PlanClass& c = classes_[k.place()];
    c.kind = k.kind;
    c.list = k.list;
    const Alike& other = b;
    if (!(fixed ? other.dynamic && may_touch(a, b) : may_touch(a, b))) {
      c.culled += static_cast<int>(pairs);
      return;
    }
    c.candidates += static_cast<int>(pairs);
    c.a.push_back(i);
    c.b.push_back(j);
  }

  void finish() {
    const auto n = static_cast<std::int32_t>(plan_.colliders.size());
    std::int64_t key = 0;
    int kinds = 0;
    for (auto& [id, c] : classes_) {
      const std::int64_t keys = c.candidates == 0  ? 0
                                : is_fixed(c.list) ? static_cast<std::int64_t>(plan_.fixed.size()) *
                                                         static_cast<std::int64_t>(n)
                                                   : kernels::places_of_tournament(n);
      kinds += keys > 0 ? 1 : 0;
      c.first_key = static_cast<int>(key);
      c.keys = static_cast<int>(keys);
      key += keys;
      if (key > kMaxKeys) continue;
      plan_.classes.push_back(std::move(c));
    }
    if (key <= kMaxKeys) return;
    throw SceneError(
        {{"shapes", "are " + std::to_string(n) + " moving and " +
                        std::to_string(plan_.fixed.size()) + " fixed, in " + std::to_string(kinds) +
                        " types of pair: " + std::to_string(key) +
                        " distinct pairs, must be at most " + std::to_string(kMaxKeys)}});
  }

  static constexpr std::int64_t kMaxKeys = std::numeric_limits<std::int32_t>::max() - 1;
  using Places = std::map<decltype(Alike().key()), std::size_t>;

  PlanData& plan_;
  Scene extreme_;  // with the largest numbers of materials that a world may have
  std::vector<Flock> moving_, fixed_;
  Places place_of_moving_, place_of_fixed_;
  int shapes_ = 0, fixed_shapes_ = 0;
  std::vector<std::size_t> flock_;  // [collider]
  std::map<std::pair<std::size_t, std::size_t>, std::int64_t> same_body_;
  std::map<KindOfPair::Place, PlanClass> classes_;
};

}  // namespace

void count_pairs(PlanData& plan) { Counter(plan).run(); }

}  // namespace manyworlds
