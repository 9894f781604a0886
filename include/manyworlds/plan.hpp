// Plan: the stages and arrays that the step of one scene needs. Immutable; batches share it.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "manyworlds/field_table.hpp"
#include "manyworlds/scene.hpp"

namespace manyworlds {

// Thrown by compile(), and for meshes (mesh.hpp). Contains all issues of the scene or mesh; what()
// lists them one per line.
class SceneError : public std::invalid_argument {
 public:
  explicit SceneError(std::vector<Issue> issues);
  // `subject`: what has the issues, for what(): "mesh".
  SceneError(const char* subject, std::vector<Issue> issues);
  const std::vector<Issue>& issues() const { return issues_; }

 private:
  std::vector<Issue> issues_;
};

// Stages, and rows of a stage, that a Plan omits if the scene does not need them. PlanOptions::keep
// keeps a feature, to measure the benefit of omitting it and to test that results are equal.
enum class Feature {
  orientation,  // rotation state (omitted if every dynamic body is a centred sphere)
  inertia,      // full inertia tensors and gyroscopic term (omitted if all are isotropic)
  friction,     // tangent rows (omitted if no candidate pair has friction)
  restitution,  // restitution pass (omitted if no candidate pair bounces)
  contacts,     // all contact stages (omitted if no pair can ever touch)
  drag,         // drag factors
  gravity,      // gravity and its drift term
  joints,       // joints
  resistance,   // rows against rolling and spinning (omitted if no candidate pair resists)
};
inline constexpr int kFeatureCount = 9;
const char* to_string(Feature feature);

// How the step finds pairs of shapes that are close. All methods find the same pairs in the same
// order. all_pairs and sort_and_sweep store all pairs in the plan: memory grows with the square of
// the number of shapes. sparse stores none.
//
// automatic chooses sparse above 512 moving shapes, or above 32,768 pairs of a moving shape and a
// fixed shape other than a plane. Below, it chooses sort_and_sweep in planar scenes of at least 48
// shapes, else all_pairs.
enum class BroadPhase { automatic, all_pairs, sort_and_sweep, sparse };
const char* to_string(BroadPhase broad_phase);

struct PlanOptions {
  BroadPhase broad_phase = BroadPhase::automatic;
  std::vector<Feature> keep = {};
};

// Summary of a plan; `manyworlds plan` prints it.
struct PlanReport {
  struct Item {
    std::string name = {};
    bool in = false;
    std::string why = {};
  };
  struct PairClass {
    std::string kernel = {};  // "sphere-sphere", "box-plane", ...
    std::string kind = {};    // "fixed" (against a fixed shape) or "pairs"
    int candidates = 0;       // pairs of shapes that the step tests
    int culled = 0;           // pairs of shapes that can never touch, omitted from the plan
  };
  struct Array {
    std::string name = {};
    std::string shape = {};  // "[body][3]"
    std::size_t bytes_per_world = 0;
  };
  // An option that the plan chose.
  struct Choice {
    std::string option = {};  // path of the option, "substeps"
    double value = 0;         // in the unit of the option
    std::string why = {};
    std::string name = {};  // name of the value if it has one, "tree"
  };
  std::vector<Choice> choices = {};
  std::vector<Item> features = {};
  std::vector<Item> stages = {};  // in the order of the step
  std::vector<PairClass> pairs = {};
  std::vector<Array> arrays = {};  // persistent, float32
  BroadPhase broad_phase = BroadPhase::all_pairs;
  int pair_capacity = 0;   // manifolds per world between moving bodies
  int fixed_capacity = 0;  // manifolds per world against fixed shapes
  std::size_t bytes_per_world = 0;
};

struct PlanData;  // src/plan/plan_data.hpp

class Plan {
 public:
  // Throws std::invalid_argument for null. A moved-from Plan keeps its value.
  explicit Plan(std::shared_ptr<const PlanData> data);
  Plan(const Plan&) = default;
  Plan& operator=(const Plan&) = default;
  const Scene& scene() const;
  const PlanOptions& options() const;
  // The scene's options, with the values that the plan chose. joint.method stays empty if the plan
  // sweeps.
  const Options& resolved() const;
  // Handles by name, as in Scene.
  BodyId body(std::string_view name) const { return scene().body(name); }
  ShapeId shape(std::string_view name) const { return scene().shape(name); }
  ShapeId shape(BodyId body, std::string_view name) const { return scene().shape(body, name); }
  JointId joint(std::string_view name) const { return scene().joint(name); }
  ControlId control(std::string_view name) const { return scene().control(name); }
  TendonId tendon(std::string_view name) const { return scene().tendon(name); }
  SiteId site(std::string_view name) const { return scene().site(name); }
  KeyframeId keyframe(std::string_view name) const { return scene().keyframe(name); }
  int bodies() const;              // bodies with state: dynamic and kinematic, in scene order
  int items(ItemKind kind) const;  // items of a world with state fields of this kind
  std::size_t numbers(Field field) const;  // values of a world: items times components
  // The row of a body in arrays [body], and the body of a row. Fixed bodies have no row: row()
  // throws std::invalid_argument for them. Both throw it for a body or row that does not exist.
  int row(BodyId body) const;
  int row(ShapeId shape) const;  // in arrays [shape of the scene]; every shape has one
  std::optional<int> find_row(BodyId body) const;
  BodyId body_in_row(int row) const;
  // Number of observed coordinates of all joints (observed.hpp).
  int coordinates() const;
  // Index of the first observed coordinate of a joint, in the order of the scene. Both throw
  // std::invalid_argument for a joint that is not in the scene.
  int first_observed(JointId joint) const;
  // The same; with Solver::newton the index in generalized_position, which has other coordinates in
  // another order (ItemKind::coordinate).
  int first_coordinate(JointId joint) const;
  bool has(Feature feature) const;
  // Snapshots fit all plans with an equal fingerprint. It omits names, initial values and what is
  // for observation only.
  std::uint64_t fingerprint() const;
  PlanReport report() const;
  const PlanData& data() const { return *data_; }

 private:
  std::shared_ptr<const PlanData> data_;
};

// Validates and compiles. Throws SceneError.
Plan compile(const Scene& scene, const PlanOptions& options = {});

}  // namespace manyworlds
