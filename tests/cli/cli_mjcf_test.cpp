// The program and MJCF files from anybody: what is refused, and what the child process survives for
// it.
#if MW_HAVE_CLI

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>

#include "tests/support/mjcf_text.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/program_checks.hpp"
#include "tests/support/sanitized.hpp"

namespace manyworlds {
namespace {

namespace fs = std::filesystem;
using test::contains, test::Outcome, test::ScratchFolder;

const std::string kBall = "<body><freejoint/><geom size='.1'/></body>";

Outcome run_in(const ScratchFolder& folder, const std::string& arguments) {
  // Nothing here may hang; a minute and a half is long on any machine.
  return test::run_program("timeout", folder,
                           "90 '" + std::string(test::kProgram) + "' " + arguments);
}

void write(const ScratchFolder& folder, const std::string& name, const std::string& text) {
  fs::create_directories((folder / name).parent_path());
  std::ofstream(folder / name) << text;
}

}  // namespace

TEST_CASE("hostile MJCF files are one line and exit code 2", "[cli]") {
  if (!test::program_reads_mjcf()) return;
  const ScratchFolder folder;
  write(folder, "hfield.xml",
        test::world("",
                    "<asset><hfield name='h' nrow='30000' ncol='30000' size='1 1 1 1'/></asset>"));
  write(folder, "crowd.xml", test::world("<replicate count='1000000'>" + kBall + "</replicate>"));
  write(folder, "include.xml", "<mujoco>\n<include file='/etc/passwd'/></mujoco>");
  write(folder, "urdf.xml", "<robot name='r'><link name='l'/></robot>");
  write(folder, "empty.xml", "");
  REQUIRE(mkfifo((folder / "fifo.xml").c_str(), 0600) == 0);
  for (const char* command : {"run", "plan", "soak"}) {
    const auto refused = [&](const char* file, const char* message) {
      check_refused(run_in(folder, std::string(command) + " " + file), message);
    };
    refused("hfield.xml", "hfield.xml: hfield 'h', line 1: has 30000 x 30000 samples");
    refused("crowd.xml", "crowd.xml: replicate, line 1: makes 3000001 elements; expected at most");
    refused("include.xml", "include.xml: include, line 2: '/etc/passwd' is outside");
    refused("urdf.xml", "urdf.xml: robot 'r', line 1: is a URDF file");
    refused("empty.xml", "empty.xml: is an empty file");
    refused("fifo.xml", "fifo.xml: is a FIFO; expected a file");
  }
}

TEST_CASE("a model that MuJoCo is not done with in time ends as one line", "[cli]") {
  if (!test::program_reads_mjcf()) return;
  const ScratchFolder folder;
  write(folder, "crowd.xml", test::world("<replicate count='1000000'>" + kBall + "</replicate>"));
  check_refused(run_in(folder, "run crowd.xml --mjcf-limit copies=10000000 --mjcf-limit seconds=1"),
                "crowd.xml: MuJoCo did not compile it within 1 s");
}

TEST_CASE("a model that MuJoCo crashes on, or has no memory for, ends as one line", "[cli]") {
  if (!test::program_reads_mjcf()) return;
#ifdef MW_SANITIZED
  WARN("the child's memory is not limited under a sanitizer, whose shadow memory would not fit");
#else
  const ScratchFolder folder;
  write(folder, "mesh.xml",
        test::world("<geom type='mesh' mesh='m'/>",
                    "<asset><mesh name='m' builtin='supersphere' params='20000 1 1'/></asset>"));
  check_refused(
      run_in(folder, "run mesh.xml --mjcf-limit vertices=1000000000 --mjcf-limit megabytes=500"),
      "mesh.xml: ");
  write(folder, "hfield.xml",
        test::world("",
                    "<asset><hfield name='h' nrow='30000' ncol='30000' size='1 1 1 1'/></asset>"));
  check_refused(
      run_in(folder, "run hfield.xml --mjcf-limit samples=1000000000 --mjcf-limit megabytes=500"),
      "hfield.xml: ");
#endif
}

TEST_CASE("the program widens what an MJCF file may open and ask for", "[cli]") {
  if (!test::program_reads_mjcf()) return;
  const ScratchFolder folder;
  write(folder, "parts/ball.xml", test::world(kBall));
  write(folder, "model/model.xml", "<mujoco><include file='../parts/ball.xml'/></mujoco>");
  check_refused(run_in(folder, "run model/model.xml"), "outside the model's folder");
  const Outcome found =
      run_in(folder, "run model/model.xml --worlds 2 --steps 2 --mjcf-root parts");
  CHECK(found.code == 0);
  CHECK(contains(found.out, "hash"));
  check_refused(run_in(folder, "run parts/ball.xml --mjcf-limit elements=3"), "limit 'elements'");
  check_refused(run_in(folder, "run parts/ball.xml --mjcf-limit elementz=3"),
                "--mjcf-limit: unknown limit 'elementz'; expected file_bytes, ");
  check_refused(run_in(folder, "run parts/ball.xml --mjcf-limit elements"),
                "--mjcf-limit: must be NAME=N with a whole number N of at least 1, is 'elements'");
  check_refused(run_in(folder, "run parts/ball.xml --mjcf-limit elements=0"), "is 'elements=0'");
  check_refused(run_in(folder, "run parts/ball.xml --mjcf-root none"), "MJCF root 'none'");
}

}  // namespace manyworlds

#endif  // MW_HAVE_CLI
