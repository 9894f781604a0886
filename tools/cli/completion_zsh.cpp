// The script for zsh, of calls of its own function _arguments.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "completion.hpp"
#include "completion_words.hpp"

namespace manyworlds::cli {
namespace {

constexpr const char* kZshHead = R"(#compdef manyworlds
# Completes manyworlds in zsh; made by `manyworlds completion zsh`.

)";

// Within single quotes, as a part of a specification of _arguments.
std::string zsh_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
    } else if (c == '\n') {
      result += ' ';
    } else {
      if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
      result += c;
    }
  }
  return result;
}

std::string zsh_function(const std::vector<std::string>& path) {
  return fmt::format("_{}", fmt::join(path, "_"));
}

// The action of _arguments for a value.
std::string zsh_action(const Completion& value) {
  if (!value.choices.empty()) return fmt::format("({})", fmt::join(value.choices, " "));
  if (value.scene_options) return "__manyworlds_paths";
  if (value.list) return "_sequence __manyworlds_scenes";
  const std::string files =
      value.files.empty() ? ""
                          : fmt::format("_files -g \"*.({})(-.)\"", fmt::join(value.files, "|"));
  if (value.scenes && !files.empty()) {
    return fmt::format("__manyworlds_scenes_or_files {}", fmt::join(value.files, ","));
  }
  if (value.scenes) return "__manyworlds_scenes";
  if (!files.empty()) return files;
  return value.folders ? "_files -/" : " ";
}

std::string zsh_option(const CommandLine::Option& option) {
  // One that was given is not offered again, by none of its names.
  std::string names;
  if (option.names.size() == 1) {
    names = fmt::format("'{}{}", option.repeats ? "*" : "", option.names.front());
  } else {
    names =
        fmt::format("'({0})'{{{1}}}'", fmt::join(option.names, " "), fmt::join(option.names, ","));
  }
  const bool takes = !option.value_name.empty();
  // "=": the value is the next word, or behind an equals sign.
  std::string text = names + (takes && option.names.size() == 1 ? "=" : "");
  text += "[" + zsh_text(option.help) + "]";
  if (takes) text += ":" + zsh_text(option.value_name) + ":" + zsh_action(option.value);
  return text + "'";
}

std::string zsh_command(const CommandLine& line, const std::vector<CommandLine>& lines) {
  std::string text = zsh_function(line.path) + "() {\n";
  if (!line.commands.empty()) text += "  local curcontext=$curcontext state line\n";
  text += line.commands.empty() ? "  _arguments" : "  _arguments -C";
  for (const CommandLine::Option& option : line.options) {
    text += " \\\n    " + zsh_option(option);
  }
  if (!line.commands.empty()) {
    text += " \\\n    '1:command:->command' '*::argument:->argument'\n";
    text += "  case $state in\n    command)\n      local -a commands=(\n";
    for (const CommandLine& other : lines) {
      if (other.path.size() != line.path.size() + 1) continue;
      if (!std::equal(line.path.begin(), line.path.end(), other.path.begin())) continue;
      text += fmt::format("        '{}:{}'\n", other.path.back(), zsh_text(other.help));
    }
    text += "      )\n      _describe command commands ;;\n    argument)\n      case $line[1] in\n";
    for (const std::string& name : line.commands) {
      std::vector<std::string> path = line.path;
      path.push_back(name);
      text += fmt::format("        {}) {} ;;\n", name, zsh_function(path));
    }
    return text + "      esac ;;\n  esac\n}\n\n";
  }
  for (const Completion& argument : line.arguments) {
    text += fmt::format(" \\\n    '*:argument:{}'", zsh_action(argument));
  }
  return text + "\n}\n\n";
}

}  // namespace

std::string zsh_completion(const std::vector<CommandLine>& lines) {
  std::string text = kZshHead;
  text += fmt::format(
      "__manyworlds_scenes() {{\n"
      "  local -a scenes=({})\n"
      "  compadd \"$@\" -a scenes\n"
      "}}\n\n"
      "# Names of scenes, and files with endings as \"xml,h5\".\n"
      "__manyworlds_scenes_or_files() {{\n"
      "  local endings=${{${{@[-1]}}//,/|}}\n"
      "  _alternative 'scenes:scene:__manyworlds_scenes' \"files:file:_files -g "
      "'*.($endings)(-.)'\"\n"
      "}}\n\n"
      "__manyworlds_paths() {{\n"
      "  local -a paths=({})\n"
      "  compadd \"$@\" -S = -q -a paths\n"
      "}}\n\n",
      fmt::join(all_scene_names(), " "), fmt::join(option_paths(), " "));
  for (const CommandLine& line : lines) text += zsh_command(line, lines);
  text +=
      "if [[ $funcstack[1] == _manyworlds ]]; then\n"
      "  _manyworlds \"$@\"\n"
      "else\n"
      "  compdef _manyworlds manyworlds\n"
      "fi\n";
  return text;
}

}  // namespace manyworlds::cli
