// The program `manyworlds`: parsing and exit codes. What a subcommand does is in its own file.
// It is over 400 lines because the help of every subcommand is here.
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "command_line.hpp"
#include "commands.hpp"
#include "completion.hpp"
#include "options.hpp"
#include "src/base/output_file.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/version.hpp"

namespace manyworlds::cli {
namespace {

using tools::kVersion, tools::tell;

struct AllOptions {
  bool scenes_json = false;
  bool info_json = false, info_options = false;
  JobOptions run;
  JobOptions plan;
  JobOptions model;
  BenchOptions bench;
  VerifyOptions verify;
  std::optional<std::uint64_t> verify_seed;
  CompareOptions compare;
  JobOptions soak;
  ReplayArguments replay;
  ViewArguments view;
  ReportOptions report;
  ReportPageOptions report_page;
  std::string shell;  // of completion
};

constexpr const char* kAppFooter =
    "Examples:\n"
    "  manyworlds run bin-boxes --worlds 4096 --seconds 5\n"
    "  manyworlds bench --scenes bin-spheres,stack10\n"
    "  manyworlds run --help\n"
    "\n"
    "Exit codes: 0 ok, 1 a world was lost, bits differ or a gate of 'compare' fails, 2 bad input "
    "or\n"
    "a file that cannot be written, 130 interrupted (Ctrl-C), 143 terminated.\n"
    "Scenes in other sizes: pyramid2d:100, bin-spheres:1000, bin-boxes:1000.\n"
    "MANYWORLDS_ISA=scalar|avx2|avx512 chooses the instruction set of all commands. The build\n"
    "defines which ones are available (MW_ISAS=\"scalar;avx2\" tools/run).";

void add_scenes(CLI::App& app, AllOptions& all, int& code) {
  CLI::App* command = app.add_subcommand("scenes", "List the named scenes");
  command->add_flag("--json", all.scenes_json, "print JSON instead of text");
  command->footer("Example:\n  manyworlds scenes");
  command->callback([&] { code = scenes_command(all.scenes_json); });
}

void add_run(CLI::App& app, AllOptions& all, int& code) {
  CLI::App* command = app.add_subcommand("run", "Step many worlds of a scene and print a summary");
  add_scene_argument(*command, all.run);
  add_batch_options(*command, all.run);
  add_length_options(*command, all.run);
  add_random_controls(*command, all.run);
  add_keyframe(*command, all.run);
  add_count(*command, "--steps-per-call", all.run.steps_per_call, 1, "n of each step(n) call");
  add_sleep_option(*command, all.run.sleep);
  add_plan_options(*command, all.run);
  add_seed(*command, all.run.seed, "world i draws from seed + i (default: 0)");
  add_record_options(*command, all.run);
  add_dump_option(*command, all.run);
  add_json_option(*command, all.run);
  command->footer(
      "Examples:\n"
      "  manyworlds run bin-boxes --worlds 4096 --seconds 5\n"
      "  manyworlds run pile.xml --dt 0.005 --substeps 2 --threads 1 --json\n"
      "  manyworlds run stack10 --precision f64 --worlds 1 --seed 17\n"
      "  manyworlds run bin-boxes --seconds 20 --sleep on\n"
      "  manyworlds run stack10 --record stack.h5 --record-worlds 0,10-19 --record-every 6\n"
      "\n"
      "Contacts, penetration, energy, lost worlds and hash describe the state after the last\n"
      "step. The stage split is measured afterwards, in a few more steps. With --record, the\n"
      "speed includes recording, and calls end at samples.");
  command->callback([&] { code = run_command(all.run); });
}

void add_plan(CLI::App& app, AllOptions& all, int& code) {
  CLI::App* command =
      app.add_subcommand("plan", "Show which stages a scene's step has, which it omits, and why");
  add_scene_argument(*command, all.plan);
  add_plan_options(*command, all.plan);
  add_json_option(*command, all.plan);
  command->footer(
      "Examples:\n"
      "  manyworlds plan bin-boxes\n"
      "  manyworlds plan ball3d --keep friction --keep drag");
  command->callback([&] { code = plan_command(all.plan); });
}

void add_model(CLI::App& app, AllOptions& all, int& code) {
  CLI::App* command =
      app.add_subcommand("model", "Show a model as it was read: joints, actuators, pairs");
  add_scene_argument(*command, all.model);
  add_plan_options(*command, all.model);
  add_json_option(*command, all.model);
  command->footer(
      "Examples:\n"
      "  manyworlds model humanoid.xml\n"
      "  manyworlds model humanoid.xml --json\n"
      "\n"
      "q and v are the first index of a joint's coordinates and velocities in\n"
      "generalized_position and generalized_velocity, MuJoCo's qpos and qvel. As with 'run',\n"
      "unsupported elements are errors.");
  command->callback([&] { code = model_command(all.model); });
}

void add_bench(CLI::App& app, AllOptions& all, int& code) {
  CLI::App* command = app.add_subcommand("bench", "Measure the standard scenes");
  JobOptions& job = all.bench.job;
  add_scene_list(*command, all.bench.scenes);
  add_batch_options(*command, job);
  add_count(*command, "--steps", job.steps, 1, "timed steps of every run");
  add_count(*command, "--warm-up", all.bench.warm_up, 0, "steps before the clock starts");
  add_count(*command, "--repeats", all.bench.repeats, 1, "number of runs; prints their median");
  add_count(*command, "--steps-per-call", job.steps_per_call, 1, "k of the step(k) column");
  add_sleep_options(*command, all.bench.sleep);
  add_plan_options(*command, job);
  add_seed(*command, job.seed, "world i draws from seed + i (default: 0)");
  add_json_option(*command, job);
  command->footer(
      "Examples:\n"
      "  manyworlds bench\n"
      "  manyworlds bench --scenes bin-spheres,bin-boxes --steps 600 --repeats 5\n"
      "  manyworlds bench --threads 2 --json\n"
      "  manyworlds bench --sleep both --steps 1200\n"
      "\n"
      "Each scene is measured with 1 thread and with --threads (default: all), by step(1)\n"
      "calls and by step(k) calls. All runs of a scene must end in the same hash.");
  command->callback([&] { code = bench_command(all.bench); });
}

void add_verify(CLI::App& app, AllOptions& all, int& code) {
  CLI::App* command = app.add_subcommand(
      "verify", "Check on this machine that a world's bits do not depend on how it is run");
  command->add_flag("--quick", all.verify.quick, "fewer scenes and steps");
  command->add_flag("--json", all.verify.json, "print JSON instead of text");
  add_scene_list(*command, all.verify.scenes);
  add_seed(*command, all.verify_seed, "seed of the worlds compared (default: 1)");
  command->footer(
      "Examples:\n"
      "  manyworlds verify --quick\n"
      "  manyworlds verify --scenes stack10,billiards");
  command->callback([&] {
    if (all.verify_seed) all.verify.seed = *all.verify_seed;
    code = verify_command(all.verify);
  });
}

void add_compare(CLI::App& app, AllOptions& all, int& code) {
  CLI::App* command =
      app.add_subcommand("compare", "Compare an MJCF model's motion and speed with MuJoCo's");
  all.compare.job.worlds = 320;
  all.compare.job.steps = 1000;
  command->add_option("model", all.compare.job.scene, "an MJCF file with joints")
      ->required()
      ->type_name("FILE.xml");
  add_mjcf_options(*command, all.compare.job);
  add_count(*command, "--worlds", all.compare.job.worlds, 1, "number of states to compare");
  add_count(*command, "--steps", all.compare.job.steps, 1, "steps of each path");
  add_seed(*command, all.compare.job.seed, "seed of states, velocities and controls (default: 0)");
  command
      ->add_option("--tolerance", all.compare.tolerance,
                   "tolerance of both solvers; float32: at least 1e-7")
      ->check(CLI::PositiveNumber)
      ->type_name("X")
      ->capture_default_str();
  command->add_flag("--no-speed", all.compare.no_speed, "do not compare speed");
  add_json_option(*command, all.compare.job);
  command->footer(
      "Examples:\n"
      "  manyworlds compare humanoid.xml\n"
      "  manyworlds compare humanoid.xml --worlds 2000 --steps 3000 --json\n"
      "\n"
      "Both engines solve with Newton's method, on one thread. The exit code is 1\n"
      "if a difference exceeds its gate (docs/mujoco.md).");
  command->callback([&] { code = compare_command(all.compare); });
}

void add_soak(CLI::App& app, AllOptions& all, int& code) {
  CLI::App* command = app.add_subcommand(
      "soak", "Run many worlds for many steps from random seeds and count lost worlds");
  all.soak.worlds = 10000;
  all.soak.steps = 1000;
  add_scene_argument(*command, all.soak);
  add_batch_options(*command, all.soak);
  add_length_options(*command, all.soak);
  add_random_controls(*command, all.soak);
  add_keyframe(*command, all.soak);
  add_sleep_option(*command, all.soak.sleep);
  add_plan_options(*command, all.soak);
  add_seed(*command, all.soak.seed, "world i draws from seed + i (default: random, printed)");
  add_dump_option(*command, all.soak);
  add_json_option(*command, all.soak);
  command->footer(
      "Examples:\n"
      "  manyworlds soak bin-boxes\n"
      "  manyworlds soak mixed-pile --worlds 100000 --seconds 60\n"
      "  manyworlds soak mixed-pile --dump-lost lost\n"
      "  manyworlds soak humanoid --worlds 4096 --steps 100000 --random-controls");
  command->callback([&] { code = soak_command(all.soak); });
}

void add_replay(CLI::App& app, AllOptions& all, int& code) {
  CLI::App* command =
      app.add_subcommand("replay", "Simulate a recording again and compare every sample");
  command->add_option("file", all.replay.file, "recording from --record or --dump-lost")
      ->required()
      ->type_name("FILE.h5");
  add_kernel_options(*command, all.replay.job);
  add_json_option(*command, all.replay.job);
  command->footer(
      "Examples:\n"
      "  manyworlds replay stack.h5\n"
      "  manyworlds replay lost/world_17.h5 --isa scalar --json\n"
      "\n"
      "Exit codes: 0 all equal, 1 something differs, 2 the file cannot be read.");
  command->callback([&] { code = replay_command(all.replay); });
}

void add_view(CLI::App& app, AllOptions& all, int& code) {
  CLI::App* command = app.add_subcommand("view", "Make a page that shows worlds in a browser");
  ViewArguments& view = all.view;
  command
      ->add_option(
          "what", view.sources,
          "recordings (.h5), names of scenes or MJCF files (.xml); several are shown side by side")
      ->required()
      ->type_name("FILE.h5|NAME|FILE.xml");
  command
      ->add_option("--out", view.out,
                   "the page to write (default: one in the temporary folder, which is opened)")
      ->type_name("PAGE.html");
  command->add_flag("--open", view.open, "also open the page of --out");
  command->add_option("--png", view.png, "write a picture with headless Chromium instead of a page")
      ->type_name("FILE.png");
  command
      ->add_option("--mp4", view.mp4,
                   "write a film with headless Chromium and ffmpeg instead of a page")
      ->type_name("FILE.mp4");
  const auto add_time = [&](const char* name, std::optional<double>& to, const char* help) {
    return command->add_option(name, to, help)->check(CLI::NonNegativeNumber)->type_name("S");
  };
  add_time("--time", view.time, "simulated time of the picture (default: the end)");
  add_time("--begin", view.begin, "start time of the film, simulated (default: 0)");
  add_time("--end", view.end, "end time of the film, simulated (default: the end)");
  // What they were called before. Not in the help, and so not in lists of what excludes what.
  add_time("--at", view.at, "")->group("");
  add_time("--until", view.until, "")->group("");
  command->add_option("--size", view.size, "size of the picture or film in pixels")
      ->type_name("WxH")
      ->capture_default_str();
  command->add_option("--world", view.world, "world that the picture or film shows, from 0")
      ->check(CLI::Range(0, 1 << 20))
      ->type_name("N");
  command
      ->add_option("--follow", view.follow,
                   "body of --world (default: 0) that the camera follows: its name or index")
      ->type_name("BODY");
  command
      ->add_option(
          "--color", view.color,
          "color bodies by body, speed, spin, rest, height, contact or run (default: body)")
      ->type_name("BY");
  command->add_flag("--dark", view.dark, "use the dark theme");
  command->add_option("--title", view.title, "title of the page (default: the name of the scene)")
      ->type_name("TEXT");
  command
      ->add_option("--worlds", view.worlds,
                   "show the first N worlds (default: all recorded, or as many as fit)")
      ->check(CLI::Range(1, 1 << 20))
      ->type_name("N");
  add_count(*command, "--every", view.every, 1, "show every N-th sample of recordings");
  add_count(*command, "--fps", view.fps, 1,
            "frames per simulated second of scenes; with --mp4, of the film");
  command->add_option("--seconds", view.seconds, "simulated time of scenes in seconds")
      ->check(CLI::PositiveNumber)
      ->type_name("S")
      ->capture_default_str();
  add_contacts_option(
      *command, view.contacts, "--contacts",
      "contact points per world and frame of scenes, the N with the largest forces");
  CLI::Option* live = command->add_flag(
      "--live", view.live, "step a scene and serve its page on this machine until Ctrl-C");
  for (const char* other :
       {"--out", "--open", "--png", "--mp4", "--time", "--begin", "--end", "--world", "--follow",
        "--color", "--dark", "--every", "--fps", "--seconds", "--contacts"}) {
    live->excludes(command->get_option(other));
  }
  command->add_option("--port", view.port, "port of --live (default: any free one)")
      ->check(CLI::Range(1, 65535))
      ->needs(live)
      ->type_name("N");
  command
      ->add_option("--speed", view.speed,
                   "simulated seconds per real second with --live or --mp4; --live also takes max "
                   "(default: 1)")
      ->type_name("X");
  command
      ->add_flag("--paused", view.paused, "start --live paused, until play is pressed in the page")
      ->needs(live);
  add_mjcf_options(*command, view.job);
  add_plan_options(*command, view.job);
  add_random_controls(*command, view.job);
  add_keyframe(*command, view.job);
  add_sleep_option(*command, view.job.sleep);
  add_seed(*command, view.job.seed, "world i of a scene draws from seed + i (default: 0)");
  add_json_option(*command, view.job);
  command->footer(
      "Examples:\n"
      "  manyworlds view bin-boxes\n"
      "  manyworlds view run.h5 --out page.html\n"
      "  manyworlds view bin-boxes --png picture.png --time 1.2 --size 1200x680\n"
      "  manyworlds view run.h5 --mp4 film.mp4 --speed 0.25\n"
      "  manyworlds view humanoid --random-controls --mp4 film.mp4 --world 5 --follow chest\n"
      "  manyworlds view before.h5 after.h5 --out both.html\n"
      "  manyworlds view humanoid.xml --random-controls --worlds 16 --seconds 5\n"
      "  manyworlds view bin-boxes --live --worlds 64\n"
      "\n"
      "The page is one file that needs no server and no network. Scenes are recorded first, with\n"
      "as many worlds as fit into a page of about 10 MB. With --live, the page shows worlds while\n"
      "they step, and can drag bodies, apply external forces, reset and pause.");
  command->callback([&] { code = view_command(all.view); });
}

void add_info(CLI::App& app, AllOptions& all, int& code) {
  CLI::App* command =
      app.add_subcommand("info", "Show the CPU, instruction sets, threads and versions");
  command->add_flag("--json", all.info_json, "print JSON instead of text");
  command->add_flag("--options", all.info_options,
                    "list the options of a scene for --set, and their defaults");
  command->footer(
      "Examples:\n  MANYWORLDS_ISA=avx2 manyworlds info\n  manyworlds info --json\n"
      "  manyworlds info --options");
  command->callback([&] {
    code = all.info_options ? list_options_command(all.info_json) : info_command(all.info_json);
  });
}

// Where memory runs out in what cannot say so, a destructor, the program still ends as it promises.
[[noreturn]] void end_without_memory() {
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    std::fputs("manyworlds: not enough memory\n", stderr);
    std::_Exit(kBadInput);
  } catch (...) {
  }
  std::abort();
}

// One line per problem, each with the program's name in front.
int complain(std::string_view text) {
  std::fflush(stdout);  // the lines below come after it on a terminal and in a log
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    if (!line.empty()) tell("manyworlds: {}\n", line);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  }
  return kBadInput;
}

