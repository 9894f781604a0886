#include "tools/report/peers.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "manyworlds/batch.hpp"
#include "manyworlds/scenes.hpp"
#include "tools/base/interrupt.hpp"
#include "tools/base/median.hpp"
#include "tools/report/peer_program.hpp"
#include "tools/report/plan_worth.hpp"

namespace manyworlds::report {
namespace {

constexpr int kWarmUp = 60;
// Engines below this share of the fastest one's speed take part in the first round only, and not in
// long visits: their figures are of no use for a comparison with the best and take most of the
// time.
constexpr double kSlow = 1.0 / 3;

PeerProtocol protocol_of(const Peers& peers, int visit) {
  return {peers.worlds, kWarmUp, peers.steps, visit};
}

// manyworlds in the same scene, `visit` steps per call.
class Own {
 public:
  Own(const std::string& scene, int worlds)
      : batch_(compile(scenes::find(scene)->make()), options(worlds)) {}

  double speed(const PeerProtocol& protocol) {
    // What peers take seconds for may be over in milliseconds.
    constexpr double kMinSeconds = 0.1;  // s
    double seconds = 0;
    int runs = 0;
    for (; seconds < kMinSeconds; ++runs) {
      batch_.reset();
      step(protocol.warm_up, protocol.visit);
      const double start = processor_seconds();
      step(protocol.steps, protocol.visit);
      seconds += processor_seconds() - start;
    }
    return static_cast<double>(batch_.worlds()) * protocol.steps * runs / seconds;
  }

  PeerErrors errors() const { return errors_of(batch_); }

 private:
  static BatchOptions options(int worlds) {
    BatchOptions out;
    out.worlds = worlds, out.threads = 1;
    return out;
  }
  void step(int steps, int visit) {
    for (int done = 0; done < steps; done += visit) batch_.step(std::min(visit, steps - done));
  }
  Batch batch_;
};

// What was measured of one engine so far.
struct Runs {
  const PeerProgram* program;
  bool failed = false;
  PeerResult last;
  std::optional<PeerErrors> errors;
  std::vector<double> speeds, ratios, long_speeds, long_ratios;
};

class Comparison {
 public:
  Comparison(const std::string& scene, const std::vector<const PeerProgram*>& programs, Peers& out)
      : scene_(scene), out_(out), own_(scene, out.worlds) {
    for (const PeerProgram* program : programs)
      runs_.push_back({program, false, {}, {}, {}, {}, {}, {}});
  }

  void round(int index) {
    visit(1, index > 0);
    visit(kLongVisit, true);
  }

  PeerScene result() const {
    PeerScene out;
    out.scene = scene_;
    out.world_steps_per_s = tools::median(speeds_), out.long_visit = tools::median(long_speeds_);
    out.errors = own_.errors();
    for (const Runs& r : runs_) {
      if (r.failed) continue;
      PeerRow row;
      row.engine = r.last.engine, row.version = r.last.version, row.settings = r.last.settings;
      row.rounds = static_cast<int>(r.speeds.size());
      row.speed = {tools::median(r.speeds), tools::median(r.ratios)};
      if (!r.long_speeds.empty()) {
        row.long_visit = {tools::median(r.long_speeds), tools::median(r.long_ratios)};
      }
      row.errors = *r.errors;
      out.engines.push_back(std::move(row));
    }
    std::stable_sort(out.engines.begin(), out.engines.end(), [](const auto& a, const auto& b) {
      return a.speed.world_steps_per_s > b.speed.world_steps_per_s;
    });
    return out;
  }

 private:
  // The engines that still work, alternately with manyworlds before and after each of them: the
  // machine drifts, and what both sides of a ratio share of it cancels.
  void visit(int steps, bool fast_only) {
    const PeerProtocol protocol = protocol_of(out_, steps);
    const bool is_long = steps > 1;
    std::vector<double>& own_speeds = is_long ? long_speeds_ : speeds_;
    own_speeds.push_back(own_.speed(protocol));
    const double least = fast_only ? kSlow * fastest() : 0;
    for (Runs& r : runs_) {
      tools::stop_if_interrupted();
      if (r.failed || (fast_only && r.speeds.front() < least)) continue;
      if (!run(r, protocol)) continue;
      const double before = own_speeds.back(), speed = r.last.world_steps_per_s;
      own_speeds.push_back(own_.speed(protocol));
      (is_long ? r.long_speeds : r.speeds).push_back(speed);
      (is_long ? r.long_ratios : r.ratios).push_back(0.5 * (before + own_speeds.back()) / speed);
    }
  }

