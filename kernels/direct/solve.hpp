// The joints of trees solved at once: the velocities nearest to those that there are, in the
// measure of kinetic energy, with which every joint does what it asks for. Articulated bodies
// (Featherstone 2008, 7.3) in the coordinates of free bodies: what hangs on a joint is felt at its
// anchor as an inertia and a load, from which the coordinates along which the joint gives way are
// eliminated. Nothing fills in, whatever the branching, and nothing is warm started. All numbers
// are changes of velocity: rounding is of what joints do, and linear momentum is kept.
//
// Lanes in which a joint does not hold cut the tree there: the child is a root in those.
#pragma once

#include "kernels/direct/ball_bounds.hpp"
#include "kernels/direct/joint_impulses.hpp"
#include "kernels/direct/loops.hpp"
#include "kernels/direct/pivot_rule.hpp"
#include "kernels/direct/turning.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, bool kDense>
class TreeSolve {
 public:
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;

  // At the start of substep `place`. `stiffened`: with the geometric stiffness; `closes`: see
  // Bound; `first` solve of a substep.
  TreeSolve(const Constants& t, const Group& g, Work& w, int place, bool stiffened, bool closes,
            bool first)
      : t_(t),
        g_(g),
        w_(w),
        d_(w.direct),
        rotary_(stiffened ? d_.stiffened : d_.rotary),
        place_(place),
        stiffened_(stiffened),
        first_(first),
        closes_(closes),
        factors_(factors_in<S>(d_.of_solves)),
        bounds_(t, g, w, closes, first),
        balls_(t, w, bounds_),
        loops_(t, g, w, factors_),
        turning_(t, w) {}

  // Until the active sets stay as they are.
  void run() const {
    const bool turns = stiffened_ && turning_.begin();
    if (!stiffened_) turning_.clear();
    if (first_) d_.firm = kAllLanes;
    solve_in(kAllLanes, turns && !loops_.any());  // what closes loops knows of no mean
  }
  // After contacts, whose impulses are the loads of the bodies (response.hpp).
  void run_again() const {
    if (d_.pushed != 0) solve_in(d_.pushed, false);
  }

  // Factors for what contacts do to trees. Limits that act and drives hold against contacts as
  // rigidly as they do in the last solve. Where one of them has given way to the contacts of this
  // substep they keep their impulses instead, which takes back what contacts pushed against in
  // vain: else that feeds energy.
  TreeFactors<S> factor_for_contacts() const { return factor_in(d_.firm); }
  // Factors for the effective masses of attached rows. A limit or drive that holds would add to the
  // mass, and the impulse of a row that pulls the joint off the limit would be far too large.
  TreeFactors<S> factor_without_bounds() const {
    return factor_in(t_.joint_trees.bounded ? 0 : kAllLanes);
  }

  // Active sets to begin a step with.
  void guess_active_sets() const {
    bounds_.for_each([](const auto& bound, auto&, auto&) { bound.guess(); });
  }

 private:
  static constexpr int kMostSolves = 32;

  // Velocities and impulses of some lanes. `turns`: see Turning.
  void solve_in(std::uint32_t lanes, bool turns) const {
    PivotRule rule;
    bounds_.for_each([](const auto&, auto& dof, auto&) {
      dof.before = dof.active;
      dof.corrected = dof.settled = {0, 0};
    });
    bool changed = false;
    for (int i = 0; i < kMostSolves; ++i) {
      factor_for_solves();
      loops_.clear();
      turns ? turning_.find([&] { solve_linear(); }) : solve_linear();
      if (loops_.any()) {
        find_changes_of_closures();
        loops_.find_impulses();
        solve_linear();
      }
      if (i + 1 == kMostSolves) break;  // what the last solve did is what is kept
      if (!correct_active_sets(lanes, rule)) break;
      changed = true;
    }
    if (changed && !first_) {
      bounds_.for_each([&](const auto& bound, auto&, auto&) { d_.firm &= ~bound.gave_way(); });
    }
    commit(lanes);
  }

  void solve_linear() const {
    reduce_loads();
    substitute_back();
  }
  void find_changes_of_closures() const {
    const int edges = t_.joint_trees.edges;
    for (int i = edges; i < edges + t_.joint_trees.closures; ++i) {
      EdgeRows<S>& s = edge_rows<S>(w_, i);
      store(s.change[0], find_change(t_.joint_trees.edge[i], s));
    }
  }

