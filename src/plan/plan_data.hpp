// PlanData: the contents of a Plan, in double and in plain arrays. src/state/tables.cpp makes it
// into the kernels' number type.
#pragma once

#include <array>
#include <cstring>
#include <set>
#include <utility>
#include <vector>

#include "kernels/data/tables.hpp"
#include "manyworlds/plan.hpp"
#include "src/plan/stages.hpp"
#include "src/plan/trees.hpp"
#include "src/scene/height_field.hpp"
#include "src/scene/shape/shape.hpp"
#include "src/scene/variations.hpp"

namespace manyworlds {

// A body with state. The kernels see its centre of mass and principal axes; what the user calls
// position and orientation differs by a fixed transform.
struct PlanBody {
  int scene_body = -1;
  double inv_mass = 0;          // 0: kinematic
  double mass = 0;              // kg; 0 for kinematic bodies
  Vec3 inertia = Vec3::Zero();  // principal; planar: z
  Vec3 inv_inertia = Vec3::Zero();
  Vec3 center = Vec3::Zero();         // of mass, in the user's body frame
  Quat principal = Quat::Identity();  // principal axes in the user's body frame
  bool aligned = true;                // both are trivial: reading and writing copies bits
  bool reshaped = false;              // its shapes, or how mass is spread over them, may vary
  bool shifted = false;               // its centre of mass or where its shapes are may vary
  double radius = 0;                  // bounding sphere about the centre of mass
  double half_thickness = 0;          // least of its shapes, m
  bool jointed = false;               // a joint acts on it
};

// Its frame: from the centre of mass, principal axes.
struct PlanCollider : ShapeForm {
  int body = -1;  // state body
  int scene_body = -1, shape = -1;
  int hull = 0;  // of a hull: where its table is, in fours
  Material material;
  int row = 0;
};

struct PlanFixed {
  kernels::ShapeKind kind{};
  int scene_body = -1, shape = -1;
  std::vector<double> row;  // pose row
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  std::array<double, 4> plane{};
  double length = 0;  // of a link
  // Of a tile: how many its field has, and how many of them come before it; the field's cells, m.
  int triangles = 0, triangles_before = 0;
  Vec2 cell = Vec2::Zero();
  Material material;
  int row_offset = 0;
};

// Part of a joint, and its numbers.
struct PlanPart {
  int joint = -1;  // of the scene
  kernels::JointPart what{};
  kernels::JointConstants<double> constants{};
};

// Joints that are solved at once.
struct PlanJointTrees {
  kernels::JointTrees counts{};          // its lists are these:
  std::vector<kernels::TreeEdge> edges;  // those that close loops last
  std::vector<kernels::JointLoops> loops;
  std::vector<std::int32_t> roots, bodies;
  std::vector<std::int32_t> edge_of;  // [body] that it hangs on; -1: none
};

// Thrust or torque of a control.
struct PlanThrust {
  kernels::ThrustTable what{};
  Vec3 point = Vec3::Zero();      // from the centre of mass, principal axes
  Vec3 direction = Vec3::Zero();  // principal axes
};

struct PlanClass {
  kernels::PairKind kind{};
  kernels::ListId list{};
  int first_key = 0;
  int keys = 0;
  int candidates = 0;  // pairs that may touch; a sparse plan has keys for the others, too
  int culled = 0;
  std::vector<std::int32_t> a, b;  // the candidates; of a sparse plan examples of all materials
};

// What differs from world to world.
struct PlanVaries {
  bool masses = false;     // and inertias
  bool shapes = false;     // sizes, and places about the centre of mass
  bool materials = false;  // numbers of Material
  bool delta_v = false;    // gravity
  bool drag = false;
  bool joints = false;   // limits, drives, springs, loads and frames of joints on bodies
  bool thrusts = false;  // where controls act, and along what
  bool starts = false;   // how bodies begin
  bool ranges = false;   // of controls
  // Of trees: centres of mass and principal axes of links, armatures and the like of joints, gains
  // and ranges of forces, limits, how soft contacts are.
  bool links = false, dofs = false, actuators = false;
  bool limits = false, contacts = false;
  bool attractors = false;
  bool body_constants() const { return masses || delta_v || drag; }
};

struct PlanData {
  Scene described;  // as it was given
  Scene scene;      // its options with all that they leave to the plan filled in (resolve.cpp)
  std::vector<PlanReport::Choice> choices;
  PlanOptions options;
  std::vector<VariedNumber> varied;
  PlanVaries varies;
  std::array<bool, kFeatureCount> in{};
  std::array<std::string, kFeatureCount> why;
  PlanStages stages;  // what a step runs
  kernels::InertiaKind inertia_kind{};
  std::vector<PlanBody> bodies;
  std::vector<int> state_body;  // per scene body: its row; -1: fixed
  std::vector<PlanCollider> colliders;
  std::vector<PlanFixed> fixed;
  std::vector<double> hulls;  // tables of hulls that move (kernels/data/pose_rows.hpp)
  std::vector<PlanClass> classes;
  std::vector<PlanPart> parts;  // of joints, in their order
  PlanJointTrees trees_of_joints;
  std::vector<PlanThrust> thrusts;                   // by body
  PlanTrees trees;                                   // of Solver::newton
  std::vector<std::array<double, 2>> control_range;  // [control] low, high
  // Of trees `part` is the joint of a link (PlanTrees::joints), and of `what` the kind alone
  // counts.
  std::vector<kernels::JointCoordinate> coordinates;
  // [joint + 1] among `coordinates`; the same but in generalized_position where there are trees.
  std::vector<int> first_observed, first_coordinate;
  std::array<int, kernels::kLists> capacity{};
  bool sweep = false;
  bool rectangles = true;  // every polygon is one, and stays one
  bool rounded = false;    // some polygon has a radius; then all are taken to have one
  bool sparse = false;     // no tables of pairs
  bool collider_is_body = true;
  bool orientations_matter = true;  // where not, they may be kept none the less
  bool cast = false;
  bool uniform_gravity = true, uniform_friction = true;
  bool slows = false;  // some body may have linear drag, whatever stages are kept
  int row_block = 0;

