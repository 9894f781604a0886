// The joints of trees solved at once: the velocities nearest to those that there are, in the
// measure of kinetic energy, with which every joint does what it asks for. Articulated bodies
// (Featherstone 2008, 7.3) in the coordinates of free bodies: what hangs on a joint is felt at its
// anchor as an inertia and a load, from which the coordinates along which the joint gives way are
// eliminated. Nothing fills in, whatever the branching, and nothing is warm started. All numbers
// are changes of velocity, so that rounding is of what the joints do, and linear momentum is kept
// as well.
//
// Lanes in which a joint does not hold cut the tree there: the child is a root in those.
#pragma once

#include "kernels/direct/bounds.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, bool kDense>
class TreeSolve {
 public:
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;

  // `rotary`: moments of inertia [body][rotary][lane], with what resists as inertia does; `closes`:
  // see Bound; `first` solve of a substep.
  TreeSolve(const Constants& t, const Group& g, Work& w, const Real* rotary, bool closes,
            bool first)
      : t_(t), g_(g), w_(w), d_(w.direct), rotary_(rotary), closes_(closes), first_(first) {}

  // Until the active sets stay as they are. The angular momenta that there are are those of the
  // moments `before`.
  void run(const Real* before) const {
    for_each_tree_body(t_, [&](int b) {
      WrenchOf<S> p{zero_of<Ang>(), zero_of<Vec>()};
      if (before != rotary_) {
        const Velocity<S> v = get_velocity<S, kDense>(w_, w_.velocity, b);
        p.n = apply(moments(before, b), v.w) - apply(moments(rotary_, b), v.w);
      }
      store(row(d_.own_load, b, kTwistRowsOf<S>), p);
    });
    for (int i = 0; i < kMostSolves; ++i) {
      eliminate_all();
      substitute_back();
      // What the last solve did is what is kept.
      if (i + 1 == kMostSolves || !correct_active_sets()) break;
    }
    commit();
  }

  // Active sets to begin a step with.
  void guess_active_sets() const {
    for_each_bound([](const auto& bound, const EdgeRows<S>&) { bound.guess(); });
  }

 private:
  static constexpr int kMostSolves = 4;

  // From the leaves to the roots.
  void eliminate_all() const {
    for_each_tree_body(t_, [&](int b) {
      store(row(d_.inertia, b, kArticulatedRowsOf<S>), rigid_body(mass_of(b), moments(rotary_, b)));
      store(row(d_.load, b, kTwistRowsOf<S>),
            load_as<WrenchOf<S>>(row(d_.own_load, b, kTwistRowsOf<S>)));
    });
    for (int i = t_.joint_trees.edges - 1; i >= 0; --i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      EdgeRows<S>& s = edge_rows<S>(w_, i);
      const auto arm = load_as<Vec>(s.arm_child[0]);
      ArticulatedOf<S> inertia = moved_back(
          load_as<ArticulatedOf<S>>(row(d_.inertia, edge.child, kArticulatedRowsOf<S>)), -arm);
      WrenchOf<S> load =
          moved(load_as<WrenchOf<S>>(row(d_.load, edge.child, kTwistRowsOf<S>)), arm);
      const TwistOf<S> change = find_change(edge, s);
      store(s.change[0], change);
      load = load - mul(inertia, change);
      if (edge.slides) eliminate(edge, edge.slide, s.slide, axis_of_slide(s), inertia, load);
      if (hinges(edge)) eliminate(edge, edge.angle, s.turn, axis_of_turn(s), inertia, load);
      if constexpr (S::kDim == 3) {
        if (edge.ball) eliminate_rotation(s, inertia, load);
      }
      if (edge.prescribed) continue;
      const auto back = load_as<Vec>(s.arm_parent[0]);
      add_in_lanes<kArticulatedRowsOf<S>>(row(d_.inertia, edge.parent, kArticulatedRowsOf<S>),
                                          moved_back(inertia, back), s.lanes);
      add_in_lanes<kTwistRowsOf<S>>(row(d_.load, edge.parent, kTwistRowsOf<S>), moved(load, -back),
                                    s.lanes);
    }
  }
  // And back.
  void substitute_back() const {
    for (int i = 0; i < t_.joint_trees.roots; ++i) solve_alone(t_.joint_trees.root[i]);
    for (int i = 0; i < t_.joint_trees.edges; ++i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      EdgeRows<S>& s = edge_rows<S>(w_, i);
      TwistOf<S> v{zero_of<Ang>(), zero_of<Vec>()};
      if (!edge.prescribed) {
        v = moved(load_as<TwistOf<S>>(row(d_.twist, edge.parent, kTwistRowsOf<S>)),
                  load_as<Vec>(s.arm_parent[0]));
      }
      if (hinges(edge)) v = expand(s.turn, axis_of_turn(s), v);
      if constexpr (S::kDim == 3) {
        if (edge.ball) {
          v.w = mul(load_as<Sym3>(s.compliance[0]), load_vec3(s.moment[0]) - mul(mixed_of(s), v.v));
        }
      }
      if (edge.slides) v = expand(s.slide, axis_of_slide(s), v);
      v = moved(v + load_as<TwistOf<S>>(s.change[0]), -load_as<Vec>(s.arm_child[0]));
      Real* to = row(d_.twist, edge.child, kTwistRowsOf<S>);
      if (s.lanes == kAllLanes) {
        store(to, v);
      } else {
        solve_alone(edge.child);
        store(to, select(mask_from_bits(s.lanes), v, load_as<TwistOf<S>>(to)));
      }
    }
  }

