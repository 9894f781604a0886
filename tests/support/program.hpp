// The program manyworlds, run as its users run it, in a folder of its own.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "tests/support/paths.hpp"

namespace manyworlds::test {

// A folder of its own, gone with the object.
class ScratchFolder {
 public:
  ScratchFolder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("manyworlds_cli_test_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string content(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

// `program` in `folder`, with `arguments` as a shell takes them; `environment` is put in front.
inline Outcome run_program(const std::string& program, const ScratchFolder& folder,
                           const std::string& arguments, const std::string& environment = "") {
  const std::string command = "cd '" + folder.path().string() + "' && " + environment + " '" +
                              program + "' " + arguments + " >out 2>err </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(folder / "out"),
          content(folder / "err")};
}

#if MW_HAVE_CLI
// A folder that the program runs in.
struct ProgramFolder : ScratchFolder {
  Outcome run(const std::string& arguments, const std::string& environment = "") const {
    return run_program(kProgram, *this, arguments, environment);
  }
};
#endif

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

#if MW_HAVE_CLI
// Whether the program's `info` has this line.
inline bool program_has(const std::string& line) {
  return contains(run_program(kProgram, ScratchFolder(), "info").out, line);
}
inline bool program_records() { return program_has("recordings   yes"); }
inline bool program_reads_mjcf() { return program_has("mjcf         yes"); }

// A page that holds nothing but the place for recordings.
inline void write_empty_page(const ScratchFolder& folder) {
  std::ofstream(folder / "viewer.html")
      << "<meta name=\"manyworlds-page\" content=\"1\"><!-- manyworlds: recordings -->";
}
#endif

}  // namespace manyworlds::test
