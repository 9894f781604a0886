// Pairs of free bodies on one joint of any type keep momentum and energy for a minute.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/support/tables.hpp"
#include "tools/invariants/joint_systems.hpp"
#include "tools/invariants/momenta.hpp"
#include "tools/invariants/similarity.hpp"

namespace manyworlds::test {

TEST_CASE("pairs on one joint in space keep momentum and energy for a minute", "[joint]") {
  constexpr int kPairs = 60, kSteps = 3600;
  for (const Table& table : widest_tables()) {
    for (const double spin : {0.01, 0.03}) {  // rad a step
      for (int pair = 0; pair < kPairs; ++pair) {
        tools::Random kind(static_cast<std::uint64_t>(1000 + pair)),
            state(static_cast<std::uint64_t>(77 + pair));
        const invariants::Scale scale{1, 9.81, 1.0 / 60};
        invariants::JointSystem system;
        system.space = Space::spatial, system.bodies = 2, system.mass_ratio = 10;
        Scene scene = invariants::draw_joints(kind, scale, system);
        invariants::set_moving(state, scene, spin / scale.dt);
        invariants::SideWorlds worlds(scene, table.precision);
        worlds.put(0, scene);
        const std::vector<MassProperties> masses = invariants::masses_of(scene);
        const auto look = [&] {
          return invariants::momenta_of(masses, {worlds.now(0, 0), worlds.now(0, 1)});
        };
        const invariants::Momenta start = look();
        double linear = 0, angular = 0, energy = 0;
        for (int i = 0; i < kSteps; i += 60) {
          worlds.step(60);
          const invariants::Momenta now = look();
          linear = std::max(linear, (now.linear - start.linear).norm() / start.linear_sum);
          angular = std::max(angular, (now.angular - start.angular).norm() / start.angular_sum);
          energy = std::max(energy, std::abs(now.kinetic / start.kinetic - 1));
        }
        INFO(name(table) << " pair " << pair << ", joint type " << scene.joints[0].type.index()
                         << ", rad a step: " << spin);
        // Rounding of 14,400 substeps, as a random walk.
        CHECK(linear < (table.precision == Precision::f32 ? 3e-5 : 1e-11));
        CHECK(angular < 1e-3);
        CHECK(energy < 1e-2);
      }
    }
  }
}

}  // namespace manyworlds::test
