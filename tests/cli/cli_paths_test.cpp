// Names of files and folders that cannot be: one line before any work, with the option that gave
// it.
#if MW_HAVE_CLI

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace manyworlds {

using test::contains, test::Outcome;

TEST_CASE("a name that cannot be is told with the option that gave it", "[cli][files]") {
  const test::ScratchFolder folder;
  const auto run = [&](const std::string& arguments) {
    return test::run_program(test::kProgram, folder, arguments);
  };
  const bool records = contains(run("info").out, "recordings   yes");
  const std::string job = "run ball3d --worlds 4 --steps 2 --threads 1 ";
  const std::string report = "report throughput --quick --scenes ball3d ";
  std::ofstream(folder / "file") << "text";
  std::filesystem::create_directory(folder / "sealed");
  REQUIRE(chmod((folder / "sealed").c_str(), 0555) == 0);
  const std::string long_name(300, 'x');
  struct Bad {
    std::string arguments, message;
  };
  std::vector<Bad> all = {
      {report + "--out ''", "--out: must be the name of a folder, is ''"},
      {report + "--out file", "--out: 'file': is a file, not a folder"},
      {report + "--out file/sub", "--out: 'file': is a file, not a folder"},
      {report + "--out /proc/none", "--out: '/proc/none': the folder cannot be created: "},
      {report + "--out /dev/null", "--out: '/dev/null': is not a folder"},
      {report + "--out " + long_name, "the folder cannot be created: File name too long"},
      {report + "--peers ''", "--peers: must be the name of a folder, is ''"},
      {report + "--peers-only", "--peers-only requires --peers"},
      {report + "--peers none", "--peers: 'none': cannot be read: No such file or directory"},
      {report + "--peers file", "--peers: 'file': is not a folder"},
      {report + "--peers .", "--peers: '.': it contains no program peer_*"},
      {report + "--peers " + long_name, "cannot be read: File name too long"},
  };
  if (records) {
    const std::vector<Bad> recorded = {
        {job + "--record ''", "--record: must be the name of a file, is ''"},
        {job + "--record none/a.h5", "--record: 'none/a.h5': no such folder: 'none'"},
        {job + "--record file/a.h5", "--record: 'file/a.h5': its folder cannot be used: Not a d"},
        {job + "--record .", "--record: '.': is a directory, not a file"},
        {job + "--record " + long_name, "File name too long"},
        {job + "--dump-lost ''", "--dump-lost: must be the name of a folder, is ''"},
        {job + "--dump-lost file", "--dump-lost: 'file': is a file, not a folder"},
        {job + "--dump-lost file/sub", "--dump-lost: 'file': is a file, not a folder"},
        {job + "--dump-lost /proc/none", "--dump-lost: '/proc/none': the folder cannot be created"},
        {job + "--dump-lost " + long_name, "the folder cannot be created: File name too long"},
    };
    all.insert(all.end(), recorded.begin(), recorded.end());
  }
  if (geteuid() != 0) {  // whom nothing stops
    all.push_back({report + "--out sealed", "--out: cannot write 'sealed/throughput.json': Perm"});
    if (records) {
      all.push_back({job + "--record sealed/a.h5", "--record: 'sealed/a.h5': Permission denied"});
      all.push_back({job + "--dump-lost sealed", "--dump-lost: 'sealed/world_0.h5': Permission"});
    }
  }
  for (const Bad& bad : all) {
    INFO(bad.arguments);
    const Outcome outcome = run(bad.arguments);
    INFO(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, bad.message));
    CHECK(outcome.err.rfind("manyworlds: --", 0) == 0);
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  }
}

}  // namespace manyworlds

#endif  // MW_HAVE_CLI
