// compile(): from a valid Scene to a Plan.
#include "src/base/enum_names.hpp"
#include "src/base/float_mode.hpp"
#include "src/plan/plan_data.hpp"

namespace manyworlds {

Plan compile(const Scene& scene, const PlanOptions& options) {
  const FloatMode mode;
  checked_enum(options.broad_phase);
  for (std::size_t i = 0; i < options.keep.size(); ++i) {
    checked_enum(options.keep[i], "keep[" + std::to_string(i) + "]");
  }
  std::vector<Issue> issues = validate(scene);
  if (!issues.empty()) throw SceneError(std::move(issues));
  auto plan = std::make_shared<PlanData>();
  plan->described = plan->scene = scene;
  plan->options = options;
  collect_variations(*plan);
  resolve_options(*plan);
  collect_bodies(*plan);
  choose_polygons(*plan);
  collect_colliders(*plan);
  collect_fixed(*plan);
  lay_out_shapes(*plan);
  collect_joints(*plan);
  collect_coordinates(*plan);
  collect_controls(*plan);
  collect_trees(*plan);
  collect_pairs(*plan);
  collect_tree_pairs(*plan);
  choose_features(*plan);
  choose_stages(*plan);
  return Plan(std::move(plan));
}

Plan::Plan(std::shared_ptr<const PlanData> data) : data_(std::move(data)) {
  if (!data_) throw std::invalid_argument("Plan: it is empty, compile() makes a plan");
}
const Scene& Plan::scene() const { return data_->described; }
const Options& Plan::resolved() const { return data_->scene.options; }
const PlanOptions& Plan::options() const { return data_->options; }
int Plan::bodies() const { return static_cast<int>(data_->bodies.size()); }
bool Plan::has(Feature feature) const { return data_->has(checked_enum(feature)); }
std::uint64_t Plan::fingerprint() const {
  const FloatMode mode;
  return manyworlds::fingerprint(*data_);
}
PlanReport Plan::report() const {
  const FloatMode mode;
  return describe(*data_);
}

}  // namespace manyworlds
