// `view --mp4` and `--png`: what is asked of the browser and the encoder, and what is said where
// they fail. Both are scripts here; real ones are in viewer/test.
#if MW_HAVE_CLI

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace manyworlds {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::contains, test::content, test::Outcome;

struct FilmFolder : test::ProgramFolder {
  FilmFolder() {
    write("viewer.html",
          "<meta name=\"manyworlds-page\" content=\"1\"><!-- manyworlds: recordings -->");
    // Links, so that they can be taken away.
    fs::create_symlink(std::string(test::kSourceFolder) + "/tests/support/fake_browser.py",
                       *this / "browser");
    fs::create_symlink(std::string(test::kSourceFolder) + "/tests/support/fake_encoder.sh",
                       *this / "encoder");
    fs::create_directory(*this / "tmp");
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(*this / name) << text;
  }
  Outcome run(const std::string& arguments, const std::string& mode = "") const {
    return ProgramFolder::run(
        arguments,
        "MANYWORLDS_VIEWER=viewer.html TMPDIR=\"$PWD/tmp\" CHROMIUM=./browser "
        "FFMPEG=./encoder MODE=" +
            mode);
  }
  // Whether nothing was left: no part of a file, nothing in the temporary folder.
  void check_clean() const {
    CHECK(fs::is_empty(*this / "tmp"));
    for (const auto& entry : fs::directory_iterator(path())) {
      CHECK_FALSE(contains(entry.path().filename().string(), ".part-"));
    }
  }
  void check_bad(const Outcome& outcome, const std::string& message) const {
    INFO(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, message));
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    CHECK_FALSE(fs::exists(*this / "film.mp4"));
    check_clean();
  }
};

constexpr const char* kShort = "view ball3d --worlds 2 --seconds 0.1 --mp4 film.mp4 ";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

}  // namespace

TEST_CASE("films have a frame for each moment, in order", "[cli]") {
  const FilmFolder folder;
  if (!test::program_records()) return;
  const std::string name = "it's \"my\" $film;*.mp4";
  const Outcome made = folder.run(
      "view ball3d --worlds 2 --seconds 0.1 --fps 4 --speed 0.5 --begin 0.25 --end 1 --size "
      "640x480 "
      "--world 1 --follow \"a &b\" --color speed --dark --json --mp4 \"it's \\\"my\\\" "
      "\\$film;*.mp4\"");
  INFO(made.err);
  REQUIRE(made.code == 0);
  const Json json = Json::parse(made.out);
  CHECK(json["film"]["file"] == name);
  CHECK(json["film"]["frames"] == 7);
  CHECK(json["film"]["seconds"] == 1.75);
  CHECK(json["film"]["bytes"] == fs::file_size(folder / name));
  CHECK_FALSE(json.contains("page"));
  const std::vector<std::string> frames = lines_of(content(folder / name));
  REQUIRE(frames.size() == 7);
  for (int k = 0; k < 7; ++k) {  // 0.125 s apart, which has no error
    const auto at = static_cast<std::size_t>(k);
    CHECK(frames[at] == Json(0.25 + 0.125 * k).dump() + " image/jpeg true");
  }
  CHECK(content(folder / "size") == "640x480");
  CHECK(contains(content(folder / "url"),
                 "/page.html#film&world=1&follow=a%20%26b&color=speed&theme=dark"));
  CHECK(contains(content(folder / "arguments"), "\n-framerate\n4.000000\n"));
  folder.check_clean();
}

TEST_CASE("pictures are of one moment", "[cli]") {
  const FilmFolder folder;
  if (!test::program_records()) return;
  const Outcome both = folder.run(
      "view ball3d --worlds 2 --seconds 0.1 --png a.png --time 1.5 --out page.html --size 65x99");
  INFO(both.err);
  CHECK(both.code == 0);
  CHECK(content(folder / "a.png") == "1.5 image/png false\n");
  CHECK(contains(both.out, "page.html, a.png: 2 worlds, "));
  CHECK(contains(content(folder / "url"), "/page.html#film"));
  CHECK(fs::exists(folder / "page.html"));
  const Outcome at_end = folder.run("view ball3d --worlds 2 --seconds 0.1 --png a.png");
  CHECK(contains(at_end.out, "a.png: 2 worlds, "));
  CHECK(content(folder / "a.png") == "2.0 image/png false\n");
  folder.check_clean();
}

TEST_CASE("times of films and pictures have their former names, too", "[cli]") {
  const FilmFolder folder;
  if (!test::program_records()) return;
  const Outcome made = folder.run(
      "view ball3d --worlds 2 --seconds 0.1 --at 0.5 --until 1 --fps 2 --mp4 film.mp4 --png a.png");
  INFO(made.err);
  CHECK(made.code == 0);
  CHECK(content(folder / "a.png") == "0.5 image/png false\n");
  CHECK(content(folder / "film.mp4") == "0.5 image/jpeg true\n1.0 image/jpeg true\n");
  CHECK_FALSE(contains(folder.run("view --help").out, "--until"));
}

