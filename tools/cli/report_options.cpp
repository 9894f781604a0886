// Options that reports alone have.
#include <limits>

#include <CLI/CLI.hpp>

#include "option_checks.hpp"
#include "options.hpp"

namespace manyworlds::cli {

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

}  // namespace manyworlds::cli
