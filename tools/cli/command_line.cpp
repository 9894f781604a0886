#include "command_line.hpp"

#include <optional>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "manyworlds/nearest.hpp"

namespace manyworlds::cli {

std::string describe(const CLI::ParseError& error, const CLI::App& app) {
  // The innermost command that was named, and how it is called.
  const CLI::App* command = &app;
  std::string called = "manyworlds";
  while (!command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
    called += " " + command->get_name();
  }
  if (dynamic_cast<const CLI::ValidationError*>(&error) != nullptr) return error.what();
  const std::vector<std::string> rest = app.remaining(true);
  const auto meant = [](const std::string& word, const std::vector<std::string>& known) {
    const std::optional<std::string> near = nearest(word, known);
    return near ? fmt::format("; did you mean '{}'?", *near) : std::string();
  };
  if (!rest.empty() && rest.front().starts_with("-")) {
    const std::string option = rest.front().substr(0, rest.front().find('='));
    std::vector<std::string> known;
    for (const CLI::Option* one : command->get_options()) {
      for (const std::string& name : one->get_lnames()) known.push_back("--" + name);
    }
    return fmt::format("unknown option '{}'{} (see '{} --help')", option, meant(option, known),
                       called);
  }
  std::vector<std::string> names;
  for (const CLI::App* one : command->get_subcommands(nullptr)) names.push_back(one->get_name());
  if (!names.empty()) {
    const std::string what = command == &app ? "command" : command->get_name();
    const std::string all = fmt::format("{}", fmt::join(names, ", "));
    if (rest.empty()) return fmt::format("missing {}; expected one of {}", what, all);
    const std::string near = meant(rest.front(), names);
    return fmt::format("unknown {} '{}'{}", what, rest.front(),
                       near.empty() ? "; expected one of " + all : near);
  }
  return fmt::format("{} (see '{} --help')", error.what(), called);
}

}  // namespace manyworlds::cli
