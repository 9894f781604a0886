// Work: the per-thread scratch of one plan, reused from group to group. Laid out once by
// make_scratch (work.cpp); stages only follow the pointers.
#pragma once

#include "kernels/data/table.hpp"
#include "kernels/lane/space.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using Constants = kernels::SceneConstants<Real>;
using Group = kernels::GroupView<Real>;
using kernels::kLists;
using kernels::ListId;

// Candidates of one class, one per lane and block. An inactive lane holds the code of the dummy.
struct CandidateList {
  int count;
  std::int32_t* code;   // [block][lane]: a | b << 16
  std::int32_t* key;    // [block][lane]
  std::uint32_t* mask;  // [block]: active lanes
  Real* axis;           // [block][lane]: separating axis found so far (boxes)
};

struct BlockList {
  int count;
  int max_blocks;
  std::size_t stride;         // bytes of a block
  std::size_t bounce_stride;  // bytes of a block's restitution rows
  unsigned char* blocks;
  unsigned char* bounces;
  unsigned char* resistances;      // [block] Resistance
  unsigned char* impulses_before;  // [block] BlockImpulses, when sweeps after an impact began
};

// Takes down contact points while the collide stages run: of one lane (Kernels::record), or the
// places of those of all lanes for the observers (kernels/observe/).
struct Recorder {
  kernels::ContactPoint<Real>* out;
  int max, lane, count;
  Real* const* places;  // [list], or nullptr
};

// Sparse plans: where pairs are looked for, one lane after the other
// (kernels/broad/sparse_pairs.cpp). The shapes are the colliders, then the fixed shapes. Those that
// are there are cut into strips; on the average a shape lies in no more than kCopies of them.
inline constexpr int kMaxStrips = 256, kCopies = 3;
struct SparseWork {
  std::int32_t* hit_start;             // [class], of its hits
  std::int32_t* hit_code;              // [hit]
  std::int32_t* name;                  // [shape that is there]
  float* bounds;                       // [axis][low, high][shape that is there]
  std::uint64_t *order, *order_spare;  // [shape that is there]: lower bound, which
  float* sorted;                       // [axis][low, high][place], strip by strip
  std::int32_t *shape, *first_strip;   // [place]
  std::int32_t strip_start[kMaxStrips + 2];
  std::uint64_t *found, *found_spare;  // [room]: key, code
  std::uint64_t* pairs;                // [lane][lane_room]: key, code; ascending
  std::int32_t shapes, room, lane_room;
  std::int32_t count[kLanes];  // of pairs
};

// Blocks of an integrator, laid out as the state is (kernels/flight/).
struct FlightWork {
  Real* now;   // where the group has come
  Real* base;  // where it was
  Real* rate;  // of change
  Real* sum;   // of rates
};

// Of conjugate gradients (kernels/solver/impulses.cpp): for each impulse of each row, in the order
// of the solver, what it was and the way that it goes.
struct Search {
  Real* before;
  Real* way;
  Real* square;  // [lane], of the last step
};

// A one-sided row of the newton solver (kernels/tree/row_force.hpp).
struct alignas(64) TreeRow {
  Real weight[kLanes], reference[kLanes];  // D = 1 / R, 0 where there is none; acceleration
  Real residual[kLanes], change[kLanes];   // J a - reference, and along the search
  std::uint32_t lanes;                     // that have it
};

// The same of a ball joint's limit, and the axis of its rotation in the link's axes.
struct alignas(64) TreeBallRow {
  Real axis[3][kLanes];
  TreeRow row;
};

// A contact point between two links, or a link and the world (kernels/tree/contacts.hpp).
struct alignas(64) TreeContact {
  Real frame[9][kLanes];                    // normal from A to B, two tangents
  Real arm_a[3][kLanes], arm_b[3][kLanes];  // the point from the frames of A and B, m
  Real distance[kLanes], friction[kLanes];  // m; 1
  Real weight[kLanes];                      // of all of its rows, see TreeRow
  Real reference[4][kLanes], residual[4][kLanes], change[4][kLanes];
  std::int32_t pair;     // key
  std::int32_t feature;  // which point of the manifold
  std::uint32_t lanes;   // that have it
};

