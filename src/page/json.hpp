// JSON as the pages and recordings have it: members in the order in which they were put.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace manyworlds::page {

using Json = nlohmann::ordered_json;

// As text inside of an element of HTML, which no '<' in it ends.
inline std::string embedded(const Json& json) {
  std::string out;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace manyworlds::page
