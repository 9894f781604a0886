// ObserverView: what a batch with observers wants to know of a group after the last step of a call,
// and where it is put down. Everything lies in lanes, in memory of the thread; src/api brings it
// into the order of worlds. What was not asked for is a null pointer.
#pragma once

#include "kernels/data/program.hpp"
#include "kernels/data/table.hpp"
#include "manyworlds/observed.hpp"

namespace manyworlds::kernels {

// The rows of an item of an observer are its outputs in the order of MW_OBSERVED, each with the
// components that it has in space. In the plane the third component of a vector is left out, and a
// spin is the last of its three.
struct ObserverRows {
  int of_item[kObserverCount] = {};  // by Observer
  int first[kObservedCount] = {};    // by Observed, among those of the item
};
consteval ObserverRows make_observer_rows() {
  ObserverRows out;
  for (int i = 0; i < kObservedCount; ++i) {
    const ObservedComponents components = kObservedInfo[i].components;
    int& rows = out.of_item[static_cast<int>(kObservedInfo[i].observer)];
    out.first[i] = rows;
    rows += components == ObservedComponents::one   ? 1
            : components == ObservedComponents::two ? 2
                                                    : 3;
  }
  return out;
}
constexpr ObserverRows kObserverRows = make_observer_rows();
consteval int rows_of(Observer observer) {
  return kObserverRows.of_item[static_cast<int>(observer)];
}
consteval int row_of(Observed what) { return kObserverRows.first[static_cast<int>(what)]; }

// One point of a contact, over the whole step.
template <class Real>
struct ContactImpulse {
  std::int32_t key;  // identifies class and candidate
  std::int32_t feature;
  Real normal[3], point[3];  // world, m
  Real separation;           // m, when the step began
  Real impulse;              // N s, along the normal
  Real friction[3];          // N s, world
  Real twist;                // N m s, about the normal
};

// Rows of a body's frame.
inline constexpr int kFrameRows = 7;

// What all worlds share of a ray.
struct RayTable {
  std::int32_t body;   // the sensor is fixed to it; -1: world
  std::uint32_t mask;  // of the categories that it sees
};
// What rays see of a shape, fixed shapes first, then those of bodies.
struct SeenShape {
  std::uint32_t category;
  std::int32_t body, shape;  // of the scene
};
// Rows of a ray: origin, unit direction, length. Of a body in its principal axes, from its centre
// of mass. Rows of a hit: distance (the length for a miss), normal.
inline constexpr int kRayRows = 7, kHitRows = 4;

// A point of a body, m in the body's own frame.
template <class Real>
struct PointTable {
  std::int32_t body;
  Real position[3];
};

// A tendon of trees, among the terms of all.
struct TendonTable {
  std::int32_t first_term, terms;
};

// Where a joint of a tree holds its body B, for what it carries (kernels/observe/tree_joints.hpp):
// on a link, or on a frame without mass that the first `joints` of its joints have moved.
template <class Real>
struct TreeAnchor {
  std::int32_t link, joints;
  Real position[3];  // m, in the link's frame at the reference
};

template <class Real>
struct ObserverView {
  // By Observer, what it sees: [item][row][lane], and how many items there are.
  Real* rows[kObserverCount];
  std::int32_t items[kObserverCount];
  // Where each body's centre of mass is in its own frame, and the rotation from that frame to its
  // principal axes: [body][centre 3, quaternion 4][lane]; nullptr: nowhere and none, in all lanes.
  const Real* frames;

  // Beside the blocks of each list: places and features of their points, impulses of the step.
  // contacts, touching or penetration are asked for, or link_forces of plans without trees
  bool of_contacts;
  Real* places[kLists];          // [block][point][component][lane], [lane]
  Real* totals[kLists];          // [block][point, tangent, twist][lane]; plans without restitution
  std::uint32_t* none_asleep;    // [body] 0
  std::uint32_t* asleep_before;  // [body], before the last step put bodies to sleep; several passes

  ContactImpulse<Real>* contacts;  // [lane][room]
  std::int32_t room;

  unsigned char* saved;  // rows and velocities while one more sweep is tried

  const JointCoordinate* coordinate;  // [coordinate]
  const std::int32_t* joint_of_part;  // [part]
  // Of trees whose joint_loads are asked for, else nullptr.
  const TreeAnchor<Real>* anchor;  // [joint of the scene]
  bool of_links;                   // links, dofs, tendons, sites or drives of trees are asked for
  Real* before;  // the group's state before the last stage, where one of the two is; else nullptr

  const RayTable* ray;            // [ray]
  const SeenShape* seen_shape;    // [fixed shape, then collider]
  const Real* ray_rows;           // [ray][row][lane]
  const PointTable<Real>* point;  // [point]
  Real* placed;                   // [ray][origin, direction][lane], in the world

  const TendonTable* tendon;  // [tendon]
  const TreeTerm<Real>* tendon_term;
  // [site] of a body, or a link of trees, in its own frame; -1: in the world
  const PointTable<Real>* site;
};

template <class Real>
using Observe = void (*)(const SceneConstants<Real>&, const GroupView<Real>&, Scratch*,
                         const ObserverView<Real>&);

template <class Real>
struct ObserverTable {
  // Of an observer of states: fills its rows at the present one. nullptr: the functions below do.
  Observe<Real> look[kObserverCount][kInertiaKinds];
  // What an observer has to keep, in its rows, of the start of the last step before that look, or
  // of the state where there was no step; nullptr: nothing.
  Observe<Real> begin[kObserverCount][kInertiaKinds];

  // Reals that places and totals of a list need in the thread's scratch.
  std::size_t (*place_reals)(const SceneConstants<Real>&, Scratch*, int list);
  std::size_t (*total_reals)(const SceneConstants<Real>&, Scratch*, int list);
  // While places are given, the collide stages put down where points are; nullptr ends it.
  void (*watch)(Scratch*, Real* const* places);
  Observe<Real> accumulate[kInertiaKinds];  // after each relax pass, in plans without restitution
  Observe<Real> clear;                      // rows of observers of steps
  // Adds what the blocks of the step tell of pairs that are awake, or, after collide has found them
  // again, what the stored impulses tell of pairs that are asleep.
  Observe<Real> awake[kInertiaKinds], asleep[kInertiaKinds];
  Observe<Real> of_trees;  // the same of trees, whose contacts have no blocks
  // Around the last stage of trees: keeps the state that it begins with; what joints carry in it.
  Observe<Real> keep_tree_state, loads_of_trees;
  // Links, and what acts on them and on dofs: in that stage; the same of a state without a step.
  Observe<Real> links_of_trees, look_at_links;
  // Around one more sweep of the solver: keep what it changes; what that is, and put it back.
  std::size_t (*saved_bytes)(const SceneConstants<Real>&, Scratch*);
  Observe<Real> save_rows, compare[kInertiaKinds];
  RunProgram<Real> run_program;  // on what is there after these
  // One ray against one fixed pose row (64-byte aligned); whether it hits. out: a hit's rows.
  bool (*cast)(Dimension, ShapeKind, const Real* row, const Real* ray, Real* out);
};

}  // namespace manyworlds::kernels
