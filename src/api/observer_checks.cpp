// Observers in words: sizes, what is wrong with them.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "kernels/data/pair_keys.hpp"
#include "src/api/batch_data.hpp"
#include "src/api/observations.hpp"
#include "src/base/enum_names.hpp"

namespace manyworlds {

std::size_t observed_size(Observed what, const PlanData& plan, std::size_t rays) {
  const bool planar = plan.scene.space == Space::planar;
  const std::size_t dim = planar ? 2 : 3, spins = planar ? 1 : 3;
  switch (checked_enum(what)) {
    case Observed::momentum:
    case Observed::mass_center: return dim;
    case Observed::angular_momentum: return spins;
    case Observed::touching: return plan.bodies.size();
    case Observed::joint_position:
    case Observed::joint_speed: return plan.coordinates.size();
    case Observed::residual: return kernels::kResidualRows;
    case Observed::joint_force: return plan.scene.joints.size() * dim;
    case Observed::joint_torque: return plan.scene.joints.size() * spins;
    case Observed::ray_distance:
    case Observed::ray_body:
    case Observed::ray_shape: return rays;
    case Observed::ray_normal: return rays * dim;
    default: return 1;
  }
}

void check_observers(const Observers& observers) {
  for (std::size_t i = 0; i < observers.what.size(); ++i) {
    checked_enum(observers.what[i], "observe.what[" + std::to_string(i) + "]");
  }
  if (observers.contacts_per_world < 0) {
    reject("observe.contacts_per_world is " + std::to_string(observers.contacts_per_world) +
           ", must be >= 0");
  }
}

void check_rays(std::span<const Ray> rays, const Plan& plan) {
  const Space space = plan.scene().space;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    const auto wrong = [&](const char* field, const auto& found, const std::string& expected) {
      std::ostringstream text;
      text << "rays[" << i << "]." << field << " is " << found << ", must be " << expected;
      reject(text.str());
    };
    Vec3 way = ray.direction;
    if (space == Space::planar) way.z() = 0;
    if (!ray.origin.allFinite()) wrong("origin", ray.origin.transpose(), "finite");
    if (!way.allFinite() || way.isZero(0)) {
      wrong("direction", ray.direction.transpose(),
            space == Space::planar ? "finite and not zero in the plane" : "finite and not zero");
    }
    if (!(ray.length > 0)) wrong("length", ray.length, "> 0 m");
    if (ray.body == BodyId()) continue;
    const int bodies = static_cast<int>(plan.scene().bodies.size());
    if (!ray.body || ray.body.index() >= bodies) {
      wrong("body", ray.body.index(), "-1 to " + std::to_string(bodies - 1));
    }
    if (!plan.find_row(ray.body)) {
      wrong("body", body_text(plan.scene(), ray.body),
            "one that can move: where a fixed one stands, give the ray in the world");
    }
  }
}

template <class Real>
PairNames names_of(const PlanData& plan, const kernels::WorldTables<Real>& t, std::int32_t key) {
  const kernels::PairOfKey pair = kernels::pair_of_key(t, key);
  const auto named = [&](const auto& a) {
    const PlanCollider& b = plan.colliders[static_cast<std::size_t>(pair.b)];
    return PairNames{{BodyId(a.scene_body), a.shape}, {BodyId(b.scene_body), b.shape}};
  };
  const auto a = static_cast<std::size_t>(pair.a);
  const bool fixed = is_fixed(t.pair_class[kernels::class_of_key(t, key)].list);
  return fixed ? named(plan.fixed[a]) : named(plan.colliders[a]);
}
template PairNames names_of(const PlanData&, const kernels::WorldTables<float>&, std::int32_t);
template PairNames names_of(const PlanData&, const kernels::WorldTables<double>&, std::int32_t);

}  // namespace manyworlds