  // A step is as many passes, each with its own contacts and substeps (collision_passes.cpp).
  int passes() const { return *scene.options.contact.collision_passes; }
  int pass_substeps() const { return *scene.options.substeps / passes(); }
  double pass_dt() const { return scene.options.dt / passes(); }     // s
  double substep_dt() const { return pass_dt() / pass_substeps(); }  // s

  bool has_trees() const { return scene.options.solver.method == Solver::newton; }
  bool has(Feature f) const { return in[static_cast<std::size_t>(f)]; }
  // Whether the energy of its worlds can be audited (kernels/observe/audit.hpp). Overlaps of
  // penalty hold energy that nobody knows; free motion is exact.
  bool audited() const {
    const bool rows = runs(StepStage::collide) || runs(StepStage::joints);
    return !has_trees() && scene.options.solver.method != Solver::penalty &&
           (rows || runs(StepStage::flight));
  }
  bool runs(StepStage s) const { return stages[static_cast<std::size_t>(s)].in; }
  kernels::Dimension dimension() const {
    return scene.space == Space::planar ? kernels::Dimension::planar : kernels::Dimension::spatial;
  }
};

// "body 3 'crate'" (rows.cpp)
std::string body_text(const Scene& scene, BodyId body);

// From how far on shapes are looked at, m; those of a pair add up (colliders.cpp).
double min_margin(const PlanData& plan);

// Scene bodies, the lower one first, that joints keep from colliding (joints.cpp).
std::set<std::pair<int, int>> joined_bodies(const Scene& scene);

// Whether bodies without rows have another integrator than the substeps of the solver.
inline bool has_flight(const Options& o) {
  return o.integrator != Integrator::symplectic_euler ||
         o.rotation.value_or(Rotation::splitting) != Rotation::splitting;
}

// A pose row as the numbers that it is.
template <template <class> class Row>
void append_row(const Row<double>& row, std::vector<double>& out) {
  static_assert(sizeof(row) == kernels::row_size<Row> * sizeof(double));
  const std::size_t at = out.size();
  out.resize(at + sizeof(row) / sizeof(double));
  std::memcpy(out.data() + at, &row, sizeof(row));
}

std::vector<PlanFixed> terrain_links(const Body& body, const Shape& shape);  // terrain.cpp

// The tiles that a height field is made of (kernels/collide/tile.hpp).
std::vector<PlanFixed> height_field_tiles(const Body& body, const Shape& shape,
                                          const TileCount& tiles,
                                          const Scene& scene);  // height_field.cpp

// A hull as the kernels take it: about the middle of its bounding box, in units of half its
// extents.
struct HullCorners {
  Vec3 middle, half;                    // m, of the bounding box, shape frame
  double radius = 0, inner_radius = 0;  // about the middle, m
  double half_thickness = 0;            // of a sphere inside, about the mean of the corners, m
  std::vector<double> rows;             // HullRow (kernels/data/pose_rows.hpp)
};
// `stretched`: in some worlds it has another size.
HullCorners hull_corners(const Hull& hull, bool stretched);  // hulls.cpp
// Puts them with the plan's, unless they are there already; returns where, in fours.
int put_corners(PlanData& plan, const HullCorners& corners);  // hulls.cpp

// The steps of compile(), in order.
void collect_variations(PlanData& plan);    // variations.cpp
void resolve_options(PlanData& plan);       // resolve.cpp
void collect_bodies(PlanData& plan);        // bodies.cpp
void choose_polygons(PlanData& plan);       // colliders.cpp
void collect_colliders(PlanData& plan);     // colliders.cpp
void collect_fixed(PlanData& plan);         // colliders.cpp
void collect_joints(PlanData& plan);        // joints.cpp
void collect_joint_trees(PlanData& plan);   // joint_trees.cpp, of which joints.cpp makes use
void collect_controls(PlanData& plan);      // controls.cpp
void collect_trees(PlanData& plan);         // collect_trees.cpp
void collect_tree_pairs(PlanData& plan);    // tree_pairs.cpp
void collect_coordinates(PlanData& plan);   // coordinates.cpp
void lay_out_shapes(PlanData& plan);        // colliders.cpp
void collect_pairs(PlanData& plan);         // pairs.cpp, sparse_pairs.cpp
void choose_features(PlanData& plan);       // features.cpp
void choose_stages(PlanData& plan);         // stages.cpp
PlanReport describe(const PlanData& plan);  // report.cpp

// Numbers of trees once more, of those that vary (tree_numbers.cpp).
void number_trees(PlanData& plan);
// Bodies and shapes of a copy of a plan once more, after its scene was given the numbers of one
// world (variations.cpp).
void derive_again(PlanData& plan);
// The scene as it is described and, where something varies, with all at their lowest and highest.
std::vector<Scene> extremes(const PlanData& plan);

// Equal for plans that step worlds alike and store them alike (fingerprint.cpp).
std::uint64_t fingerprint(const PlanData& plan);
std::uint64_t fingerprint(const Scene& scene);  // of what of it counts (members.hpp)
std::string to_string(kernels::PairKind kind);  // "box-sphere"

}  // namespace manyworlds
