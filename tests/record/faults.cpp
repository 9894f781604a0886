#include "tests/record/faults.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace manyworlds::test {

namespace {

struct Fault {
  bool armed = false, all_later = false, fired = false;
  Call call{};
  long left = 0;
  int error = 0;
};
thread_local constinit Fault fault;
thread_local constinit std::vector<Written>* written = nullptr;

// True, with errno, where this call is to fail.
bool fails(Call call) {
  if (!fault.armed || fault.call != call) return false;
  if (fault.fired ? !fault.all_later : --fault.left > 0) return false;
  fault.fired = true;
  errno = fault.error;
  return true;
}

int open_in(int folder, const char* path, int flags, mode_t mode) {
  if (fails(Call::open)) return -1;
  return static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}

}  // namespace

const char* to_string(Call call) {
  constexpr const char* kNames[] = {"write",    "sync", "close", "rename",
                                    "truncate", "open", "read",  "allocation"};
  return kNames[static_cast<int>(call)];
}

void fail_call(Call call, long n, int error, bool all_later) {
  fault = {true, all_later, false, call, n, error};
}
bool end_failing() {
  fault.armed = false;
  return fault.fired;
}

void log_writes(std::vector<Written>* log) { written = log; }

std::string in_child(const std::function<std::string(const Progress&)>& work) {
  constexpr std::size_t kSize = 4096;
  void* shared = mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) return "no memory to share";
  char* const text = static_cast<char*>(shared);
  const auto say = [&](const std::string& what) { std::snprintf(text, kSize, "%s", what.c_str()); };
  std::fflush(nullptr);
  const int said = memfd_create("standard error", 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(said, STDERR_FILENO);
    std::string problem;
    try {
      problem = work(say);
    } catch (const std::exception& error) {
      problem = std::string(text) + ": threw " + error.what();
    }
    if (!problem.empty()) say(problem);
    std::exit(problem.empty() ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  std::string problem;
  if (WIFSIGNALED(status)) {
    problem = std::string(text) + ": signal " + std::to_string(WTERMSIG(status));
  } else if (WEXITSTATUS(status) != 0) {
    problem = std::string(text) + ": exit " + std::to_string(WEXITSTATUS(status));
  }
  munmap(shared, kSize);
  // Not even at exit is there anything to say.
  char last_words[200] = {};
  if (pread(said, last_words, sizeof last_words - 1, 0) > 0) {
    problem += std::string(problem.empty() ? "" : ", ") + "on standard error: " + last_words;
  }
  close(said);
  return problem;
}

}  // namespace manyworlds::test

using manyworlds::test::Call;
using manyworlds::test::fails;
using manyworlds::test::open_in;
using manyworlds::test::written;

extern "C" {

// What HDF5 has of a file that it could not open or close it does not free, nor do we.
const char* __lsan_default_suppressions() { return "leak:libhdf5"; }
const char* __lsan_default_options() { return "print_suppressions=0"; }

ssize_t write(int file, const void* bytes, size_t size) {
  if (fails(Call::write)) return -1;
  return syscall(SYS_write, file, bytes, size);
}
ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  if (fails(Call::write)) return -1;
  if (written != nullptr) {
    const auto* from = static_cast<const std::byte*>(bytes);
    written->push_back({static_cast<std::uint64_t>(at), {from, from + size}});
  }
  return syscall(SYS_pwrite64, file, bytes, size, at);
}
int fsync(int file) {
  if (fails(Call::sync)) return -1;
  if (written != nullptr) written->push_back({0, {}, false, true});
  return fcntl(file, F_GETFD) < 0 ? -1 : 0;  // no test outlives the machine
}
int close(int file) {
  // As the kernel has it, the file is closed all the same.
  const long result = syscall(SYS_close, file);
  return fails(Call::close) ? -1 : static_cast<int>(result);
}
int rename(const char* from, const char* to) noexcept {
  if (fails(Call::rename)) return -1;
  return static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}
int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  if (fails(Call::rename)) return -1;
  if (written != nullptr) written->push_back({0, {}, false, false, true});
  return static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, 0));
}
int ftruncate(int file, off_t size) noexcept {
  if (fails(Call::truncate)) return -1;
  if (written != nullptr) written->push_back({static_cast<std::uint64_t>(size), {}, true});
  return static_cast<int>(syscall(SYS_ftruncate, file, size));
}
int openat(int folder, const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return open_in(folder, path, flags, mode);
}
int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return open_in(AT_FDCWD, path, flags, mode);
}
ssize_t read(int file, void* bytes, size_t size) {
  if (fails(Call::read)) return -1;
  return syscall(SYS_read, file, bytes, size);
}
ssize_t pread(int file, void* bytes, size_t size, off_t at) {
  if (fails(Call::read)) return -1;
  return syscall(SYS_pread64, file, bytes, size, at);
}

}  // extern "C"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

void* allocate(std::size_t size, std::size_t alignment) {
  if (fails(Call::allocate)) throw std::bad_alloc();
  size = size == 0 ? alignment : (size + alignment - 1) / alignment * alignment;
  void* const p = std::aligned_alloc(alignment, size);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}

}  // namespace

// NOLINTBEGIN(misc-new-delete-overloads)
void* operator new(std::size_t size) { return allocate(size, alignof(std::max_align_t)); }
void* operator new[](std::size_t size) { return allocate(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
// NOLINTEND(misc-new-delete-overloads)

#endif
