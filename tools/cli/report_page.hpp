// The page of a report: the one that viewer/ builds, with the report's JSON in it.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace manyworlds::cli {

// The page without a report; nothing where none was built. Throws InputError where
// MANYWORLDS_REPORT names none.
std::optional<std::string> read_report_page();

// `empty` with the report in it.
std::string page_of(std::string empty, const nlohmann::ordered_json& report);

}  // namespace manyworlds::cli
