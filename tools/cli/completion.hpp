// `manyworlds completion SHELL`: scripts that complete the program's command line, made from the
// parser's own commands and options, so that they cannot differ from --help.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace manyworlds::cli {

// Adds the command `completion`, which prints a script for all commands of `app`.
void add_completion(CLI::App& app, std::string& shell, int& code);

// What completes one option's value or one argument.
struct Completion {
  bool scenes = false;               // names of scenes
  bool scene_options = false;        // paths of --set, with '=' behind them
  bool folders = false;              // names of folders
  bool list = false;                 // several, separated by commas
  std::vector<std::string> files;    // endings of files, as "xml"; "*": any
  std::vector<std::string> choices;  // these words
};

struct CommandLine {
  struct Option {
    std::vector<std::string> names;  // "-h", "--help"
    std::string help, value_name;    // value_name: empty for flags
    bool repeats = false;
    Completion value;
  };
  std::vector<std::string> path;  // "manyworlds", "report", "plan"
  std::string help;
  std::vector<Option> options;
  std::vector<Completion> arguments;  // the last one repeats
  std::vector<std::string> commands;  // names of its subcommands
};

// `app` and all of its commands, each before those within it.
std::vector<CommandLine> command_lines(const CLI::App& app);

std::string bash_completion(const std::vector<CommandLine>& lines);
std::string zsh_completion(const std::vector<CommandLine>& lines);

}  // namespace manyworlds::cli
