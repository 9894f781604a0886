// The comparison with other engines as text and as a section of a page.
#include <algorithm>

#include <fmt/format.h>

#include "tools/base/text.hpp"
#include "tools/report/page.hpp"
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

// Names with versions, in the order in which they first come.
std::vector<std::string> engines_of(const Peers& peers) {
  std::vector<std::string> out;
  for (const PeerScene& scene : peers.scenes) {
    for (const PeerRow& row : scene.engines) {
      const std::string name = row.engine + ' ' + row.version;
      if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
    }
  }
  return out;
}

}  // namespace

std::string peers_text(const Peers& peers) {
  std::string out = fmt::format("\npeers: {}\n", protocol_text(peers));
  out += fmt::format("  {:<14} {:<16} {:>12} {:>17}  {}\n", "scene", "engine", "steps/s",
                     "manyworlds/engine", "worst, last step");
  for (const PeerScene& scene : peers.scenes) {
    out += fmt::format("  {:<14} {:<16} {:>12} {:>17}  {}\n", scene.scene, "manyworlds",
                       speed_text(scene.world_steps_per_s), "", error_text(scene.errors));
    for (const PeerRow& row : scene.engines) {
      out += fmt::format("  {:<14} {:<16} {:>12} {:>17}  {}\n", "", row.engine + ' ' + row.version,
                         speed_text(row.world_steps_per_s), ratio_text(row.ratio),
                         error_text(row.errors));
    }
  }
  for (const std::string& failure : peers.failures) out += "  " + failure + '\n';
  return out;
}

std::string peers_html(const Peers& peers) {
  std::string out = "<h2>Beside other engines</h2><p>" + escaped(protocol_text(peers)) +
                    ". World-steps per second, how often as fast manyworlds is (median of the "
                    "rounds, each against manyworlds right before and after) in parentheses, and "
                    "the deepest overlap or widest joint gap of all worlds after the last "
                    "step.</p>";
  const std::vector<std::string> engines = engines_of(peers);
  std::vector<std::vector<std::string>> rows = {{"scene", "manyworlds"}};
  rows.front().insert(rows.front().end(), engines.begin(), engines.end());
  std::vector<std::string> notes;  // an engine with its settings, once
  for (const PeerScene& scene : peers.scenes) {
    std::vector<std::string> cells(2 + engines.size());
    cells[0] = scene.scene;
    cells[1] = speed_text(scene.world_steps_per_s) + ", " + error_text(scene.errors);
    for (const PeerRow& row : scene.engines) {
      const std::string name = row.engine + ' ' + row.version;
      const auto at = std::find(engines.begin(), engines.end(), name) - engines.begin();
      cells[2 + static_cast<std::size_t>(at)] =
          fmt::format("{} ({}), {}", speed_text(row.world_steps_per_s), ratio_text(row.ratio),
                      error_text(row.errors));
      const std::string note = name + ": " + row.settings;
      if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
    }
    rows.push_back(std::move(cells));
  }
  out += table(rows);
  for (const std::string& note : notes) out += "<p>" + escaped(note) + ".</p>";
  for (const std::string& failure : peers.failures) out += "<p>" + escaped(failure) + "</p>";
  return out;
}

}  // namespace manyworlds::report
