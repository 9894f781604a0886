// `manyworlds report page`: the page of a report that was measured before.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "built_page.hpp"
#include "commands.hpp"
#include "report_page.hpp"
#include "src/base/output_file.hpp"
#include "src/base/output_folder.hpp"

namespace manyworlds::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kReports[] = {"accuracy", "stability", "invariants", "plan", "throughput"};

bool is_report(const Json& json) {
  if (!json.is_object() || !json.contains("results")) return false;
  const auto kind = json.find("report");
  if (kind == json.end()) return false;
  return std::find(std::begin(kReports), std::end(kReports), *kind) != std::end(kReports);
}

Json read_report(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {
    throw InputError(fmt::format("'{}': no such file", file.string()));
  }
  if (!fs::is_regular_file(file, ignored)) {
    throw InputError(fmt::format("'{}': is not a file", file.string()));
  }
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw InputError(fmt::format("'{}': cannot be read", file.string()));
  Json report = Json::parse(text, nullptr, false);
  if (is_report(report)) return report;
  throw InputError(fmt::format("'{}': is not a report; expected the JSON of report {}",
                               file.string(), fmt::join(kReports, ", ")));
}

}  // namespace

int report_page_command(const ReportPageOptions& options) {
  const std::optional<std::string> empty = read_report_page();
  if (!empty) throw InputError("report page: " + why_no_page(kReportPage));
  // All are read before the first is written.
  std::vector<std::pair<fs::path, std::string>> pages;
  for (const std::string& name : options.files) {
    const fs::path file = name;
    fs::path page = options.out.empty() ? file : fs::path(options.out) / file.filename();
    page.replace_extension(".html");
    if (page == file) {
      throw InputError(fmt::format(
          "'{}': its page would overwrite it; expected a name that does not end with .html",
          file.string()));
    }
    pages.emplace_back(std::move(page), page_of(*empty, read_report(file)));
  }
  try {
    if (!options.out.empty()) make_folder(options.out);
    for (const auto& [page, text] : pages) {
      write_file(page, text);
      fmt::print("{}\n", page.string());
    }
  } catch (const FileError& error) {
    throw InputError(std::string("report page: cannot write ") + error.what());
  }
  return kOk;
}

}  // namespace manyworlds::cli
