#include "src/film/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <thread>
#include <utility>

#include "manyworlds/film.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds::film {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPause = std::chrono::milliseconds(50);  // from one question to GoOn to the next
constexpr int kFree = 20;  // descriptors of a child from here on are none that it knows by number

// Of what a child is started with.
class SpawnOptions {
 public:
  SpawnOptions() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    // A group of its own, so that all of it can be ended, and Ctrl-C reaches this program alone,
    // which sees to the rest. Signals as a program expects them.
    sigset_t none, pipe;
    sigemptyset(&none);
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &pipe);
    posix_spawnattr_setflags(
        &attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnOptions() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnOptions(const SpawnOptions&) = delete;
  SpawnOptions& operator=(const SpawnOptions&) = delete;

  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

// The environment, but what is temporary goes into `folder`: programs that are ended leave theirs.
std::vector<std::string> environment_with(const std::filesystem::path& folder) {
  std::vector<std::string> out = {"TMPDIR=" + std::filesystem::absolute(folder).string()};
  for (char** one = environ; *one != nullptr; ++one) {
    if (!std::string_view(*one).starts_with("TMPDIR=")) out.emplace_back(*one);
  }
  return out;
}

// As programs are given them.
std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> out;
  for (std::string& word : words) out.push_back(word.data());
  out.push_back(nullptr);
  return out;
}

[[noreturn]] void fail(const std::string& name, int error_number) {
  throw FilmError(name + " cannot be started: " + reason_of(error_number));
}

}  // namespace

Child::Child(std::vector<std::string> words, const std::vector<int>& ends,
             std::filesystem::path log, GoOn go_on)
    : name_(words.front()), log_(std::move(log)), go_on_(std::move(go_on)) {
  int pair[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0) fail(name_, errno);
  socket_ = Descriptor(pair[0]);
  Descriptor low(pair[1]);
  const Descriptor theirs(fcntl(low.get(), F_DUPFD_CLOEXEC, kFree));
  if (theirs.get() < 0) fail(name_, errno);
  low.close();
  SpawnOptions options;
  posix_spawn_file_actions_addopen(&options.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&options.actions, STDOUT_FILENO, log_.c_str(),
                                   O_WRONLY | O_CREAT | O_APPEND, 0600);
  posix_spawn_file_actions_adddup2(&options.actions, STDOUT_FILENO, STDERR_FILENO);
  for (const int end : ends) {
    posix_spawn_file_actions_adddup2(&options.actions, theirs.get(), end);
  }
  std::vector<std::string> environment = environment_with(log_.parent_path());
  const int error =
      posix_spawn(&process_, words.front().c_str(), &options.actions, &options.attributes,
                  pointers_to(words).data(), pointers_to(environment).data());
  if (error != 0) {
    process_ = -1;
    fail(name_, error);
  }
}

Child::~Child() {
  if (process_ < 0) return;
  kill(-process_, SIGKILL);
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

bool Child::await(short events, Time deadline) {
  for (;;) {
    pollfd waiting{socket_.get(), events, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(kPause.count()));
    if (ready > 0) return true;
    if (go_on_ && !go_on_()) throw Stopped();
    if (Clock::now() > deadline) return false;
  }
}

bool Child::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n =
        ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(n));
    } else if (errno == EAGAIN) {
      await(POLLOUT, Time::max());
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

bool Child::receive(std::string& bytes, Time deadline) {
  constexpr std::size_t kPiece = 1 << 18;
  for (;;) {
    if (!await(POLLIN, deadline)) return false;
    const std::size_t before = bytes.size();
    bytes.resize(before + kPiece);
    const ssize_t n = recv(socket_.get(), bytes.data() + before, kPiece, MSG_DONTWAIT);
    bytes.resize(before + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (n > 0) return true;
    if (n == 0 || (errno != EAGAIN && errno != EINTR)) return false;
  }
}

void Child::finish_sending() { shutdown(socket_.get(), SHUT_WR); }

int Child::wait(Time deadline) {
  for (;;) {
    int status = 0;
    const pid_t ended = waitpid(process_, &status, WNOHANG);
    if (ended == process_) {
      kill(-process_, SIGKILL);  // what it has left behind
      process_ = -1;
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    if (ended < 0 && errno != EINTR) return -1;
    if (go_on_ && !go_on_()) throw Stopped();
    if (Clock::now() > deadline) return -1;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

std::string Child::last_words() const {
  std::ifstream file(log_);
  std::string line, last;
  while (std::getline(file, line)) {
    std::replace_if(
        line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    if (line.find_first_not_of(' ') != std::string::npos) last = line;
  }
  constexpr std::size_t kMost = 300;
  return last.empty() ? last : ": " + last.substr(0, kMost);
}

}  // namespace manyworlds::film