// An entry of a row of M + J' D J (kernels/tree/stiffness.hpp): where in the row, and where the row
// of its column begins, in reals.
struct TreeEntry {
  std::int32_t at, row;
};

// Trees (kernels/tree/), in world axes. Places are from an origin of each tree, its root's centre
// of mass; twists, wrenches and inertias of a link are about the origin of its own frame, so that
// light links far from the root lose no digits.
struct TreeWork {
  Real* origin;    // [link: a root][3][lane], in the world
  Real* pose;      // [link][rotation 4, position of its frame 3][lane]
  Real* offset;    // [link][3][lane], of its frame from that of its parent
  Real* axis;      // [dof][twist of a unit velocity][lane]
  Real* velocity;  // [link][twist][lane]
  Real* rate;      // [link][twist][lane], acceleration but for those of the dofs; then scratch of
                   // Newton's method: twists by its accelerations, or along its search
  Real* force;     // [link][wrench][lane]
  Real* inertia;   // [link][kInertiaRows][lane]; in joint space with all links beyond it
  Real* diagonal;  // [dof][lane], what is added to armatures: stiffness of limits, dampers
  Real* load;      // [dof][lane], generalised forces, then accelerations
  Real* free;      // [dof][lane], accelerations of links that move freely; only with implicit_fast
  Real* next;      // [coordinate, then dof][lane], the state after the step
  // Runge-Kutta.
  Real* start;         // [coordinate, then dof][lane], the state before the step
  Real* displacement;  // [dof][lane], of the stage from the start
  Real* stage_rate;    // [dof][lane] of coordinates, then of velocities
  Real* rate_sum;      // as those
  // By links (articulated.hpp). Rows mark their links as stale in either space.
  Real* held;             // [link][articulated inertia][lane], of its contacts with the world
  Real* beyond;           // [link][articulated inertia][lane], as its parent feels it
  Real* response;         // [dof][wrench][lane], to its unit acceleration
  Real* inverse;          // [dof][lane], 1 / D
  bool *is_held, *stale;  // [link] it has such contacts; its numbers are to be found anew
  Real* inertial;         // [link][wrench][lane], its inertia times its acceleration
  Real* inertial_along;   // [link][wrench][lane], times that along the search
  // Of rows that couple branches (couplings.hpp).
  Real* pending;           // [dof][wrench][lane]
  Real* spread;            // [row][dof][lane]
  Real* scaled;            // [dof][lane], the last row of them times 1 / D
  Real* schur;             // [row][rows up to it][lane]
  Real* multiplier;        // [row][lane]
  std::uint64_t* reached;  // [row] dofs
  // In joint space.
  Real* matrix;  // [entry][lane], of the joint-space inertia, then its factors
  // The newton solver.
  TreeRow* limit_rows;     // [limit]
  TreeBallRow* ball_rows;  // [ball limit]
  TreeContact* contacts;   // [contact]
  std::int32_t contact_count;
  Real* column;     // [dof of a pair][3][lane], of its motion at a contact
  Real* stiffness;  // [dof][dofs up to it][lane], M + J' D J, then its factors (stiffness.hpp)
  // Of its rows: which entries rows of constraints ask for, then those that there are; what was
  // asked for when they were listed; the list, the last dof first, and its length.
  std::uint64_t *coupled, *listed;  // [dof]
  TreeEntry* entries;               // [dof][dofs before it]
  std::int32_t* counts;             // [dof]
  Real* guess;                      // [dof][lane], accelerations so far
  Real* balance;                    // [dof][lane], M a
  Real* direction;                  // [dof][lane]
  Real* descent;                    // [dof][lane], the opposite of the gradient
  Real* reach;                      // [dof][lane], M times the direction
  Real* row_load;                   // [dof][lane], J' times the forces of rows
};

