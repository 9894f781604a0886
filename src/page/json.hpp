// JSON as the pages and recordings have it: members in the order in which they were put.
#pragma once

#include <nlohmann/json.hpp>

namespace manyworlds::page {

using Json = nlohmann::ordered_json;

}  // namespace manyworlds::page
