#include "report_page.hpp"

#include <fstream>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "built_page.hpp"
#include "options.hpp"
#include "src/page/json.hpp"

namespace manyworlds::cli {
namespace {

// Where in the page the report goes, and how it says which data it reads.
constexpr std::string_view kReportPlace = "<!-- manyworlds: report -->";
constexpr std::string_view kReportVersion = "<meta name=\"manyworlds-report\" content=\"1\">";

}  // namespace

std::optional<std::string> read_report_page() {
  const auto file = find_page(kReportPage);
  if (!file) return std::nullopt;
  std::ifstream in(*file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (text.find(kReportVersion) == std::string::npos ||
      text.find(kReportPlace) == std::string::npos) {
    throw InputError(fmt::format(
        "'{}': is not a page of this version; expected report.html as viewer/ builds it",
        file->string()));
  }
  return text;
}

std::string page_of(std::string empty, const nlohmann::ordered_json& report) {
  const std::string data =
      "<script type=\"application/json\" id=\"mw-report\">" + page::embedded(report) + "</script>";
  return empty.replace(empty.find(kReportPlace), kReportPlace.size(), data);
}

}  // namespace manyworlds::cli
