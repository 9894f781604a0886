// Observers in words: names, sizes, what is wrong with them.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "kernels/pair_keys.hpp"
#include "src/api/batch_data.hpp"
#include "src/api/observations.hpp"

namespace manyworlds {

const char* to_string(Observer observer) {
  switch (observer) {
    case Observer::contacts: return "contacts";
    case Observer::touching: return "touching";
    case Observer::penetration: return "penetration";
    case Observer::motion: return "motion";
    case Observer::joints: return "joints";
    case Observer::joint_loads: return "joint_loads";
    case Observer::residual: return "residual";
  }
  return "?";
}

const char* to_string(Observed what) {
  switch (what) {
    case Observed::kinetic_energy: return "kinetic_energy";
    case Observed::potential_energy: return "potential_energy";
    case Observed::mass: return "mass";
    case Observed::momentum: return "momentum";
    case Observed::angular_momentum: return "angular_momentum";
    case Observed::mass_center: return "mass_center";
    case Observed::penetration: return "penetration";
    case Observed::contact_count: return "contact_count";
    case Observed::touching: return "touching";
    case Observed::joint_position: return "joint_position";
    case Observed::joint_speed: return "joint_speed";
    case Observed::joint_force: return "joint_force";
    case Observed::joint_torque: return "joint_torque";
    case Observed::residual: return "residual";
    case Observed::ray_distance: return "ray_distance";
    case Observed::ray_normal: return "ray_normal";
    case Observed::ray_body: return "ray_body";
    case Observed::ray_shape: return "ray_shape";
  }
  return "?";
}

std::size_t observed_size(Observed what, const PlanData& plan, std::size_t rays) {
  const bool planar = plan.scene.space == Space::planar;
  const std::size_t dim = planar ? 2 : 3, spins = planar ? 1 : 3;
  switch (what) {
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
  if (observers.contacts_per_world < 0) {
    reject("observe.contacts_per_world is " + std::to_string(observers.contacts_per_world) +
           ", must be >= 0");
  }
}

void check_rays(std::span<const Ray> rays, Space space, int bodies) {
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
    if (ray.body < -1 || ray.body >= bodies) {
      wrong("body", ray.body, "-1 to " + std::to_string(bodies - 1));
    }
  }
}

template <class Real>
PairNames names_of(const PlanData& plan, const kernels::WorldTables<Real>& t, std::int32_t key) {
  const kernels::PairOfKey pair = kernels::pair_of_key(t, key);
  const auto named = [&](const auto& a) {
    const PlanCollider& b = plan.colliders[static_cast<std::size_t>(pair.b)];
    return PairNames{a.scene_body, a.shape, b.scene_body, b.shape};
  };
  const auto a = static_cast<std::size_t>(pair.a);
  const bool fixed = is_fixed(t.pair_class[kernels::class_of_key(t, key)].list);
  return fixed ? named(plan.fixed[a]) : named(plan.colliders[a]);
}
template PairNames names_of(const PlanData&, const kernels::WorldTables<float>&, std::int32_t);
template PairNames names_of(const PlanData&, const kernels::WorldTables<double>&, std::int32_t);

}  // namespace manyworlds
