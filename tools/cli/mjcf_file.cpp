#include "mjcf_file.hpp"

#include <fmt/format.h>

#include "not_built.hpp"
#include "options.hpp"

#ifdef MW_HAVE_MJCF

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <utility>

#include "tools/base/tell.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MW_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define MW_SANITIZED 1
#endif
#endif

namespace manyworlds::cli {
namespace {

using Clock = std::chrono::steady_clock;

// Of the child alone; the limits of the files themselves are MjcfLimits.
struct ChildLimits {
  std::int64_t megabytes = 4096;  // besides what the program has already
  std::int64_t seconds = 60;      // of a CPU
};

struct Limits {
  MjcfOptions options;
  ChildLimits child;
};

Limits parse_limits(const MjcfArguments& arguments) {
  Limits limits;
  limits.options.roots.assign(arguments.roots.begin(), arguments.roots.end());
  for (const std::string& text : arguments.limits) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    std::int64_t value = 0;
    const char* begin = text.data() + (equals == std::string::npos ? text.size() : equals + 1);
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (begin == end || error != std::errc{} || stop != end || value < 1) {
      throw InputError(fmt::format(
          "--mjcf-limit: must be NAME=N with a whole number N of at least 1, is '{}'", text));
    }
    if (name == "megabytes") {
      limits.child.megabytes = value;
    } else if (name == "seconds") {
      limits.child.seconds = value;
    } else {
      try {
        mjcf_limit(limits.options.limits, name) = value;
      } catch (const std::invalid_argument&) {
        throw InputError(
            fmt::format("--mjcf-limit: unknown limit '{}'; expected {}, megabytes or seconds", name,
                        fmt::join(mjcf_limit_names(), ", ")));
      }
    }
  }
  return limits;
}

void set_limit(int resource, std::int64_t most) {
  rlimit limit{};
  getrlimit(static_cast<__rlimit_resource_t>(resource), &limit);
  const auto value = static_cast<rlim_t>(most);
  if (limit.rlim_max == RLIM_INFINITY || value < limit.rlim_max) limit.rlim_max = value;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(static_cast<__rlimit_resource_t>(resource), &limit);
}

// Bytes of address space that the process has now; 0 if it cannot be told.
std::int64_t address_space() {
  long long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lld", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * sysconf(_SC_PAGESIZE);
}

// The child: compiles, says what was wrong, and ends. Nothing of the parent's is flushed or freed.
[[noreturn]] void compile_in_child(const MjcfFiles& files, const ChildLimits& limits, int out,
                                   pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  for (const int sig : {SIGINT, SIGTERM, SIGXCPU, SIGSEGV, SIGABRT}) signal(sig, SIG_DFL);
  // The parent says in one line what happened, so that the C++ library of MuJoCo need not.
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, limits.seconds);
#ifndef MW_SANITIZED  // whose shadow memory takes terabytes of address space
  const std::int64_t present = address_space();
  if (present > 0) set_limit(RLIMIT_AS, present + limits.megabytes * 1000000);
#endif
  std::string problems;
  try {
    files.compile();
  } catch (const std::exception& error) {
    problems = error.what();
    if (problems.empty()) problems = "cannot be read";
  }
  for (std::size_t at = 0; at < problems.size();) {
    const ssize_t n = write(out, problems.data() + at, problems.size() - at);
    if (n < 0 && errno != EINTR) break;
    if (n > 0) at += static_cast<std::size_t>(n);
  }
  _exit(0);
}

// What the child writes until it ends. Kills it at the deadline and then returns false.
bool read_until_end(int in, pid_t child, Clock::time_point deadline, std::string& text) {
  while (true) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) {
      kill(child, SIGKILL);
      return false;
    }
    pollfd wait{in, POLLIN, 0};
    if (poll(&wait, 1, static_cast<int>(std::min<std::int64_t>(left.count(), 1000))) <= 0) continue;
    std::array<char, 4096> buffer{};
    const ssize_t n = read(in, buffer.data(), buffer.size());
    if (n == 0) return true;
    if (n > 0) text.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

// Throws InputError when a child process cannot compile the files within its limits.
void require_harmless(const MjcfFiles& files, const std::string& path, const ChildLimits& limits) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw InputError(fmt::format("{}: no child process can be started to compile it: {}", path,
                                 std::strerror(errno)));
  }
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) compile_in_child(files, limits, ends[1], parent);
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    throw InputError(fmt::format("{}: no child process can be started to compile it: {}", path,
                                 std::strerror(errno)));
  }
  // A busy machine may give the child a quarter of a CPU.
  const auto deadline =
      Clock::now() + std::chrono::seconds(4 * std::min<std::int64_t>(limits.seconds, 1000000) + 10);
  std::string problems;
  const bool in_time = read_until_end(ends[0], child, deadline, problems);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const int sig = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (!in_time || sig == SIGXCPU || sig == SIGKILL) {
    throw InputError(fmt::format("{}: MuJoCo did not compile it within {} s (limit 'seconds')",
                                 path, limits.seconds));
  }
  if (sig == SIGINT || sig == SIGTERM) throw InputError(fmt::format("{}: interrupted", path));
  if (sig != 0) {
    throw InputError(
        fmt::format("{}: MuJoCo ended with signal {} ({}) while compiling it; the model may be "
                    "invalid, or need more than {} MB (limit 'megabytes')",
                    path, sig, strsignal(sig), limits.megabytes));
  }
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace

bool reads_mjcf() { return true; }

MjcfFiles read_mjcf_files(const std::string& path, const MjcfArguments& arguments) {
  const Limits limits = parse_limits(arguments);
  try {
    // Read once: what the child survives is what is compiled afterwards.
    MjcfFiles files = MjcfFiles::read(path, limits.options);
    require_harmless(files, path, limits.child);
    return files;
  } catch (const MjcfError& error) {
    throw InputError(error.what());
  }
}

Scene load_mjcf_file(const std::string& path, const MjcfArguments& arguments,
                     std::vector<std::string>* warnings) {
  const MjcfFiles files = read_mjcf_files(path, arguments);
  try {
    MjcfResult result = files.compile();
    if (warnings != nullptr) {
      *warnings = std::move(result.warnings);
    } else {
      for (const std::string& warning : result.warnings) {
        tools::tell("manyworlds: warning: {}\n", warning);
      }
    }
    return std::move(result.scene);
  } catch (const MjcfError& error) {
    throw InputError(error.what());
  }
}

}  // namespace manyworlds::cli

#else

#include <filesystem>
#include <system_error>

namespace manyworlds::cli {

bool reads_mjcf() { return false; }

Scene load_mjcf_file(const std::string& path, const MjcfArguments&, std::vector<std::string>*) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw InputError(path + ": no such file");
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(path + ": is a directory; expected a file");
  }
  throw not_built(fmt::format("cannot read '{}'", path), "MJCF", "MW_MJCF=ON");
}

}  // namespace manyworlds::cli

#endif
