// What closes the loops of trees: a correction of low rank to their solve. The impulses l along the
// rows J of the joints that close loops, which the tree's solve leaves open, follow from how the
// tree gives way to them (W the inverse of its inertia),
//
//   (J W J' + floor) l = J (v wanted - v by the tree alone),
//
// and are loads in a second solve of the tree. J W J' takes a way to the roots and back for each
// row; it depends on what the factors of the tree depend on.
//
// Rows may depend on one another (planar loops in space), and a chain that is straight between two
// anchors gives way along itself by nothing at all. The floor, a share of what the bodies would
// give way by if they were free, is what then bounds the impulses.
#pragma once

#include "kernels/direct/tree_paths.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using kernels::JointLoops;

// Impulses are at most a speed over it. With 1e-5 in float32 random loops gain energy
// (direct_random_test.cpp), as they do with more solves.
inline constexpr Real kLoopFloor = Real(sizeof(Real) == 4 ? 1e-4 : 1e-8);
// What begins apart may be straight and compressed, and is flung across itself by less.
inline constexpr Real kGradualFloor = Real(1e-4);
inline constexpr int kLoopSolves = 3;

template <class S, bool kDense>
class TreeLoops {
 public:
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  TreeLoops(const Constants& t, const Group& g, Work& w, const TreeFactors<S>& factors)
      : t_(t), g_(g), w_(w), d_(w.direct), paths_(t, w, factors) {}

  bool any() const { return t_.joint_trees.loops > 0; }

  // J W J' of all loops, as L D L'.
  void factor() const {
    for_each_loop([&](const JointLoops& loop) {
      Real* a = d_.loop_factors + loop.factor * kLanes;
      for_each_row(loop, [&](int r, int edge, const WrenchOf<S>& along) {
        paths_.open();
        push(edge, along);
        for_each_row(loop, [&](int c, int other, const WrenchOf<S>& of) {
          if (c > r) return;
          const std::uint32_t both = rows(edge).lanes & rows(other).lanes;
          const Float x = dot(change_at(other), of);
          select(mask_from_bits(both), x, Float(Real(0))).store(entry(a, r, c));
        });
        const Float own =
            free_compliance(edge, along) * Float(loop.gradual ? kGradualFloor : kLoopFloor);
        const Float floor = select(mask_from_bits(rows(edge).lanes), own, Float(Real(0)));
        floor.store(d_.loop_floor + (loop.row + r) * kLanes);
        eliminate(a, r, floor);
      });
    });
  }

  void clear() const {
    for (int r = 0; r < t_.joint_trees.loop_rows; ++r) Float(Real(0)).store(impulse(r));
  }
  // From what the edges are to change by (EdgeRows::change) and what the tree makes of it.
  void find_impulses() const {
    for_each_loop([&](const JointLoops& loop) {
      for_each_row(loop, [&](int r, int edge, const WrenchOf<S>& along) {
        const EdgeRows<S>& s = rows(edge);
        const TwistOf<S> left = load_as<TwistOf<S>>(s.change[0]) - twist_at(edge);
        const Float b = select(mask_from_bits(s.lanes), dot(left, along), Float(Real(0)));
        b.store(target(loop.row + r));
      });
      for (int i = 0; i < kLoopSolves; ++i) solve_once(loop);
    });
  }
  // visit(edge, what it does to its child at its anchor): all that close loops.
  template <class Visit>
  MW_INLINE void for_each_wrench(Visit visit) const {
    for_each_loop([&](const JointLoops& loop) {
      WrenchOf<S> sum{zero_of<Ang>(), zero_of<Vec>()};
      int last = loop.first;
      for_each_row(loop, [&](int r, int edge, const WrenchOf<S>& along) {
        if (edge != last) visit(last, sum), sum = {zero_of<Ang>(), zero_of<Vec>()};
        last = edge;
        const Float x = Float::load(impulse(loop.row + r));
        sum = {fma(along.n, x, sum.n), fma(along.f, x, sum.f)};
      });
      visit(last, sum);
    });
  }
  // visit(body, what they do to it about its centre of mass, lanes).
  template <class Visit>
  MW_INLINE void for_each_side(Visit visit) const {
    for_each_wrench([&](int edge, const WrenchOf<S>& p) {
      for_each_side_of(edge, p,
                       [&](int body, const WrenchOf<S>& of) { visit(body, of, rows(edge).lanes); });
    });
  }

 private:
  const EdgeRows<S>& rows(int edge) const { return edge_rows<S>(w_, edge); }
  Real* target(int row) const { return d_.loop_target + row * kLanes; }
  Real* impulse(int row) const { return d_.loop_impulse + row * kLanes; }
  static const Real* entry(const Real* a, int row, int column) {
    return a + (row * (row + 1) / 2 + column) * kLanes;
  }
  static Real* entry(Real* a, int row, int column) {
    return a + (row * (row + 1) / 2 + column) * kLanes;
  }

