#include "tools/report/peer_program.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/base/interrupt.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

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

}  // namespace

bool PeerProgram::has(const std::string& scene) const {
  return std::find(scenes.begin(), scenes.end(), scene) != scenes.end();
}

std::vector<std::string> find_peers(const std::string& folder) {
  std::vector<std::string> out;
  std::error_code error, no_file;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string path = it->path().string();
    if (!it->path().filename().string().starts_with("peer_")) continue;
    if (it->is_regular_file(no_file) && access(path.c_str(), X_OK) == 0) out.push_back(path);
  }
  const std::string named = "--peers: '" + folder + "': ";
  if (error == std::errc::not_a_directory) throw std::invalid_argument(named + "is not a folder");
  if (error) throw std::invalid_argument(named + "cannot be read: " + error.message());
  if (out.empty()) {
    throw std::invalid_argument(named + "it contains no program peer_*; tools/peers builds them");
  }
  std::sort(out.begin(), out.end());
  return out;
}

PeerProgram list_peer(const std::string& path) {
  return {path, fs::path(path).filename().string(), output_of(path, "--list")};
}

PeerResult run_peer(const PeerProgram& peer, const std::string& scene,
                    const PeerProtocol& protocol) {
  const std::vector<std::string> lines = output_of(
      peer.path,
      fmt::format("--scenes {} --worlds {} --warm-up {} --steps {} --visit {} --poses", scene,
                  protocol.worlds, protocol.warm_up, protocol.steps, protocol.visit));
  for (const std::string& line : lines) {
    const Json json = Json::parse(line, nullptr, false);
    if (!json.is_object()) continue;  // something that an engine says on its own account
    try {
      if (json.at("scene") != scene) continue;
      PeerResult out;
      out.engine = json.at("engine"), out.version = json.at("version");
      out.settings = json.value("settings", "");
      out.world_steps_per_s = json.at("world_steps_per_s");
      out.poses = json.at("poses").get<std::vector<double>>();
      if (!(out.world_steps_per_s > 0)) throw PeerError("its speed must be above 0");
      return out;
    } catch (const Json::exception& error) {
      throw PeerError(printable(error.what()));
    }
  }
  throw PeerError("it printed no result");
}

}  // namespace manyworlds::report
