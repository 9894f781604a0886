#include "tools/report/peers.hpp"
#include "tools/base/interrupt.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "manyworlds/batch.hpp"
#include "manyworlds/scenes.hpp"
#include "tools/base/joint_gap.hpp"
#include "tools/base/median.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kWarmUp = 60;

// What a peer did that it should not have; what() goes on after "peer_x failed: ".
class PeerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    if (end > from) out.push_back(text.substr(from, end - from));
    from = end + 1;
  }
  return out;
}

// JSON takes no bytes that are not text, and a line of a report is short.
std::string printable(std::string text) {
  constexpr std::size_t kMaxLength = 300;
  if (text.size() > kMaxLength) text.resize(kMaxLength);
  for (char& c : text) c = c < ' ' || c > '~' ? '?' : c;
  return text;
}

constexpr int kPatience = 900;  // s, for one scene
constexpr int kTimedOut = 124;  // what timeout (coreutils) exits with

// The lines that a program prints, to standard error as well: the last one says why it failed.
std::vector<std::string> output_of(const std::string& program, const std::string& arguments) {
  const std::string command = fmt::format("timeout {} {} {} 2>&1 </dev/null", kPatience,
                                          tools::shell_word(program), arguments);
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw PeerError("cannot be started");
  std::string text;
  char part[4096];
  while (const std::size_t n = std::fread(part, 1, sizeof part, pipe)) text.append(part, n);
  const int status = pclose(pipe);
  tools::stop_if_interrupted();  // of which the program has heard as well
  const std::vector<std::string> lines = lines_of(text);
  if (status == 0) return lines;
  const std::string why = lines.empty() ? "" : ": " + printable(lines.back());
  if (WIFEXITED(status) && WEXITSTATUS(status) == kTimedOut) {
    throw PeerError(fmt::format("not done after {} s", kPatience));
  }
  if (WIFEXITED(status)) {
    throw PeerError(fmt::format("exit status {}{}", WEXITSTATUS(status), why));
  }
  throw PeerError("ended by a signal" + why);
}

struct Peer {
  std::string path, name;
  std::vector<std::string> scenes;
  bool has(const std::string& scene) const {
    return std::find(scenes.begin(), scenes.end(), scene) != scenes.end();
  }
};

std::optional<double> number_or_none(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? std::nullopt : std::optional<double>(value.get<double>());
}

// One run; `ratio` is left to the caller.
PeerRow measure(const Peer& peer, const std::string& scene, const Peers& protocol) {
  const std::vector<std::string> lines =
      output_of(peer.path, fmt::format("--scenes {} --worlds {} --warm-up {} --steps {}", scene,
                                       protocol.worlds, kWarmUp, protocol.steps));
  for (const std::string& line : lines) {
    const Json json = Json::parse(line, nullptr, false);
    if (!json.is_object()) continue;  // something that an engine says on its own account
    try {
      if (json.at("scene") != scene) continue;
      PeerRow row;
      row.engine = json.at("engine"), row.version = json.at("version");
      row.settings = json.value("settings", "");
      row.world_steps_per_s = json.at("world_steps_per_s");
      row.errors = {number_or_none(json, "worst_overlap_m"), number_or_none(json, "worst_gap_m")};
      if (!(row.world_steps_per_s > 0)) throw PeerError("its speed is not above 0");
      return row;
    } catch (const Json::exception& error) {
      throw PeerError(printable(error.what()));
    }
  }
  throw PeerError("it printed no result");
}

// manyworlds in the same scene, a step per call.
class Own {
 public:
  Own(const std::string& scene, const Peers& protocol)
      : batch_(compile(scenes::find(scene)->make()), options(protocol)), steps_(protocol.steps) {}

  double speed() {
    using Clock = std::chrono::steady_clock;
    // What peers take seconds for may be over in milliseconds.
    constexpr double kMinSeconds = 0.1;  // s
    double seconds = 0;
    int runs = 0;
    for (; seconds < kMinSeconds; ++runs) {
      batch_.reset();
      for (int i = 0; i < kWarmUp; ++i) batch_.step();
      const auto start = Clock::now();
      for (int i = 0; i < steps_; ++i) batch_.step();
      seconds += std::chrono::duration<double>(Clock::now() - start).count();
    }
    return static_cast<double>(batch_.worlds()) * steps_ * runs / seconds;
  }

  PeerErrors errors() const {
    if (!batch_.plan().scene().joints.empty()) return {{}, tools::max_joint_gap(batch_)};
    return {batch_.measure_contacts().max_penetration, {}};
  }

 private:
  static BatchOptions options(const Peers& protocol) {
    BatchOptions out;
    out.worlds = protocol.worlds, out.threads = 1;
    return out;
  }
  Batch batch_;
  int steps_;
};

