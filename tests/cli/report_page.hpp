// Reports with a page that is short, and what was put into it.
#pragma once

#if MW_HAVE_CLI

#include <fstream>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace manyworlds::test {

// A page without a report, as viewer/ builds it but for what shows it.
inline constexpr const char* kBlank =
    "<meta name=\"manyworlds-report\" content=\"1\">\n<!-- manyworlds: report -->\nend\n";
inline constexpr const char* kWithBlank = "MANYWORLDS_REPORT=blank.html";

// `arguments` with the page above.
inline Outcome run_with_page(const ScratchFolder& folder, const std::string& arguments) {
  std::ofstream(folder / "blank.html") << kBlank;
  return run_program(kProgram, folder, arguments, kWithBlank);
}

// What was put into a page.
inline nlohmann::json report_in(const std::string& page) {
  const std::string start = "<script type=\"application/json\" id=\"mw-report\">";
  const std::size_t from = page.find(start), to = page.find("</script>");
  REQUIRE(from != std::string::npos);
  REQUIRE(to != std::string::npos);
  CHECK(page.find('<', from + start.size()) == to);  // nothing in it is HTML
  CHECK(contains(page.substr(to), "end"));
  return nlohmann::json::parse(page.substr(from + start.size(), to - from - start.size()));
}

}  // namespace manyworlds::test

#endif
