// `manyworlds view --live`: worlds in a browser while they step.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "not_built.hpp"

#ifdef MW_HAVE_LIVE
#include "job.hpp"
#include "manyworlds/live.hpp"
#include "tools/base/interrupt.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"
#include "view_page.hpp"
#endif

namespace manyworlds::cli {

#ifdef MW_HAVE_LIVE

namespace {

using tools::counted;

constexpr int kWorlds = 64;             // unless --worlds says otherwise
constexpr double kLeastGravity = 9.81;  // m/s^2, to either side of a scene that has none

double parse_speed(const std::string& text) {
  if (text == "max") return std::numeric_limits<double>::infinity();
  double speed = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, speed);
  if (error == std::errc{} && stop == end && speed >= 0.001 && speed <= 1e4) return speed;
  throw InputError(fmt::format("--speed: must be 0.001 to 10000, or max, is '{}'", text));
}

bool varies(const Scene& scene, Parameter parameter) {
  return std::any_of(scene.variations.begin(), scene.variations.end(),
                     [&](const Variation& v) { return v.parameter == parameter; });
}

// What the page's sliders of gravity and friction are compiled with.
Variation gravity_slider(const Scene& scene) {
  const Vec3& g = scene.options.gravity;
  const double most = 2 * std::max(g.norm(), kLeastGravity);
  Variation v;
  v.parameter = Parameter::gravity;
  v.draw = Draw::none;
  v.low = g.cwiseMin(-g), v.high = g.cwiseMax(-g);
  const int up = scene.space == Space::planar ? 1 : 2;
  for (int axis = 0; axis < 3; ++axis) {
    if (g[axis] != 0 || (g.isZero() && axis == up)) v.low[axis] = -most, v.high[axis] = most;
  }
  return v;
}

std::optional<Variation> friction_slider(const Scene& scene) {
  double most = 0;
  for (const Body& body : scene.bodies) {
    for (const Shape& shape : body.shapes) most = std::max(most, shape.material.friction);
  }
  if (most == 0) return std::nullopt;
  return vary(Parameter::friction, 0, 2 * most, Draw::none);
}

// Compiled with as many sliders as the scene takes; `names` says which.
Job prepare_with_sliders(const JobOptions& options, std::vector<std::string>& names) {
  std::vector<std::string> warnings;
  Job plain = prepare(options, &warnings);
  for (const std::string& warning : warnings) tools::tell("{}\n", warning);
  const Scene& scene = plain.plan.scene();
  std::vector<Variation> wanted;
  if (!varies(scene, Parameter::gravity)) wanted.push_back(gravity_slider(scene));
  if (const auto v = friction_slider(scene); v && !varies(scene, Parameter::friction)) {
    wanted.push_back(*v);
  }
  std::vector<Variation> taken;
  for (const Variation& one : wanted) {
    std::vector<Variation> tried = taken;
    tried.push_back(one);
    try {
      plain = prepare(options, nullptr, [&](Scene& changed) {
        changed.variations.insert(changed.variations.end(), tried.begin(), tried.end());
      });
      taken = tried;
      names.emplace_back(info(one.parameter).name);
    } catch (const SceneError&) {  // such scenes have no such slider
    }
  }
  return plain;
}

}  // namespace

int live_command(const ViewArguments& arguments) {
  if (arguments.sources.size() != 1) {
    throw InputError(
        fmt::format("--live: expects one scene, {} were given", arguments.sources.size()));
  }
  const std::string& source = arguments.sources.front();
  if (source.ends_with(".h5")) {
    throw InputError(
        fmt::format("--live: steps a scene or an MJCF file; '{}' is a recording", source));
  }
  const double speed = parse_speed(arguments.speed.value_or("1"));
  JobOptions options = arguments.job;
  options.scene = source;
  options.worlds = arguments.worlds > 0 ? arguments.worlds : kWorlds;
  LiveOptions live_options;
  live_options.page = empty_page();
  live_options.title = arguments.title;
  live_options.port = arguments.port;
  live_options.clock = live_options.resets = live_options.controls = true;
  live_options.parameters = true;
  std::vector<std::string> sliders;
  const Job job = prepare_with_sliders(options, sliders);
  const std::uint64_t seed = options.seed.value_or(0);
  Batch batch = make_batch(job, options, options.worlds, seed, options.threads);
  RandomControls controls = asked_controls(batch, options, seed);
  const tools::Interruptible interruptible;
  const auto open = [&]() -> Live {
    try {
      return Live(batch, live_options);
    } catch (const LiveError& error) {
      throw InputError(error.what());
    }
  };
  Live live = open();
  if (arguments.job.json) {
    const nlohmann::ordered_json json = {{"url", live.url()},
                                         {"port", live.port()},
                                         {"worlds", batch.worlds()},
                                         {"sliders", sliders}};
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    fmt::print("{}\n", live.url());
  }
  std::fflush(stdout);
  if (!sliders.empty()) {
    tools::tell("compiled with variable {} for the page's sliders\n", fmt::join(sliders, " and "));
  }
  tools::tell("{}; anyone with the address can view and control them; Ctrl-C ends the server\n",
              counted(batch.worlds(), "world"));
  LiveClock clock;
  clock.speed = speed;
  clock.paused = arguments.paused;
  bool random = arguments.job.random_controls;
  clock.before = [&](Batch& stepped) {
    if (!random) return std::numeric_limits<int>::max();
    controls.apply(stepped, stepped.steps());
    return controls.steps_until_next(stepped.steps());
  };
  clock.controls_set = [&] { random = false; };  // the page's own from then on
  live.run(batch, clock, [] { return tools::interrupted() == 0; });
  live.close();
  return kOk;
}

#else

int live_command(const ViewArguments&) {
  throw not_built("--live", "live pages",
                  "MW_LIVE=ON (requires Boost's headers, Debian: libboost-dev)");
}

#endif

}  // namespace manyworlds::cli