// The peers that still work, alternately with manyworlds before and after each of them: the machine
// drifts, and what both sides of a ratio share of it cancels.
PeerScene compare(const std::string& scene, std::vector<Peer> peers, Peers& out) {
  PeerScene result;
  result.scene = scene;
  Own own(scene, out);
  std::vector<double> speeds;
  struct Runs {
    PeerRow last;
    std::vector<double> speeds, ratios;
  };
  std::vector<Runs> runs(peers.size());
  std::vector<bool> failed(peers.size(), false);
  for (int round = 0; round < out.rounds; ++round) {
    speeds.push_back(own.speed());
    tools::stop_if_interrupted();
    for (std::size_t p = 0; p < peers.size(); ++p) {
      if (failed[p]) continue;
      try {
        runs[p].last = measure(peers[p], scene, out);
      } catch (const PeerError& error) {
        out.failures.push_back(
            fmt::format("{} failed: {}: {}", peers[p].name, scene, error.what()));
        failed[p] = true;
        continue;
      }
      const double before = speeds.back();
      speeds.push_back(own.speed());
      runs[p].speeds.push_back(runs[p].last.world_steps_per_s);
      runs[p].ratios.push_back(0.5 * (before + speeds.back()) / runs[p].speeds.back());
    }
  }
  result.world_steps_per_s = tools::median(speeds);
  result.errors = own.errors();
  for (std::size_t p = 0; p < peers.size(); ++p) {
    if (failed[p]) continue;
    PeerRow row = runs[p].last;
    row.world_steps_per_s = tools::median(runs[p].speeds);
    row.ratio = tools::median(runs[p].ratios);
    result.engines.push_back(std::move(row));
  }
  return result;
}

std::vector<Peer> listed(const std::string& folder, std::vector<std::string>& failures) {
  std::vector<Peer> out;
  for (const std::string& path : find_peers(folder)) {
    Peer peer{path, fs::path(path).filename().string(), {}};
    try {
      peer.scenes = output_of(path, "--list");
      out.push_back(std::move(peer));
    } catch (const PeerError& error) {
      failures.push_back(fmt::format("{} failed: --list: {}", peer.name, error.what()));
    }
  }
  return out;
}

nlohmann::ordered_json number_or_null(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::vector<std::string> find_peers(const std::string& folder) {
  std::vector<std::string> out;
  std::error_code error, no_file;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string path = it->path().string();
    if (!it->path().filename().string().starts_with("peer_")) continue;
    if (it->is_regular_file(no_file) && access(path.c_str(), X_OK) == 0) out.push_back(path);
  }
  const std::string named = "--peers: '" + folder + "': ";
  if (error == std::errc::not_a_directory) throw std::invalid_argument(named + "is no folder");
  if (error) throw std::invalid_argument(named + "cannot be read: " + error.message());
  if (out.empty()) {
    throw std::invalid_argument(named +
                                "there is no program peer_* in it; tools/peers builds them");
  }
  std::sort(out.begin(), out.end());
  return out;
}

void run_peers(const PeerOptions& options,
               const std::function<void(const std::string&, double)>& tell, Peers& out) {
  out.worlds = options.quick ? 128 : 1024;
  out.steps = options.quick ? 60 : 300;
  out.rounds = options.quick ? 1 : 3;
  const std::vector<Peer> peers = listed(options.folder, out.failures);
  std::vector<std::string> names;
  for (const scenes::Entry& entry : scenes::all()) {
    const std::string name = entry.name;
    const auto& wanted = options.scenes;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
    if (std::any_of(peers.begin(), peers.end(), [&](const Peer& p) { return p.has(name); })) {
      names.push_back(name);
    }
  }
  for (const std::string& name : names) {
    tell("peers " + name,
         static_cast<double>(out.scenes.size()) / static_cast<double>(names.size()));
    std::vector<Peer> those;
    std::copy_if(peers.begin(), peers.end(), std::back_inserter(those),
                 [&](const Peer& p) { return p.has(name); });
    out.scenes.push_back(compare(name, std::move(those), out));
  }
}

nlohmann::ordered_json to_json(const PeerScene& scene) {
  nlohmann::ordered_json engines = nlohmann::ordered_json::array();
  for (const PeerRow& r : scene.engines) {
    engines.push_back({{"engine", r.engine},
                       {"version", r.version},
                       {"world_steps_per_s", r.world_steps_per_s},
                       {"ratio", r.ratio},
                       {"worst_overlap_m", number_or_null(r.errors.overlap)},
                       {"worst_gap_m", number_or_null(r.errors.gap)},
                       {"settings", r.settings}});
  }
  return {{"scene", scene.scene},
          {"world_steps_per_s", scene.world_steps_per_s},
          {"worst_overlap_m", number_or_null(scene.errors.overlap)},
          {"worst_gap_m", number_or_null(scene.errors.gap)},
          {"engines", engines}};
}

}  // namespace manyworlds::report
