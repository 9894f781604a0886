// Files are written whole or not at all, and nothing but files is written over.
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>

#include "manyworlds/snapshot.hpp"
#include "src/base/output_file.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/program.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

mode_t mode_of(const fs::path& file) {
  struct stat at {};
  REQUIRE(stat(file.c_str(), &at) == 0);
  return at.st_mode & 07777;
}

void check_refused(const fs::path& file, const std::string& why) {
  CHECK_THROWS_WITH(write_file(file, "new"), "'" + file.string() + "': " + why);
}

}  // namespace

TEST_CASE("what exists and is no regular file is refused, and stays", "[fast][files]") {
  const ScratchFolder folder;
  check_refused("/dev/null", "is a device, not a file");
  CHECK(fs::is_character_file("/dev/null"));
  fs::create_directory(folder / "sub");
  check_refused(folder / "sub", "is a directory, not a file");
  REQUIRE(mkfifo((folder / "fifo").c_str(), 0600) == 0);
  check_refused(folder / "fifo", "is a FIFO, not a file");
  CHECK(fs::is_fifo(folder / "fifo"));
  const int socket_number = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = folder / "socket";
  REQUIRE(name.size() < sizeof address.sun_path);
  name.copy(address.sun_path, name.size());
  REQUIRE(bind(socket_number, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  close(socket_number);
  check_refused(folder / "socket", "is a socket, not a file");
  // Behind a link it is what it is.
  fs::create_symlink("/dev/null", folder / "link");
  check_refused(folder / "link", "is a device, not a file");
  fs::create_symlink("round", folder / "round");
  check_refused(folder / "round", "symbolic links form a loop");
  check_refused(folder / "no" / "file", "no such folder: '" + (folder / "no").string() + "'");
  check_refused("", "is not a file name");
  check_refused(folder / "sub" / ".", "is a directory, not a file");
  write_file(folder / "file", "old");
  check_refused(folder / "file" / "file", "its folder cannot be used: Not a directory");
  CHECK(files_in(folder.path()) ==
        std::vector<std::string>{"fifo", "file", "link", "round", "socket", "sub"});
}

TEST_CASE("a snapshot refuses what is no file", "[fast][files][snapshot]") {
  Batch batch(compile(crowd(Space::planar)), options_of(widest_tables().front(), 2));
  CHECK_THROWS_WITH(batch.save().save("/dev/null"),
                    "snapshot: cannot write '/dev/null': is a device, not a file");
  CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("a symbolic link is followed, and its target replaced", "[fast][files]") {
  const ScratchFolder folder;
  fs::create_directory(folder / "there");
  write_file(folder / "there" / "file", "old");
  fs::create_symlink("there/file", folder / "link");
  fs::create_symlink("link", folder / "far");
  write_file(folder / "far", "new");
  CHECK(content(folder / "there" / "file") == "new");
  CHECK(fs::is_symlink(folder / "far"));
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(files_in(folder / "there") == std::vector<std::string>{"file"});
  // One that leads to nothing yet.
  fs::create_symlink("there/other", folder / "ahead");
  write_file(folder / "ahead", "first");
  CHECK(content(folder / "there" / "other") == "first");
}

TEST_CASE("nobody can prepare for a part file's name, nor get its descriptor", "[fast][files]") {
  const ScratchFolder folder;
  std::set<std::string> names;
  for (int i = 0; i < 100; ++i) {
    const OutputFile out(folder / "file");
    const std::string name = out.part().filename();
    CHECK(name.rfind("file.part-", 0) == 0);
    names.insert(name);
    if (i > 0) continue;
    CHECK(name.size() == std::string("file.part-").size() + 16);
    // Of the open files of this process that one: closed where a program is started.
    int found = 0;
    for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
      std::error_code gone;
      if (fs::read_symlink(entry.path(), gone) != fs::canonical(out.part())) continue;
      ++found;
      CHECK((fcntl(std::stoi(entry.path().filename()), F_GETFD) & FD_CLOEXEC) != 0);
    }
    CHECK(found == 1);
  }
  CHECK(names.size() == 100);
  CHECK(files_in(folder.path()).empty());
  // A name as long as names may be leaves room for it.
  const std::string longest(255, 'x');
  write_file(folder / longest, "text");
  CHECK(files_in(folder.path()) == std::vector{longest});
}

TEST_CASE("a new file has the mode that the umask leaves it, an old one keeps its own",
          "[fast][files]") {
  const ScratchFolder folder;
  const mode_t before = umask(027);
  write_file(folder / "new", "text");
  umask(before);
  CHECK(mode_of(folder / "new") == 0640);
  write_file(folder / "old", "old");
  REQUIRE(chmod((folder / "old").c_str(), 0604) == 0);
  write_file(folder / "old", "new");
  CHECK(mode_of(folder / "old") == 0604);
  CHECK(content(folder / "old") == "new");
}

TEST_CASE("a file that may not be written is not replaced", "[fast][files]") {
  const ScratchFolder folder;
  write_file(folder / "old", "old");
  REQUIRE(chmod((folder / "old").c_str(), 0444) == 0);
  REQUIRE(chmod(folder.path().c_str(), 0777) == 0);
  const uid_t user = geteuid();
  if (user == 0) REQUIRE(seteuid(65534) == 0);  // root may write anything
  std::string message;
  try {
    write_file(folder / "old", "new");
  } catch (const FileError& error) {
    message = error.reason();
  }
  REQUIRE(seteuid(user) == 0);
  CHECK(message == "Permission denied");
  CHECK(content(folder / "old") == "old");
}

TEST_CASE("what is not committed leaves nothing, and the old file", "[fast][files]") {
  const ScratchFolder folder;
  write_file(folder / "file", "old");
  {
    OutputFile out(folder / "file");
    out.write(std::as_bytes(std::span("new", 3)), 0);
    CHECK(files_in(folder.path()).size() == 2);
  }
  CHECK(files_in(folder.path()) == std::vector<std::string>{"file"});
  CHECK(content(folder / "file") == "old");
  // Something else has taken the name in between.
  OutputFile out(folder / "file");
  fs::remove(folder / "file");
  fs::create_directory(folder / "file");
  CHECK_THROWS_WITH(out.commit(), Catch::EndsWith("is a directory, not a file"));
}

TEST_CASE("threads that save one path leave one whole file", "[fast][files][snapshot]") {
  const ScratchFolder folder;
  const fs::path file = folder / "start.mws";
  Batch batch(compile(crowd(Space::planar)), options_of(widest_tables().front(), 8));
  const Snapshot one = batch.save();
  batch.step(3);
  const Snapshot two = batch.save();
  one.save(file);
  std::vector<std::thread> threads;
  for (const Snapshot* snapshot : {&one, &two, &one, &two}) {
    threads.emplace_back([&file, snapshot] {
      for (int i = 0; i < 10; ++i) snapshot->save(file);
    });
  }
  for (int i = 0; i < 50; ++i) CHECK(Snapshot::load(file).worlds() == 8);
  for (std::thread& thread : threads) thread.join();
  const Snapshot last = Snapshot::load(file);
  CHECK((last.bytes() == one.bytes() || last.bytes() == two.bytes()));
  CHECK(files_in(folder.path()) == std::vector<std::string>{"start.mws"});
}

TEST_CASE("part files are left over once nobody writes them", "[fast][files]") {
  const ScratchFolder folder;
  const fs::path file = folder / "file";
  std::vector<fs::path> parts;
  {
    OutputFile one(file), two(file), other(folder / "file2");
    CHECK(leftover_parts(file).empty());
    parts = {one.part(), two.part()};
    for (OutputFile* out : {&one, &two, &other}) out->keep();
  }
  std::sort(parts.begin(), parts.end());
  CHECK(leftover_parts(file) == parts);
  fs::create_symlink("file", folder / "link");
  CHECK(leftover_parts(folder / "link") == parts);
  CHECK(leftover_parts_in(folder.path()).size() == 3);
  write_file(folder / "file.part-of-something", "");
  write_file(folder / "file.part-0123456789abcdeg", "");
  CHECK(leftover_parts(file) == parts);
  CHECK(leftover_parts_in(folder.path()).size() == 3);
}

}  // namespace manyworlds::test
