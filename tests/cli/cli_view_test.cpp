// `view`: what it makes of recordings and scenes, and what it says where it cannot. What is on a
// page is tested in tests/record and in a browser (viewer/test).
#if MW_HAVE_CLI

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
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

struct ViewFolder : test::ProgramFolder {
  Outcome run(const std::string& arguments, const std::string& viewer = "viewer.html") const {
    return ProgramFolder::run(arguments, "MANYWORLDS_VIEWER=" + viewer);
  }
};

}  // namespace

TEST_CASE("view makes pages of scenes and recordings", "[cli]") {
  const ViewFolder folder;
  if (!test::program_records()) return;
  test::write_empty_page(folder);
  const Outcome scene =
      folder.run("view ball3d --worlds 3 --seconds 1 --fps 15 --out ball.html --json");
  INFO(scene.err);
  REQUIRE(scene.code == 0);
  const Json json = Json::parse(scene.out);
  CHECK(json["page"] == "ball.html");
  CHECK(json["worlds"] == 3);
  CHECK(json["bodies"] == 3);
  CHECK(json["frames"] == 16);
  CHECK(json["bytes"] == fs::file_size(folder / "ball.html"));
  CHECK(json["opened"] == false);

  REQUIRE(folder.run("run stack10 --worlds 4 --steps 12 --record a.h5 --record-every 2").code == 0);
  const Outcome both = folder.run("view a.h5 stack10 --seconds 0.1 --worlds 2 --out both.html");
  INFO(both.err);
  CHECK(both.code == 0);
  CHECK(contains(both.out, "both.html: 4 worlds, 40 moving bodies, 7 frames, "));
  CHECK(folder.run("view a.h5 --every 3 --json --out c.html").code == 0);
  // As many worlds as fit, and no file is left but the page.
  const Outcome fits = folder.run("view ball3d --seconds 0.1 --out d.html --json");
  CHECK(Json::parse(fits.out)["worlds"] == 256);
}

TEST_CASE("view says what is wrong", "[cli]") {
  const ViewFolder folder;
  if (!test::program_records()) return;
  test::check_refused(folder.run("view ball3d", "absent.html"),
                      "MANYWORLDS_VIEWER is 'absent.html', which is not a file");
  test::write_empty_page(folder);
  test::check_refused(folder.run("view absent.h5 --out a.html"), "'absent.h5': cannot be read");
  test::check_refused(folder.run("view ball4d --out a.html"), "unknown scene 'ball4d'");
  test::check_refused(folder.run("view ball3d --seconds 0.1 --worlds 2 --out no/such/a.html"),
                      "no/such");
  test::check_refused(folder.run("view ball3d --worlds 0"), "--worlds");
  test::check_refused(folder.run("view"), "what is required");
  for (const char* size : {"3x", "1280x720x", "63x64", "64x9000", "axb"}) {
    test::check_refused(folder.run(std::string("view ball3d --png a.png --size ") + size),
                        "--size: must be like 1280x720, each 64 to 8192, is '");
  }
  CHECK_FALSE(fs::exists(folder / "a.html"));
  std::ofstream(folder / "viewer.html") << "<html>";
  test::check_refused(folder.run("view ball3d --seconds 0.1 --worlds 2 --out a.html"),
                      "is not a page of this version");
}

TEST_CASE("contacts are recorded where they are asked for, and of scenes that view records",
          "[cli]") {
  const ViewFolder folder;
  if (!test::program_records()) return;
  test::write_empty_page(folder);
  const auto has_contacts = [&](const std::string& arguments) {
    const Outcome made = folder.run("view " + arguments + " --out page.html");
    INFO(made.err);
    REQUIRE(made.code == 0);
    return contains(test::content(folder / "page.html"), "\"contacts\":true");
  };
  CHECK(has_contacts("stack10 --worlds 2 --seconds 0.1"));
  CHECK_FALSE(has_contacts("stack10 --worlds 2 --seconds 0.1 --contacts 0"));
  REQUIRE(folder.run("run stack10 --worlds 2 --steps 4 --record a.h5 --record-contacts 5").code ==
          0);
  CHECK(has_contacts("a.h5"));
  CHECK(folder.run("replay a.h5").code == 0);
  REQUIRE(folder.run("run stack10 --worlds 2 --steps 4 --record b.h5").code == 0);
  CHECK_FALSE(has_contacts("b.h5"));
  test::check_refused(folder.run("run stack10 --record-contacts 5"),
                      "--record-contacts requires --record");
  test::check_refused(folder.run("run stack10 --record c.h5 --record-contacts 70000"),
                      "--record-contacts: must be at most 65536, is 70000");
  test::check_refused(folder.run("view stack10 --contacts -1"),
                      "--contacts: must be at least 0, is -1");
}

TEST_CASE("view without --out leaves its page in the temporary folder, or nothing", "[cli]") {
  const ViewFolder folder;
  if (!test::program_records()) return;
  fs::create_directory(folder / "tmp");
  const auto view = [&](const std::string& arguments) {
    return folder.run(arguments, "viewer.html TMPDIR=tmp env -u DISPLAY -u WAYLAND_DISPLAY");
  };
  std::ofstream(folder / "viewer.html") << "<html>";
  test::check_refused(view("view ball3d --seconds 0.1 --worlds 2"),
                      "is not a page of this version");
  CHECK(fs::is_empty(folder / "tmp"));
  test::write_empty_page(folder);
  test::check_refused(view("view absent.h5"), "'absent.h5': cannot be read");
  CHECK(fs::is_empty(folder / "tmp"));
  const Outcome made = view("view ball3d --seconds 0.1 --worlds 2 --json");
  REQUIRE(made.code == 0);
  const fs::path page = std::string(Json::parse(made.out)["page"]);
  CHECK(page.filename() == "ball3d.html");
  CHECK(fs::exists(folder / page.string()));
  CHECK(std::distance(fs::directory_iterator(folder / "tmp"), fs::directory_iterator()) == 1);
}

TEST_CASE("view --live says what it cannot show", "[cli]") {
  const ViewFolder folder;
  test::write_empty_page(folder);
  const Outcome bare = folder.run("view ball3d --live");
  if (contains(bare.err, "was built without")) {
    CHECK(bare.code == 2);
    CHECK(contains(bare.err, "libboost-dev"));
    return;
  }
  test::check_refused(bare, "the page is not of this version");  // it may open no socket
  test::check_refused(folder.run("view run.h5 --live"), "'run.h5' is a recording");
  test::check_refused(folder.run("view ball3d ball2d --live"), "expects one scene, 2 were given");
  test::check_refused(folder.run("view ball3d --live --speed fast"),
                      "--speed: must be 0.001 to 10000, or max");
  test::check_refused(folder.run("view ball3d --live --speed 0"), "is '0'");
  test::check_refused(folder.run("view nothing --live"), "nothing");
  for (const char* other : {"--out a.html", "--png a.png", "--seconds 3", "--fps 5"}) {
    CHECK(folder.run(std::string("view ball3d --live ") + other).code == 2);
  }
  for (const char* alone : {"--speed 2", "--port 8080", "--paused"}) {
    CHECK(folder.run(std::string("view ball3d ") + alone).code == 2);
  }
  test::check_refused(folder.run("view ball3d --live", "none.html"),
                      "MANYWORLDS_VIEWER is 'none.html'");
}

}  // namespace manyworlds

#endif
