// What the subcommands share: the options of a job, their checks, and how they are parsed.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "manyworlds/batch.hpp"
#include "manyworlds/plan.hpp"

#include "mjcf_file.hpp"

namespace CLI {
class App;
}

namespace manyworlds::cli {

// Exit codes of the program.
inline constexpr int kOk = 0;
inline constexpr int kWorldLost =
    1;  // or, for verify and bench, bits that differ; for compare, numbers
inline constexpr int kBadInput = 2;

// The user asked for something that cannot be done; what() is one complete line.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct JobOptions {
  std::string scene;  // name of a scene, or path of an MJCF file
  MjcfArguments mjcf;

  // Changes to the scene and its plan.
  std::optional<double> dt;     // s
  std::optional<int> substeps;  // per step
  std::optional<Solver> solver;
  std::optional<int> iterations;  // per substep
  std::optional<JointMethod> joints;
  std::vector<std::string> set;  // "contact.slop=0.01" (set_option.hpp), after those above
  BroadPhase broad_phase = BroadPhase::automatic;
  std::vector<Feature> keep;

  // The batch.
  int worlds = 1024;
  int threads = 0;  // 0: all
  Precision precision = Precision::f32;
  std::optional<std::uint64_t> seed;  // world i draws from seed + i
  std::optional<Isa> isa;
  ContactLayout layout = ContactLayout::automatic;
  bool sleep = false;
  int audit_every = BatchOptions{}.audit_every;

  // The length of the job.
  int steps = 300;
  std::optional<double> seconds;  // s, simulated; replaces steps
  int steps_per_call = 16;        // n of each step(n) call
  bool random_controls = false;   // random_controls.hpp
  std::string keyframe;           // that worlds begin at; empty: as the scene begins

  bool json = false;

  // Recordings (recording.hpp); empty: none.
  std::string record;         // file
  std::string record_worlds;  // "0,5,10-20"; empty: the first few
  int record_every = 1;       // steps
  double record_flush = 5;    // s
  int record_contacts = 0;    // points of a world and sample at most; 0: none
  std::string dump_lost;      // folder
};

struct BenchOptions {
  JobOptions job;
  std::vector<std::string> scenes;  // empty: the standard ones
  int warm_up = 60;                 // steps before the clock starts
  int repeats = 3;                  // timed runs; the median counts
  std::vector<bool> sleep = {false};
};

struct VerifyOptions {
  std::vector<std::string> scenes;  // empty: a chosen handful
  std::uint64_t seed = 1;
  bool quick = false;
  bool json = false;
};

struct CompareOptions {
  JobOptions job;  // scene, mjcf, worlds, steps, seed and json of it
  double tolerance = 1e-16;
  bool no_speed = false;
};

struct ReportOptions {
  std::vector<std::string> cases;   // of accuracy and stability; empty: all
  std::vector<std::string> scenes;  // of the others; empty: the report's own
  std::string out = "report";       // folder
  std::string peers;                // of throughput: folder of other engines' programs
  bool peers_only = false;          // and no sweeps
  bool quick = false;
  bool json = false;

  // Of invariants.
  std::vector<std::string> families;  // ids or laws; empty: all
  std::optional<std::uint64_t> seed;
  std::optional<int> kinds;  // groups of worlds of a family
  std::string units;         // "similar" or "earth"; empty: both
  std::optional<Precision> precision;
  std::optional<int> world;  // alone, of one family
  std::string record;        // file of that world
};

struct ReportPageOptions {
  std::vector<std::string> files;  // JSON of reports
  std::string out;                 // folder; empty: beside each
};

struct ReplayArguments {
  std::string file;
  JobOptions job;  // threads, isa, layout and json of it
};

struct ViewArguments {
  std::vector<std::string> sources;  // recordings, scenes, MJCF files
  std::string out;                   // file; empty: one in the temporary folder, which is opened
  std::string title;
  int worlds = 0;  // 0: all of a recording, as many of a scene as fit
  int every = 1;   // of the samples
  int fps = 30;    // frames per simulated second of scenes, per second of a film
  double seconds = 10;
  int contacts = 64;  // points of a world and frame of scenes at most
  bool open = false;
  std::string png, mp4;         // files; empty: no picture, no film
  std::optional<double> time;   // s, of the picture; default: the end
  std::optional<double> begin;  // s, of the film; default: 0
  std::optional<double> end;    // s, of the film; default: the end
  std::optional<double> at;     // the name that --time and --begin had
  std::optional<double> until;  // the name that --end had
  std::string size = "1280x720";
  std::optional<int> world;  // of pictures and films; none: all
  std::string follow;        // a body of that world or of the first; empty: none
  std::string color;         // by what; empty: by body
  bool dark = false;
  bool live = false;  // served while it steps (live_command.hpp)
  int port = 0;       // of 127.0.0.1; 0: any that is free
  std::optional<std::string>
      speed;            // simulated per real second, or "max" of live pages; default: 1
  bool paused = false;  // at first
  JobOptions job;       // of scenes
};

// Each adds one group of options to a subcommand; values that fail their check make CLI11's parse
// throw with the option's name in front. The options must outlive the parse.
void add_scene_argument(CLI::App& app, JobOptions& options);
void add_mjcf_options(CLI::App& app, JobOptions& options);  // of add_scene_argument
void add_plan_options(CLI::App& app, JobOptions& options);
void add_batch_options(CLI::App& app, JobOptions& options);
void add_kernel_options(CLI::App& app, JobOptions& options);  // those that do not change a bit
void add_length_options(CLI::App& app, JobOptions& options);
void add_random_controls(CLI::App& app, JobOptions& options);
void add_keyframe(CLI::App& app, JobOptions& options);
void add_sleep_option(CLI::App& app, bool& sleep);
void add_sleep_options(CLI::App& app, std::vector<bool>& sleep);  // or both
void add_json_option(CLI::App& app, JobOptions& options);
void add_record_options(CLI::App& app, JobOptions& options);
void add_contacts_option(CLI::App& app, int& contacts, const char* flag, const std::string& help);
void add_dump_option(CLI::App& app, JobOptions& options);
void add_scene_list(CLI::App& app, std::vector<std::string>& scenes);
// The name of a folder.
void add_folder(CLI::App& app, const std::string& flag, std::string& folder,
                const std::string& help);
// A whole number of at least `least`.
void add_count(CLI::App& app, const std::string& flag, int& value, int least,
               const std::string& help);
void add_seed(CLI::App& app, std::optional<std::uint64_t>& seed, const std::string& help);

// The name an option takes for a value: "auto" for automatic, otherwise the library's own.
std::string option_name(BroadPhase broad_phase);
std::string option_name(ContactLayout layout);

// `report` and its subcommands, which set `code` to their exit code (report_subcommands.cpp).
void add_report(CLI::App& app, ReportOptions& options, ReportPageOptions& pages, int& code);

}  // namespace manyworlds::cli