  // What the twist of the child against the parent is to change by at the anchor, but for the
  // coordinates, whose rates go to their rows.
  MW_INLINE TwistOf<S> find_change(const TreeEdge& edge, EdgeRows<S>& s) const {
    const Velocity<S> b = get_velocity<S, kDense>(w_, w_.velocity, edge.child);
    TwistOf<S> v = moved(TwistOf<S>{b.w, b.v}, load_as<Vec>(s.arm_child[0]));
    if (edge.parent != t_.bodies) {
      const Velocity<S> a = get_velocity<S, kDense>(w_, w_.velocity, edge.parent);
      const TwistOf<S> of_parent = moved(TwistOf<S>{a.w, a.v}, load_as<Vec>(s.arm_parent[0]));
      v = {v.w - of_parent.w, v.v - of_parent.v};
    }
    if (edge.slides) {
      const auto axis = load_as<Vec>(s.slide_axis[0]);
      const Float rate = dot(axis, v.v);
      rate.store(s.slide.began);
      v.v = fnma(axis, rate, v.v);
    }
    if (hinges(edge)) {
      if constexpr (S::kDim == 2) {
        v.w.store(s.turn.began);
        v.w = Real(0);
      } else {
        const auto axis = load_vec3(s.turn_axis[0]);
        const Float rate = dot(axis, v.w);
        rate.store(s.turn.began);
        v.w = fnma(axis, rate, v.w);
      }
    }
    TwistOf<S> change{-v.w, -v.v};
    if (closes_) change = change + load_as<TwistOf<S>>(s.target[0]);
    if (edge.ball) change.w = zero_of<Ang>();
    return change;
  }

  MW_INLINE void eliminate(const TreeEdge& edge, int part, EdgeDof<S>& dof, const TwistOf<S>& axis,
                           ArticulatedOf<S>& inertia, WrenchOf<S>& load) const {
    const WrenchOf<S> f = mul(inertia, axis);
    const Float pivot = dot(axis, f);
    Float stiffness(Real(0)), push(Real(0));
    with_bound(edge, part, dof, [&](const auto& bound) { bound.add(pivot, stiffness, push); });
    const Float inverse = inverse_or_zero(pivot + stiffness), own = dot(axis, load) + push;
    store(dof.response[0], f);
    pivot.store(dof.pivot), inverse.store(dof.inverse), own.store(dof.load);
    inertia = without(inertia, f, inverse);
    load = fnma(f, own * inverse, load);
  }
  MW_INLINE void eliminate_rotation(EdgeRows<S>& s, ArticulatedOf<S>& inertia,
                                    WrenchOf<S>& load) const requires(S::kDim == 3) {
    const Sym3 compliance = inverse(inertia.rotary);
    const Mat3 m = inertia.mixed;
    const Mat3 by{mul(compliance, m.x), mul(compliance, m.y), mul(compliance, m.z)};
    const Sym3& a = inertia.linear;
    store(s.compliance[0], compliance), store(s.moment[0], load.n);
    store(s.mixed[0][0], m.x), store(s.mixed[1][0], m.y), store(s.mixed[2][0], m.z);
    const Sym3 left{a.xx - dot(m.x, by.x), a.xy - dot(m.x, by.y), a.xz - dot(m.x, by.z),
                    a.yy - dot(m.y, by.y), a.yz - dot(m.y, by.z), a.zz - dot(m.z, by.z)};
    const Float zero(Real(0));
    const Vec3 none{zero, zero, zero};
    inertia = {{zero, zero, zero, zero, zero, zero}, {none, none, none}, left};
    load = {none, load.f - mul_transposed(by, load.n)};
  }
  static MW_INLINE Mat3 mixed_of(const EdgeRows<S>& s) {
    return {load_vec3(s.mixed[0][0]), load_vec3(s.mixed[1][0]), load_vec3(s.mixed[2][0])};
  }
  static MW_INLINE TwistOf<S> expand(EdgeDof<S>& dof, const TwistOf<S>& axis, const TwistOf<S>& v) {
    const Float load = Float::load(dof.load) - dot(v, load_as<WrenchOf<S>>(dof.response[0]));
    const Float change = load * Float::load(dof.inverse);
    change.store(dof.change);
    return fma(axis, change, v);
  }

  // Returns whether that of some edge has changed.
  bool correct_active_sets() const {
    std::uint32_t changed = 0;
    for_each_bound(
        [&](const auto& bound, const EdgeRows<S>& s) { changed |= bound.correct() & s.lanes; });
    return changed != 0;
  }