  TreeFactors<S> factor_in(std::uint32_t firm) const {
    if (firm == kAllLanes) {
      factor_for_solves();
      return factors_;
    }
    const TreeFactors<S> own = factors_in<S>(d_.of_contacts);
    eliminate_all(own, firm);
    return own;
  }
  // Unless there are some of this place and of these active sets.
  void factor_for_solves() const {
    bool same = d_.factored.place == place_ && d_.factored.stiffened == stiffened_;
    bounds_.for_each(
        [&](const auto&, auto& dof, auto&) { same = same && dof.factored == dof.active; });
    if (same) return;
    eliminate_all(factors_, kAllLanes);
    loops_.factor();
    d_.factored = {place_, stiffened_};
    bounds_.for_each([](const auto&, auto& dof, auto&) { dof.factored = dof.active; });
  }

  // From the leaves to the roots. `firm`: see Bound::stiffness.
  void eliminate_all(const TreeFactors<S>& to, std::uint32_t firm) const {
    for_each_tree_body(t_, [&](int b) {
      store(row(to.inertia, b, kArticulatedRowsOf<S>), rigid_body(mass_of(b), moments(rotary_, b)));
    });
    for (int i = t_.joint_trees.edges - 1; i >= 0; --i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      const EdgeRows<S>& s = edge_rows<S>(w_, i);
      EdgeFactors<S>& f = to.edge[i];
      ArticulatedOf<S> inertia =
          moved_back(load_as<ArticulatedOf<S>>(row(to.inertia, edge.child, kArticulatedRowsOf<S>)),
                     -load_as<Vec>(s.arm_child[0]));
      const auto give_way = [&](const TwistOf<S>& axis, DofFactors<S>& dof, auto visit) {
        const WrenchOf<S> response = mul(inertia, axis);
        const Float pivot = dot(axis, response);
        Float stiffness(Real(0));
        visit([&](const auto& bound) { stiffness = bound.stiffness(pivot, firm); });
        const Float inverse = inverse_or_zero(pivot + stiffness);
        store(dof.response[0], response);
        pivot.store(dof.pivot), inverse.store(dof.inverse);
        inertia = without(inertia, response, inverse);
      };
      if (edge.slides) {
        give_way(axis_of_slide(s), f.slide, [&](auto look) { bounds_.visit_slide(i, look); });
      }
      if (hinges(edge)) {
        give_way(axis_of_turn(s), f.turn, [&](auto look) { bounds_.visit_turn(i, look); });
      }
      if constexpr (S::kDim == 3) {
        if (edge.ball) {
          eliminate_rotation(f.ball, inertia);
          if (limited(edge)) balls_.eliminate(i, f, inertia, firm);
        }
      }
      if (edge.prescribed) continue;
      const auto arm = load_as<Vec>(s.arm_parent[0]);
      Real* parent = row(to.inertia, edge.parent, kArticulatedRowsOf<S>);
      if constexpr (S::kDim == 3) {
        if (edge.ball && !limited(edge)) {  // what is left is of forces alone
          add_in_lanes<kArticulatedRowsOf<S>>(parent, spring_at(arm, inertia.linear), s.lanes);
          continue;
        }
      }
      add_in_lanes<kArticulatedRowsOf<S>>(parent, moved_back(inertia, arm), s.lanes);
    }
  }
  void reduce_loads() const {
    for_each_tree_body(t_, [&](int b) {
      store(row(d_.load, b, kTwistRowsOf<S>),
            load_as<WrenchOf<S>>(row(d_.own_load, b, kTwistRowsOf<S>)));
    });
    loops_.for_each_side([&](int b, const WrenchOf<S>& p, std::uint32_t in) {
      add_in_lanes<kTwistRowsOf<S>>(row(d_.load, b, kTwistRowsOf<S>), p, in);
    });
    for (int i = t_.joint_trees.edges - 1; i >= 0; --i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      EdgeRows<S>& s = edge_rows<S>(w_, i);
      const auto arm = load_as<Vec>(s.arm_child[0]);
      const TwistOf<S> change = find_change(edge, s);
      store(s.change[0], change);
      const auto inertia =
          load_as<ArticulatedOf<S>>(row(factors_.inertia, edge.child, kArticulatedRowsOf<S>));
      const auto own = load_as<WrenchOf<S>>(row(d_.load, edge.child, kTwistRowsOf<S>));
      WrenchOf<S> load = moved(own - mul(inertia, moved(change, -arm)), arm);
      const EdgeFactors<S>& f = factors_.edge[i];
      const auto reduce = [&](const TwistOf<S>& axis, const DofFactors<S>& factors, EdgeDof<S>& dof,
                              auto visit) {
        const Float along = dot(axis, load);
        Float push(Real(0));
        visit([&](const auto& bound) { push = bound.push(); });
        along.store(dof.load), push.store(dof.push);
        const Float rate = (along + push) * Float::load(factors.inverse);
        load = fnma(load_as<WrenchOf<S>>(factors.response[0]), rate, load);
      };
      if (edge.slides) {
        reduce(axis_of_slide(s), f.slide, s.slide,
               [&](auto look) { bounds_.visit_slide(i, look); });
      }
      if (hinges(edge)) {
        reduce(axis_of_turn(s), f.turn, s.turn, [&](auto look) { bounds_.visit_turn(i, look); });
      }
      if constexpr (S::kDim == 3) {
        if (edge.ball) {
          store(s.moment[0], load.n);
          load = limited(edge) ? balls_.reduce(i, f, load) : without_turn(f.ball, load);
        }
      }
      if (edge.prescribed) continue;
      add_in_lanes<kTwistRowsOf<S>>(row(d_.load, edge.parent, kTwistRowsOf<S>),
                                    moved(load, -load_as<Vec>(s.arm_parent[0])), s.lanes);
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
      const EdgeFactors<S>& f = factors_.edge[i];
      if (hinges(edge)) v = expand(f.turn, s.turn, axis_of_turn(s), v);
      if constexpr (S::kDim == 3) {
        if (edge.ball) {
          const Vec3 moment = load_vec3(s.moment[0]);
          v.w = limited(edge) ? balls_.turn(i, f, moment, v) : turn_of(f.ball, moment, v.v);
        }
      }
      if (edge.slides) v = expand(f.slide, s.slide, axis_of_slide(s), v);
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
      v = v - of_parent;
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
    if constexpr (S::kDim == 3) {
      if (edge.ball) {
        if (edge.cone >= 0) dot(load_vec3(s.slide_axis[0]), v.w).store(s.slide.began);
        if (edge.angle >= 0) dot(load_vec3(s.turn_axis[0]), v.w).store(s.turn.began);
      }
    }
    TwistOf<S> change{-v.w, -v.v};
    if (closes_) change = change + load_as<TwistOf<S>>(s.target[0]);
    if (edge.ball) change.w = zero_of<Ang>();
    return change;
  }

  static MW_INLINE TwistOf<S> expand(const DofFactors<S>& f, EdgeDof<S>& dof,
                                     const TwistOf<S>& axis, const TwistOf<S>& v) {
    const Float load = Float::load(dof.load) - dot(v, load_as<WrenchOf<S>>(f.response[0]));
    const Float change = (load + Float::load(dof.push)) * Float::load(f.inverse);
    load.store(dof.load), change.store(dof.change);
    return fma(axis, change, v);
  }

  // Corrects them; returns whether some were wrong. What has been corrected alone is right at
  // first, but for rounding, where both of its states are as good: that is settled, on the side
  // that leaves the error in an impulse rather than in a velocity.
  bool correct_active_sets(std::uint32_t lanes, PivotRule& rule) const {
    const auto wrong_in = [&](const auto& bound, const auto& dof, const EdgeRows<S>& s) {
      return bound.wrong(lanes & s.lanes) & ~dof.settled;
    };
    std::uint32_t some = 0;
    bounds_.for_each([&](const auto& bound, auto& dof, const EdgeRows<S>& s) {
      const BoundLanes wrong = wrong_in(bound, dof, s);
      some |= wrong.limit | wrong.drive;
      rule.count(wrong.limit), rule.count(wrong.drive);
    });
    if (some == 0) return false;
    const std::uint32_t all = rule.choose(some);
    std::uint32_t last = some & ~all;
    // Visited backwards: the first that is wrong is the last one.
    bounds_.template for_each<true>([&](const auto& bound, auto& dof, const EdgeRows<S>& s) {
      const BoundLanes wrong = wrong_in(bound, dof, s);
      BoundLanes alone{wrong.limit & last, 0};
      last &= ~alone.limit;
      alone.drive = wrong.drive & last;
      last &= ~alone.drive;
      const BoundLanes again = alone & dof.corrected;
      dof.settled = dof.settled | again;
      dof.corrected = alone;
      bound.correct((wrong & BoundLanes{all, all}) | (alone & ~again) |
                    (again & bound.gives_way()));
    });
    return true;
  }

  // Velocities, and what joints did.
  void commit(std::uint32_t lanes) const {
    for_each_tree_body(t_, [&](int b) {
      const auto change = load_as<TwistOf<S>>(row(d_.twist, b, kTwistRowsOf<S>));
      const auto own_load = load_as<WrenchOf<S>>(row(d_.own_load, b, kTwistRowsOf<S>));
      store(row(d_.load, b, kTwistRowsOf<S>),
            WrenchOf<S>{apply(moments(rotary_, b), change.w), change.v * mass_of(b)} - own_load);
      const Velocity<S> old = get_velocity<S, kDense>(w_, w_.velocity, b);
      const Velocity<S> now{old.v + change.v, old.w + change.w};
      const std::uint32_t held = d_.held[b] & lanes;
      if (held == kAllLanes) {
        put_velocity<S, kDense>(w_, w_.velocity, b, now);
      } else {
        put_velocity<S, kDense>(w_, w_.velocity, b, select(mask_from_bits(held), now, old));
      }
    });
    loops_.for_each_side([&](int b, const WrenchOf<S>& p, std::uint32_t in) {
      add_in_lanes<kTwistRowsOf<S>>(row(d_.load, b, kTwistRowsOf<S>), WrenchOf<S>{-p.n, -p.f}, in);
    });
    bounds_.for_each([&](const auto& bound, auto&, auto&) { bound.keep(lanes); });
    const JointImpulses<S> kept(w_, first_, lanes);
    loops_.for_each_wrench([&](int i, const WrenchOf<S>& p) {
      kept.keep(t_.joint_trees.edge[i], edge_rows<S>(w_, i), p);
    });
    for (int i = t_.joint_trees.edges - 1; i >= 0; --i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      const EdgeRows<S>& s = edge_rows<S>(w_, i);
      const WrenchOf<S> p = moved(load_as<WrenchOf<S>>(row(d_.load, edge.child, kTwistRowsOf<S>)),
                                  load_as<Vec>(s.arm_child[0]));
      kept.keep(edge, s, p);
      if (edge.prescribed) continue;
      add_in_lanes<kTwistRowsOf<S>>(row(d_.load, edge.parent, kTwistRowsOf<S>),
                                    moved(p, -load_as<Vec>(s.arm_parent[0])), s.lanes);
    }
  }
  // Of a root, or of what hangs on nothing in some lanes.
  MW_INLINE void solve_alone(int body) const {
    store(row(d_.twist, body, kTwistRowsOf<S>),
          solve(load_as<ArticulatedOf<S>>(row(factors_.inertia, body, kArticulatedRowsOf<S>)),
                load_as<WrenchOf<S>>(row(d_.load, body, kTwistRowsOf<S>))));
  }
  MW_INLINE Float mass_of(int body) const {
    return Float(Real(1)) / Float(constants_of_body(g_, body).inv_mass);
  }
  static MW_INLINE MomentsOf<S> moments(const Real* of, int body) {
    return load_as<MomentsOf<S>>(of + body * S::kInertia * kLanes);
  }
  static MW_INLINE Real* row(Real* of, int body, int rows) { return of + body * rows * kLanes; }

  const Constants& t_;
  const Group& g_;
  Work& w_;
  DirectWork& d_;
  const Real* rotary_;  // moments of inertia [body][rotary][lane], with what resists as they do
  const int place_;
  const bool stiffened_, first_, closes_;
  const TreeFactors<S> factors_;  // of the solves
  const EdgeBounds<S> bounds_;
  const BallBounds<S> balls_;
  const TreeLoops<S, kDense> loops_;
  const Turning<S, kDense> turning_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
