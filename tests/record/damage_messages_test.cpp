// What is said of a damaged recording: one line that names the file and what in it is wrong, what
// was found and what was expected, in the words of our own format and not in those of HDF5.
#include <catch2/catch.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <set>

#include "tests/record/faults.hpp"
#include "tests/record/forged.hpp"

namespace manyworlds::test {
namespace {

// Nobody but who reads HDF5's or the standard library's source knows these words.
const char* const kForeign[] = {"H5",     "HDF5:",       "unable to",        "object header",
                                "b-tree", "B-tree",      "filesystem error", "json.exception",
                                "std::",  "heap",        "link info",        "superblock",
                                "symbol", "std::length", "vector::",         "basic_string"};

// The messages of files, each of which is read in one child.
class Messages {
 public:
  explicit Messages(const Folder& folder) : file_(folder / "run.h5") {}

  // What is wrong with what is said of these bytes. `place` is a name that it has to give.
  std::string of(const Bytes& bytes, const std::string& place = {}, bool must_fail = true) {
    write_bytes(file_, bytes);
    return of_file(file_, place, must_fail);
  }
  std::string of_file(const fs::path& file, const std::string& place = {}, bool must_fail = true) {
    try {
      replay(Recording::open(file));
    } catch (const RecordError& error) {
      for (const std::string& problem : error.problems()) {
        const std::string wrong = what_is_wrong(problem, "'" + file.string() + "': ", place);
        if (!wrong.empty()) return wrong + ": " + problem;
      }
      return {};
    } catch (const std::exception& error) {
      return std::string("another error: ") + error.what();
    }
    return must_fail ? "nothing is wrong" : "";
  }

 private:
  static std::string what_is_wrong(const std::string& text, const std::string& start,
                                   const std::string& place) {
    if (!text.starts_with(start) || text.size() < start.size() + 10) return "no file";
    const std::string rest = text.substr(start.size());
    for (const char c : rest) {
      if (static_cast<unsigned char>(c) < ' ') return "a control character";
    }
    for (const char* word : kForeign) {
      if (rest.find(word) != std::string::npos) return std::string("the word ") + word;
    }
    return rest.find(place) == std::string::npos ? "no " + place : "";
  }

  fs::path file_;
};

int open_files() {
  int count = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator("/proc/self/fd")) ++count;
  return count;
}

// All of `cases(messages)` in a child, whose end is looked at, too.
template <class Cases>
void check_messages(Cases cases) {
  honest();
  const Folder folder;
  CHECK(in_child([&](const Progress&) -> std::string {
          Messages messages(folder);
          messages.of(honest(), {}, false);  // HDF5 sets itself up at first
          const int open_before = open_files();
          const std::string problem = cases(messages);
          return problem.empty() && open_files() != open_before ? "files are left open" : problem;
        }) == "");
}

Bytes sealed(Bytes bytes) {
  record::seal(std::span(bytes));
  return bytes;
}

const char* const kTables[] = {"step",
                               "inputs_before",
                               "time",
                               "start",
                               "kinds/0/world",
                               "kinds/0/hash",
                               "kinds/0/status",
                               "kinds/0/position",
                               "kinds/0/orientation",
                               "kinds/0/linear_velocity",
                               "kinds/0/angular_velocity",
                               "inputs/step",
                               "inputs/call_steps",
                               "inputs/input",
                               "inputs/world",
                               "inputs/body",
                               "inputs/begin",
                               "inputs/count",
                               "inputs/values",
                               "inputs/states"};
const char* const kTexts[] = {"kinds/0/scene", "kinds/0/plan_options"};

std::string leaf(const std::string& path) { return path.substr(path.rfind('/') + 1); }

// In the place of what was there: a dataset of `type` and `rank` dimensions, with nothing written.
void put_other(hid_t h5, const char* name, hid_t type, int rank) {
  H5Ldelete(h5, name, H5P_DEFAULT);
  const hsize_t dims[] = {3, 3, 3, 3, 3};
  const hid_t space = rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, dims, nullptr);
  const hid_t data = H5Dcreate2(h5, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dclose(data), H5Sclose(space);
}

// The part file of a recording whose disk became full after the first flushes.
Bytes part_file() {
  const Folder folder;
  const fs::path file = folder / "run.h5";
  Batch batch(compile(crowd(Space::planar)), batch_options(widest_tables().front(), 2));
  Recorder recorder(batch, file, {.every = 1, .flush_seconds = 0});
  batch.step(2);
  batch.step(2);
  fail_call(Call::write, 1, ENOSPC, true);
  batch.step(2);
  CHECK_THROWS_AS(recorder.close(), RecordError);
  end_failing();
  const auto left = unfinished_recordings(file);
  REQUIRE(left.size() == 1);
  return bytes_of(left.front());
}

}  // namespace

TEST_CASE("a recording that was cut or changed says so in one line", "[fast][record][messages]") {
  check_messages([](Messages& messages) -> std::string {
    const Bytes& whole = honest();
    for (std::size_t n = 0; n < whole.size(); n += kOneIn * (n < 600 ? 50 : 997)) {
      const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n));
      if (const std::string wrong = messages.of(cut); !wrong.empty()) return wrong;
      // A right frame around what is cut.
      if (n < record::kFrameSize) continue;
      if (const std::string wrong = messages.of(sealed(cut)); !wrong.empty()) return wrong;
    }
    for (std::size_t i = 0; i < whole.size(); i += i < 40 ? 1 : kOneIn * 211) {
      Bytes changed = whole;
      changed[i] ^= std::byte{0x41};
      if (const std::string wrong = messages.of(changed); !wrong.empty()) return wrong;
      // May be a number that nothing depends on.
      const std::string wrong = messages.of(sealed(changed), {}, false);
      if (!wrong.empty()) return wrong;
    }
    for (const std::size_t at : {0u, 512u, 600u, 1024u, 4096u}) {
      Bytes zeroed = whole;
      std::fill_n(zeroed.begin() + static_cast<std::ptrdiff_t>(at), 512, std::byte{0});
      if (const std::string wrong = messages.of(zeroed); !wrong.empty()) return wrong;
      const std::string wrong = messages.of(sealed(zeroed), {}, false);
      if (!wrong.empty()) return wrong;
    }
    return {};
  });
}

