// The pages without data that viewer/ builds beside this program.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace manyworlds::cli {

struct BuiltPage {
  const char* file;
  const char* variable;  // of the environment, which names another
};
inline constexpr BuiltPage kViewerPage = {"viewer.html", "MANYWORLDS_VIEWER"};
inline constexpr BuiltPage kReportPage = {"report.html", "MANYWORLDS_REPORT"};

// What was named, installed or built; nothing where there is none. Throws InputError where what was
// named is no file.
std::optional<std::filesystem::path> find_page(const BuiltPage& page);

// "the page was not built with this program: ...", and how to get it.
std::string why_no_page(const BuiltPage& page);

}  // namespace manyworlds::cli
