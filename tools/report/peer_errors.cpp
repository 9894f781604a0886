#include "tools/report/peer_errors.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "manyworlds/scenes.hpp"
#include "tools/base/joint_gap.hpp"
#include "tools/report/peer_program.hpp"

namespace manyworlds::report {

PeerErrors errors_of(const Batch& batch) {
  if (!batch.plan().scene().joints.empty()) return {{}, tools::max_joint_gap(batch)};
  return {batch.measure_contacts().max_penetration, {}};
}

PeerErrors errors_of(const std::string& scene, int worlds, const std::vector<double>& poses) {
  BatchOptions options;
  options.worlds = worlds, options.threads = 1;
  Batch batch(compile(scenes::find(scene)->make()), options);
  const bool planar = batch.plan().scene().space == Space::planar;
  const std::size_t axes = planar ? 2 : 3, numbers = planar ? 3 : 7;
  const std::size_t bodies = static_cast<std::size_t>(batch.plan().bodies());
  const std::size_t wanted = static_cast<std::size_t>(worlds) * bodies * numbers;
  if (poses.size() != wanted) {
    throw PeerError(fmt::format("its poses are {} numbers, expected {} ({} worlds of {} bodies)",
                                poses.size(), wanted, worlds, bodies));
  }
  if (!std::all_of(poses.begin(), poses.end(), [](double x) { return std::isfinite(x); })) {
    throw PeerError("its poses are not finite");
  }
  std::vector<double> positions(bodies * axes);
  // Scenes whose bodies cannot be told from turned ones have no such field.
  std::vector<double> orientations(batch.size(Field::orientation) /
                                   static_cast<std::size_t>(worlds));
  const double* from = poses.data();
  for (int world = 0; world < worlds; ++world) {
    for (std::size_t b = 0; b < bodies; ++b, from += numbers) {
      std::copy_n(from, axes, &positions[b * axes]);
      if (orientations.empty()) continue;
      if (planar) {
        orientations[2 * b] = std::cos(from[2]), orientations[2 * b + 1] = std::sin(from[2]);
      } else {
        std::copy_n(from + 3, 4, &orientations[4 * b]);
      }
    }
    batch.write(Field::position, world, positions);
    if (!orientations.empty()) batch.write(Field::orientation, world, orientations);
  }
  return errors_of(batch);
}

}  // namespace manyworlds::report
