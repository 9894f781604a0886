// The comparison with other engines as text.
#include <fmt/format.h>

#include "tools/base/text.hpp"
#include "tools/report/peers.hpp"

namespace manyworlds::report {
namespace {

std::string protocol_text(const Peers& peers) {
  return fmt::format(
      "{} worlds on one thread, round robin, {} steps of 1/60 s after 60 to warm up, no sleep; in "
      "turns in one run, {}",
      peers.worlds, peers.steps,
      peers.rounds == 1 ? "once" : fmt::format("median of {} rounds", peers.rounds));
}

// "overlap 2.57 mm"
std::string error_text(const PeerErrors& errors) {
  if (errors.gap) return "gap " + tools::length(*errors.gap);
  return errors.overlap ? "overlap " + tools::length(*errors.overlap) : "error unknown";
}

std::string ratio_text(double ratio) { return fmt::format("{:.3g} x", ratio); }

}  // namespace

std::string peers_text(const Peers& peers) {
  std::string out = fmt::format("\npeers: {}\n", protocol_text(peers));
  out += fmt::format("  {:<14} {:<16} {:>12} {:>17}  {}\n", "scene", "engine", "steps/s",
                     "manyworlds/engine", "worst, last step");
  for (const PeerScene& scene : peers.scenes) {
    out += fmt::format("  {:<14} {:<16} {:>12} {:>17}  {}\n", scene.scene, "manyworlds",
                       tools::speed_text(scene.world_steps_per_s), "", error_text(scene.errors));
    for (const PeerRow& row : scene.engines) {
      out += fmt::format("  {:<14} {:<16} {:>12} {:>17}  {}\n", "", row.engine + ' ' + row.version,
                         tools::speed_text(row.world_steps_per_s), ratio_text(row.ratio),
                         error_text(row.errors));
    }
  }
  for (const std::string& failure : peers.failures) out += "  " + failure + '\n';
  return out;
}

}  // namespace manyworlds::report