// Factors of trees of joints (kernels/direct/edges.hpp), and what they were found with, active sets
// aside.
struct TreeFactorRows {
  unsigned char* edges;  // [edge]
  Real* inertia;         // [body][articulated inertia][lane]
};
struct FactorState {
  int place;       // the substep that begins where the bodies were; -1: none
  bool stiffened;  // with the geometric stiffness
};

// Trees of joints that are solved at once (kernels/direct/); twists and wrenches about centres of
// mass.
struct DirectWork {
  Real* rotary;          // [body][moments of inertia][lane], world axes
  Real* stiffened;       // the same with the geometric stiffness
  Real* stiffness;       // [body][sum, sum times arm^2][lane], of it
  Real* turning;         // [body][mean rotation, what is left of it][lane] (turning.hpp)
  Real* own_load;        // [body][wrench][lane]
  Real* load;            // [body][wrench][lane], with what hangs on it; then what joints did
  Real* twist;           // [body][twist][lane], change of velocity
  unsigned char* edges;  // rows of edges
  std::uint32_t* held;   // [body] lanes in which a tree moves it
  int located;           // the substep that the rows are of
  TreeFactorRows of_solves;
  FactorState factored;  // of the solves
  bool is_stiff;         // whether some body has geometric stiffness in this substep
  // Of plans with loops (kernels/direct/loops.hpp).
  Real* loop_factors;                             // [entry][lane], lower triangles
  Real *loop_floor, *loop_target, *loop_impulse;  // [row][lane]
  // Of impulses on bodies of trees (kernels/direct/tree_paths.hpp), in plans with loops, contacts
  // or attached rows.
  Real* pending;                 // [body][wrench][lane], of roots
  unsigned char* pending_edges;  // the same of edges
  std::int32_t* path;            // edges from a body to its root
  // Of plans with contacts or attached rows (kernels/direct/response.hpp).
  TreeFactorRows of_contacts;
  TreeFactorRows of_round;  // those of the present round
  std::uint32_t firm;       // lanes in which limits and drives hold against them
  Real* inv_tree_mass;      // [body][lane], 1/kg, of plans with contacts
  Real* compliance;         // [body][compliance][lane]
  std::uint32_t* touched;   // [body] lanes with any on it, or on what hangs on it
  std::uint32_t pushed;     // lanes in which the pass has done anything
};

// Of a step in which energies are audited (kernels/observe/audit.hpp): the energy before it, what a
// gain is compared with, what inputs may give, what drives have given, what joints hold, J.
enum AuditSum { kEnergyBefore, kAuditScale, kGiven, kDriven, kGapEnergy, kAuditSums };
struct AuditWork {
  std::uint32_t due;  // lanes of it
  Real* sums;         // [kAuditSums][lane]
  Real* speed;        // [part][3][lane], of rows that give energy, at the end of the last substep
};

