// Checks of options' values, and options that take one of a list of names.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace manyworlds::cli {

// "a, b or c"
std::string any_of(const std::vector<std::string>& names);

// Checks of numbers. Each leaves the number as CLI11 reads it, too: it takes a leading 0 for octal.
CLI::Validator whole_number(std::int64_t least, std::int64_t most);
// Finite, and above 0 or at least that.
CLI::Validator real_number(bool above_zero);
inline CLI::Validator positive_number() { return real_number(true); }

// An empty name would stand for an option that is not given.
CLI::Validator name_of_a(const char* what);

template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

// An option that takes one name out of a list, each time it is given.
template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& flag, const Choices<Value>& choices,
                        std::function<void(Value)> take, const std::string& help) {
  std::vector<std::string> names;
  for (const auto& choice : choices) names.push_back(choice.first);
  const auto on_values = [flag, choices, names, take](const std::vector<std::string>& values) {
    for (const std::string& text : values) {
      bool known = false;
      for (const auto& [name, value] : choices) {
        if (name != text) continue;
        take(value);
        known = true;
      }
      if (!known) {
        throw CLI::ValidationError(flag, fmt::format("must be {}, is '{}'", any_of(names), text));
      }
    }
  };
  CLI::Option* option = app.add_option_function<std::vector<std::string>>(flag, on_values, help);
  return option->type_name(fmt::format("{}", fmt::join(names, "|")))
      ->expected(1)
      ->allow_extra_args(false);
}

}  // namespace manyworlds::cli
