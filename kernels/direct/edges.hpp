// Rows of the edges of trees, where the substep has taken the bodies: arms, axes and what the
// joints are apart by, all of it from the rows of their parts (kernels/joint/).
#pragma once

#include "kernels/direct/spaces.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using kernels::TreeEdge;

// Lanes in which a limit acts, and in which a drive is at its largest impulse, of a coordinate.
struct ActiveSet {
  std::uint32_t low, high, above, below;
  bool operator==(const ActiveSet&) const = default;
};

// Lanes of its limits and of its drive.
struct BoundLanes {
  std::uint32_t limit, drive;
  BoundLanes operator&(BoundLanes o) const { return {limit & o.limit, drive & o.drive}; }
  BoundLanes operator|(BoundLanes o) const { return {limit | o.limit, drive | o.drive}; }
  BoundLanes operator~() const { return {~limit, ~drive}; }
};

// A coordinate along which a joint gives way: q of the child against the parent.
template <class S>
struct alignas(64) EdgeDof {
  // Along the axis, but for what drives and limits push by: first with the parent at rest.
  Real load[kLanes], push[kLanes];
  Real began[kLanes], change[kLanes];  // rate before the solve, and what it changes by
  ActiveSet active, before;            // of the solve, and when it began
  BoundLanes corrected, settled;       // of the solve: see TreeSolve::correct_active_sets
  ActiveSet factored;                  // that the factors of the solves were found with
};

// A ball joint has its cone in the places of a slide, and its twist in those of a turn.
template <class S>
struct alignas(64) EdgeRows {
  Real arm_parent[S::kDim][kLanes], arm_child[S::kDim][kLanes];  // to the point that both share
  Real slide_axis[S::kDim][kLanes], turn_axis[S::kAng][kLanes];
  Real target[kTwistRowsOf<S>]
             [kLanes];  // twist of the child against the parent there that closes the joint
  Real change[kTwistRowsOf<S>][kLanes];  // what its twist is to change by, but for the coordinates
  EdgeDof<S> slide, turn;
  Real moment[S::kAng][kLanes];  // on what rotates freely
  std::uint32_t lanes;           // in which the joint holds
};

template <class S>
struct alignas(64) DofFactors {
  Real response[kTwistRowsOf<S>][kLanes];  // wrench that a unit rate asks for
  Real pivot[kLanes];                      // axis . response
  Real inverse[kLanes];                    // 1 / (pivot + what drives and limits add)
};
// Of a ball joint, whose rotation is eliminated at once: inverse of the moments of inertia, and
// what couples them with the linear velocity.
template <class S>
struct alignas(64) BallFactors {
  Real compliance[S::kInertia][kLanes], mixed[3][3][kLanes];
};

template <>
struct BallFactors<Planar> {};  // a hinge there

// How the edges of trees give way, and what hangs on them: of the solves, or of what meets trees
// between them (solve.hpp).
template <class S>
struct EdgeFactors {
  DofFactors<S> slide, turn;
  BallFactors<S> ball;
};
template <class S>
struct TreeFactors {
  EdgeFactors<S>* edge;
  Real* inertia;  // [body][articulated inertia][lane]
};
template <class S>
MW_INLINE TreeFactors<S> factors_in(const TreeFactorRows& rows) {
  return {reinterpret_cast<EdgeFactors<S>*>(rows.edges), rows.inertia};
}

template <class S>
MW_INLINE EdgeRows<S>& edge_rows(const Work& w, int edge) {
  return reinterpret_cast<EdgeRows<S>*>(w.direct.edges)[edge];
}
template <class S, class Rows>
MW_INLINE Rows& part_rows(const Work& w, int part) {
  return *reinterpret_cast<Rows*>(w.parts + static_cast<std::size_t>(part) * kPartBytes<S>);
}

// Moments of inertia of the bodies of trees where the substeps have rotated them.
template <class S>
MW_INLINE void find_moments(const Constants& t, const Group& g, const Work& w) {
  for_each_tree_body(t, [&](int b) {
    const auto& inertia = constants_of_body(g, b).inertia;
    Real* to = w.direct.rotary + b * S::kInertia * kLanes;
    if constexpr (S::kDim == 2) {
      Float(inertia[2]).store(to);
    } else {
      const auto axes = load_as<Mat3>(principal_axes(w, b));
      store(to, rotate_diagonal(axes, AxisOrder(t.body[b].middle).of(inertia)));
    }
  });
}

// Twist of B against A that closes what the parts are apart by, in a substep. Axes too.
template <class S, bool kDense>
class EdgeFinder {
 public:
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  EdgeFinder(const Constants& t, const Group& g, Work& w) : t_(t), g_(g), w_(w) {}

