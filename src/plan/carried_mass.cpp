// What joints carry. Bodies and the world are the nodes of a graph, joints its edges; a joint that
// parts the graph, a bridge, carries the side that the world is not on, or else the lighter one.
// Bridges are found by one walk in depth (Tarjan 1974): those below which nothing leads back up.
#include <algorithm>
#include <limits>
#include <vector>

#include "src/plan/plan_data.hpp"
#include "src/plan/substeps.hpp"

namespace manyworlds {

namespace {

class Walk {
 public:
  explicit Walk(const Scene& scene)
      : nodes_(scene.bodies.size() + 1), carried_(scene.joints.size(), 0) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      const bool moves = body.motion == Motion::dynamic;
      place_.push_back(moves ? i + 1 : kWorld);
      if (moves) nodes_[i + 1].mass = mass_properties(scene, body).mass;
    }
    for (std::size_t j = 0; j < scene.joints.size(); ++j) {
      const std::size_t a = place_of(scene.joints[j].body_a), b = place_of(scene.joints[j].body_b);
      if (a == b) continue;
      nodes_[a].edges.push_back({j, b}), nodes_[b].edges.push_back({j, a});
    }
  }

  std::vector<double> carried() {
    for (std::size_t root = kWorld; root < nodes_.size(); ++root) {
      if (nodes_[root].entry == 0) walk(root);
    }
    return carried_;
  }

 private:
  static constexpr std::size_t kWorld = 0;
  struct Edge {
    std::size_t joint, to;
  };
  struct Node {
    double mass = 0;  // kg, in the end with all below
    std::vector<Edge> edges;
    std::size_t next = 0;           // edge to follow
    std::size_t entry = 0, up = 0;  // order of the walk, from 1; the first that is led back to
    Edge from = {};
  };

  std::size_t place_of(BodyId body) const {
    return body ? place_[static_cast<std::size_t>(body.index())] : kWorld;
  }
  void enter(std::size_t node, const Edge& from) {
    nodes_[node].entry = nodes_[node].up = ++entered_;
    nodes_[node].from = from;
    path_.push_back(node);
  }

  void walk(std::size_t root) {
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> parted;  // nodes below bridges
    enter(root, {kNone, kNone});
    while (!path_.empty()) {
      const std::size_t at = path_.back();
      Node& node = nodes_[at];
      if (node.next < node.edges.size()) {
        const Edge edge = node.edges[node.next++];
        if (edge.joint == node.from.joint) continue;
        if (nodes_[edge.to].entry == 0) {
          enter(edge.to, {edge.joint, at});
        } else {
          node.up = std::min(node.up, nodes_[edge.to].entry);
        }
        continue;
      }
      path_.pop_back();
      if (node.from.to == kNone) continue;
      Node& above = nodes_[node.from.to];
      above.mass += node.mass, above.up = std::min(above.up, node.up);
      if (node.up == node.entry) parted.push_back(at);
    }
    for (const std::size_t below : parted) {
      const Node& node = nodes_[below];
      const double rest = nodes_[root].mass - node.mass;
      carried_[node.from.joint] = root == kWorld ? node.mass : std::min(node.mass, rest);
    }
  }

  std::vector<Node> nodes_;         // the world, then the bodies
  std::vector<std::size_t> place_;  // of each body its node
  std::vector<double> carried_;
  std::vector<std::size_t> path_;
  std::size_t entered_ = 0;
};

}  // namespace

std::vector<double> carried_masses(const Scene& scene) {
  if (scene.joints.empty()) return {};
  return Walk(scene).carried();
}

BodyId lighter_body(const Scene& scene, const Joint& joint) {
  BodyId lighter;
  double least = std::numeric_limits<double>::infinity();
  for (const BodyId body : {joint.body_a, joint.body_b}) {
    if (!body || scene.at(body).motion != Motion::dynamic) continue;
    const double mass = mass_properties(scene, scene.at(body)).mass;
    if (mass < least) lighter = body, least = mass;
  }
  return lighter;
}

}  // namespace manyworlds
