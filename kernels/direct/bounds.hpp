// What drives and limits do along a coordinate of an edge. They stand in its pivot, so that they
// are as implicit as the joint itself: an impulse p along the rate q of the child against the
// parent, where v = q, or -q where the child is A, has been v0 before the solve.
//
//   spring of a drive   p = k (share target speed - bias_rate C - v),  1 / k = rho K + gamma
//   motor               the same with v = target speed and a k that is hard against the pivot
//   limit               p = k (bound - v) of one sign, hard or as such a spring
//
// (RowSoftness). p = k (w - v0) - k (v - v0): of v itself float would have no digits left. Which
// limits act, and which drives are at their largest impulse, is the active set: guessed by the last
// solve, corrected by this one. Impulses are those of the substep so far.
#pragma once

#include "kernels/direct/edges.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Times the pivot. A limit outdoes a motor that drives into it.
inline constexpr Real kHardMotor = Real(1e3), kHardLimit = Real(1e6);
inline constexpr Real kUnbounded = Real(1e30);  // N s or N m s, of drives
// What rounding leaves of speeds does not change active sets.
inline constexpr Real kActiveSlack = sizeof(Real) == 4 ? Real(1e-5) : Real(1e-12);

template <class S>
class Bound {
 public:
  // closes: limits are closed, too. `first`: the substep has no impulses yet.
  MW_INLINE Bound(const Constants& t, const Group& g, const Work& w, const JointPart& part,
                  const Joint& constants, Row<S>& s, EdgeDof<S>& dof, const DofFactors<S>& factors,
                  bool reversed, bool closes, bool first)
      : part_(part),
        c_(constants),
        s_(s),
        dof_(dof),
        factors_(factors),
        closes_(closes),
        first_(first) {
    sign_ = reversed ? Real(-1) : Real(1);
    began_ = Float::load(dof.began) * sign_;
    const Float value = Float::load(s.value);
    if (first) value.store(s.driven);
    inv_h_ = t.inv_h;
    if (closes) curved_ = curving(w, part, s);
    if (part.drive) {
      const DriveTarget target = target_of(g, part, constants);
      wanted_ = target.speed * Float(constants.speed_share);
      if (part.springy) {
        const Float error = Float::load(s.driven) - target.position;
        wanted_ = fnma(error, Float(constants.drive_soft.bias_rate), wanted_);
      }
    }
    if (part.low) low_ = bound(value - Float(constants.low)) - curved_;
    if (part.high) high_ = bound(Float(constants.high) - value) + curved_;
  }

  // The active set to begin a step with: what acted at the end of the last one.
  MW_INLINE void guess() const {
    const Float zero(Real(0));
    dof_.active.above = dof_.active.below = 0;
    dof_.active.low = bits(zero < Float::load(s_.impulse[1]));
    dof_.active.high = bits(zero < Float::load(s_.impulse[2]));
  }

  // What it adds to the pivot; in lanes that are not `firm` only what has no bound.
  MW_INLINE Float stiffness(Float pivot, std::uint32_t firm) const {
    const Float zero(Real(0));
    Float sum = zero;
    if (part_.drive) {
      Mask yields = mask_from_bits(dof_.active.above | dof_.active.below);
      if (firm != kAllLanes) {
        yields = yields | ((Float(c_.max_impulse) < Float(kUnbounded)) & mask_from_bits(~firm));
      }
      sum = select(yields, zero, drive_stiffness(pivot));
    }
    const Float of_limit = limit_stiffness(pivot);
    if (part_.low) sum = sum + select(mask_from_bits(dof_.active.low & firm), of_limit, zero);
    if (part_.high) sum = sum + select(mask_from_bits(dof_.active.high & firm), of_limit, zero);
    return sum;
  }

  // And to the load.
  MW_INLINE Float push() const {
    const Float zero(Real(0)), pivot = Float::load(factors_.pivot);
    Float sum = zero;
    if (part_.drive) {
      const Mask above = mask_from_bits(dof_.active.above),
                 below = mask_from_bits(dof_.active.below);
      const Float k = drive_stiffness(pivot), most = c_.max_impulse, so_far = before(0);
      Float p = k * (wanted_ - began_) - (part_.springy ? so_far : zero);
      p = select(above, most - so_far, select(below, zero - most - so_far, p));
      sum = fma(p, sign_, sum);
    }
    const auto limit = [&](std::uint32_t active, Float least, Float speed, int which) {
      const Float k = limit_stiffness(pivot);
      const Float p = k * (least - speed) - (part_.soft_limit ? before(which) : zero);
      return select(mask_from_bits(active), p, zero - before(which));
    };
    if (part_.low) sum = fma(limit(dof_.active.low, low_, began_, 1), sign_, sum);
    if (part_.high) sum = fnma(limit(dof_.active.high, high_, zero - began_, 2), sign_, sum);
    return sum;
  }

