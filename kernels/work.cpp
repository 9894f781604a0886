// Lays out a thread's scratch: measures it, then carves it out of one block.
#include "kernels/work/work.hpp"
#include <initializer_list>

#include "kernels/lane/planar_inertia.hpp"
#include "kernels/lane/spatial.hpp"
#include "kernels/motion/substep_rotation.hpp"
#include "kernels/rows/block_impulses.hpp"
#include "kernels/rows/resistance.hpp"
#include "kernels/work/solver_tables.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

// Hands out 64-byte aligned pieces; with a null base it only counts.
class Carver {
 public:
  explicit Carver(unsigned char* base) : base_(base) {}
  template <class T>
  void take(T*& out, std::size_t count) {
    out = base_ ? reinterpret_cast<T*>(base_ + used_) : nullptr;
    used_ += (count * sizeof(T) + 63) / 64 * 64;
  }
  std::size_t used() const { return used_; }

 private:
  unsigned char* base_;
  std::size_t used_ = 0;
};

template <class S, class A>
void size_blocks(Work& w, ListId several, ListId one) {
  BlockList &many = w.blocks[static_cast<int>(several)], &single = w.blocks[static_cast<int>(one)];
  many.stride = sizeof(SidedBlock<S, S::kMulti, A>), single.stride = sizeof(SidedBlock<S, 1, A>);
  many.bounce_stride = sizeof(Bounce<S, S::kMulti>), single.bounce_stride = sizeof(Bounce<S, 1>);
}
template <class S>
void size_blocks(Work& w) {
  size_blocks<S, Free>(w, ListId::pair_multi, ListId::pair_single);
  size_blocks<S, Fixed>(w, ListId::fixed_multi, ListId::fixed_single);
}

std::size_t resistance_bytes(const Constants& t) {
  switch (t.inertia_kind) {
    case kernels::InertiaKind::planar: return sizeof(Resistance<Planar>);
    case kernels::InertiaKind::isotropic: return sizeof(Resistance<Isotropic>);
    default: return sizeof(Resistance<Tensor>);
  }
}
// They are the same with a tensor of inertia.
std::size_t impulses_bytes(const Constants& t, int list) {
  const bool one = list == static_cast<int>(ListId::pair_single) ||
                   list == static_cast<int>(ListId::fixed_single);
  if (t.inertia_kind == kernels::InertiaKind::planar) {
    return one ? sizeof(BlockImpulses<Planar, 1>) : sizeof(BlockImpulses<Planar, Planar::kMulti>);
  }
  return one ? sizeof(BlockImpulses<Tensor, 1>) : sizeof(BlockImpulses<Tensor, Tensor::kMulti>);
}

// Blocks of a list: classes follow one another, and each has no more candidates in a lane than
// candidate_limit allows. One more, since a block is written before it is known to have a point.
int blocks_needed(const Constants& t, int list) {
  int blocks = 1;
  for (int c = 0; c < t.classes; ++c) {
    if (static_cast<int>(t.pair_class[c].list) != list) continue;
    blocks += max_candidates(t, t.pair_class[c]);
  }
  return blocks;
}

// Room for hits, and for the candidates of the longest class.
struct HitRoom {
  int hits = 1, longest = 1;
};
HitRoom room_of_tables(const Constants& t) {
  HitRoom room;
  for (int i = 0; i < t.classes; ++i) {
    const int end = t.pair_class[i].first_key + t.pair_class[i].count;
    room.hits = end > room.hits ? end : room.hits;
    room.longest = t.pair_class[i].count > room.longest ? t.pair_class[i].count : room.longest;
  }
  return room;
}
// Hits of a class are those of all lanes. Listed are either those of one lane, or dense ones, if
// they fit the blocks.
HitRoom room_of_sparse(const Constants& t) {
  HitRoom room;
  for (int i = 0; i < t.classes; ++i) room.hits += kLanes * max_candidates(t, t.pair_class[i]);
  for (int l = 0; l < kLists; ++l) {
    const int blocks = blocks_needed(t, l);
    room.longest = blocks > room.longest ? blocks : room.longest;
  }
  return room;
}