struct Work {
  AuditWork audit;
  FlightWork flight;
  TreeWork tree;
  DirectWork direct;
  Real* before;  // the group's state before the step (plans without contacts only)
  // begin
  Real* pose_rows;  // [lane][row_block], the last kDummyRow of a block are the dummy's
  Real* body_rows;  // [lane][bodies + 1][body_row], see body_row_size
  Real* bounds;     // [collider][centre dim, half extent dim][lane], margin included
  // Where drop_distant has work (work/stages.hpp), else nullptr:
  Real* travel;  // [collider][lane], how far any of its points may move in the step, m
  Real* facing;  // [collider][cos, sin][lane], its orientation for the contacts of this step
  Real* beyond;  // [collider][lane], how much farther its body may move than the margin's cap
  // broad phase
  std::int32_t* hits;        // [key] candidate index within its class, compacted per class
  std::uint32_t* hit_masks;  // [key]
  std::int32_t* hit_count;   // [class]
  std::uint32_t* marks;      // [key], sort and sweep
  Real* sorted;              // [collider][low, high, index][lane], sort and sweep
  SparseWork sparse;
  // narrow phase
  CandidateList candidates;  // of the class at work
  CandidateList found;       // box pairs: after the separating-axis test
  int candidate_room;        // blocks of either
  std::uint32_t* keep;       // [block], lanes that passed it
  BlockList blocks[kLists];
  unsigned char* parts;   // rows of joints (kernels/joint/)
  Real* rotation;         // [body + 2], of those with joints (kernels/motion/substep_rotation.hpp)
  std::uint32_t* swept;   // [body] lanes in which they rotate as bodies without joints do
  Real* loads;            // [breakable joint] impulses of the step so far
  std::int32_t* reached;  // [body] by a joint that broke
  std::int32_t lane_count[kLists][kLanes];  // manifolds of each lane so far
  std::int32_t cursor[kLists][kLanes];      // kLanes times where matching stands in the stored keys
  std::int32_t key_at_cursor[kLists][kLanes];
  // sleep
  std::uint32_t frozen;         // lanes that were frozen when the step began
  std::uint32_t untouched;      // those, and lanes in which no body is awake: their cache stays
  std::uint32_t partly_asleep;  // lanes whose cache keeps the impulses of sleeping pairs:
  std::int32_t kept[kLists][kLanes];
  std::int32_t* kept_keys[kLists];  // [lane][capacity]
  Real* kept_rows[kLists];          // [lane][capacity][cache row]
  std::uint32_t* ready;             // [body], lanes in which it has rested long enough
  std::int32_t* parent;             // [body] of islands
  std::int32_t* restless;           // [body] 1: its island has a body that is not ready
  std::uint32_t overflow;           // lanes that dropped a contact in this step
  int class_index;
  bool dense;
  int substep;
  int sweep;  // of the substep, over contacts (solver/sweep.hpp)
  Search search;
  // solver
  Real* velocity;      // dense or rows, see lane/space.hpp
  Real* warmed;        // velocity after warm start
  Real* impulse_part;  // what warm starting adds to the velocity of the next substep
  Real* displacement;
  Real* velocity_before;        // when sweeps after an impact began
  std::uint32_t* stirred;       // [2][body] lanes in which impacts have changed it
  std::uint32_t struck;         // lanes in which a contact has taken an impact in this substep
  std::uint32_t struck_before;  // all, if another pass of the substep has asked before
  bool settles;                 // sweeps follow an impact
  Real* delta_v_storage;
  Real* delta_v;  // what each lane adds to velocities in a substep; nullptr: all the same
  Real* factor_storage;
  Real* factor;                           // what drag leaves of them; nullptr: all the same
  int rows_per_lane;                      // bodies + dummy + world + padding
  alignas(64) Real strike_speed[kLanes];  // m/s, of the slowest impacts
  alignas(64) std::int32_t velocity_base[kLanes];  // offset of a lane's velocity rows
  alignas(64) std::int32_t pose_base[kLanes];
  alignas(64) std::int32_t body_base[kLanes];
  std::int32_t* swift;  // colliders that go far in this step (casts between moving shapes)
  std::int32_t swift_count;
  std::uint32_t* touched;  // [body] lanes in which a contact may act on the body in this step
  unsigned char* met;  // [body][lane] 1: in rows of the narrow phase, before they are bits there
  Recorder* recorder;  // nullptr but while contacts are recorded
  Recorder recorder_storage;
  kernels::GroupCounters counters;
};

// Place of the world among velocities, for joints that hold to it. Not the dummy's, to which idle
// lanes of contacts write.
MW_INLINE int world_body(const Constants& t) { return t.bodies + 1; }

// Inverse mass and inertia of a body, and its centre of mass (for shapes that are off it):
//   planar      1/m 1/I x y
//   isotropic   1/m 1/I 0 0 | x y z 0
//   tensor      Ixx Ixy Ixz Iyy | Iyz Izz 1/m 0 | x y z 0    (inverse, world axes)
inline constexpr int body_row_size(kernels::InertiaKind kind) {
  return kind == kernels::InertiaKind::planar      ? 4
         : kind == kernels::InertiaKind::isotropic ? 8
                                                   : 12;
}

MW_INLINE Work& work_of(kernels::Scratch* s) { return *reinterpret_cast<Work*>(s); }

std::size_t scratch_bytes(const Constants& tables);
kernels::Scratch* make_scratch(const Constants& tables, void* memory);

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
