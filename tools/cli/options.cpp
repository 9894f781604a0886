#include "options.hpp"

#include <charconv>
#include <limits>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "option_checks.hpp"
#include "set_option.hpp"

namespace manyworlds::cli {
namespace {

constexpr int kMaxContacts = 1 << 16;  // as kMaxContactsRecorded, which is of recordings alone

// The whole of `text` as a number, or nothing. Stricter than CLI11's own conversion, which takes
// leading blanks, hexadecimal and, for unsigned numbers, a minus sign.
template <class Number>
std::optional<Number> parse(const std::string& text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

const Choices<BroadPhase>& broad_phases() {
  static const Choices<BroadPhase> choices = {{"auto", BroadPhase::automatic},
                                              {"all-pairs", BroadPhase::all_pairs},
                                              {"sort-and-sweep", BroadPhase::sort_and_sweep},
                                              {"sparse", BroadPhase::sparse}};
  return choices;
}

Choices<Solver> solvers() {
  Choices<Solver> choices;
  for (int i = 0; i <= static_cast<int>(Solver::newton); ++i) {
    const auto solver = static_cast<Solver>(i);
    choices.emplace_back(to_string(solver), solver);
  }
  return choices;
}

const Choices<ContactLayout>& layouts() {
  static const Choices<ContactLayout> choices = {{"auto", ContactLayout::automatic},
                                                 {"dense", ContactLayout::dense},
                                                 {"rows", ContactLayout::rows}};
  return choices;
}

Choices<Feature> features() {
  Choices<Feature> choices;
  for (int i = 0; i < kFeatureCount; ++i) {
    const auto feature = static_cast<Feature>(i);
    choices.emplace_back(to_string(feature), feature);
  }
  return choices;
}

template <class Value>
std::string name_of(const Choices<Value>& choices, Value value) {
  for (const auto& [name, candidate] : choices) {
    if (candidate == value) return name;
  }
  return {};
}

}  // namespace

void add_count(CLI::App& app, const std::string& flag, int& value, int least,
               const std::string& help) {
  app.add_option(flag, value, help)
      ->transform(whole_number(least, std::numeric_limits<int>::max()))
      ->type_name("N")
      ->capture_default_str();
}

void add_seed(CLI::App& app, std::optional<std::uint64_t>& seed, const std::string& help) {
  app.add_option_function<std::string>(
         "--seed",
         [&seed](const std::string& text) {
           seed = parse<std::uint64_t>(text);
           if (!seed) {
             throw CLI::ValidationError(
                 "--seed", fmt::format("must be a whole number from 0 to 2^64 - 1, is '{}'", text));
           }
         },
         help)
      ->type_name("N");
}

void add_scene_argument(CLI::App& app, JobOptions& options) {
  app.add_option("scene", options.scene,
                 "name of a scene, optionally with a size (bin-boxes:1000), or an MJCF file (.xml)")
      ->required()
      ->type_name("NAME|NAME:SIZE|FILE.xml");
  add_mjcf_options(app, options);
}

void add_mjcf_options(CLI::App& app, JobOptions& options) {
  app.add_option("--mjcf-root", options.mjcf.roots,
                 "another folder from which the MJCF file may load files; may be repeated")
      ->type_name("DIR")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--mjcf-limit", options.mjcf.limits,
                 "set a limit on MJCF files, by the name in its error message, or on their "
                 "compilation: seconds=60, megabytes=4096; may be repeated")
      ->type_name("NAME=N")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_plan_options(CLI::App& app, JobOptions& options) {
  app.add_option("--dt", options.dt, "length of a step, s (default: the scene's)")
      ->transform(positive_number())
      ->type_name("S");
  app.add_option("--substeps", options.substeps,
                 "contact substeps per step, 1 to 64 (default: the scene's)")
      ->transform(whole_number(1, 64))
      ->type_name("N");
  add_choice<Solver>(
      app, "--solver", solvers(), [&options](Solver value) { options.solver = value; },
      "solver of contacts and joints (default: the scene's)");
  app.add_option("--iterations", options.iterations,
                 "sweeps over all rows per substep, 1 to 10000 (default: the solver's)")
      ->transform(whole_number(1, 10000))
      ->type_name("N");
  const Choices<JointMethod> methods{{to_string(JointMethod::sweep), JointMethod::sweep},
                                     {to_string(JointMethod::tree), JointMethod::tree}};
  add_choice<JointMethod>(
      app, "--joints", methods, [&options](JointMethod value) { options.joints = value; },
      "solve joints one after the other, or all of a tree at once (default: the scene's)");
  app.add_option("--set", options.set,
                 "set any option of the scene by its path, such as contact.frequency=30 or "
                 "gravity=0,0,-9.81; 'info --options' lists them; may be repeated")
      ->check(CLI::Validator(
          [](std::string& text) {
            Options of_no_scene;
            return set_option(of_no_scene, text);
          },
          std::string()))
      ->type_name("PATH=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_choice<BroadPhase>(
      app, "--broad-phase", broad_phases(),
      [&options](BroadPhase value) { options.broad_phase = value; },
      "method that finds candidate pairs; does not affect the bits");
  add_choice<Feature>(
      app, "--keep", features(), [&options](Feature value) { options.keep.push_back(value); },
      "keep a feature that the plan would omit; may be repeated")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_batch_options(CLI::App& app, JobOptions& options) {
  add_count(app, "--worlds", options.worlds, 1, "number of worlds");
  add_choice<Precision>(
      app, "--precision",
      {{to_string(Precision::f32), Precision::f32}, {to_string(Precision::f64), Precision::f64}},
      [&options](Precision value) { options.precision = value; },
      "arithmetic of the step (default: f32)");
  app.add_option("--audit-every", options.audit_every,
                 "audit the energy of each world every N steps; 0: never")
      ->transform(whole_number(0, 255))
      ->type_name("N")
      ->capture_default_str();
  add_kernel_options(app, options);
}

void add_kernel_options(CLI::App& app, JobOptions& options) {
  app.add_option("--threads", options.threads, "number of threads; 0: all that the process may use")
      ->transform(whole_number(0, 1024))
      ->type_name("N")
      ->capture_default_str();
  add_choice<Isa>(
      app, "--isa",
      {{to_string(Isa::scalar), Isa::scalar},
       {to_string(Isa::avx2), Isa::avx2},
       {to_string(Isa::avx512), Isa::avx512}},
      [&options](Isa value) { options.isa = value; },
      "instruction set (default: MANYWORLDS_ISA, else the widest)");
  add_choice<ContactLayout>(
      app, "--layout", layouts(), [&options](ContactLayout value) { options.layout = value; },
      "storage of contacts between bodies; does not affect the bits");
}

void add_length_options(CLI::App& app, JobOptions& options) {
  CLI::Option* steps = app.add_option("--steps", options.steps, "number of steps of each world")
                           ->transform(whole_number(1, std::numeric_limits<int>::max()))
                           ->type_name("N")
                           ->capture_default_str();
  app.add_option("--seconds", options.seconds, "simulated time in seconds, instead of --steps")
      ->transform(positive_number())
      ->type_name("S")
      ->excludes(steps);
}

void add_random_controls(CLI::App& app, JobOptions& options) {
  app.add_flag("--random-controls", options.random_controls,
               "draw controls at random every 5 steps, and reset worlds after 500 steps");
}

void add_keyframe(CLI::App& app, JobOptions& options) {
  app.add_option("--keyframe", options.keyframe,
                 "start and reset at this keyframe of the scene ('manyworlds model' lists them)")
      ->type_name("NAME");
}

void add_sleep_option(CLI::App& app, bool& sleep) {
  add_choice<bool>(
      app, "--sleep", {{"off", false}, {"on", true}}, [&sleep](bool value) { sleep = value; },
      "let bodies at rest fall asleep (default: off)");
}

void add_sleep_options(CLI::App& app, std::vector<bool>& sleep) {
  add_choice<std::vector<bool>>(
      app, "--sleep", {{"off", {false}}, {"on", {true}}, {"both", {false, true}}},
      [&sleep](const std::vector<bool>& value) { sleep = value; },
      "let bodies at rest fall asleep, or not, or measure both (default: off)");
}

void add_json_option(CLI::App& app, JobOptions& options) {
  app.add_flag("--json", options.json, "print JSON instead of text");
}

void add_record_options(CLI::App& app, JobOptions& options) {
  CLI::Option* file =
      app.add_option("--record", options.record, "record worlds to this file, for 'replay'")
          ->check(name_of_a("file"))
          ->type_name("FILE.h5");
  app.add_option("--record-worlds", options.record_worlds,
                 "worlds to record, such as 0,5,10-20 (default: the first 64)")
      ->type_name("LIST")
      ->needs(file);
  app.add_option("--record-every", options.record_every, "number of steps between samples")
      ->transform(whole_number(1, std::numeric_limits<int>::max()))
      ->type_name("K")
      ->capture_default_str()
      ->needs(file);
  app.add_option(
         "--record-flush", options.record_flush,
         "seconds between flushes; flushed samples survive a crash (0: flush after every call)")
      ->transform(real_number(false))
      ->type_name("SECONDS")
      ->capture_default_str()
      ->needs(file);
  add_contacts_option(app, options.record_contacts, "--record-contacts",
                      "contact points per world and sample, at most the N with the largest forces");
  app.get_option("--record-contacts")->needs(file);
}

void add_contacts_option(CLI::App& app, int& contacts, const char* flag, const std::string& help) {
  app.add_option(flag, contacts, help)
      ->transform(whole_number(0, kMaxContacts))
      ->type_name("N")
      ->capture_default_str();
}

void add_dump_option(CLI::App& app, JobOptions& options) {
  app.add_option("--dump-lost", options.dump_lost,
                 "record how the first 16 lost worlds are lost, for 'replay', as DIR/world_N.h5")
      ->check(name_of_a("folder"))
      ->type_name("DIR");
}

void add_folder(CLI::App& app, const std::string& flag, std::string& folder,
                const std::string& help) {
  app.add_option(flag, folder, help)
      ->check(name_of_a("folder"))
      ->type_name("FOLDER")
      ->capture_default_str();
}

void add_scene_list(CLI::App& app, std::vector<std::string>& scenes) {
  app.add_option("--scenes", scenes, "run only these scenes, separated by commas")
      ->delimiter(',')
      ->type_name("A,B,...");
}

std::string option_name(BroadPhase broad_phase) { return name_of(broad_phases(), broad_phase); }
std::string option_name(ContactLayout layout) { return name_of(layouts(), layout); }

}  // namespace manyworlds::cli