  // Lanes in which a limit has let go since the solve began, or a drive has given way.
  MW_INLINE std::uint32_t gave_way() const {
    const ActiveSet &before = dof_.before, &now = dof_.active;
    return (before.low & ~now.low) | (before.high & ~now.high) | (now.above & ~before.above) |
           (now.below & ~before.below);
  }

  // Of `lanes` those in which what came of it does not agree with the active set.
  MW_INLINE BoundLanes wrong(std::uint32_t lanes) const {
    const ActiveSet now = found();
    return {lanes & ((now.low ^ dof_.active.low) | (now.high ^ dof_.active.high)),
            lanes & ((now.above ^ dof_.active.above) | (now.below ^ dof_.active.below))};
  }
  // Lanes in which no limit acts, and in which the drive is at its largest impulse.
  MW_INLINE BoundLanes gives_way() const {
    const ActiveSet& now = dof_.active;
    return {~(now.low | now.high), now.above | now.below};
  }
  // Corrects it in some lanes.
  MW_INLINE void correct(const BoundLanes& lanes) const {
    const ActiveSet now = found();
    const auto put = [](std::uint32_t& to, std::uint32_t from, std::uint32_t in) {
      to = (to & ~in) | (from & in);
    };
    put(dof_.active.low, now.low, lanes.limit), put(dof_.active.high, now.high, lanes.limit);
    put(dof_.active.above, now.above, lanes.drive), put(dof_.active.below, now.below, lanes.drive);
  }

  // Keeps the impulses of the substep, in some lanes.
  MW_INLINE void keep(std::uint32_t lanes) const {
    const Impulses p = impulses();
    const Mask mask = mask_from_bits(lanes);
    const Float zero(Real(0));
    const Float of[3] = {p.drive, max(p.low, zero), max(p.high, zero)};
    for (int i = 0; i < 3; ++i) {
      select(mask, of[i], Float::load(s_.impulse[i])).store(s_.impulse[i]);
    }
  }

 private:
  struct Impulses {
    Float drive, low, high;
  };
  MW_INLINE Float before(int which) const {
    return first_ ? Float(Real(0)) : Float::load(s_.impulse[which]);
  }
  MW_INLINE Float change_of_speed() const { return Float::load(dof_.change) * sign_; }
  MW_INLINE Float one_over(const kernels::RowSoftness<LaneNumber>& soft) const {
    return inverse_or_zero(fma(Float::load(s_.k), Float(soft.rho), soft.gamma));
  }
  MW_INLINE Float drive_stiffness(Float pivot) const {
    return part_.springy ? one_over(c_.drive_soft) : pivot * Float(kHardMotor);
  }
  MW_INLINE Float limit_stiffness(Float pivot) const {
    return part_.soft_limit ? one_over(c_.limit_soft) : pivot * Float(kHardLimit);
  }
  // The least speed towards the inside, by the distance to the limit.
  MW_INLINE Float bound(Float gap) const {
    const Float zero(Real(0)), ahead = zero - gap * inv_h_;
    if (!closes_ && !part_.soft_limit) return min(ahead, zero);
    return select(zero < gap, ahead, zero - gap * Float(c_.limit_soft.bias_rate));
  }
  // Of the substep, if nothing bounded it.
  MW_INLINE Float unbounded_drive(Float change) const {
    const Float k = drive_stiffness(Float::load(factors_.pivot)), zero(Real(0));
    return k * ((wanted_ - began_) - change) + (part_.springy ? zero : before(0));
  }
  // Of the substep, by the active set. What limits do is what the pivot lacks: by their own
  // stiffness float would have no digits left.
  MW_INLINE Impulses impulses() const {
    const Float zero(Real(0)), change = change_of_speed();
    Impulses out{before(0), zero, zero};
    if (part_.drive) {
      const Float most = c_.max_impulse;
      out.drive =
          select(mask_from_bits(dof_.active.above), most,
                 select(mask_from_bits(dof_.active.below), zero - most, unbounded_drive(change)));
    }
    if (!part_.low && !part_.high) return out;
    const Float all =
        fms(Float::load(factors_.pivot), Float::load(dof_.change), Float::load(dof_.load));
    const Float low = fms(all, sign_, out.drive - before(0)) + (before(1) - before(2));
    out.low = select(mask_from_bits(dof_.active.low), low, zero);
    out.high = select(mask_from_bits(dof_.active.high), zero - low, zero);
    return out;
  }
  // The active set that agrees with what came of it.
  MW_INLINE ActiveSet found() const {
    const Impulses p = impulses();
    const Float zero(Real(0)), change = change_of_speed(), v = began_ + change;
    const Float slack = (abs(began_) + abs(change)) * Float(kActiveSlack);
    const Float slack_p = slack * Float::load(factors_.pivot);
    ActiveSet out{0, 0, 0, 0};
    if (part_.low) {
      const Mask acts = mask_from_bits(dof_.active.low);
      out.low = bits((acts & (zero - slack_p < p.low)) | ((v < low_ - slack) & !acts));
    }
    if (part_.high) {
      const Mask acts = mask_from_bits(dof_.active.high);
      out.high = bits((acts & (zero - slack_p < p.high)) | ((zero - v < high_ - slack) & !acts));
    }
    if (part_.drive) {
      const Float free = unbounded_drive(change), most = c_.max_impulse;
      const Float speeds = abs(began_) + abs(change) + abs(wanted_);
      const Float slack_f =
          speeds * (drive_stiffness(Float::load(factors_.pivot)) * Float(Real(0.1) * kActiveSlack));
      const auto ends = [&](Float x, std::uint32_t at) {
        return bits(most + select(mask_from_bits(at), zero - slack_f, slack_f) < x);
      };
      // Never from one bound to the other at once: the answer may be in between.
      out.above = ends(free, dof_.active.above) & ~dof_.active.below;
      out.below = ends(zero - free, dof_.active.below) & ~dof_.active.above;
    }
    return out;
  }

