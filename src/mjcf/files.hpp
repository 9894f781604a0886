// Reads the files of a model: regular ones only, within the roots, no larger than the limits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "manyworlds/mjcf.hpp"

namespace manyworlds::mjcf {

// Throws an MjcfError of one line, "place: what".
[[noreturn]] void refuse(const std::string& place, const std::string& what);
// "…; expected at most N (limit 'name')"
[[noreturn]] void refuse_size(const std::string& place, const std::string& what, std::int64_t most,
                              const char* limit);

// Of a count, which may be beyond every integer.
std::string whole(double value);

struct File {
  std::string label;           // as messages name it: as it was written, not where links lead
  std::filesystem::path real;  // where it is, links followed
  std::string bytes;
};

class FileReader {
 public:
  explicit FileReader(const MjcfOptions& options);

  // The file that the user names may lie anywhere; its folder becomes a root.
  File read_model(const std::filesystem::path& file);
  // The first of the candidates that exists. `written` is the name in the model, `place` where it
  // is asked for.
  File read_part(const std::vector<std::filesystem::path>& candidates, const std::string& written,
                 const std::string& place);

  // Counts what was not read from a file.
  void add_bytes(const std::string& place, double bytes);

  const MjcfLimits& limits() const { return limits_; }
  // Where the relative paths of a text begin; empty when no root was given.
  std::filesystem::path first_root() const {
    return roots_.empty() ? std::filesystem::path() : roots_[0];
  }

 private:
  File read(const std::filesystem::path& file, const std::string& place, bool anywhere);
  void check_root(const std::filesystem::path& real, const std::filesystem::path& file,
                  const std::string& place) const;

  MjcfLimits limits_;
  std::vector<std::filesystem::path> roots_;  // real paths
  std::int64_t files_ = 0;
  double bytes_ = 0;
};

}  // namespace manyworlds::mjcf
