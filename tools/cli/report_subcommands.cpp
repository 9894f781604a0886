// `manyworlds report` on the command line: its subcommands, their options and help.
#include <limits>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "commands.hpp"
#include "option_checks.hpp"
#include "options.hpp"

namespace manyworlds::cli {
namespace {

void add_case_list(CLI::App& app, std::vector<std::string>& cases, const std::string& example) {
  app.add_option("--cases", cases, "run only these cases, such as " + example + " (default: all)")
      ->delimiter(',')
      ->type_name("ID,...");
}

void add_invariant_options(CLI::App& app, ReportOptions& options) {
  const int most = std::numeric_limits<int>::max();
  app.add_option("--families", options.families,
                 "run only these families or laws, such as energy,rest (default: all)")
      ->delimiter(',')
      ->type_name("NAME,...");
  add_seed(app, options.seed, "seed of all worlds (default: 1)");
  app.add_option("--kinds", options.kinds,
                 "groups of 16 worlds in each family (default: 64, with --quick 4)")
      ->transform(whole_number(1, 1 << 20))
      ->type_name("N");
  add_choice<std::string>(
      app, "--units", {{"similar", "similar"}, {"earth", "earth"}},
      [&options](const std::string& value) { options.units = value; },
      "scale gravity and time with length, or use those of the Earth (default: both)");
  add_choice<Precision>(
      app, "--precision",
      {{to_string(Precision::f32), Precision::f32}, {to_string(Precision::f64), Precision::f64}},
      [&options](Precision value) { options.precision = value; },
      "arithmetic of the step (default: f32, and f64 with similar units)");
  CLI::Option* world =
      app.add_option("--world", options.world,
                     "run only this world of one family, and print its value after each step")
          ->transform(whole_number(0, most))
          ->type_name("K");
  app.add_option("--record", options.record, "also record --world to this file, for 'view'")
      ->check(name_of_a("file"))
      ->type_name("FILE.h5")
      ->needs(world);
}

// What all reports take.
void add_report_options(CLI::App& app, ReportOptions& options, const std::string& name) {
  app.add_flag("--quick", options.quick, "run a shorter version, in under two minutes");
  add_folder(app, "--out", options.out, fmt::format("folder for {0}.html and {0}.json", name));
  app.add_flag("--json", options.json, "print JSON instead of text");
}

void add_report_page(CLI::App& report, ReportPageOptions& options, int& code) {
  CLI::App* page = report.add_subcommand("page", "Make pages from the JSON of earlier reports");
  page->add_option("file", options.files, "JSON of reports")->required()->type_name("FILE.json");
  add_folder(*page, "--out", options.out, "folder for the pages (default: next to the JSON)");
  page->footer(
      "Examples:\n"
      "  manyworlds report page report/accuracy.json\n"
      "  manyworlds report page report/*.json --out pages\n"
      "\n"
      "Use it for reports from a program that was built without pages, or from an earlier "
      "version.");
  page->callback([&] { code = report_page_command(options); });
}

}  // namespace

void add_report(CLI::App& app, ReportOptions& options, ReportPageOptions& pages, int& code) {
  CLI::App* command = app.add_subcommand(
      "report", "Measure accuracy, stability, laws of mechanics, plans and throughput");
  command->require_subcommand(1);
  CLI::App* accuracy = command->add_subcommand(
      "accuracy", "Measure error against run time in scenes with known solutions");
  add_report_options(*accuracy, options, "accuracy");
  add_case_list(*accuracy, options.cases, "A1,A16");
  accuracy->footer(
      "Examples:\n"
      "  manyworlds report accuracy --quick\n"
      "  manyworlds report accuracy --cases A5,A16 --out /tmp/report\n"
      "\n"
      "Each case is a scene with a known solution. It runs with several integrators or numbers\n"
      "of substeps and several step lengths: once to measure the error, and once without\n"
      "observing it to measure the time. The page has a picture of each case.");
  accuracy->callback([&] { code = report_accuracy_command(options); });

  CLI::App* stability =
      command->add_subcommand("stability", "Test stiff and extreme scenes against criteria");
  add_report_options(*stability, options, "stability");
  add_case_list(*stability, options.cases, "B9,B13");
  stability->footer(
      "Examples:\n"
      "  manyworlds report stability --quick\n"
      "  manyworlds report stability --cases B13,B15 --json\n"
      "\n"
      "Each case runs in many slightly different worlds, with the default and with other\n"
      "settings. It fails if one of its worlds fails. Failures appear in the report and do not\n"
      "change the exit code.");
  stability->callback([&] { code = report_stability_command(options); });

  CLI::App* invariants = command->add_subcommand(
      "invariants", "Check laws of mechanics over families of random scenes");
  add_report_options(*invariants, options, "invariants");
  add_invariant_options(*invariants, options);
  invariants->footer(
      "Examples:\n"
      "  manyworlds report invariants --quick\n"
      "  manyworlds report invariants --families energy,rest --kinds 256 --seed 7\n"
      "  manyworlds report invariants --families FAMILY --world 37 --record world.h5\n"
      "\n"
      "Each family draws random scenes, 16 worlds per group, and checks every world against a law\n"
      "after every step. The report has the share of worlds that break the law and the worst\n"
      "world. A family passes if at most 0.1 % of its worlds break the law. Failures appear in "
      "the\n"
      "report and do not change the exit code. A world depends only on its family, --units,\n"
      "--precision, --seed and number. --world prints the value of its law after each step, and\n"
      "--record records it for 'manyworlds view'.");
  invariants->callback([&] { code = report_invariants_command(options); });

  CLI::App* plan = command->add_subcommand("plan", "Measure the benefit of omitting unused stages");
  add_report_options(*plan, options, "plan");
  add_scene_list(*plan, options.scenes);
  plan->footer(
      "Examples:\n"
      "  manyworlds report plan --quick\n"
      "  manyworlds report plan --scenes bin-boxes,ball3d\n"
      "\n"
      "Each variant (a stage switched on again, another layout, another broad phase) steps\n"
      "alternately with the default batch, on one thread, and must produce the same bits.");
  plan->callback([&] { code = report_plan_command(options); });

  CLI::App* throughput = command->add_subcommand(
      "throughput",
      "Measure speed by number of worlds, threads and bodies, instruction set and precision");
  add_report_options(*throughput, options, "throughput");
  add_scene_list(*throughput, options.scenes);
  add_folder(*throughput, "--peers", options.peers,
             "compare with the engines in this folder, built by tools/peers");
  throughput->add_flag("--peers-only", options.peers_only, "run only the comparison of --peers")
      ->needs("--peers");
  throughput->footer(
      "Examples:\n"
      "  manyworlds report throughput --quick\n"
      "  manyworlds report throughput --scenes stack10 --json\n"
      "  manyworlds report throughput --peers build/peers/bin --peers-only\n"
      "\n"
      "Peers step the same standard scenes alternately with manyworlds. This takes up to an hour,\n"
      "or two minutes with --quick. The fastest engine of each scene comes first. A peer that\n"
      "fails gets a line in the report.");
  throughput->callback([&] { code = report_throughput_command(options); });
  add_report_page(*command, pages, code);
}

}  // namespace manyworlds::cli