void carve_sparse(const Constants& t, SparseWork& s, Carver& c, int hits) {
  const int dim = t.dimension == kernels::Dimension::spatial ? 3 : 2;
  s.shapes = t.colliders + t.fixed_shapes;
  s.lane_room = 0;
  for (int i = 0; i < t.classes; ++i) s.lane_room += max_candidates(t, t.pair_class[i]);
  s.room = 2 * s.lane_room + 1024;
  const auto count = [](int n) { return static_cast<std::size_t>(n); };
  c.take(s.hit_start, count(t.classes));
  c.take(s.hit_code, count(hits));
  c.take(s.name, count(s.shapes));
  c.take(s.bounds, count(s.shapes * 2 * dim));
  c.take(s.sorted, count(s.shapes * 2 * dim * kCopies));
  c.take(s.shape, count(s.shapes * kCopies));
  c.take(s.first_strip, count(s.shapes * kCopies));
  c.take(s.order, count(s.shapes));
  c.take(s.order_spare, count(s.shapes));
  c.take(s.found, count(s.room));
  c.take(s.found_spare, count(s.room));
  c.take(s.pairs, count(s.lane_room * kLanes));
}

template <class S>
int impulses_of_list(bool several) {
  return several ? S::kMulti + S::kTangents + (S::kDim == 3 ? 1 : 0) : 1 + S::kTangents;
}
void carve_search(const Constants& t, Search& s, Carver& c) {
  const bool planar = t.dimension == kernels::Dimension::planar;
  int impulses = t.parts * kernels::kPartImpulses;
  for (int l = 0; t.has_contacts && l < kLists; ++l) {
    const bool several = is_multi(static_cast<ListId>(l));
    const int rows = planar ? impulses_of_list<Planar>(several) : impulses_of_list<Tensor>(several);
    impulses += blocks_needed(t, l) * rows;
  }
  c.take(s.before, static_cast<std::size_t>(impulses * kLanes));
  c.take(s.way, static_cast<std::size_t>(impulses * kLanes));
  c.take(s.square, static_cast<std::size_t>(kLanes));
}

void carve_tree(const Constants& t, TreeWork& w, Carver& c) {
  const auto& tree = t.tree;
  const auto take = [&](Real*& out, int rows) {
    c.take(out, static_cast<std::size_t>(rows * kLanes));
  };
  take(w.origin, 3 * tree.links), take(w.pose, 7 * tree.links);
  take(w.offset, 3 * tree.links);
  take(w.axis, kTwistRows * tree.dofs);
  take(w.velocity, kTwistRows * tree.links), take(w.rate, kTwistRows * tree.links);
  take(w.force, kTwistRows * tree.links), take(w.inertia, kInertiaRows * tree.links);
  take(w.load, tree.dofs), take(w.diagonal, tree.dofs);
  take(w.next, tree.coordinates + tree.dofs);
  if (tree.implicit) take(w.free, tree.dofs);
  const auto links = static_cast<std::size_t>(tree.links);
  const auto dofs = static_cast<std::size_t>(tree.dofs);
  c.take(w.stale, links), c.take(w.is_held, links);
  if (tree.by_links) {
    take(w.beyond, kArticulatedRows * tree.links);
    take(w.response, kTwistRows * tree.dofs), take(w.inverse, tree.dofs);
  } else {
    take(w.matrix, tree.entries);
  }
  if (tree.stages > 1) {
    take(w.start, tree.coordinates + tree.dofs), take(w.displacement, tree.dofs);
    take(w.stage_rate, 2 * tree.dofs), take(w.rate_sum, 2 * tree.dofs);
  }
  if (!tree.has_rows) return;
  c.take(w.limit_rows, static_cast<std::size_t>(tree.limits));
  c.take(w.ball_rows, static_cast<std::size_t>(tree.ball_limits));
  int contacts = 0;
  for (int i = 0; t.has_contacts && i < t.classes; ++i) {
    contacts += t.pair_class[i].count * (is_multi(t.pair_class[i].list) ? Isotropic::kMulti : 1);
  }
  c.take(w.contacts, static_cast<std::size_t>(contacts));
  take(w.guess, tree.dofs), take(w.row_load, tree.dofs);
  take(w.direction, tree.dofs), take(w.descent, tree.dofs);
  if (tree.by_links) {
    take(w.held, kArticulatedRows * tree.links);
    take(w.inertial, kTwistRows * tree.links), take(w.inertial_along, kTwistRows * tree.links);
    if (tree.couplings == 0) return;
    take(w.pending, kTwistRows * tree.dofs), take(w.scaled, tree.dofs);
    take(w.spread, tree.couplings * tree.dofs), take(w.multiplier, tree.couplings);
    take(w.schur, tree.couplings * (tree.couplings + 1) / 2);
    c.take(w.reached, static_cast<std::size_t>(tree.couplings));
  } else {
    take(w.column, 3 * tree.dofs);
    take(w.stiffness, tree.dofs * (tree.dofs + 1) / 2);
    c.take(w.coupled, dofs), c.take(w.listed, dofs), c.take(w.counts, dofs);
    c.take(w.entries, dofs * dofs / 2);
    take(w.balance, tree.dofs), take(w.reach, tree.dofs);
  }
}