TEST_CASE("films say what is wrong, and leave nothing", "[cli]") {
  const FilmFolder folder;
  if (!test::program_records()) return;
  const auto bad = [&](const std::string& mode, const std::string& message) {
    folder.check_bad(folder.run(kShort, mode), message);
  };
  bad("dies", "./browser ended (exit code 1): no display");
  bad("babbles", "./browser sent an invalid message");
  bad("crashes", "the page crashed in ./browser");
  bad("refuses", "the page: there is no world 7, only 0 to 1\n");
  bad("fails", "'film.mp4': ./encoder failed (exit code 1): No space left on device");
  bad("ends", "'film.mp4': ./encoder failed (exit code 8): Unknown encoder");
  folder.check_bad(folder.run(std::string(kShort) + "--begin 3"),
                   "the film would start at 3.0 s, but worlds end at 2.0 s");
  folder.check_bad(folder.run("view ball3d --worlds 2 --seconds 0.1 --mp4 no/such/film.mp4"),
                   "no such folder: 'no/such'");
  folder.check_bad(folder.run("view ball3d --worlds 2 --seconds 0.1 --mp4 tmp"),
                   "'tmp': is a directory, not a file");
  // What was there stays.
  folder.write("film.mp4", "old");
  CHECK(folder.run(kShort, "fails").code == 2);
  CHECK(content(folder / "film.mp4") == "old");
  fs::remove(folder / "film.mp4");

  fs::rename(folder / "encoder", folder / "gone");
  bad("",
      "needs an encoder, found none of ./encoder; install Debian's ffmpeg or PyPI's imageio-ffmpeg "
      "(found ");
  fs::rename(folder / "browser", folder / "gone");
  const Outcome picture = folder.run("view ball3d --png a.png");  // at once: nothing is recorded
  folder.check_bad(picture, "needs a browser, found none of ./browser; install Debian's chromium");
}

TEST_CASE("films refuse options that they cannot have", "[cli]") {
  const FilmFolder folder;
  if (!test::program_records()) return;
  const auto bad = [&](const std::string& options, const std::string& message) {
    folder.check_bad(folder.run("view ball3d " + options), message);
  };
  bad("--mp4 film.mp4 --size 641x480", "--size: must be even numbers for a film, is '641x480'");
  bad("--mp4 film.mp4 --speed max", "--speed: must be 0.001 to 1000 for a film, is 'max'");
  bad("--mp4 film.mp4 --speed 0", "is '0'");
  bad("--mp4 film.mp4 --begin 2 --end 1", "--end: must be 2 s (--begin) or later, is 1 s");
  bad("--png a.png --speed 2", "--speed: is of --live and --mp4");
  bad("--mp4 film.mp4 --time 2", "--time: applies only with --png");
  bad("--png a.png --begin 1", "--begin: applies only with --mp4");
  bad("--png a.png --end 1", "--end: applies only with --mp4");
  bad("--png a.png --until 1", "--until: applies only with --mp4");
  bad("--out a.html --at 2", "--at: applies only with --png or --mp4");
  bad("--mp4 film.mp4 --at 2 --begin 1", "--at: excludes --time and --begin");
  bad("--mp4 film.mp4 --until 2 --end 3", "--until: excludes --end");
  bad("--live --at 2", "--at, --until: exclude --live");
  bad("--out a.html --dark",
      "--world, --follow, --color, --dark: applies only with --png or --mp4");
  bad("--out a.html --follow ball", "applies only with --png or --mp4");
}

TEST_CASE("a film that is interrupted leaves nothing", "[cli]") {
  const FilmFolder folder;
  if (!test::program_records()) return;
  for (const auto& [name, code] : {std::pair{"INT", 130}, {"TERM", 143}}) {
    fs::remove(folder / "browser_waits");
    // With job control, without which a shell has programs in the background ignore SIGINT.
    const Outcome stopped = test::run_program(
        "bash", folder,
        "-c 'set -m; \"$0\" \"$@\" & program=$!; "
        "while [ ! -s browser_waits ]; do sleep 0.05; done; kill -" +
            std::string(name) + " $program; wait $program' \"" + std::string(test::kProgram) +
            "\" " + kShort,
        "MANYWORLDS_VIEWER=viewer.html TMPDIR=\"$PWD/tmp\" CHROMIUM=./browser FFMPEG=./encoder "
        "MODE=sleeps");
    INFO(stopped.err);
    CHECK(stopped.code == code);
    CHECK(contains(stopped.err, std::string("SIG") + name + ": nothing was written"));
    CHECK_FALSE(fs::exists(folder / "film.mp4"));
    folder.check_clean();
    // The browser is gone, too.
    CHECK_FALSE(fs::exists("/proc/" + content(folder / "browser_waits")));
  }
}

}  // namespace manyworlds

#endif
