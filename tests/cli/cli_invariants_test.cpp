// `manyworlds report invariants`, run as its users run it.
#if MW_HAVE_CLI

#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/cli/report_page.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace manyworlds {
namespace {

using Json = nlohmann::json;
using test::contains, test::content, test::Outcome, test::report_in, test::run_with_page,
    test::ScratchFolder;

// Laws, then families, as the message for an unknown one lists them.
std::vector<std::string> known_families(const ScratchFolder& folder) {
  const Outcome outcome =
      test::run_program(test::kProgram, folder, "report invariants --families nosuch");
  const std::string start = "expected ";
  const std::size_t from = outcome.err.find(start);
  REQUIRE(from != std::string::npos);
  std::istringstream list(outcome.err.substr(from + start.size()));
  std::vector<std::string> names;
  for (std::string name; list >> name;) {
    if (name.back() == ',') name.pop_back();
    names.push_back(name);
  }
  REQUIRE_FALSE(names.empty());
  return names;
}

}  // namespace

TEST_CASE("report invariants counts the worlds that break a law", "[cli][report]") {
  const ScratchFolder folder;
  const std::string law = known_families(folder).front();
  const std::string options = "report invariants --quick --kinds 2 --seed 5 --json --families ";
  const Outcome outcome = run_with_page(folder, options + law);
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  const Json report = Json::parse(outcome.out);
  const Json& rows = report["results"];
  REQUIRE_FALSE(rows.empty());
  std::map<std::string, std::set<std::string>> settings;
  for (const Json& r : rows) {
    INFO(r.dump());
    CHECK(r["law"] == law);
    CHECK(r["seed"] == 5);
    CHECK_FALSE(r["title"].get<std::string>().empty());
    CHECK_FALSE(r["criterion"].get<std::string>().empty());
    const int worlds = r["worlds"], broken = r["broken"];
    CHECK(worlds == 2 * 16);
    CHECK(r["share"].get<double>() == broken / static_cast<double>(worlds));
    CHECK(r["passed"] == (r["share"].get<double>() <= 1e-3));
    CHECK(broken + r["lost"].get<int>() <= worlds);
    CHECK(r["silent"].get<int>() <= broken);
    CHECK(r["worst_world"].get<int>() < worlds);
    const bool within = r["worst"].is_number() && r["worst"] <= r["limit"];
    CHECK(within == (broken == 0));
    settings[r["family"]].insert(r["units"].get<std::string>() + r["precision"].get<std::string>());
  }
  for (const auto& [family, own] : settings) {
    CHECK(own == std::set<std::string>{"similarf32", "earthf32", "similarf64"});
  }
  CHECK(Json::parse(content(folder.path() / "report" / "invariants.json")) == report);
  CHECK(report_in(content(folder.path() / "report" / "invariants.html"))["results"] == rows);

  // A family alone, with the same seed, in one setting.
  const std::string family = rows[0]["family"];
  const Outcome alone =
      run_with_page(folder, options + "'" + family + "' --units similar --precision f32");
  INFO(alone.err);
  REQUIRE(alone.code == 0);
  CHECK(Json::parse(alone.out)["results"] == Json::array({rows[0]}));

  // The worst value of its worst world is that of the report.
  const Outcome one =
      test::run_program(test::kProgram, folder,
                        fmt::format("report invariants --json --seed 5 --world {} --families '{}'",
                                    rows[0]["worst_world"].get<int>(), family));
  INFO(one.err);
  REQUIRE(one.code == 0);
  const Json world = Json::parse(one.out);
  CHECK(world["worst"] == rows[0]["worst"]);
  CHECK(world["values"].size() == world["steps"].get<std::size_t>() + 1);
  CHECK(world["first_broken"].is_null() == (rows[0]["broken"] == 0));

  // Its worst world, by the command that the report prints.
  if (!contains(test::run_program(test::kProgram, folder, "info").out, "recordings   yes")) return;
  const std::string command = rows[0]["command"];
  const Outcome recorded = test::run_program(test::kProgram, folder, command.substr(11));
  INFO(command << ": " << recorded.err);
  REQUIRE(recorded.code == 0);
  const std::string file = command.substr(command.rfind(' ') + 1);
  CHECK(contains(recorded.out, "manyworlds view " + file));
  const Outcome replayed =
      test::run_program(test::kProgram, folder, "replay " + file + " --isa scalar");
  INFO(replayed.out << replayed.err);
  CHECK(replayed.code == 0);
  CHECK(contains(replayed.out, "different    none"));
}

TEST_CASE("report invariants --quick measures every family", "[cli][report]") {
  const ScratchFolder folder;
  const Outcome outcome = run_with_page(folder, "report invariants --quick --json");
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  std::map<std::string, int> rows;
  const Json report = Json::parse(outcome.out);
  for (const Json& r : report["results"]) {
    ++rows[r["family"]];
    CHECK(r["worlds"] == 4 * 16);
  }
  const auto names = known_families(folder);
  std::set<std::string> laws;
  for (const Json& r : report["results"]) laws.insert(r["law"].get<std::string>());
  CHECK(rows.size() + laws.size() == names.size());
  for (const auto& [family, count] : rows) {
    INFO(family);
    CHECK(count == 3);
  }
}

TEST_CASE("report invariants says which families there are", "[fast][cli][report]") {
  const ScratchFolder folder;
  const std::vector<std::string> names = known_families(folder);
  REQUIRE(names.size() > 2);
  CHECK(std::set<std::string>(names.begin(), names.end()).size() == names.size());
  for (const auto& [arguments, message] : std::map<std::string, std::string>{
           {"--families nosuch",
            "--families: unknown family or law 'nosuch'; expected " + names[0]},
           {"--kinds 0", "--kinds: must be at least 1, is 0"},
           {"--units mars", "--units: must be similar or earth, is 'mars'"},
           {"--world 3", "--world: needs one family, --families selects "},
           {"--record x.h5", "--record requires --world"},
           {"--world 3 --record x.h5 --families " + names.back() + "," + names[names.size() - 2],
            "--world: needs one family, --families selects 2; expected one of "}}) {
    const Outcome outcome =
        test::run_program(test::kProgram, folder, "report invariants " + arguments);
    INFO(arguments << ": " << outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, message));
  }
  CHECK_FALSE(std::filesystem::exists(folder / "report"));
}

}  // namespace manyworlds

#endif
