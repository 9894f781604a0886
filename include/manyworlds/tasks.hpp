// Named tasks shared by tests, benchmarks, examples and the Python package.
#pragma once

#include <string_view>
#include <vector>

#include "manyworlds/task.hpp"

namespace manyworlds::tasks {

struct Entry {
  const char* name;     // "CartPole"
  const char* summary;  // one line
  Task (*make)();
};

const std::vector<Entry>& all();           // in the order of lists and menus
const Entry* find(std::string_view name);  // nullptr if unknown

}  // namespace manyworlds::tasks
