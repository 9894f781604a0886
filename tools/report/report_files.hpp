// The files of a report, its JSON and a page.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace manyworlds::report {

// Each of the two is the old one or the whole new one under its name, whatever fails, the power
// included. Of the pair: both are on the disk before the page gets its name, and the JSON gets its
// own after that. So a new JSON has its page beside it, if it has one; what can be left is a new
// page with the old JSON or none, where the system refused the second name or was cut off between
// the two, and the error names the JSON then.
class ReportFiles {
 public:
  // Makes the folder, and tries the files, so that no work is lost to a name that cannot be one.
  // This and write() throw std::runtime_error: one line, with the option --out in front.
  ReportFiles(const std::filesystem::path& folder, const std::string& name, bool with_page);
  // A page where there is to be one. An old one stays where not.
  void write(const std::string& json, const std::optional<std::string>& page) const;

  // Part files beside them that a program left when it was cut off.
  std::vector<std::filesystem::path> leftovers() const;
  const std::filesystem::path& page() const { return page_; }
  const std::filesystem::path& json() const { return json_; }

 private:
  std::filesystem::path page_, json_;
};

}  // namespace manyworlds::report