TEST_CASE("what is missing in a recording, or of another kind, is named",
          "[fast][record][messages]") {
  check_messages([](Messages& messages) -> std::string {
    std::vector<std::string> all(std::begin(kTables), std::end(kTables));
    all.insert(all.end(), std::begin(kTexts), std::end(kTexts));
    for (const std::string& name : all) {
      const std::function<void(hid_t)> changes[] = {
          [&](hid_t h5) { H5Ldelete(h5, name.c_str(), H5P_DEFAULT); },
          [&](hid_t h5) {
            H5Ldelete(h5, name.c_str(), H5P_DEFAULT);
            H5Gclose(H5Gcreate2(h5, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
          },
          [&](hid_t h5) {
            H5Ldelete(h5, name.c_str(), H5P_DEFAULT);
            H5Lcreate_soft("/nowhere", h5, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
          },
          [&](hid_t h5) { put_other(h5, name.c_str(), H5T_STD_I16BE, 1); },
          [&](hid_t h5) { put_other(h5, name.c_str(), H5T_C_S1, 2); },
          [&](hid_t h5) { put_other(h5, name.c_str(), H5T_IEEE_F32LE, 5); },
          [&](hid_t h5) { put_other(h5, name.c_str(), H5T_STD_I64LE, 0); },
      };
      for (const auto& change : changes) {
        const std::string wrong = messages.of(rebuilt(change), "'" + leaf(name) + "'");
        if (!wrong.empty()) return name + ": " + wrong;
      }
    }
    for (const char* name :
         {"format", "format_version", "precision", "sleep", "threads", "seed", "isa"}) {
      for (const bool other : {false, true}) {
        const std::string wrong = messages.of(
            rebuilt([&](hid_t h5) {
              H5Adelete(h5, name);
              if (!other) return;
              const hid_t space = H5Screate(H5S_SCALAR);
              H5Aclose(H5Acreate2(h5, name, H5T_STD_I16BE, space, H5P_DEFAULT, H5P_DEFAULT));
              H5Sclose(space);
            }),
            name);
        if (!wrong.empty()) return wrong;
      }
    }
    return {};
  });
}

TEST_CASE("a damaged part file says so in one line", "[fast][record][messages]") {
  const Bytes part = part_file();
  check_messages([&](Messages& messages) -> std::string {
    std::string wrong = messages.of(part, {}, false);
    for (std::size_t n = 8; wrong.empty() && n < part.size(); n += kOneIn * (n < 600 ? 25 : 997)) {
      const auto end = part.begin() + static_cast<std::ptrdiff_t>(n);
      wrong = messages.of({part.begin(), end}, {}, false);
    }
    for (std::size_t i = 0; wrong.empty() && i < part.size(); i += i < 64 ? 1 : kOneIn * 211) {
      Bytes changed = part;
      changed[i] ^= std::byte{0x41};
      wrong = messages.of(changed, {}, false);
    }
    return wrong;
  });
}

TEST_CASE("what is no recording at all is told from one", "[fast][record][messages]") {
  const Folder folder;
  write_bytes(folder / "text", Bytes(2000, std::byte{'x'}));
  write_bytes(folder / "escape", Bytes(2000, std::byte{0x1b}));
  write_bytes(folder / "empty", {});
  write_bytes(folder / "zeros", Bytes(4096));
  H5Fclose(H5Fcreate((folder / "other").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  REQUIRE(mkfifo((folder / "fifo").c_str(), 0600) == 0);
  write_bytes(folder / "secret", honest());
  REQUIRE(chmod((folder / "secret").c_str(), 0) == 0);
  REQUIRE(chmod(folder.path().c_str(), 0777) == 0);
  check_messages([&](Messages& messages) -> std::string {
    const uid_t user = geteuid();
    if (user == 0 && seteuid(65534) != 0) return "cannot be somebody else";  // root reads all
    const std::string long_name(300, 'x');
    const std::pair<fs::path, const char*> cases[] = {
        {folder / "text", "begins with 'xxxxxxxx', must begin with 'MWRECO'"},
        {folder / "escape", "begins with '?"},
        {folder / "empty", "is 0 bytes long, too short for a recording, must be at least 512"},
        {folder / "zeros", "begins with zeros"},
        {folder / "other", "is an HDF5 file of another program"},
        {folder / "fifo", "is not a regular file; expected a recording"},
        {folder / "secret", "Permission denied"},
        {folder / "absent", "No such file or directory"},
        {folder / "text" / "below", "Not a directory"},
        {folder / long_name, "File name too long"},
        {folder.path(), "is a directory"},
        {"/dev/null", "is not a regular file"},
        {"", "No such file or directory"},
    };
    for (const auto& [file, why] : cases) {
      const std::string wrong = messages.of_file(file, why);
      if (!wrong.empty()) return wrong;
    }
    return seteuid(user) == 0 ? "" : "cannot be oneself again";
  });
}

}  // namespace manyworlds::test
