#include <algorithm>
#include <cstdio>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "manyworlds/scenes.hpp"

#include "commands.hpp"

namespace manyworlds::cli {

int scenes_command(bool json) {
  if (json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const scenes::Entry& entry : scenes::all()) {
      list.push_back(
          {{"name", entry.name}, {"summary", entry.summary}, {"standard", entry.standard}});
    }
    fmt::print("{}\n", list.dump(2));
    return kOk;
  }
  std::size_t width = 0;
  for (const scenes::Entry& entry : scenes::all()) {
    width = std::max(width, std::string_view(entry.name).size());
  }
  for (const scenes::Entry& entry : scenes::all()) {
    fmt::print("{:<{}}  {}\n", entry.name, width, entry.summary);
  }
  return kOk;
}

}  // namespace manyworlds::cli
