#include "completion.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "commands.hpp"

namespace manyworlds::cli {
namespace {

// The words between the bars of "auto|dense|rows".
std::vector<std::string> alternatives(const std::string& text) {
  std::vector<std::string> words;
  std::size_t begin = 0;
  for (std::size_t bar = text.find('|'); bar != std::string::npos; bar = text.find('|', begin)) {
    words.push_back(text.substr(begin, bar - begin));
    begin = bar + 1;
  }
  words.push_back(text.substr(begin));
  return words;
}

bool has_upper(const std::string& text) {
  return std::any_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isupper(c) != 0; });
}

// The name that --help shows for a value says what completes it: "auto|dense|rows" is a choice,
// words in capitals stand for something.
Completion completion_of(const CLI::Option& option) {
  Completion result;
  const std::string shown = option.get_type_name();
  const std::vector<std::string> words = alternatives(shown);
  if (words.size() > 1 && !has_upper(shown)) {
    result.choices = words;
    return result;
  }
  const bool scenes = option.check_lname("scenes");
  result.list = scenes;
  // NAME alone is the name of a keyframe, for instance, which only the scene knows.
  result.scenes =
      scenes || (words.size() > 1 && words.end() != std::find(words.begin(), words.end(), "NAME"));
  for (const std::string& word : words) {
    const std::size_t dot = word.rfind('.');
    if (word == "DIR" || word == "FOLDER") result.folders = true;
    if (word == "PATH=VALUE") result.scene_options = true;
    if (dot != std::string::npos && word != "A,B,...") result.files.push_back(word.substr(dot + 1));
  }
  return result;
}

CommandLine::Option option_of(const CLI::Option& option) {
  CommandLine::Option result;
  for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
  result.help = option.get_description();
  if (option.get_items_expected_max() > 0) {
    result.value_name = option.get_type_name();
    result.value = completion_of(option);
  }
  result.repeats = option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
  return result;
}

void collect(const CLI::App& app, std::vector<std::string> path, std::vector<CommandLine>& lines) {
  path.push_back(app.get_name());
  CommandLine line;
  line.path = path;
  line.help = app.get_description();
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) {
      line.arguments.push_back(completion_of(*option));
    } else if (!option->get_group().empty()) {  // else it is not in the help either
      line.options.push_back(option_of(*option));
    }
  }
  const std::vector<const CLI::App*> commands = app.get_subcommands(nullptr);
  for (const CLI::App* command : commands) line.commands.push_back(command->get_name());
  lines.push_back(line);
  for (const CLI::App* command : commands) collect(*command, path, lines);
}

}  // namespace

std::vector<CommandLine> command_lines(const CLI::App& app) {
  std::vector<CommandLine> lines;
  collect(app, {}, lines);
  return lines;
}

void add_completion(CLI::App& app, std::string& shell, int& code) {
  CLI::App* command =
      app.add_subcommand("completion", "Print a script that completes commands in a shell");
  command->add_option("shell", shell, "the shell")
      ->required()
      ->check(CLI::Validator(
          [](std::string& text) {
            return text == "bash" || text == "zsh"
                       ? std::string()
                       : fmt::format("must be bash or zsh, is '{}'", text);
          },
          std::string()))
      ->type_name("bash|zsh");
  command->footer(
      "Examples:\n"
      "  source <(manyworlds completion bash)\n"
      "  manyworlds completion zsh > ~/.zsh/functions/_manyworlds\n"
      "\n"
      "cmake --install installs both scripts.");
  command->callback([&app, &shell, &code] {
    const std::vector<CommandLine> lines = command_lines(app);
    fmt::print("{}", shell == "bash" ? bash_completion(lines) : zsh_completion(lines));
    code = kOk;
  });
}

}  // namespace manyworlds::cli
