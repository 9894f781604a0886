// Plan: what the step needs for one scene, and nothing else. Immutable; batches share it.
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

// Thrown by compile(), and for meshes (mesh.hpp): carries every issue of the scene or the mesh;
// what() lists them one per line.
class SceneError : public std::invalid_argument {
 public:
  explicit SceneError(std::vector<Issue> issues);
  // `subject`: what has the issues, in what(); "mesh".
  SceneError(const char* subject, std::vector<Issue> issues);
  const std::vector<Issue>& issues() const { return issues_; }

 private:
  std::vector<Issue> issues_;
};

// Stages, and rows of a stage, that a Plan leaves out when the scene does not need them.
// Listing one in PlanOptions::keep switches it back on, to measure its worth and harmlessness.
enum class Feature {
  orientation,  // rotation state (left out when every dynamic body is a centred sphere)
  inertia,      // full inertia tensors and gyroscopic term (left out when all are isotropic)
  friction,     // tangent rows (left out when no candidate pair has friction)
  restitution,  // restitution pass (left out when no candidate pair bounces)
  contacts,     // everything about contacts (left out when no pair can ever touch)
  drag,         // drag factors
  gravity,      // gravity and its drift term
  joints,       // joints
};
inline constexpr int kFeatureCount = 8;
const char* to_string(Feature feature);

// How pairs of shapes that come close are found; all ways find the same in the same order. The
// first two list all pairs in the plan, so that its memory grows with the square of the shapes;
// sparse lists none. Automatic takes it above 512 moving shapes, or 32,768 pairs of moving shapes
// with fixed ones that are not planes; below, sort_and_sweep in the plane from 48 shapes on, else
// all_pairs.
enum class BroadPhase { automatic, all_pairs, sort_and_sweep, sparse };
const char* to_string(BroadPhase broad_phase);

struct PlanOptions {
  BroadPhase broad_phase = BroadPhase::automatic;
  std::vector<Feature> keep = {};
};

// What a plan contains, for people: `manyworlds plan` prints it.
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
    int culled = 0;           // pairs of shapes that can never touch, dropped at plan time
  };
  struct Array {
    std::string name = {};
    std::string shape = {};  // "[body][3]"
    std::size_t bytes_per_world = 0;
  };
  // What Options left to the plan.
  struct Choice {
    std::string option = {};  // its path, "substeps"
    double value = 0;         // in the unit of the option
    std::string why = {};
    std::string name = {};  // of a value that has one, "tree"
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
  // Throws std::invalid_argument for null. A Plan that is moved from stays what it was.
  explicit Plan(std::shared_ptr<const PlanData> data);
  Plan(const Plan&) = default;
  Plan& operator=(const Plan&) = default;
  const Scene& scene() const;
  const PlanOptions& options() const;
  // Those of the scene, with what they leave to the plan filled in. joint.method stays empty where
  // the plan sweeps.
  const Options& resolved() const;
  // As those of its Scene: the one of a name.
  BodyId body(std::string_view name) const { return scene().body(name); }
  ShapeId shape(std::string_view name) const { return scene().shape(name); }
  ShapeId shape(BodyId body, std::string_view name) const { return scene().shape(body, name); }
  JointId joint(std::string_view name) const { return scene().joint(name); }
  ControlId control(std::string_view name) const { return scene().control(name); }
  TendonId tendon(std::string_view name) const { return scene().tendon(name); }
  SiteId site(std::string_view name) const { return scene().site(name); }
  KeyframeId keyframe(std::string_view name) const { return scene().keyframe(name); }
  int bodies() const;              // bodies with state: dynamic and kinematic, in scene order
  int items(ItemKind kind) const;  // of a world, that have the state fields of this kind
  std::size_t numbers(Field field) const;  // of a world: items times components
  // The row of a body in arrays [body], and the body of a row. Fixed bodies are in none: row()
  // throws std::invalid_argument for them, and both do for what is not there.
  int row(BodyId body) const;
  int row(ShapeId shape) const;  // of arrays [shape of the scene]; all have one
  std::optional<int> find_row(BodyId body) const;
  BodyId body_in_row(int row) const;
  // Of all joints of the scene, as observers see them (observed.hpp).
  int coordinates() const;
  // Where those of a joint begin, joint by joint in the order of the scene. Both throw
  // std::invalid_argument for a joint that is not in the scene.
  int first_observed(JointId joint) const;
  // The same; with Solver::newton where it begins in generalized_position, which has other
  // coordinates in another order (ItemKind::coordinate).
  int first_coordinate(JointId joint) const;
  bool has(Feature feature) const;
  // Equal for plans whose worlds can go on in each other: of everything but names and where bodies
  // begin.
  std::uint64_t fingerprint() const;
  PlanReport report() const;
  const PlanData& data() const { return *data_; }

 private:
  std::shared_ptr<const PlanData> data_;
};

// Validates and compiles. Throws SceneError.
Plan compile(const Scene& scene, const PlanOptions& options = {});

}  // namespace manyworlds
