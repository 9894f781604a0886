#include "src/scene/tree_order.hpp"

#include <cstddef>

namespace manyworlds {

TreeOrder tree_order(const Scene& scene) {
  const std::size_t bodies = scene.bodies.size();
  TreeOrder out{std::vector<std::vector<int>>(bodies), std::vector<int>(bodies, -1), {}};
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    out.series[static_cast<std::size_t>(scene.joints[j].body_b.index())].push_back(
        static_cast<int>(j));
  }
  const auto moves = [&](BodyId body) { return body && scene.at(body).motion == Motion::dynamic; };
  std::vector<int> roots;
  std::vector<std::vector<int>> children(bodies);
  for (std::size_t b = 0; b < bodies; ++b) {
    const int body = static_cast<int>(b);
    if (!moves(BodyId(body))) continue;
    const auto& series = out.series[b];
    const BodyId a =
        series.empty() ? BodyId() : scene.joints[static_cast<std::size_t>(series.front())].body_a;
    if (moves(a)) out.parent[b] = a.index();
    (moves(a) ? children[static_cast<std::size_t>(a.index())] : roots).push_back(body);
  }
  std::vector<int> waiting(roots.rbegin(), roots.rend());
  while (!waiting.empty()) {
    const int body = waiting.back();
    waiting.pop_back();
    out.links.push_back(body);
    const auto& next = children[static_cast<std::size_t>(body)];
    waiting.insert(waiting.end(), next.rbegin(), next.rend());
  }
  return out;
}

}  // namespace manyworlds
