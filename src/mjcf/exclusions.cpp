#include "src/mjcf/exclusions.hpp"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

namespace manyworlds::mjcf {
namespace {

using Pair = std::pair<int, int>;  // of MuJoCo's bodies, in the order of their numbers

// Whether two of their geoms would, by contype and conaffinity.
bool could_collide(const Model& model, int a, int b) {
  const mjModel& m = *model.compiled;
  for (int g = m.body_geomadr[a]; g < m.body_geomadr[a] + m.body_geomnum[a]; ++g) {
    for (int h = m.body_geomadr[b]; h < m.body_geomadr[b] + m.body_geomnum[b]; ++h) {
      const bool meet = (m.geom_contype[g] & m.geom_conaffinity[h]) != 0 ||
                        (m.geom_contype[h] & m.geom_conaffinity[g]) != 0;
      if (meet && model.contacts_enabled()) return true;
    }
  }
  return false;
}

// Those that would collide but that MuJoCo leaves out.
std::set<Pair> left_out(const Model& model) {
  const mjModel& m = *model.compiled;
  std::vector<std::vector<int>> weld(static_cast<std::size_t>(m.nbody));  // [root] its bodies
  for (int b = 0; b < m.nbody; ++b) {
    weld[static_cast<std::size_t>(m.body_weldid[b])].push_back(b);
  }
  std::set<Pair> pairs;
  const auto add = [&](int a, int b) {
    if (a != b && could_collide(model, a, b)) pairs.insert(std::minmax(a, b));
  };
  const bool filter_parents = (m.opt.disableflags & mjDSBL_FILTERPARENT) == 0;
  for (int b = 0; b < m.nbody; ++b) {
    const int root = m.body_weldid[b];
    if (root == 0) continue;  // static bodies collide with each other nowhere
    for (const int other : weld[static_cast<std::size_t>(root)]) add(b, other);
    const int above = m.body_weldid[m.body_parentid[root]];
    if (above == 0 || !filter_parents) continue;
    for (const int other : weld[static_cast<std::size_t>(above)]) add(b, other);
  }
  for (int x = 0; x < m.nexclude; ++x) {
    const int a = m.exclude_signature[x] >> 16, b = m.exclude_signature[x] & 0xffff;
    if (m.body_weldid[a] != 0 || m.body_weldid[b] != 0) add(a, b);
  }
  return pairs;
}

// Of the scene's bodies, in the order of their numbers.
using Handles = std::pair<int, int>;

std::set<Handles> kept_apart_by_joints(const Scene& scene) {
  std::set<Handles> pairs;
  for (const Joint& joint : scene.joints) {
    if (!joint.body_a || joint.collide) continue;
    pairs.insert(std::minmax(joint.body_a.index(), joint.body_b.index()));
  }
  return pairs;
}

}  // namespace

void add_exclusions(const Model& model, const std::vector<BodyId>& scene_body, Scene& scene) {
  const std::set<Handles> apart = kept_apart_by_joints(scene);
  for (const Pair& pair : left_out(model)) {
    const BodyId a = scene_body[static_cast<std::size_t>(pair.first)];
    const BodyId b = scene_body[static_cast<std::size_t>(pair.second)];
    if (!apart.contains(std::minmax(a.index(), b.index()))) scene.exclusions.push_back({a, b});
  }
}

}  // namespace manyworlds::mjcf
