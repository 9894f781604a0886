#include "src/base/output_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <ctime>
#include <system_error>
#include <utility>

#include "src/base/float_mode.hpp"

namespace manyworlds {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPart = ".part-";
constexpr std::size_t kDigits = 16;
constexpr int kMaxLinks = 40;  // as the kernel has it

// "a.h5.part-": how all part files of a.h5 begin. A long name is cut, so that theirs is none too
// long.
std::string part_prefix(const std::string& name) {
  return name.substr(0, NAME_MAX - kPart.size() - kDigits) + std::string(kPart);
}

bool is_part_name(std::string_view name, std::string_view prefix) {
  return name.size() == prefix.size() + kDigits && name.starts_with(prefix) &&
         name.substr(prefix.size()).find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a directory";
  if (S_ISFIFO(mode)) return "a FIFO";
  if (S_ISSOCK(mode)) return "a socket";
  if (S_ISLNK(mode)) return "a symbolic link";
  return "a device";
}

std::string not_a_file(mode_t mode) { return std::string("is ") + kind_of(mode) + ", not a file"; }

[[noreturn]] void refuse(const fs::path& file, mode_t mode) {
  throw FileError(file, not_a_file(mode));
}

// Where the file is, or will be, that a path stands for: links followed, also one that leads to
// nothing yet.
fs::path resolved(const fs::path& file) {
  struct stat at {};
  if (stat(file.c_str(), &at) == 0 && !S_ISREG(at.st_mode)) refuse(file, at.st_mode);
  fs::path path = file;
  for (int links = 0; lstat(path.c_str(), &at) == 0 && S_ISLNK(at.st_mode); ++links) {
    char to[PATH_MAX];
    const ssize_t length = readlink(path.c_str(), to, sizeof to);
    if (length < 0) throw FileError(file, reason_of(errno));
    if (links == kMaxLinks) throw FileError(file, reason_of(ELOOP));
    path = path.parent_path() / std::string(to, static_cast<std::size_t>(length));
  }
  return path;
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

std::string random_digits(const fs::path& file) {
  unsigned char random[kDigits / 2];
  std::size_t got = 0;
  while (got < sizeof random) {
    const ssize_t n = getrandom(random + got, sizeof random - got, 0);
    if (n < 0 && errno != EINTR) throw FileError(file, reason_of(errno));
    if (n > 0) got += static_cast<std::size_t>(n);
  }
  std::string text;
  for (const unsigned char byte : random) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

// A file that would grow beyond the limit of its process brings a signal, which ends the process,
// before the call says so. While one of these lives, its thread gets none.
class NoSizeSignal {
 public:
  NoSizeSignal() {
    sigemptyset(&size_);
    sigaddset(&size_, SIGXFSZ);
    pthread_sigmask(SIG_BLOCK, &size_, &before_);
  }
  ~NoSizeSignal() {
    const int error_number = errno;
    if (sigismember(&before_, SIGXFSZ) == 0) {
      const timespec now{};
      while (sigtimedwait(&size_, nullptr, &now) == SIGXFSZ) {
      }
      pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    errno = error_number;
  }
  NoSizeSignal(const NoSizeSignal&) = delete;
  NoSizeSignal& operator=(const NoSizeSignal&) = delete;

 private:
  sigset_t size_{}, before_{};
};

// True where a process holds the lock that a part file is written under.
bool is_being_written(const Descriptor& folder, const std::string& name) {
  const Descriptor part(
      openat(folder.get(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  return part.get() >= 0 && flock(part.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

// Part files in `folder` whose names are `wanted`, and that have no writer.
template <class Wanted>
std::vector<fs::path> leftovers(const fs::path& folder, Wanted wanted) {
  std::vector<fs::path> found;
  const Descriptor opened(open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    std::error_code ignored;
    if (!wanted(name) || at->symlink_status(ignored).type() != fs::file_type::regular) continue;
    if (!is_being_written(opened, name)) found.push_back(at->path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::string reason_of(int error_number) {
  switch (error_number) {
    case EFBIG: return "the file would be larger than this process may write (ulimit -f)";
    case EDQUOT: return "no space left in the quota";
    case EROFS: return "the file system is read-only";
    case ELOOP: return "symbolic links form a loop";
    default: return std::generic_category().message(error_number);
  }
}

std::string why_no_file(const fs::path& path) {
  struct stat at {};
  if (stat(path.c_str(), &at) != 0 || S_ISREG(at.st_mode)) return {};
  return not_a_file(at.st_mode);
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}
Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}
int Descriptor::release() { return std::exchange(number_, -1); }
bool Descriptor::close() {
  const int number = release();
  // Where a signal comes between it is closed all the same.
  return number < 0 || ::close(number) == 0 || errno == EINTR;
}

OutputFile::OutputFile(const fs::path& file) : file_(file) {
  const FloatMode mode;  // the standard library's paths grow by a floating-point factor
  if (file.empty()) throw FileError(file, "is not a file name");
  const fs::path path = resolved(file);
  name_ = path.filename().string();
  if (name_.empty() || name_ == "." || name_ == "..") throw FileError(file, "is not a file name");
  folder_ = Descriptor(open(folder_of(path).c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (folder_.get() < 0) {
    const int why = errno;
    throw FileError(file, why == ENOENT ? "no such folder: '" + folder_of(path).string() + "'"
                                        : "its folder cannot be used: " + reason_of(why));
  }
  struct stat old {};
  const bool exists = fstatat(folder_.get(), name_.c_str(), &old, AT_SYMLINK_NOFOLLOW) == 0;
  if (!exists && errno != ENOENT) fail(errno);
  if (exists && !S_ISREG(old.st_mode)) refuse(file, old.st_mode);
  // To take the place of a file needs the folder's permission only; its own counts as well.
  if (exists && faccessat(folder_.get(), name_.c_str(), W_OK, AT_EACCESS) != 0) fail(errno);
  do {
    part_name_ = part_prefix(name_) + random_digits(file);
    part_file_ = Descriptor(openat(folder_.get(), part_name_.c_str(),
                                   O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                                   exists ? mode_t{0600} : mode_t{0666}));
  } while (part_file_.get() < 0 && errno == EEXIST);
  if (part_file_.get() < 0) fail(errno);
  try {
    part_ = path.parent_path() / part_name_;
  } catch (...) {
    unlinkat(folder_.get(), part_name_.c_str(), 0);
    throw;
  }
  flock(part_file_.get(), LOCK_EX | LOCK_NB);  // tells it from one that is left over
  if (exists) {
    // Where the owner cannot be kept it becomes the writer; the mode comes second, since a new
    // owner takes bits of it away.
    if (old.st_uid != geteuid() || old.st_gid != getegid()) {
      [[maybe_unused]] const int kept = fchown(part_file_.get(), old.st_uid, old.st_gid);
    }
    fchmod(part_file_.get(), old.st_mode & 07777);
  }
}

OutputFile::~OutputFile() {
  if (!committed_ && !keep_ && !part_name_.empty()) unlinkat(folder_.get(), part_name_.c_str(), 0);
}

void OutputFile::fail(int error_number) const { throw FileError(file_, reason_of(error_number)); }

void OutputFile::write(std::span<const std::byte> bytes, std::uint64_t at) {
  const NoSizeSignal no_signal;
  while (!bytes.empty()) {
    const ssize_t n = pwrite(part_file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail(n < 0 ? errno : EIO);
    bytes = bytes.subspan(static_cast<std::size_t>(n));
    at += static_cast<std::uint64_t>(n);
  }
}

void OutputFile::read(std::span<std::byte> bytes, std::uint64_t at) const {
  while (!bytes.empty()) {
    const ssize_t n = pread(part_file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(errno);
    if (n == 0) break;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
    at += static_cast<std::uint64_t>(n);
  }
  std::fill(bytes.begin(), bytes.end(), std::byte{0});
}

void OutputFile::truncate(std::uint64_t size) {
  const NoSizeSignal no_signal;
  if (ftruncate(part_file_.get(), static_cast<off_t>(size)) != 0) fail(errno);
}

void OutputFile::sync() {
  if (fsync(part_file_.get()) != 0) fail(errno);
}

void OutputFile::commit() {
  sync();
  if (!part_file_.close()) fail(errno);
  // Whatever has taken the name since stays, too, if it is no file.
  struct stat now {};
  if (fstatat(folder_.get(), name_.c_str(), &now, AT_SYMLINK_NOFOLLOW) == 0 &&
      !S_ISREG(now.st_mode)) {
    refuse(file_, now.st_mode);
  }
  if (renameat(folder_.get(), part_name_.c_str(), folder_.get(), name_.c_str()) != 0) fail(errno);
  committed_ = true;
  // The descriptor that the names are looked up by cannot be synced. A folder that may not be read
  // cannot be opened for it, and some file systems have nothing to sync.
  Descriptor folder(openat(folder_.get(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.get() < 0) return;
  if (fsync(folder.get()) != 0 && errno != EINVAL && errno != ENOTSUP) fail(errno);
}

void write_file(const fs::path& file, std::span<const std::byte> bytes) {
  OutputFile out(file);
  out.write(bytes, 0);
  out.commit();
}
void write_file(const fs::path& file, std::string_view text) {
  write_file(file, std::as_bytes(std::span(text)));
}

std::vector<fs::path> leftover_parts(const fs::path& file) {
  const FloatMode mode;
  const fs::path path = resolved(file);
  const std::string prefix = part_prefix(path.filename().string());
  std::vector<fs::path> found = leftovers(
      folder_of(path), [&](const std::string& name) { return is_part_name(name, prefix); });
  if (!path.has_parent_path()) {
    for (fs::path& part : found) part = part.filename();
  }
  return found;
}

std::vector<fs::path> leftover_parts_in(const fs::path& folder) {
  const FloatMode mode;
  return leftovers(folder, [&](const std::string& name) {
    const std::size_t at = name.rfind(kPart);
    return at != std::string::npos && is_part_name(name, name.substr(0, at + kPart.size()));
  });
}

}  // namespace manyworlds
