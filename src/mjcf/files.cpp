#include "src/mjcf/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace manyworlds::mjcf {
namespace {

namespace fs = std::filesystem;

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  operator int() const { return fd_; }  // NOLINT: stands for it in calls

 private:
  int fd_;
};

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "is a directory";
  if (S_ISFIFO(mode)) return "is a FIFO";
  if (S_ISSOCK(mode)) return "is a socket";
  return "is a device";
}

void require_regular(const struct stat& about, const std::string& place) {
  if (!S_ISREG(about.st_mode))
    refuse(place, std::string(kind_of(about.st_mode)) + "; expected a file");
}

// Where the open file is, whatever its name has come to mean since.
fs::path real_path(int fd, const fs::path& file) {
  std::error_code error;
  const fs::path real = fs::read_symlink("/proc/self/fd/" + std::to_string(fd), error);
  return error ? fs::canonical(file) : real;
}

bool is_within(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
         folder.end();
}

}  // namespace

void refuse(const std::string& place, const std::string& what) {
  throw MjcfError({place + ": " + what});
}
void refuse_size(const std::string& place, const std::string& what, std::int64_t most,
                 const char* limit) {
  refuse(place, what + "; expected at most " + std::to_string(most) + " (limit '" + limit + "')");
}

std::string whole(double value) {
  return std::to_string(static_cast<std::int64_t>(std::min(value, 9e15)));
}

FileReader::FileReader(const MjcfOptions& options) : limits_(options.limits) {
  for (const fs::path& root : options.roots) {
    std::error_code error;
    const fs::path real = fs::canonical(root, error);
    if (error || !fs::is_directory(real)) {
      throw MjcfError({"MJCF root '" + root.string() + "': is not a readable folder"});
    }
    roots_.push_back(real);
  }
}

File FileReader::read_model(const fs::path& file) {
  File read_file = read(file, file.string(), true);
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const fs::path real = fs::canonical(folder, error);
  if (!error) roots_.insert(roots_.begin(), real);
  return read_file;
}

File FileReader::read_part(const std::vector<fs::path>& candidates, const std::string& written,
                           const std::string& place) {
  if (written.find('\0') != std::string::npos || written.empty()) refuse(place, "names no file");
  if (roots_.empty()) {
    refuse(
        place,
        "'" + written +
            "' cannot be searched for: an MJCF string has no folder; expected a file in the roots "
            "(MjcfOptions::roots)");
  }
  for (const fs::path& candidate : candidates) {
    struct stat about {};
    if (stat(candidate.c_str(), &about) != 0 && (errno == ENOENT || errno == ENOTDIR)) continue;
    return read(candidate, place, false);
  }
  refuse(place, "'" + written + "': no such file");
}

// Looked at before it is opened, which has effects on devices, and after, when it can no longer be
// exchanged.
File FileReader::read(const fs::path& file, const std::string& place, bool anywhere) {
  const std::string at = anywhere ? place : place + ": '" + file.string() + "'";
  if (++files_ > limits_.files) refuse_size(place, "is one file too many", limits_.files, "files");
  struct stat about {};
  if (stat(file.c_str(), &about) != 0) {
    if (errno == ENOENT) refuse(at, "no such file");
    refuse(at, std::string("cannot be read: ") + std::strerror(errno));
  }
  if (!anywhere) {
    std::error_code error;
    const fs::path real = fs::canonical(file, error);
    if (error) refuse(at, "cannot be read: " + error.message());
    check_root(real, file, place);
  }
  require_regular(about, at);
  const Descriptor fd(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (fd < 0 || fstat(fd, &about) != 0) {
    refuse(at, std::string("cannot be read: ") + std::strerror(errno));
  }
  require_regular(about, at);
  File out{file.string(), real_path(fd, file), {}};
  if (!anywhere) check_root(out.real, file, place);
  if (about.st_size > limits_.file_bytes) {
    refuse_size(at, "has " + std::to_string(about.st_size) + " bytes", limits_.file_bytes,
                "file_bytes");
  }
  add_bytes(at, static_cast<double>(about.st_size));
  out.bytes.resize(static_cast<std::size_t>(about.st_size));
  std::size_t got = 0;
  while (got < out.bytes.size()) {
    const ssize_t n = ::read(fd, out.bytes.data() + got, out.bytes.size() - got);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) refuse(at, std::string("cannot be read: ") + std::strerror(errno));
    if (n == 0) break;  // it has become shorter
    got += static_cast<std::size_t>(n);
  }
  out.bytes.resize(got);
  return out;
}

void FileReader::check_root(const fs::path& real, const fs::path& file,
                            const std::string& place) const {
  for (const fs::path& root : roots_) {
    if (is_within(real, root)) return;
  }
  std::string folders;
  for (const fs::path& root : roots_)
    folders += (folders.empty() ? "'" : ", '") + root.string() + "'";
  refuse(place, "'" + file.string() + "'" +
                    (real == file.lexically_normal() ? "" : ", which is '" + real.string() + "',") +
                    " is outside the model's folder; expected a file in " + folders +
                    ", or in one of the roots (MjcfOptions::roots, --mjcf-root)");
}

void FileReader::add_bytes(const std::string& place, double bytes) {
  bytes_ += bytes;
  if (bytes_ > static_cast<double>(limits_.total_bytes)) {
    refuse_size(place, "brings the model's total to " + whole(bytes_) + " bytes",
                limits_.total_bytes, "total_bytes");
  }
}

}  // namespace manyworlds::mjcf
