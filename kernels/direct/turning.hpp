// The rotation that geometric stiffness K is against. A chain that swings under a heavy load turns
// as a whole, and the impulses of its joints turn with it; what has to be held is how its bodies
// turn against one another. So the stiffness is against a share s of the mean rotation of each tree
// (in each lane: of what holds together) as the substep begins,
//
//   mean = (sum K)^-1 (sum K w),   K (w - s mean),
//
// with the s for which the w that come of it make sum (w - s mean)' K (w - s mean) the least:
// sum mean' K (w - s mean) = 0. Then the stiffness takes sum w' K (w - s mean) >= 0 of energy and
// gives none, however the joints change w. It is linear in s, so two solves tell it, and a third
// has it. Contacts and attached rows change w afterwards, and are fed energy by what still turns:
// in lanes in which there are some on a tree, s is 0.
//
// Between two ends that hold still no motion of a straight chain turns it in the mean: all that the
// stiffness is for is held as before. Swings are not damped any more.
#pragma once

#include "kernels/direct/stiffness.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Of half the trace of sum K: what a chain that is straight lacks about itself.
inline constexpr Real kTurningFloor = Real(1e-3);
// Of mean' (sum K) mean: where less of it is left, s is rounding, and 0 instead.
inline constexpr Real kLeastTurning = sizeof(Real) == 4 ? Real(1e-4) : Real(1e-9);

template <class S, bool kDense>
class Turning {
 public:
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  Turning(const Constants& t, const Work& w) : t_(t), w_(w), d_(w.direct) {}

  // Loads where there is no stiffness.
  void clear() const {
    const WrenchOf<S> none{zero_of<Ang>(), zero_of<Vec>()};
    for_each_tree_body(t_, [&](int b) { store(at(d_.own_load, b), none); });
  }
  // Means, and loads against all of the rotation; whether something turns.
  bool begin() const {
    const bool turns = find_mean();
    put_loads(Real(0));
    return turns;
  }
  // By solve(), of the bodies' own loads.
  template <class Solve>
  void find(Solve solve) const {
    put_loads(Real(0));
    solve();
    find_rest(Float(Real(0)));
    for_each_tree_body(t_, [&](int b) { Float::load(at(d_.load, b)).store(rest(b)); });
    put_loads(Real(1));
    solve();
    find_rest(Float(Real(1)));
    put_loads_of_least();
    solve();
  }

 private:
  static constexpr int kRows = S::kAng + 1;

  bool find_mean() const {
    for_each_tree_body(t_, [&](int b) {
      const MomentsOf<S> k = stiffness(b);
      store(at(d_.twist, b), k), store(at(d_.load, b), apply(k, velocity(b)));
    });
    sum_trees<S::kInertia, MomentsOf<S>>(d_.twist), sum_trees<S::kAng, Ang>(d_.load);
    if (are_loaded(t_)) spread_touched();
    std::uint32_t turns = 0;
    for_each_tree_body(t_, [&](int b) {
      const auto sum = load_as<MomentsOf<S>>(at(d_.twist, b));
      const Mask touched = mask_from_bits(are_loaded(t_) ? d_.touched[b] : 0);
      const Ang mean = select(touched, zero_of<Ang>(), mean_of(sum, load_as<Ang>(at(d_.load, b))));
      store(mean_at(b), mean);
      turns |= bits(Float(Real(0)) < dot_of(mean, mean));
    });
    return turns != 0;
  }
  // What the stiffness takes from angular momenta, into the bodies' own loads.
  void put_loads(Real share) const {
    for_each_tree_body(t_, [&](int b) { put_load(b, Float(share)); });
  }
  // By the rests of shares 0 and 1.
  void put_loads_of_least() const {
    for_each_tree_body(t_, [&](int b) {
      const Float none = Float::load(rest(b)), change = none - Float::load(at(d_.load, b));
      change.store(at(d_.twist, b));
    });
    for_each_tree_body(t_, [&](int b) {
      const auto mean = load_as<Ang>(mean_at(b));
      dot_of(mean, apply(stiffness(b), mean)).store(at(d_.load, b));
    });
    sum_trees<1, Float>(d_.load);
    for_each_tree_body(t_, [&](int b) {
      const Float change = Float::load(at(d_.twist, b));
      const Float least = Float::load(at(d_.load, b)) * Float(kLeastTurning);
      const Float share = Float::load(rest(b)) * inverse_or_zero(change);
      put_load(b, select(least < change, share, Float(Real(0))));
    });
  }