  template <class Visit>
  MW_INLINE void for_each_loop(Visit visit) const {
    for (int i = 0; i < t_.joint_trees.loops; ++i) visit(t_.joint_trees.loop[i]);
  }
  // visit(row of the loop, edge, direction): all along which the joints that close it hold.
  template <class Visit>
  void for_each_row(const JointLoops& loop, Visit visit) const {
    int r = 0;
    for (int i = loop.first; i < loop.end; ++i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      const auto along = [&](Vec f) { visit(r++, i, WrenchOf<S>{zero_of<Ang>(), f}); };
      const auto about = [&](Ang n) { visit(r++, i, WrenchOf<S>{n, zero_of<Vec>()}); };
      const Float zero(Real(0)), one(Real(1));
      if constexpr (S::kDim == 2) {
        if (edge.slides) {
          along(load_as<Vec>(part_rows<S, LineRows<S>>(w_, edge.hold).direction[0][0]));
        } else {
          along({one, zero}), along({zero, one});
        }
        if (edge.locked) about(one);
      } else {
        if (edge.slides) {
          const auto& line = part_rows<S, LineRows<S>>(w_, edge.hold);
          along(load_vec3(line.direction[0][0])), along(load_vec3(line.direction[1][0]));
        } else {
          along({one, zero, zero}), along({zero, one, zero}), along({zero, zero, one});
        }
        if (edge.locked) {
          about({one, zero, zero}), about({zero, one, zero}), about({zero, zero, one});
        } else if (edge.turn >= 0) {
          const auto& swing = part_rows<S, SwingRows<S>>(w_, edge.turn);
          about(load_vec3(swing.across[0][0])), about(load_vec3(swing.across[1][0]));
        }
      }
    }
  }

  // visit(body, wrench about its centre of mass): of those that move.
  template <class Visit>
  MW_INLINE void for_each_side_of(int i, const WrenchOf<S>& p, Visit visit) const {
    const TreeEdge& edge = t_.joint_trees.edge[i];
    const EdgeRows<S>& s = rows(i);
    visit(edge.child, moved(p, -load_as<Vec>(s.arm_child[0])));
    if (edge.prescribed) return;
    visit(edge.parent, moved(WrenchOf<S>{-p.n, -p.f}, -load_as<Vec>(s.arm_parent[0])));
  }
  MW_INLINE void push(int edge, const WrenchOf<S>& p) const {
    for_each_side_of(
        edge, p, [&](int body, const WrenchOf<S>& of) { paths_.push(body, of, rows(edge).lanes); });
  }
  // Twist of the child against the parent at the anchor, from those of both.
  template <class TwistOfBody>
  MW_INLINE TwistOf<S> relative(int i, TwistOfBody of) const {
    const TreeEdge& edge = t_.joint_trees.edge[i];
    const EdgeRows<S>& s = rows(i);
    const TwistOf<S> b = moved(of(edge.child), load_as<Vec>(s.arm_child[0]));
    if (edge.prescribed) return b;
    return b - moved(of(edge.parent), load_as<Vec>(s.arm_parent[0]));
  }
  MW_INLINE TwistOf<S> change_at(int edge) const {
    return relative(edge, [&](int body) { return paths_.change_of(body); });
  }
  MW_INLINE TwistOf<S> twist_at(int edge) const {
    return relative(edge, [&](int body) {
      return load_as<TwistOf<S>>(d_.twist + body * kTwistRowsOf<S> * kLanes);
    });
  }
  MW_INLINE Float free_compliance(int edge, const WrenchOf<S>& along) const {
    Float sum(Real(0));
    for_each_side_of(edge, along, [&](int body, const WrenchOf<S>& p) {
      const Float mass = Float(Real(1)) / Float(constants_of_body(g_, body).inv_mass);
      const auto moments = load_as<MomentsOf<S>>(d_.rotary + body * S::kInertia * kLanes);
      sum = sum + dot(solve(rigid_body(mass, moments), p), p);
    });
    return sum;
  }

  // (L D L') x = target + floor x: each takes the error by the floor down by the floor again.
  MW_INLINE void solve_once(const JointLoops& loop) const {
    const Real *l = d_.loop_factors + loop.factor * kLanes, *b = target(loop.row);
    const Real* floor = d_.loop_floor + loop.row * kLanes;
    Real* x = impulse(loop.row);
    const auto at = [](const Real* of, int r) { return Float::load(of + r * kLanes); };
    for (int r = 0; r < loop.rows; ++r) {
      Float sum = fma(at(floor, r), at(x, r), at(b, r));
      for (int c = 0; c < r; ++c) sum = fnma(Float::load(entry(l, r, c)), at(x, c), sum);
      sum.store(x + r * kLanes);
    }
    for (int r = loop.rows - 1; r >= 0; --r) {
      Float sum = at(x, r) * Float::load(entry(l, r, r));
      for (int c = r + 1; c < loop.rows; ++c) {
        sum = fnma(Float::load(entry(l, c, r)), at(x, c), sum);
      }
      sum.store(x + r * kLanes);
    }
  }

  // A row of L D L', by those before it. The diagonal holds 1 / D.
  static MW_INLINE void eliminate(Real* a, int row, Float floor) {
    Float pivot = Float::load(entry(a, row, row)) + floor;
    for (int c = 0; c < row; ++c) {
      // a = l d; those of the columns before are done.
      Float x = Float::load(entry(a, row, c));
      for (int k = 0; k < c; ++k) {
        x = fnma(Float::load(entry(a, row, k)), Float::load(entry(a, c, k)), x);
      }
      x.store(entry(a, row, c));
    }
    for (int c = 0; c < row; ++c) {
      const Float x = Float::load(entry(a, row, c));
      const Float l = x * Float::load(entry(a, c, c));
      pivot = fnma(x, l, pivot);
      l.store(entry(a, row, c));
    }
    inverse_or_zero(max(pivot, floor)).store(entry(a, row, row));
  }

  const Constants& t_;
  const Group& g_;
  Work& w_;
  DirectWork& d_;
  const TreePaths<S, false> paths_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
