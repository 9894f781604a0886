#include "bench/peers/peer.hpp"

#include <time.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace manyworlds::peers {
namespace {

class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Options {
  std::vector<std::string> scenes;  // empty: all that the engine has
  int worlds = 1024, warm_up = 60, steps = 300, visit = 1;
  bool poses = false, list = false, help = false;
};

std::vector<std::string> scenes_of(const Engine& engine) {
  std::vector<std::string> names;
  for (const Scene& scene : scenes()) {
    if (scene.planar == engine.planar) names.emplace_back(scene.name);
  }
  return names;
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

int count(const std::string& option, const std::string& text, int least) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || value < least) {
    throw UsageError(option + ": must be a whole number of at least " + std::to_string(least) +
                     ", is '" + text + "'");
  }
  return value;
}

std::vector<std::string> scene_list(const std::string& text, const Engine& engine) {
  const std::vector<std::string> known = scenes_of(engine);
  std::vector<std::string> out;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    out.push_back(text.substr(from, comma - from));
    from = comma + 1;
    if (std::find(known.begin(), known.end(), out.back()) == known.end()) {
      throw UsageError(std::string("--scenes: ") + engine.name + " has no scene '" + out.back() +
                       "'; there are " + joined(known));
    }
  }
  return out;
}

Options parse(int argc, char** argv, const Engine& engine) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--list") {
      options.list = true;
      continue;
    }
    if (option == "--poses") {
      options.poses = true;
      continue;
    }
    if (option == "--help" || option == "-h") {
      options.help = true;
      continue;
    }
    const bool known = option == "--scenes" || option == "--worlds" || option == "--warm-up" ||
                       option == "--steps" || option == "--visit";
    if (!known) throw UsageError("unknown argument '" + option + "'; see --help");
    if (i + 1 == argc) throw UsageError(option + ": a value is missing");
    const std::string value = argv[++i];
    if (option == "--scenes") options.scenes = scene_list(value, engine);
    if (option == "--worlds") options.worlds = count(option, value, 1);
    if (option == "--warm-up") options.warm_up = count(option, value, 0);
    if (option == "--steps") options.steps = count(option, value, 1);
    if (option == "--visit") options.visit = count(option, value, 1);
  }
  if (options.scenes.empty()) options.scenes = scenes_of(engine);
  return options;
}

// `visit` steps of a world, then of the next.
void step_all(const Simulations& worlds, Together* together, int steps, int visit) {
  for (int done = 0; done < steps; done += visit) {
    const int now = std::min(visit, steps - done);
    if (together != nullptr) {
      together->step(now);
      continue;
    }
    for (const auto& world : worlds) {
      for (int s = 0; s < now; ++s) world->step();
    }
  }
}

// Of this process, s: other work on the machine takes less of it than of the time on the clock.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// null for what is not finite.
std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "null";
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

// A speed is none when bodies fell through the floor, or what stands fell over.
void require_sane(const std::string& scene, const World& world, const std::vector<Pose>& poses) {
  if (world.chain) return;
  double lowest = 1e300, highest = -1e300;
  for (const Pose& pose : poses) {
    const double height = pose.position[world.planar ? 1 : 2];
    lowest = std::min(lowest, height), highest = std::max(highest, height);
  }
  if (lowest >= 0 && highest >= world.stands) return;
  throw std::runtime_error(scene + ": ends with bodies at heights from " + std::to_string(lowest) +
                           " to " + std::to_string(highest) + " m");
}

// "x,y,angle" or "x,y,z,w,x,y,z" of each body, one after the other.
void append(std::string& out, const World& world, const std::vector<Pose>& poses) {
  constexpr int kDigits = 9;
  const auto add = [&](double value) {
    if (!out.empty() && out.back() != '[') out += ',';
    out += number(value, kDigits);
  };
  for (const Pose& pose : poses) {
    for (int i = 0; i < (world.planar ? 2 : 3); ++i) {
      add(pose.position[static_cast<std::size_t>(i)]);
    }
    if (world.planar) {
      add(pose.angle);
    } else {
      for (const double component : pose.rotation) add(component);
    }
  }
}

void measure(const std::string& scene, const Options& options, const Engine& engine) {
  Simulations worlds;
  for (int i = 0; i < options.worlds; ++i) worlds.push_back(engine.make(draw(scene, i)));
  const auto together = engine.together ? engine.together(worlds) : nullptr;
  step_all(worlds, together.get(), options.warm_up, options.visit);
  const double start = processor_seconds();
  step_all(worlds, together.get(), options.steps, options.visit);
  const double seconds = processor_seconds() - start;
  if (together) together->finish();

  const World world = draw(scene, 0);
  std::string poses = "[";
  for (const auto& w : worlds) {
    const std::vector<Pose> now = w->poses();
    require_sane(scene, world, now);
    if (options.poses) append(poses, world, now);
  }
  const double speed = static_cast<double>(options.worlds) * options.steps / seconds;
  std::printf(
      "{\"engine\": \"%s\", \"version\": \"%s\", \"scene\": \"%s\", \"worlds\": %d, \"steps\": %d, "
      "\"visit\": %d, \"seconds\": %s, \"world_steps_per_s\": %s, \"settings\": \"%s\"%s%s%s}\n",
      engine.name, engine.version.c_str(), scene.c_str(), options.worlds, options.steps,
      options.visit, number(seconds, 6).c_str(), number(speed, 6).c_str(),
      engine.settings(world).c_str(), options.poses ? ", \"poses\": " : "",
      options.poses ? poses.c_str() : "", options.poses ? "]" : "");
  std::fflush(stdout);
}

void print_help(const char* program, const Engine& engine) {
  std::printf(
      "usage: %s [--scenes A,B,...] [--worlds N] [--warm-up N] [--steps N] [--visit N] [--poses]\n"
      "       | --list\n"
      "Steps N worlds (1024) of each scene (all) round robin on one thread with %s %s: warm-up\n"
      "steps (60), then timed ones (300), of 1/60 s, --visit (1) of them before the next world's.\n"
      "Prints a line of JSON for each scene, with where all bodies are after the last step: "
      "--poses.\n"
      "--list prints the scenes: %s.\n",
      program, engine.name, engine.version.c_str(), joined(scenes_of(engine)).c_str());
}

}  // namespace

int run_peer(int argc, char** argv, const Engine& engine) {
  const std::string path = argv[0];
  const std::string program = path.substr(path.rfind('/') + 1);  // npos + 1 is 0
  try {
    const Options options = parse(argc, argv, engine);
    if (options.help) {
      print_help(program.c_str(), engine);
    } else if (options.list) {
      for (const std::string& name : scenes_of(engine)) std::printf("%s\n", name.c_str());
    } else {
      for (const std::string& scene : options.scenes) measure(scene, options, engine);
    }
  } catch (const UsageError& error) {
    std::fprintf(stderr, "%s: %s\n", program.c_str(), error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program.c_str(), error.what());
    return 1;
  }
  return 0;
}

}  // namespace manyworlds::peers
