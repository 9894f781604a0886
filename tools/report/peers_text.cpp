// The comparison with other engines as text.
#include <optional>
#include <string>

#include <fmt/format.h>

#include "tools/base/text.hpp"
#include "tools/report/peers.hpp"

namespace manyworlds::report {
namespace {

std::string protocol_text(const Peers& peers) {
  return fmt::format(
      "{} worlds on one thread, round robin, {} steps of 1/60 s after 60 to warm up, no sleep; by "
      "processor time, alternating in one run, {}",
      peers.worlds, peers.steps,
      peers.rounds == 1 ? "once" : fmt::format("median of {} rounds", peers.rounds));
}

// "overlap 2.57 mm"
std::string error_text(const PeerErrors& errors) {
  if (errors.gap) return "gap " + tools::length(*errors.gap);
  return errors.overlap ? "overlap " + tools::length(*errors.overlap) : "error unknown";
}

std::string ratio_text(double ratio) { return fmt::format("{:.3g} x", ratio); }

// A row of the table; empty cells for what is not there.
std::string row_text(const std::string& scene, const std::string& engine, double speed,
                     const std::optional<double>& ratio, const std::optional<double>& long_speed,
                     const std::optional<double>& long_ratio, const PeerErrors& errors) {
  const auto ratio_or_none = [](const std::optional<double>& r) {
    return r ? ratio_text(*r) : std::string();
  };
  return fmt::format("  {:<12} {:<19} {:>12} {:>10} {:>12} {:>10}  {}\n", scene, engine,
                     tools::speed_text(speed), ratio_or_none(ratio),
                     long_speed ? tools::speed_text(*long_speed) : std::string(),
                     ratio_or_none(long_ratio), error_text(errors));
}

std::string scene_text(const PeerScene& scene) {
  std::string out = row_text(scene.scene, "manyworlds", scene.world_steps_per_s, {},
                             scene.long_visit, {}, scene.errors);
  for (const PeerRow& row : scene.engines) {
    std::optional<double> long_speed, long_ratio;
    if (row.long_visit) {
      long_speed = row.long_visit->world_steps_per_s, long_ratio = row.long_visit->ratio;
    }
    out += row_text("", row.engine + ' ' + row.version, row.speed.world_steps_per_s,
                    row.speed.ratio, long_speed, long_ratio, row.errors);
  }
  return out;
}

}  // namespace

std::string peers_text(const Peers& peers) {
  std::string out = fmt::format("\npeers: {}\n", protocol_text(peers));
  out += fmt::format("  {:<12} {:<19} {:>12} {:>10} {:>12} {:>10}  {}\n", "scene", "engine",
                     "steps/s", "manyworlds", fmt::format("{} a visit", kLongVisit), "manyworlds",
                     "worst, last step");
  for (const PeerScene& scene : peers.scenes) out += scene_text(scene);
  const PeerMeans means = means_of(peers);
  if (means.ratio) {
    out += fmt::format("  manyworlds to the fastest engine of each scene, geometric mean: {}",
                       ratio_text(*means.ratio));
    if (means.long_visit) {
      out += fmt::format(", {} with {} steps a visit", ratio_text(*means.long_visit), kLongVisit);
    }
    out += '\n';
  }
  for (const std::string& failure : peers.failures) out += "  " + failure + '\n';
  return out;
}

}  // namespace manyworlds::report
