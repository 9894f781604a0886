// The program's recordings as its users see them; and without HDF5, how to get them.
#if MW_HAVE_CLI

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/program_checks.hpp"

namespace manyworlds {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

using test::contains, test::Outcome;

}  // namespace

TEST_CASE("without recordings the program says how to get them", "[cli]") {
  const test::ProgramFolder folder;
  if (test::program_records()) return;
  test::check_refused(folder.run("run ball3d --steps 2 --record run.h5"), "cmake -D MW_RECORD=ON");
  test::check_refused(folder.run("soak ball3d --steps 2 --dump-lost lost"),
                      "cmake -D MW_RECORD=ON");
  test::check_refused(folder.run("replay run.h5"), "cmake -D MW_RECORD=ON");
}

TEST_CASE("run --record and replay end in the same bits", "[cli]") {
  const test::ProgramFolder folder;
  if (!test::program_records()) return;
  const std::string job = "run mixed-pile2d --worlds 40 --steps 60 --seed 3 ";
  const Outcome plain = folder.run(job + "--json");
  const Outcome run =
      folder.run(job + "--json --record run.h5 --record-worlds 20-22,5,7 --record-every 10");
  REQUIRE(run.code == 0);
  CHECK(Json::parse(run.out)["hash"] == Json::parse(plain.out)["hash"]);
  CHECK(Json::parse(run.out)["steps_per_call"] == 10);
  for (const char* how : {"", " --isa scalar --threads 2", " --layout dense"}) {
    const Outcome replay = folder.run(std::string("replay run.h5 --json") + how);
    CHECK(replay.code == 0);
    const Json json = Json::parse(replay.out);
    CHECK(json["worlds"] == 5);
    CHECK(json["samples"] == 7);
    CHECK(json["steps"] == 60);
    CHECK(json["compared"] == 35);
    CHECK(json["different"] == 0);
    CHECK(json["difference"].is_null());
  }
  const Outcome text = folder.run("replay run.h5");
  CHECK(contains(text.out, "run.h5: 5 worlds of mixed-pile2d, 60 steps"));
  CHECK(contains(text.out, "different    none"));

  const Outcome all = folder.run("run ball3d --worlds 100 --steps 4 --record all.h5 --sleep on");
  CHECK(contains(all.out, "recorded     64 of 100 worlds, 5 samples every 1 step, "));
  CHECK(folder.run("replay all.h5").code == 0);
}

TEST_CASE("what cannot be recorded or replayed is bad input", "[cli]") {
  const test::ProgramFolder folder;
  if (!test::program_records()) return;
  const std::string run = "run ball3d --worlds 8 --steps 2 ";
  const auto bad = [&](const std::string& arguments, const char* message) {
    INFO(arguments);
    test::check_refused(folder.run(arguments), message);
  };
  for (const char* list : {"x", "1-", "3-1", "1,,2", "1,", "1 2", "99999999999"}) {
    bad(run + "--record a.h5 --record-worlds '" + list + "'", "--record-worlds");
  }
  bad(run + "--record a.h5 --record-worlds 2-8", "holds 8, must be below --worlds, which is 8");
  bad(run + "--record a.h5 --record-every 0", "--record-every: must be at least 1");
  bad(run + "--record-every 3", "--record");
  bad(run + "--record no/such/folder/a.h5", "no/such/folder/a.h5");
  CHECK_FALSE(fs::exists(folder / "a.h5"));
  bad("replay absent.h5", "'absent.h5': cannot be read");
  bad("replay .", "'.': is a directory");
  std::ofstream(folder / "foreign.h5") << std::string(5000, 'x');
  bad("replay foreign.h5", "'foreign.h5': is not a manyworlds recording");
  REQUIRE(folder.run(run + "--record a.h5").code == 0);
  fs::resize_file(folder / "a.h5", fs::file_size(folder / "a.h5") - 1);
  bad("replay a.h5", "'a.h5': is ");
}

TEST_CASE("lost worlds are dumped, and a replay loses them again", "[cli]") {
  const test::ProgramFolder folder;
  if (!test::program_records()) return;
  // Bodies that fly at about 1 m/s leave the range of 1e10 m in one such step.
  const Outcome run =
      folder.run("run free-flight --steps 2 --dt 1e12 --worlds 20 --dump-lost lost");
  CHECK(run.code == 1);
  CHECK(contains(run.err, "manyworlds: dumped: manyworlds replay lost/world_15.h5\n"));
  CHECK_FALSE(contains(run.err, "lost/world_16.h5"));
  const Outcome replay = folder.run("replay lost/world_15.h5 --json");
  CHECK(replay.code == 0);
  CHECK(Json::parse(replay.out)["lost_worlds"] == 1);
  CHECK(Json::parse(replay.out)["different"] == 0);

  CHECK(folder.run("soak free-flight --steps 2 --dt 1e12 --worlds 3 --dump-lost s").code == 1);
  CHECK(folder.run("replay s/world_2.h5").code == 0);
  test::check_refused(folder.run("soak ball3d --steps 2 --worlds 2 --seed 1 --dump-lost out"),
                      "'out'");
}

}  // namespace manyworlds

#endif  // MW_HAVE_CLI