void carve_joint_trees(const Constants& t, DirectWork& w, Carver& c) {
  const bool planar = t.dimension == kernels::Dimension::planar;
  const auto take = [&](Real*& to, int rows) {
    c.take(to, static_cast<std::size_t>(t.bodies * rows * kLanes));
  };
  const int rotary = planar ? 1 : 6, twist = planar ? kPlanarTwistRows : kTwistRows;
  take(w.rotary, rotary), take(w.stiffened, rotary), take(w.stiffness, 2),
      take(w.turning, planar ? 2 : 4);
  const int articulated = planar ? kPlanarInertiaRows : kArticulatedRows;
  const EdgeSizes bytes = planar ? edge_sizes(Planar{}) : edge_sizes(Tensor{});
  const auto edges = static_cast<std::size_t>(t.joint_trees.edges);
  const auto take_factors = [&](TreeFactorRows& to) {
    c.take(to.edges, edges * bytes.factors), take(to.inertia, articulated);
  };
  take_factors(w.of_solves);
  take(w.own_load, twist), take(w.load, twist), take(w.twist, twist);
  const auto closures = static_cast<std::size_t>(t.joint_trees.closures);
  c.take(w.edges, (edges + closures) * bytes.rows);
  c.take(w.held, static_cast<std::size_t>(t.bodies));
  const auto lanes = static_cast<std::size_t>(kLanes);
  c.take(w.loop_factors, static_cast<std::size_t>(t.joint_trees.loop_factors) * lanes);
  const auto loop_rows = static_cast<std::size_t>(t.joint_trees.loop_rows) * lanes;
  c.take(w.loop_floor, loop_rows), c.take(w.loop_target, loop_rows);
  c.take(w.loop_impulse, loop_rows);
  const bool loaded = t.has_contacts || t.joint_trees.attached > 0;
  if (closures == 0 && !loaded) return;
  take(w.pending, twist);
  c.take(w.pending_edges, edges * bytes.pending);
  c.take(w.path, edges);
  if (!loaded) return;
  take_factors(w.of_contacts);
  take(w.compliance, articulated);
  c.take(w.touched, static_cast<std::size_t>(t.bodies) + 1);
  if (t.has_contacts) take(w.inv_tree_mass, 1);
}