  // Velocities, and what joints did.
  void commit() const {
    for_each_tree_body(t_, [&](int b) {
      const auto change = load_as<TwistOf<S>>(row(d_.twist, b, kTwistRowsOf<S>));
      const auto own_load = load_as<WrenchOf<S>>(row(d_.own_load, b, kTwistRowsOf<S>));
      store(row(d_.load, b, kTwistRowsOf<S>),
            WrenchOf<S>{apply(moments(rotary_, b), change.w) - own_load.n, change.v * mass_of(b)});
      const Velocity<S> old = get_velocity<S, kDense>(w_, w_.velocity, b);
      const Velocity<S> now{old.v + change.v, old.w + change.w};
      const std::uint32_t held = d_.held[b];
      if (held == kAllLanes) {
        put_velocity<S, kDense>(w_, w_.velocity, b, now);
      } else {
        put_velocity<S, kDense>(w_, w_.velocity, b, select(mask_from_bits(held), now, old));
      }
    });
    for_each_bound([&](const auto& bound, const EdgeRows<S>&) { bound.keep(); });
    for (int i = t_.joint_trees.edges - 1; i >= 0; --i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      const EdgeRows<S>& s = edge_rows<S>(w_, i);
      const WrenchOf<S> p = moved(load_as<WrenchOf<S>>(row(d_.load, edge.child, kTwistRowsOf<S>)),
                                  load_as<Vec>(s.arm_child[0]));
      keep_impulse(edge, s, p);
      if (edge.prescribed) continue;
      add_in_lanes<kTwistRowsOf<S>>(row(d_.load, edge.parent, kTwistRowsOf<S>),
                                    moved(p, -load_as<Vec>(s.arm_parent[0])), s.lanes);
    }
  }
  // On B, without what acts along the coordinates.
  MW_INLINE void keep_impulse(const TreeEdge& edge, const EdgeRows<S>& s, WrenchOf<S> p) const {
    if (edge.slides) {
      const auto axis = load_as<Vec>(s.slide_axis[0]);
      p.f = fnma(axis, dot(axis, p.f), p.f);
      keep(part_rows<S, LineRows<S>>(w_, edge.hold), edge, s, p.f);
    } else {
      keep(part_rows<S, PointRows<S>>(w_, edge.hold), edge, s, p.f);
    }
    if (edge.turn < 0) return;
    if (edge.locked) return keep(part_rows<S, LockRows<S>>(w_, edge.turn), edge, s, p.n);
    if constexpr (S::kDim == 3) {
      const auto axis = load_vec3(s.turn_axis[0]);
      keep(part_rows<S, SwingRows<S>>(w_, edge.turn), edge, s, fnma(axis, dot(axis, p.n), p.n));
    }
  }
  template <class Rows, class V>
  MW_INLINE void keep(Rows& to, const TreeEdge& edge, const EdgeRows<S>& s, V p) const {
    if (edge.reversed) p = -p;
    if (!first_) p = load_as<V>(to.impulse[0]) + p;
    const Mask holds = mask_from_bits(s.lanes);
    store(to.impulse[0], select(holds, p, zero_of<V>()));
  }

  // Of a root, or of what hangs on nothing in some lanes.
  MW_INLINE void solve_alone(int body) const {
    store(row(d_.twist, body, kTwistRowsOf<S>),
          solve(load_as<ArticulatedOf<S>>(row(d_.inertia, body, kArticulatedRowsOf<S>)),
                load_as<WrenchOf<S>>(row(d_.load, body, kTwistRowsOf<S>))));
  }
  MW_INLINE Float mass_of(int body) const {
    return Float(Real(1)) / Float(constants_of_body(g_, body).inv_mass);
  }
  static MW_INLINE MomentsOf<S> moments(const Real* of, int body) {
    return load_as<MomentsOf<S>>(of + body * S::kInertia * kLanes);
  }
  static MW_INLINE Real* row(Real* of, int body, int rows) { return of + body * rows * kLanes; }

  template <class Visit>
  MW_INLINE void with_bound(const TreeEdge& edge, int part, EdgeDof<S>& dof, Visit visit) const {
    if (part < 0) return;
    const JointPart& what = t_.part[part];
    const Joint& c = constants_of_part(g_, part);
    if (what.kind == PartKind::slide) {
      visit(Bound<S, true>(t_, g_, what, c, part_rows<S, Row<S, true>>(w_, part), dof,
                           edge.reversed, closes_, first_));
    } else {
      visit(Bound<S, false>(t_, g_, what, c, part_rows<S, Row<S, false>>(w_, part), dof,
                            edge.reversed, closes_, first_));
    }
  }
  template <class Visit>
  MW_INLINE void for_each_bound(Visit visit) const {
    for (int i = 0; i < t_.joint_trees.edges; ++i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      EdgeRows<S>& s = edge_rows<S>(w_, i);
      with_bound(edge, edge.slide, s.slide, [&](const auto& b) { visit(b, s); });
      with_bound(edge, edge.angle, s.turn, [&](const auto& b) { visit(b, s); });
    }
  }

  const Constants& t_;
  const Group& g_;
  Work& w_;
  DirectWork& d_;
  const Real* rotary_;
  const bool closes_, first_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
