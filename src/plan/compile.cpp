// compile(): from a valid Scene to a Plan.
#include "src/plan/plan_data.hpp"

namespace manyworlds {

Plan compile(const Scene& scene, const PlanOptions& options) {
  std::vector<Issue> issues = validate(scene);
  if (!issues.empty()) throw SceneError(std::move(issues));
  auto plan = std::make_shared<PlanData>();
  plan->scene = scene;
  plan->options = options;
  collect_variations(*plan);
  collect_bodies(*plan);
  choose_polygons(*plan);
  collect_colliders(*plan);
  collect_fixed(*plan);
  lay_out_shapes(*plan);
  collect_joints(*plan);
  collect_coordinates(*plan);
  collect_controls(*plan);
  collect_pairs(*plan);
  choose_features(*plan);
  return Plan(std::move(plan));
}

const Scene& Plan::scene() const { return data_->scene; }
const PlanOptions& Plan::options() const { return data_->options; }
int Plan::bodies() const { return static_cast<int>(data_->bodies.size()); }
int Plan::scene_body(int state_body) const {
  return data_->bodies.at(static_cast<std::size_t>(state_body)).scene_body;
}
int Plan::state_body(int scene_body) const {
  return data_->state_body.at(static_cast<std::size_t>(scene_body));
}
bool Plan::has(Feature feature) const { return data_->has(feature); }
std::uint64_t Plan::fingerprint() const { return manyworlds::fingerprint(*data_); }
PlanReport Plan::report() const { return describe(*data_); }

}  // namespace manyworlds