void carve(const Constants& t, Work& w, Carver& c) {
  const int lanes = kLanes;
  const auto count = [](int n) { return static_cast<std::size_t>(n); };
  const int dim = t.dimension == kernels::Dimension::spatial ? 3 : 2;
  const int row = kernels::velocity_row_size(t.dimension);
  // A lane's rows fill whole registers, so that they can be swept without regard to bodies.
  int rows = t.bodies + (t.has_joints ? 2 : 1);
  while (rows * row % kLanes != 0) ++rows;
  w.rows_per_lane = rows;
  const std::size_t velocities = count(rows * row * lanes);
  const int body_row = body_row_size(t.inertia_kind);
  c.take(w.body_rows, count((t.bodies + 1) * body_row * lanes));
  c.take(w.delta_v_storage, velocities);
  if (t.drag_varies) c.take(w.factor_storage, velocities);
  const std::size_t state = count(t.bodies * t.state_stride * lanes);
  if (t.flight.on) {
    c.take(w.flight.now, state), c.take(w.flight.base, state);
    c.take(w.flight.rate, state), c.take(w.flight.sum, state);
  }
  if (t.audit_every > 0) {
    c.take(w.audit.sums, count(kAuditSums * lanes));
    if (t.has_drives) c.take(w.audit.speed, count(t.parts * 3 * lanes));
  }
  if (t.tree.links > 0) carve_tree(t, w.tree, c);
  if (!t.has_substeps) {
    c.take(w.before, state);
    return;
  }
  c.take(w.velocity, velocities);
  c.take(w.warmed, velocities);
  c.take(w.impulse_part, velocities);
  c.take(w.displacement, velocities);
  c.take(w.touched, count(t.bodies + 1));
  if (t.has_contacts) {
    c.take(w.met, count((t.bodies + 1) * lanes));
    if (t.impact_sweeps > 0) {
      c.take(w.velocity_before, velocities);
      c.take(w.stirred, count(t.bodies * 2));
    }
  }
  if (t.has_joints) {
    const std::size_t bytes =
        t.dimension == kernels::Dimension::planar ? part_bytes(Planar{}) : part_bytes(Tensor{});
    c.take(w.parts, count(t.parts) * bytes);
    const int rotation =
        t.dimension == kernels::Dimension::planar ? kRotationRows<Planar> : kRotationRows<Tensor>;
    c.take(w.rotation, count((t.bodies + 2) * rotation * lanes));
    c.take(w.swept, count(t.bodies + 2));
    c.take(w.loads, count(t.breakable * row * lanes));
    if (t.breakable > 0) c.take(w.reached, count(t.bodies));
  }
  if (t.joint_trees.edges > 0) carve_joint_trees(t, w.direct, c);
  if (t.solver.kind == kernels::Solver::nncg) carve_search(t, w.search, c);
  if (t.has_sleep || t.has_restitution) c.take(w.parent, count(t.bodies));
  if (t.has_sleep) {
    c.take(w.ready, count(t.bodies));
    c.take(w.restless, count(t.bodies));
  }
  if (!t.has_contacts) return;
  if (t.cast_moving) c.take(w.swift, count(t.colliders));
  c.take(w.pose_rows, count(t.row_block * lanes));
  c.take(w.bounds, count(t.colliders * 2 * dim * lanes));
  c.take(w.beyond, count(t.colliders * lanes));
  if (can_drop_distant(t)) {
    c.take(w.travel, count(t.colliders * lanes));
    c.take(w.facing, count(t.colliders * 2 * lanes));
  }
  const auto [hits, longest] = t.sparse ? room_of_sparse(t) : room_of_tables(t);
  c.take(w.hits, count(hits));
  c.take(w.hit_masks, count(hits));
  c.take(w.hit_count, count(t.classes));
  if (t.sparse) carve_sparse(t, w.sparse, c, hits);
  if (t.sweep) {
    c.take(w.marks, count(hits));
    c.take(w.sorted, count(t.colliders * 3 * lanes));
  }
  if (t.has_sleep) {
    for (int l = 0; l < kLists; ++l) {
      const int cached = kernels::cache_row_size(t, static_cast<ListId>(l));
      c.take(w.kept_keys[l], count(lanes * t.capacity[l]));
      c.take(w.kept_rows[l], count(lanes * t.capacity[l] * cached));
    }
  }
  // Lanes are packed a register at a time (list_candidates), and end anywhere in the last one.
  w.candidate_room = (longest / lanes + 2) * lanes;
  for (CandidateList* list : {&w.candidates, &w.found}) {
    c.take(list->code, count(w.candidate_room * lanes));
    c.take(list->key, count(w.candidate_room * lanes));
    c.take(list->axis, count(w.candidate_room * lanes));
    c.take(list->mask, count(w.candidate_room));
  }
  c.take(w.keep, count(longest));
  if (t.inertia_kind == kernels::InertiaKind::planar) {
    size_blocks<Planar>(w);
  } else if (t.inertia_kind == kernels::InertiaKind::isotropic) {
    size_blocks<Isotropic>(w);
  } else {
    size_blocks<Tensor>(w);
  }
  for (int l = 0; l < kLists; ++l) {
    BlockList& list = w.blocks[l];
    list.max_blocks = blocks_needed(t, l);
    c.take(list.blocks, count(list.max_blocks) * list.stride);
    list.bounces = nullptr;
    if (t.has_restitution) c.take(list.bounces, count(list.max_blocks) * list.bounce_stride);
    list.resistances = nullptr;
    if (t.has_resistance) c.take(list.resistances, count(list.max_blocks) * resistance_bytes(t));
    list.impulses_before = nullptr;
    if (t.impact_sweeps > 0) {
      c.take(list.impulses_before, count(list.max_blocks) * impulses_bytes(t, l));
    }
  }
}

