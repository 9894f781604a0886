// `manyworlds view`: recordings as a page, those given or one that is made for it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "not_built.hpp"

#ifdef MW_HAVE_RECORD
#include "job.hpp"
#include "manyworlds/page.hpp"
#include "progress.hpp"
#include "recording.hpp"
#include "src/base/scratch_folder.hpp"
#include "tools/base/interrupt.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"
#include "view_frames.hpp"
#include "view_page.hpp"
#endif

namespace manyworlds::cli {

#ifdef MW_HAVE_RECORD

namespace {

namespace fs = std::filesystem;
using tools::counted, tools::with_prefix;

// Of a recording that is made here, unless --worlds says otherwise: what makes a page of some 10
// MB.
constexpr double kMaxPoses = 2.5e6;
constexpr int kMaxWorlds = 256;

// A recording that was made here and ended early.
struct Cut {
  std::string scene;
  int steps = 0, wanted = 0;
};
std::string text_of(const Cut& cut) {
  return fmt::format("after {} of {} of {}", cut.steps, counted(cut.wanted, "step"), cut.scene);
}

// Steps a scene and records it in `file`; says where a signal ended it early.
std::optional<Cut> record(const ViewArguments& arguments, double samples_per_second,
                          const std::string& scene, const fs::path& file) {
  JobOptions options = arguments.job;
  options.scene = scene;
  if (!options.seconds) options.seconds = arguments.seconds;
  const Job job = prepare(options);
  const double dt = job.plan.scene().options.dt;
  options.record = file.string();
  options.record_every = std::max(1, static_cast<int>(std::lround(1 / (samples_per_second * dt))));
  options.record_contacts = arguments.contacts;
  if (arguments.worlds > 0) {
    options.worlds = arguments.worlds;
  } else {
    const double frames = static_cast<double>(job.steps) / options.record_every + 1;
    const double each = frames * std::max(1, job.plan.bodies());
    options.worlds = static_cast<int>(std::clamp(kMaxPoses / each, 1.0, double{kMaxWorlds}));
  }
  options.record_worlds = fmt::format("0-{}", options.worlds - 1);
  const std::uint64_t seed = options.seed.value_or(0);
  Batch batch = make_batch(job, options, options.worlds, seed, options.threads);
  const RandomControls controls = asked_controls(batch, options, seed);
  const tools::Interruptible interruptible;
  JobRecorder recorder(batch, options);
  Timed done;
  {
    Progress progress(scene, job.steps);
    done = timed_steps(batch, job.steps, steps_per_call(options), &progress, controls);
  }
  recorder.finish(batch);
  if (!recorder.failure().empty()) throw InputError(recorder.failure());
  if (done.steps == job.steps) return std::nullopt;
  return Cut{scene, done.steps, job.steps};
}

bool is_recording(const std::string& source) {
  return source.ends_with(".h5") || source.find(".h5.part-") != std::string::npos;
}

void print_json(const nlohmann::ordered_json& json) {
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

// `written`: the files that are whole, of those that were to be written.
int tell_interrupted(const ViewArguments& arguments, const std::vector<std::string>& written) {
  if (arguments.job.json) {
    print_json({{"interrupted", tools::interrupt_name()}, {"written", written}});
    std::fflush(stdout);
  }
  tools::tell("manyworlds: {}: nothing {}was written\n", tools::interrupt_name(),
              written.empty() ? "" : fmt::format("but {} ", fmt::join(written, ", ")));
  return tools::interrupt_code();
}

int tell_cut(const Cut& cut, const fs::path& page) {
  std::fflush(stdout);
  tools::tell("manyworlds: interrupted by {} {}; {} shows the steps until then\n",
              tools::interrupt_name(), text_of(cut), page.string());
  return tools::interrupt_code();
}

// What the page is called that --out does not name.
std::string page_name(const std::string& source) {
  std::string name = fs::path(source).stem().string();
  std::replace(name.begin(), name.end(), ':', '-');
  return name + ".html";
}

}  // namespace

int view_command(const ViewArguments& arguments) {
  if (arguments.live && (arguments.at || arguments.until)) {
    throw InputError("--at, --until: exclude --live");
  }
  if (arguments.live) return live_command(arguments);
  const FramesWanted wanted = frames_wanted(arguments);
  const fs::path empty = empty_page();
  const auto before = std::chrono::steady_clock::now();
  const tools::Interruptible interruptible;
  std::vector<Recording> recordings;
  std::optional<Cut> cut;
  bool made_here = false;
  for (const std::string& source : arguments.sources) {
    if (cut) break;  // those after it would have no steps at all
    if (is_recording(source)) {
      recordings.push_back(Recording::open(source));
    } else {
      const ScratchFolder folder;
      const fs::path file = folder / "run.h5";
      cut = record(arguments, wanted.samples_per_second, source, file);
      made_here = true;
      recordings.push_back(Recording::open(file));
    }
  }
  std::vector<const Recording*> all;
  for (const Recording& one : recordings) all.push_back(&one);
  // What was recorded until Ctrl-C makes a page, but neither picture nor film.
  const bool cut_short = made_here && tools::interrupted() != 0;
  if (cut_short && wanted.any()) return tell_interrupted(arguments, {});
  PageOptions options;
  options.title = arguments.title;
  if (cut) {
    const std::string& name = recordings.front().plan().scene().name;
    options.title = fmt::format("{}, interrupted {}",
                                arguments.title.empty() ? name : arguments.title, text_of(*cut));
  }
  options.max_worlds = arguments.worlds;
  options.every = arguments.every;
  options.go_on = [cut_short] { return cut_short || tools::interrupted() == 0; };
  const bool unnamed = wanted.any() && arguments.out.empty();  // of pictures and films alone
  std::optional<ScratchFolder> folder;
  if (arguments.out.empty()) folder.emplace();
  const fs::path out = !folder   ? fs::path(arguments.out)
                       : unnamed ? folder->path() / "page.html"
                                 : folder->path() / page_name(arguments.sources.front());
  const PageReport page = write_page(all, empty, out, options);
  std::vector<std::string> written;
  if (!page.written) return tell_interrupted(arguments, written);
  if (!unnamed) written.push_back(out.string());
  if (folder && !unnamed) folder->keep();  // for the browser that opens it
  FilmReport film;
  if (wanted.picture) {
    const PictureOptions picture{
        .frame = wanted.frame, .time = wanted.time, .go_on = options.go_on};
    if (!write_picture(out, arguments.png, picture)) return tell_interrupted(arguments, written);
    written.push_back(arguments.png);
  }
  if (wanted.film) {
    film = make_film(out, arguments, wanted);
    if (!film.written) return tell_interrupted(arguments, written);
  }
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - before;
  const bool opened =
      !unnamed && (arguments.out.empty() || arguments.open) && open_in_browser(fs::absolute(out));
  if (arguments.job.json) {
    nlohmann::ordered_json json;
    if (!unnamed) json["page"] = out.string();
    if (wanted.picture) json["picture"] = arguments.png;
    if (wanted.film) {
      json["film"] = {{"file", arguments.mp4},
                      {"frames", film.frames},
                      {"seconds", film.seconds},
                      {"bytes", film.bytes}};
    }
    json.update({{"worlds", page.worlds},
                 {"bodies", page.bodies},
                 {"frames", page.frames},
                 {"bytes", page.bytes},
                 {"seconds", spent.count()},
                 {"opened", opened}});
    if (cut) {
      json["interrupted"] = tools::interrupt_name();
      json["cut"] = {{"scene", cut->scene}, {"steps", cut->steps}, {"of", cut->wanted}};
    }
    print_json(json);
    return cut ? tell_cut(*cut, out) : kOk;
  }
  std::vector<std::string> made;
  if (!unnamed) made.push_back(out.string());
  if (wanted.picture) made.push_back(arguments.png);
  if (!made.empty()) {
    fmt::print("{}: {}, {} moving bodies, {}, {}B, {:.2f} s\n", fmt::join(made, ", "),
               counted(page.worlds, "world"), page.bodies,
               counted(static_cast<int>(page.frames), "frame"),
               with_prefix(static_cast<double>(page.bytes)), spent.count());
  }
  if (wanted.film) {
    fmt::print("{}: {}, {} moving bodies, {}, {:.2f} s of film, {}B, {:.1f} s\n", arguments.mp4,
               counted(page.worlds, "world"), page.bodies,
               counted(static_cast<int>(film.frames), "frame"), film.seconds,
               with_prefix(static_cast<double>(film.bytes)), spent.count());
  }
  if (!opened && !unnamed && (arguments.out.empty() || arguments.open)) {
    fmt::print("no desktop to open it on: open {} in a browser\n", fs::absolute(out).string());
  }
  return cut ? tell_cut(*cut, out) : kOk;
}

#else

int view_command(const ViewArguments& arguments) {
  if (arguments.live) return live_command(arguments);
  throw not_built("view", "recordings", "MW_RECORD=ON");
}

#endif

}  // namespace manyworlds::cli