  bool run(Runs& r, const PeerProtocol& protocol) {
    try {
      r.last = run_peer(*r.program, scene_, protocol);
      // Of worlds that are stepped alike, whatever the visit.
      if (!r.errors) r.errors = errors_of(scene_, protocol.worlds, r.last.poses);
      return true;
    } catch (const PeerError& error) {
      out_.failures.push_back(
          fmt::format("{} failed: {}: {}", r.program->name, scene_, error.what()));
      r.failed = true;
      return false;
    }
  }

  double fastest() const {
    double most = 0;
    for (const Runs& r : runs_) {
      if (!r.failed && !r.speeds.empty()) most = std::max(most, r.speeds.front());
    }
    return most;
  }

  std::string scene_;
  Peers& out_;
  Own own_;
  std::vector<double> speeds_, long_speeds_;
  std::vector<Runs> runs_;
};

std::vector<PeerProgram> listed(const std::string& folder, std::vector<std::string>& failures) {
  std::vector<PeerProgram> out;
  for (const std::string& path : find_peers(folder)) {
    try {
      out.push_back(list_peer(path));
    } catch (const PeerError& error) {
      failures.push_back(
          fmt::format("{} failed: --list: {}", path.substr(path.rfind('/') + 1), error.what()));
    }
  }
  return out;
}

nlohmann::ordered_json number_or_null(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

void run_peers(const PeerOptions& options,
               const std::function<void(const std::string&, double)>& tell, Peers& out) {
  out.worlds = options.quick ? 128 : 1024;
  out.steps = options.quick ? 60 : 300;
  out.rounds = options.quick ? 1 : 3;
  const std::vector<PeerProgram> peers = listed(options.folder, out.failures);
  std::vector<std::string> names;
  for (const scenes::Entry& entry : scenes::all()) {
    const std::string name = entry.name;
    const auto& wanted = options.scenes;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
    if (std::any_of(peers.begin(), peers.end(), [&](const auto& p) { return p.has(name); })) {
      names.push_back(name);
    }
  }
  const double parts = static_cast<double>(names.size()) * out.rounds;
  double done = 0;
  for (const std::string& name : names) {
    std::vector<const PeerProgram*> those;
    for (const PeerProgram& peer : peers) {
      if (peer.has(name)) those.push_back(&peer);
    }
    Comparison comparison(name, those, out);
    for (int round = 0; round < out.rounds; ++round, ++done) {
      tell("peers " + name, done / parts);
      comparison.round(round);
    }
    out.scenes.push_back(comparison.result());
  }
}

PeerMeans means_of(const Peers& peers) {
  double one = 0, many = 0;
  int ones = 0, manies = 0;
  for (const PeerScene& scene : peers.scenes) {
    if (scene.engines.empty()) continue;
    one += std::log(scene.engines.front().speed.ratio), ++ones;
    const PeerSpeed* best = nullptr;
    for (const PeerRow& row : scene.engines) {
      if (!row.long_visit) continue;
      if (best == nullptr || row.long_visit->world_steps_per_s > best->world_steps_per_s) {
        best = &*row.long_visit;
      }
    }
    if (best != nullptr) many += std::log(best->ratio), ++manies;
  }
  PeerMeans out;
  if (ones > 0) out.ratio = std::exp(one / ones);
  if (manies > 0) out.long_visit = std::exp(many / manies);
  return out;
}

nlohmann::ordered_json to_json(const PeerScene& scene) {
  nlohmann::ordered_json engines = nlohmann::ordered_json::array();
  for (const PeerRow& r : scene.engines) {
    nlohmann::ordered_json row = {{"engine", r.engine},
                                  {"version", r.version},
                                  {"rounds", r.rounds},
                                  {"world_steps_per_s", r.speed.world_steps_per_s},
                                  {"ratio", r.speed.ratio},
                                  {"long_visit", nullptr},
                                  {"worst_overlap_m", number_or_null(r.errors.overlap)},
                                  {"worst_gap_m", number_or_null(r.errors.gap)},
                                  {"settings", r.settings}};
    if (r.long_visit) {
      row["long_visit"] = {{"world_steps_per_s", r.long_visit->world_steps_per_s},
                           {"ratio", r.long_visit->ratio}};
    }
    engines.push_back(std::move(row));
  }
  return {{"scene", scene.scene},
          {"world_steps_per_s", scene.world_steps_per_s},
          {"long_visit", scene.long_visit},
          {"worst_overlap_m", number_or_null(scene.errors.overlap)},
          {"worst_gap_m", number_or_null(scene.errors.gap)},
          {"engines", engines}};
}

nlohmann::ordered_json to_json(const PeerMeans& means) {
  return {{"ratio", number_or_null(means.ratio)}, {"long_visit", number_or_null(means.long_visit)}};
}

}  // namespace manyworlds::report
