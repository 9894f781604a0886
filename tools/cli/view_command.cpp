// `manyworlds view`: recordings as a page, those given or one that is made for it.
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
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
#include "tools/base/interrupt.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"
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

// A new folder that only its owner may enter: nobody else can have put a file or a link there.
fs::path make_private_folder() {
  std::string name = (fs::temp_directory_path() / "manyworlds-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw InputError(fmt::format("view: no folder can be made in '{}': {}",
                                 fs::temp_directory_path().string(), std::strerror(errno)));
  }
  return name;
}

// Files that are gone when they are not needed any more.
class ScratchFolder {
 public:
  ScratchFolder() : path_(make_private_folder()) {}
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  fs::path operator/(const char* file) const { return path_ / file; }

 private:
  fs::path path_;
};

// Steps a scene and records it in `file`.
void record(const ViewArguments& arguments, const std::string& scene, const fs::path& file) {
  JobOptions options = arguments.job;
  options.scene = scene;
  if (!options.seconds) options.seconds = arguments.seconds;
  const Job job = prepare(options);
  const double dt = job.plan.scene().options.dt;
  options.record = file.string();
  options.record_every = std::max(1, static_cast<int>(std::lround(1 / (arguments.fps * dt))));
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
  {
    Progress progress(scene, job.steps);
    timed_steps(batch, job.steps, steps_per_call(options), &progress, controls);
  }
  recorder.finish(batch);
  if (!recorder.failure().empty()) throw InputError(recorder.failure());
}

bool is_recording(const std::string& source) {
  return source.ends_with(".h5") || source.find(".h5.part-") != std::string::npos;
}

// Where the page goes that --out does not name. It stays, for the browser that opens it.
fs::path page_in_temporary_folder(const std::string& source) {
  std::string name = fs::path(source).stem().string();
  std::replace(name.begin(), name.end(), ':', '-');
  return make_private_folder() / (name + ".html");
}

}  // namespace

int view_command(const ViewArguments& arguments) {
  if (arguments.live) return live_command(arguments);
  const fs::path empty = empty_page();
  const PictureSize size = parse_size(arguments.size);
  const auto before = std::chrono::steady_clock::now();
  std::vector<Recording> recordings;
  for (const std::string& source : arguments.sources) {
    if (is_recording(source)) {
      recordings.push_back(Recording::open(source));
    } else {
      const ScratchFolder folder;
      const fs::path file = folder / "run.h5";
      record(arguments, source, file);
      recordings.push_back(Recording::open(file));
    }
  }
  std::vector<const Recording*> all;
  for (const Recording& one : recordings) all.push_back(&one);
  PageOptions options;
  options.title = arguments.title;
  options.max_worlds = arguments.worlds;
  options.every = arguments.every;
  const bool picture = !arguments.png.empty();
  std::optional<ScratchFolder> unnamed;  // of a picture alone
  if (picture && arguments.out.empty()) unnamed.emplace();
  const fs::path out = unnamed                 ? *unnamed / "page.html"
                       : arguments.out.empty() ? page_in_temporary_folder(arguments.sources.front())
                                               : fs::path(arguments.out);
  const PageReport report = write_page(all, empty, out, options);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - before;
  if (picture) {
    take_picture(out, fmt::format("picture&time={}", arguments.at.value_or(1e12)), size,
                 arguments.png);
  }
  const bool opened =
      !unnamed && (arguments.out.empty() || arguments.open) && open_in_browser(fs::absolute(out));
  const std::string made = unnamed ? arguments.png : out.string();
  if (arguments.job.json) {
    const nlohmann::ordered_json json = {{unnamed ? "picture" : "page", made},
                                         {"worlds", report.worlds},
                                         {"bodies", report.bodies},
                                         {"frames", report.frames},
                                         {"bytes", report.bytes},
                                         {"seconds", spent.count()},
                                         {"opened", opened}};
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    fmt::print("{}: {}, {} moving bodies, {}, {}B, {:.2f} s\n", made,
               counted(report.worlds, "world"), report.bodies,
               counted(static_cast<int>(report.frames), "frame"),
               with_prefix(static_cast<double>(report.bytes)), spent.count());
    if (!opened && !unnamed && (arguments.out.empty() || arguments.open)) {
      fmt::print("no desktop to open it on: open {} in a browser\n", fs::absolute(out).string());
    }
  }
  return kOk;
}

#else

int view_command(const ViewArguments& arguments) {
  if (arguments.live) return live_command(arguments);
  throw not_built("view", "recordings", "MW_RECORD=ON");
}

#endif

}  // namespace manyworlds::cli
