// Where bodies and shapes of the scene are in arrays of numbers.
#include <stdexcept>

#include "src/base/index_check.hpp"
#include "src/plan/plan_data.hpp"

namespace manyworlds {

std::optional<int> Plan::find_row(BodyId body) const {
  check_index("body", body.index(), data_->state_body.size());
  const int row = data_->state_body[static_cast<std::size_t>(body.index())];
  return row < 0 ? std::nullopt : std::optional(row);
}
int Plan::row(BodyId body) const {
  if (const auto row = find_row(body)) return *row;
  throw std::invalid_argument(body_text(scene(), body) + " is fixed, it has no row");
}
BodyId Plan::body_in_row(int row) const {
  check_index("row", row, data_->bodies.size());
  return BodyId(data_->bodies[static_cast<std::size_t>(row)].scene_body);
}
int Plan::row(ShapeId shape) const {
  check_index("body", shape.body().index(), scene().bodies.size());
  check_index("shape", shape.index(), scene().at(shape.body()).shapes.size());
  std::size_t row = static_cast<std::size_t>(shape.index());
  for (int b = 0; b < shape.body().index(); ++b) row += scene().at(BodyId(b)).shapes.size();
  return static_cast<int>(row);
}

std::string body_text(const Scene& scene, BodyId body) {
  const std::string& name = scene.at(body).name;
  return "body " + std::to_string(body.index()) + (name.empty() ? "" : " '" + name + "'");
}

}  // namespace manyworlds