// A standard stream that is closed would be the next file that is opened, and what is printed would
// go into that. What takes its place can be neither read nor written, which is an error of those.
void occupy_standard_streams() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(number, F_GETFD) >= 0) continue;
    [[maybe_unused]] const int opened =
        open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

// `code`, unless what was printed did not arrive.
int after_output(int code) {
  errno = 0;
  const bool arrived = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (arrived) return code;
  const std::string reason = errno == 0 ? "" : ": " + reason_of(errno);
  return complain("cannot write to standard output" + reason);
}

int run_program(int argc, char** argv) {
  occupy_standard_streams();
  std::set_terminate(end_without_memory);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that would grow too large is an error of its write
  CLI::App app("Steps thousands of small rigid-body worlds at once.", "manyworlds");
  app.set_version_flag("--version", fmt::format("manyworlds {}", kVersion));
  app.footer(kAppFooter);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);

  AllOptions all;
  int code = kOk;
  add_scenes(app, all, code);
  add_run(app, all, code);
  add_plan(app, all, code);
  add_model(app, all, code);
  add_bench(app, all, code);
  add_verify(app, all, code);
  add_compare(app, all, code);
  add_soak(app, all, code);
  add_replay(app, all, code);
  add_view(app, all, code);
  add_report(app, all.report, all.report_page, code);
  add_info(app, all, code);
  add_completion(app, all.shell, code);
  try {
    app.parse(argc, argv);  // runs the subcommand's callback
  } catch (const CLI::Success& help) {
    const std::vector<std::string> unknown = app.remaining(true);  // "nosuch --help"
    if (!unknown.empty()) return complain(describe(CLI::ExtrasError("manyworlds", unknown), app));
    return after_output(app.exit(help));
  } catch (const CLI::ParseError& error) {
    return complain(describe(error, app));
  } catch (const std::bad_alloc&) {
    return complain("not enough memory for so many worlds (--worlds)");
  } catch (const std::system_error& error) {
    const std::string_view text = error.what();
    if (text.starts_with("threads: ")) return complain(text);  // of replay and the like
    // Of fmt, where it cannot print.
    return complain("cannot write to standard output: " + reason_of(error.code().value()));
  } catch (const std::exception& error) {
    return complain(error.what());  // InputError, SceneError, std::invalid_argument
  }
  return after_output(code);
}

}  // namespace
}  // namespace manyworlds::cli

int main(int argc, char** argv) { return manyworlds::cli::run_program(argc, argv); }
