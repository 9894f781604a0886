#include "src/mjcf/sites.hpp"

#include <cstddef>
#include <utility>

#include "src/mjcf/pose.hpp"

namespace manyworlds::mjcf {

void add_sites(const Model& model, const std::vector<BodyId>& scene_body, Scene& scene) {
  const mjModel& m = *model.compiled;
  for (int s = 0; s < m.nsite; ++s) {
    const int body = m.site_bodyid[s], carrier = model.carrier(body);
    Site site;
    site.name = model.name(mjOBJ_SITE, s);
    site.body = scene_body[static_cast<std::size_t>(carrier)];
    const Pose pose = pose_in(m, body, site.body ? carrier : 0);
    site.position = pose.position + pose.rotation * vec3(m.site_pos + 3 * s);
    scene.add(std::move(site));
  }
}

}  // namespace manyworlds::mjcf