  static Real* at(Real* of, int body) { return of + body * kTwistRowsOf<S> * kLanes; }
  Real* mean_at(int body) const { return d_.turning + body * kRows * kLanes; }
  Real* rest(int body) const { return mean_at(body) + S::kAng * kLanes; }
  MW_INLINE MomentsOf<S> stiffness(int b) const {
    const int row = b * S::kInertia * kLanes;
    return load_as<MomentsOf<S>>(d_.stiffened + row) +
           scaled(load_as<MomentsOf<S>>(d_.rotary + row), Float(Real(-1)));
  }
  MW_INLINE Ang velocity(int b) const { return get_velocity<S, kDense>(w_, w_.velocity, b).w; }
  MW_INLINE void put_load(int b, Float share) const {
    const MomentsOf<S> k = stiffness(b);
    const Ang n = apply(k, load_as<Ang>(mean_at(b)) * share - velocity(b));
    // Lanes without any have zeros of one sign, whatever others have.
    const Mask stiff = Float(Real(0)) < transverse(k);
    store(at(d_.own_load, b), WrenchOf<S>{select(stiff, n, zero_of<Ang>()), zero_of<Vec>()});
  }
  // From roots, which know of contacts on what hangs on them.
  void spread_touched() const {
    for (int i = 0; i < t_.joint_trees.edges; ++i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      if (!edge.prescribed) d_.touched[edge.child] |= d_.touched[edge.parent];
    }
  }
  // sum mean' K (w - share mean) after a solve, of every body's tree.
  void find_rest(Float share) const {
    for_each_tree_body(t_, [&](int b) {
      const auto change = load_as<TwistOf<S>>(at(d_.twist, b));
      const auto mean = load_as<Ang>(mean_at(b));
      const Ang left = velocity(b) + change.w - mean * share;
      dot_of(mean, apply(stiffness(b), left)).store(at(d_.load, b));
    });
    sum_trees<1, Float>(d_.load);
  }
  // The sum over what holds together, for all bodies of it.
  template <int kCount, class T>
  void sum_trees(Real* rows) const {
    for (int i = t_.joint_trees.edges - 1; i >= 0; --i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      if (edge.prescribed) continue;
      add_in_lanes<kCount>(at(rows, edge.parent), load_as<T>(at(rows, edge.child)),
                           edge_rows<S>(w_, i).lanes);
    }
    for (int i = 0; i < t_.joint_trees.edges; ++i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      if (edge.prescribed) continue;
      const Mask holds = mask_from_bits(edge_rows<S>(w_, i).lanes);
      for (int r = 0; r < kCount; ++r) {
        Real* child = at(rows, edge.child) + r * kLanes;
        const Float sum = Float::load(at(rows, edge.parent) + r * kLanes);
        select(holds, sum, Float::load(child)).store(child);
      }
    }
  }
  static MW_INLINE Float dot_of(Float a, Float b) { return a * b; }
  static MW_INLINE Float dot_of(const Vec3& a, const Vec3& b) { return dot(a, b); }
  static MW_INLINE Float mean_of(Float k, Float kw) { return kw * inverse_or_zero(k); }
  static MW_INLINE Vec3 mean_of(const Sym3& k, const Vec3& kw) {
    const Float floor = transverse(k) * Float(kTurningFloor);
    return mul(inverse(Sym3{k.xx + floor, k.xy, k.xz, k.yy + floor, k.yz, k.zz + floor}), kw);
  }

  const Constants& t_;
  const Work& w_;
  const DirectWork& d_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
