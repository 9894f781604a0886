// Checks of how the coordinates that worlds begin with are drawn.
#include "src/scene/checks.hpp"
#include "src/scene/tree_order.hpp"

namespace manyworlds::detail {
namespace {

// Positions or velocities of a scene whose trees are sound.
std::size_t count_of(const Scene& scene, bool velocity) {
  if (scene.options.solver.method != Solver::newton) return 0;
  const TreeOrder order = tree_order(scene);
  std::size_t count = 0;
  for (const int link : order.links) {
    const auto& series = order.series[static_cast<std::size_t>(link)];
    if (series.empty()) count += velocity ? 6 : 7;
    for (const int joint : series) {
      const JointType& type = scene.joints[static_cast<std::size_t>(joint)].type;
      if (std::holds_alternative<FixedJoint>(type)) continue;
      count += !std::holds_alternative<BallJoint>(type) ? 1 : velocity ? 3 : 4;
    }
  }
  return count;
}

void check_range(Checker& at, const CoordinateDraw& draw, std::size_t i) {
  const std::string low = element_name("low", i);
  if (!at.finite(low, draw.low[i], "") || !at.finite(element_name("high", i), draw.high[i], "")) {
    return;
  }
  if (draw.low[i] <= draw.high[i]) return;
  at.add(low, "is " + number_text(draw.low[i]) + ", must be <= " + element_name("high", i) +
                  ", which is " + number_text(draw.high[i]));
}

}  // namespace

void check_coordinate_draws(Checker checker, const Scene& scene, bool sound) {
  for (std::size_t d = 0; d < scene.coordinate_draws.size(); ++d) {
    const CoordinateDraw& draw = scene.coordinate_draws[d];
    Checker at = checker.at(named_part("coordinate draw", d, ""));
    if (draw.high.size() != draw.low.size()) {
      at.add("high", "has " + std::to_string(draw.high.size()) +
                         " values, must have as many as low: " + std::to_string(draw.low.size()));
      continue;
    }
    for (std::size_t i = 0; i < draw.low.size(); ++i) check_range(at, draw, i);
    if (!(draw.nearest < draw.farthest)) {
      at.add("nearest", "is " + number_text(draw.nearest) + ", must be < farthest, which is " +
                            number_text(draw.farthest));
    }
    if (!sound) continue;
    const std::size_t count = count_of(scene, draw.velocity);
    const char* const what = draw.velocity ? "degrees of freedom" : "coordinates";
    if (draw.first < 0 || static_cast<std::size_t>(draw.first) + draw.low.size() > count) {
      at.add("first", "is " + std::to_string(draw.first) + " of " +
                          std::to_string(draw.low.size()) + " values, must be within the " +
                          std::to_string(count) + " " + what + " of Solver::newton");
    }
  }
}

}  // namespace manyworlds::detail
