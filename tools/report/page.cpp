#include "tools/report/page.hpp"

#include <fmt/format.h>

#include "tools/base/text.hpp"

namespace manyworlds::report {
namespace {

constexpr const char* kStyle = R"(<style>
body{font:15px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem}
table{border-collapse:collapse;margin:.5rem 0}
td,th{padding:.15rem .7rem;border-bottom:1px solid #ddd;text-align:right}
td:first-child,th:first-child{text-align:left}
svg{width:100%;max-width:46rem;font:11px sans-serif}
.g{stroke:#e5e5e5}.level{stroke:#b00;stroke-dasharray:2 3}
</style>)";

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<table>";
  for (const auto& row : rows) {
    const char* cell = &row == &rows.front() ? "th" : "td";
    out += "<tr>";
    for (const std::string& text : row) out += fmt::format("<{0}>{1}</{0}>", cell, escaped(text));
    out += "</tr>";
  }
  return out + "</table>";
}

std::string page(const std::string& title, const std::string& machine, const std::string& body) {
  return fmt::format(
      "<!doctype html><html lang='en'><meta charset='utf-8'><title>manyworlds: {0}</title>{1}"
      "<h1>{0}</h1><p>{2}</p>{3}</html>\n",
      escaped(title), kStyle, escaped(machine), body);
}

std::string time_text(double microseconds) {
  if (microseconds < 1e3) return fmt::format("{:.3g} us", microseconds);
  if (microseconds < 1e6) return fmt::format("{:.3g} ms", microseconds / 1e3);
  return fmt::format("{:.3g} s", microseconds / 1e6);
}

std::string speed_text(double per_second) { return tools::with_prefix(per_second) + "/s"; }

}  // namespace manyworlds::report
