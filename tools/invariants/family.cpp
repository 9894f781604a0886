#include "tools/invariants/family.hpp"

namespace manyworlds::invariants {

Scale draw_scale(Random& random, Units units) {
  if (units == Units::earth) return {random.log_uniform(0.01, 100), 9.81, 1.0 / 60};
  const double length = random.log_uniform(1e-3, 100), gravity = 9.81 * random.log_uniform(0.1, 10);
  return {length, gravity, std::sqrt(length * 9.81 / gravity) / 60};
}

std::vector<Family> in_both_spaces(const Family& family, const DrawInSpace& draw) {
  std::vector<Family> out;
  for (const Space space : {Space::planar, Space::spatial}) {
    Family& f = out.emplace_back(family);
    f.id += space == Space::planar ? " 2D" : " 3D";
    f.draw = [draw, space](Random& kind, Random& state, const Scale& scale) {
      return draw(space, kind, state, scale);
    };
  }
  return out;
}

std::vector<Family> families() {
  std::vector<Family> out;
  for (auto& part : {symmetry_families(), momentum_families(), energy_families(),
                     friction_families(), rest_families(), penetration_families(),
                     similarity_families(), independence_families(), joint_families()}) {
    out.insert(out.end(), part.begin(), part.end());
  }
  return out;
}

}  // namespace manyworlds::invariants
