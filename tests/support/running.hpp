// The program manyworlds in the background, to be ended by a signal.
#pragma once

#if MW_HAVE_CLI

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "tests/support/program.hpp"

namespace manyworlds::test {

// The program in the background, with the signals that a shell in the foreground gives it.
class Running {
 public:
  // `environment`: additional "NAME=value" entries.
  Running(const ScratchFolder& folder, const std::vector<std::string>& arguments,
          const std::vector<std::string>& environment = {})
      : folder_(folder) {
    process_ = fork();
    if (process_ != 0) return;
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, SIG_DFL);
    const auto open_as = [&](const char* name, int number) {
      dup2(open((folder.path() / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), number);
    };
    open_as("out", 1), open_as("err", 2);
    std::vector<const char*> words = {kProgram};
    for (const std::string& word : arguments) words.push_back(word.c_str());
    words.push_back(nullptr);
    for (const std::string& one : environment) putenv(const_cast<char*>(one.c_str()));
    if (chdir(folder.path().c_str()) == 0) {
      execv(kProgram, const_cast<char* const*>(words.data()));
    }
    std::_Exit(127);
  }
  ~Running() {
    if (process_ > 0) kill(process_, SIGKILL), waitpid(process_, nullptr, 0);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  // Waits until it notes signals, so that one that is sent does not end it.
  bool is_ready() const {
    return wait_until([&] {
      // Before it is started it is this program, which notes signals, too.
      std::error_code gone;
      const std::filesystem::path runs =
          std::filesystem::read_symlink("/proc/" + std::to_string(process_) + "/exe", gone);
      if (gone || runs != std::filesystem::canonical(kProgram)) return false;
      std::istringstream status(content("/proc/" + std::to_string(process_) + "/status"));
      for (std::string line; std::getline(status, line);) {
        if (line.rfind("SigCgt:", 0) != 0) continue;
        return (std::stoull(line.substr(7), nullptr, 16) >> (SIGTERM - 1) & 1) != 0;
      }
      return false;
    });
  }
  static bool wait_until(const std::function<bool()>& so) {
    for (int i = 0; i < 6000; ++i) {
      if (so()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  // Its exit code; 128 and the signal where one ended it.
  Outcome end(int number) {
    kill(process_, number);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    return {code, content(folder_ / "out"), content(folder_ / "err")};
  }

 private:
  const ScratchFolder& folder_;
  pid_t process_ = -1;
};

}  // namespace manyworlds::test

#endif  // MW_HAVE_CLI