  // Rows of the parts, and of those attached, where the substeps have taken the bodies.
  void refresh_parts() const {
    if constexpr (S::kDim == 3) find_moments<S>(t_, g_, w_);
    for_each_part<S>(t_, w_, [&](auto& s, const JointPart& part, int i) {
      if (part.direct || part.attached)
        refresh<S, kDense, true>(w_, part, constants_of_part(g_, i), s);
    });
  }
  // kCloses: with the bias that closes the joints, else they keep what they have.
  template <bool kCloses>
  void find() const {
    for (int i = 0; i < t_.joint_trees.edges + t_.joint_trees.closures; ++i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      EdgeRows<S>& s = edge_rows<S>(w_, i);
      TwistOf<S> target{zero_of<Ang>(), zero_of<Vec>()};
      edge.slides ? hold_line<kCloses>(edge, s, target.v) : hold_point<kCloses>(edge, s, target.v);
      if (edge.turn >= 0) {
        if (edge.locked) {
          if constexpr (kCloses) target.w = close_lock(edge);
        } else if constexpr (S::kDim == 3) {
          hold_swing<kCloses>(edge, s, target.w);
        }
      }
      if constexpr (S::kDim == 2) Float(Real(1)).store(s.turn_axis[0]);
      if constexpr (S::kDim == 3) {
        if (edge.ball) put_limits(edge, s);
      }
      if constexpr (kCloses) {
        if (edge.reversed) target = {-target.w, -target.v};
        store(s.target[0], target);
      }
    }
  }

 private:
  const Joint& numbers(int part) const { return constants_of_part(g_, part); }

  template <class Rows>
  static MW_INLINE void put_arms(const TreeEdge& edge, const Rows& from, EdgeRows<S>& s) {
    const auto a = load_as<Vec>(from.arm_a[0]), b = load_as<Vec>(from.arm_b[0]);
    store(s.arm_parent[0], edge.reversed ? b : a), store(s.arm_child[0], edge.reversed ? a : b);
    s.lanes = from.mask;
  }
  template <bool kCloses>
  MW_INLINE void hold_point(const TreeEdge& edge, EdgeRows<S>& s, Vec& target) const {
    const auto& from = part_rows<S, PointRows<S>>(w_, edge.hold);
    put_arms(edge, from, s);
    const Joint& c = numbers(edge.hold);
    if constexpr (kCloses) {
      target = -pull_of(load_as<Vec>(from.gap[0]), c.soft.bias_rate, c.pull, c.slack);
    }
  }
  template <bool kCloses>
  MW_INLINE void hold_line(const TreeEdge& edge, EdgeRows<S>& s, Vec& target) const {
    const auto& from = part_rows<S, LineRows<S>>(w_, edge.hold);
    put_arms(edge, from, s);
    const Joint& c = numbers(edge.hold);
    const auto d = load_as<Vec>(from.direction[0][0]);
    if constexpr (S::kDim == 2) {
      store(s.slide_axis[0], Vec{d.y, -d.x});
      if constexpr (kCloses) {
        target = d * -pull_of(Float::load(from.error[0]), c.soft.bias_rate, c.pull, c.slack);
      }
    } else {
      const auto e = load_as<Vec>(from.direction[1][0]);
      store(s.slide_axis[0], cross(d, e));
      if constexpr (kCloses) {
        const Vec2 x = pull_of(load_as<Vec2>(from.error[0]), c.soft.bias_rate, c.pull, c.slack);
        target = -fma(e, x.y, d * x.x);
      }
    }
  }
  MW_INLINE Ang close_lock(const TreeEdge& edge) const {
    const auto& from = part_rows<S, LockRows<S>>(w_, edge.turn);
    const Joint& c = numbers(edge.turn);
    return -pull_of(load_as<Ang>(from.error[0]), c.soft.bias_rate, c.angular_pull);
  }
  template <bool kCloses>
  MW_INLINE void hold_swing(const TreeEdge& edge, EdgeRows<S>& s, Vec3& target) const {
    const auto& from = part_rows<S, SwingRows<S>>(w_, edge.turn);
    const auto b = load_as<Vec3>(from.across[0][0]), c = load_as<Vec3>(from.across[1][0]);
    store(s.turn_axis[0], cross(b, c));
    if constexpr (kCloses) {
      const Joint& k = numbers(edge.turn);
      const Vec2 x = pull_of(load_as<Vec2>(from.error[0]), k.soft.bias_rate, k.angular_pull);
      target = -fma(c, x.y, b * x.x);
    }
  }

  MW_INLINE void put_limits(const TreeEdge& edge, EdgeRows<S>& s) const {
    const auto put = [&](int part, Real* axis) {
      if (part < 0) return;
      store(axis, load_as<Vec>(part_rows<S, Row<S>>(w_, part).angular_b[0]));
    };
    put(edge.cone, s.slide_axis[0]), put(edge.angle, s.turn_axis[0]);
  }

  const Constants& t_;
  const Group& g_;
  Work& w_;
};

// Axes of the coordinates.
template <class S>
MW_INLINE auto axis_of_slide(const EdgeRows<S>& s) {
  return TwistOf<S>{zero_of<typename S::Ang>(), load_as<typename S::Vec>(s.slide_axis[0])};
}
template <class S>
MW_INLINE auto axis_of_turn(const EdgeRows<S>& s) {
  return TwistOf<S>{load_as<typename S::Ang>(s.turn_axis[0]), zero_of<typename S::Vec>()};
}
// Whether a ball joint has limits.
MW_INLINE bool limited(const TreeEdge& edge) { return edge.cone >= 0 || edge.angle >= 0; }
// Whether a joint gives way about z alone.
MW_INLINE bool hinges(const TreeEdge& edge) { return !edge.ball && !edge.locked; }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