// What never changes: lane bases, the dummy's pose, inverse masses that do not rotate.
void fill_constants(const Constants& t, Work& w) {
  const int state = t.flight.on ? t.bodies * t.state_stride * kLanes : 0;
  for (int i = 0; i < state; ++i) w.flight.rate[i] = Real(0);  // not all rows of it are used
  const int row = kernels::velocity_row_size(t.dimension);
  const int body_row = body_row_size(t.inertia_kind);
  for (int l = 0; l < kLanes; ++l) {
    w.velocity_base[l] = l * w.rows_per_lane * row;
    w.pose_base[l] = l * t.row_block;
    w.body_base[l] = l * (t.bodies + 1) * body_row;
  }
  for (int l = 0; l < kLanes; ++l) {
    for (int b = 0; b <= t.bodies; ++b) {
      Real* r = w.body_rows + w.body_base[l] + b * body_row;
      for (int i = 0; i < body_row; ++i) r[i] = Real(0);
      if (b == t.bodies || t.inertia_kind == kernels::InertiaKind::tensor) continue;
      const auto* constants =
          reinterpret_cast<const kernels::BodyConstants<LaneNumber>*>(t.constants.body);
      r[0] = constants[b].inv_mass.lane[l];
      r[1] = constants[b].inv_inertia[2].lane[l];
    }
  }
  if (!t.has_contacts) return;
  int start = 0;
  for (int i = 0; t.sparse && i < t.classes; ++i) {
    w.sparse.hit_start[i] = start;
    start += kLanes * max_candidates(t, t.pair_class[i]);
  }
  for (int l = 0; l < kLanes; ++l) {
    Real* dummy = w.pose_rows + w.pose_base[l] + t.row_block - kernels::kDummyRow;
    for (int i = 0; i < kernels::kDummyRow; ++i) dummy[i] = Real(0);
    dummy[0] = dummy[5] = dummy[10] = Real(1);  // as a box: unit axes
    dummy[12] = dummy[13] = dummy[14] = Real(0.5);
  }
}

}  // namespace

std::size_t scratch_bytes(const Constants& tables) {
  Work measured{};
  Carver carver(nullptr);
  Work* self = nullptr;
  carver.take(self, 1);
  carve(tables, measured, carver);
  return carver.used();
}

kernels::Scratch* make_scratch(const Constants& tables, void* memory) {
  Carver carver(static_cast<unsigned char*>(memory));
  Work* self = nullptr;
  carver.take(self, 1);
  *self = Work{};
  carve(tables, *self, carver);
  fill_constants(tables, *self);
  return reinterpret_cast<kernels::Scratch*>(self);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