  const JointPart& part_;
  const Joint& c_;
  Row<S>& s_;
  EdgeDof<S>& dof_;
  const DofFactors<S>& factors_;  // of the solves
  bool closes_, first_;
  Float sign_ = Real(1), inv_h_ = Real(0), began_ = Real(0), curved_ = Real(0);
  Float wanted_ = Real(0);                // speed of a drive
  Float low_ = Real(0), high_ = Real(0);  // bounds of limits
};

// The bounds of all edges, for one solve (Bound).
template <class S>
class EdgeBounds {
 public:
  MW_INLINE EdgeBounds(const Constants& t, const Group& g, const Work& w, bool closes, bool first)
      : t_(t),
        g_(g),
        w_(w),
        factors_(factors_in<S>(w.direct.of_solves)),
        closes_(closes),
        first_(first) {}

  // look(bound) at what drives and limits an edge along x, or about z.
  template <class Look>
  MW_INLINE void visit_slide(int i, Look look) const {
    const TreeEdge& edge = t_.joint_trees.edge[i];
    visit(edge, edge.slide, edge_rows<S>(w_, i).slide, factors_.edge[i].slide, look);
  }
  template <class Look>
  MW_INLINE void visit_turn(int i, Look look) const {
    const TreeEdge& edge = t_.joint_trees.edge[i];
    visit(edge, edge.angle, edge_rows<S>(w_, i).turn, factors_.edge[i].turn, look);
  }
  // look(bound) at the cone of a ball joint.
  template <class Look>
  MW_INLINE void visit_cone(int i, Look look) const {
    const TreeEdge& edge = t_.joint_trees.edge[i];
    visit(edge, edge.cone, edge_rows<S>(w_, i).slide, factors_.edge[i].slide, look);
  }
  // look(bound, dof, rows of its edge) at all of them.
  template <bool kBackwards = false, class Look>
  MW_INLINE void for_each(Look look) const {
    const int edges = t_.joint_trees.edges;
    for (int k = 0; k < edges; ++k) {
      const int i = kBackwards ? edges - 1 - k : k;
      EdgeRows<S>& s = edge_rows<S>(w_, i);
      visit_slide(i, [&](const auto& bound) { look(bound, s.slide, s); });
      if constexpr (S::kDim == 3) {
        visit_cone(i, [&](const auto& bound) { look(bound, s.slide, s); });
      }
      visit_turn(i, [&](const auto& bound) { look(bound, s.turn, s); });
    }
  }

 private:
  template <class Look>
  MW_INLINE void visit(const TreeEdge& edge, int part, EdgeDof<S>& dof,
                       const DofFactors<S>& factors, Look look) const {
    if (part < 0) return;
    look(Bound<S>(t_, g_, w_, t_.part[part], constants_of_part(g_, part),
                  part_rows<S, Row<S>>(w_, part), dof, factors, edge.reversed, closes_, first_));
  }

  const Constants& t_;
  const Group& g_;
  const Work& w_;
  const TreeFactors<S> factors_;
  const bool closes_, first_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
