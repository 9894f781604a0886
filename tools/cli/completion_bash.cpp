// The script for bash. It needs no other package, and asks the program nothing.
#include <string>
#include <vector>

#include <fmt/format.h>

#include "completion.hpp"
#include "completion_words.hpp"

namespace manyworlds::cli {
namespace {

constexpr const char* kBashHead =
    R"(# Completes manyworlds in bash; made by `manyworlds completion bash`.

# _manyworlds_words WORD...: those that begin with what is typed.
_manyworlds_words() {
  mapfile -t COMPREPLY < <(compgen -W "$*" -- "$current")
}

# _manyworlds_add_files ENDING...: files with one of the endings, and folders.
_manyworlds_add_files() {
  local ending
  compopt -o filenames 2>/dev/null
  mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(
    for ending; do compgen -f -X "!*.$ending" -- "$current"; done
    compgen -d -- "$current")
}

_manyworlds() {
  local current=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD - 1]}
  local path=manyworlds i prefix
  COMPREPLY=()
  # "--isa=av" is three words where '=' separates words.
  if [[ $current == = ]]; then
    current=
  elif [[ $option == = ]] && ((COMP_CWORD > 1)); then
    option=${COMP_WORDS[COMP_CWORD - 2]}
  fi
)";

std::string bash_words(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

// The commands that fill COMPREPLY.
std::string bash_fill(const Completion& value) {
  std::vector<std::string> words = value.choices;
  if (value.scenes) {
    for (const std::string& name : all_scene_names()) words.push_back(name);
  }
  if (value.scene_options) {
    return fmt::format(
        "compopt -o nospace 2>/dev/null\n"
        "      mapfile -t COMPREPLY < <(compgen -S = -W \"{}\" -- \"$current\")",
        bash_words(option_paths()));
  }
  if (value.list) {
    return fmt::format(
        "prefix=\n"
        "      [[ $current != *,* ]] || prefix=${{current%,*}},\n"
        "      mapfile -t COMPREPLY < <(compgen -P \"$prefix\" -W \"{}\" -- \"${{current##*,}}\")",
        bash_words(words));
  }
  std::string text;
  if (!words.empty()) text = fmt::format("_manyworlds_words {}", bash_words(words));
  if (!value.files.empty() || value.folders) {
    if (!text.empty()) text += "\n      ";
    text += fmt::format("_manyworlds_add_files {}", bash_words(value.files));
  }
  return text.empty() ? ":" : text;
}

std::string bash_path(const CommandLine& line) { return bash_words(line.path); }

}  // namespace

std::string bash_completion(const std::vector<CommandLine>& lines) {
  std::string text = kBashHead;
  text += "  for ((i = 1; i < COMP_CWORD; ++i)); do\n    case \"$path ${COMP_WORDS[i]}\" in\n";
  std::vector<std::string> below;
  for (const CommandLine& line : lines) {
    if (line.path.size() > 1) below.push_back("\"" + bash_path(line) + "\"");
  }
  text += fmt::format("      {}) path+=\" ${{COMP_WORDS[i]}}\" ;;\n    esac\n  done\n",
                      fmt::join(below, " | \\\n        "));
  // Values of options.
  text += "  case \"$path $option\" in\n";
  for (const CommandLine& line : lines) {
    for (const CommandLine::Option& option : line.options) {
      if (option.value_name.empty()) continue;
      std::vector<std::string> patterns;
      for (const std::string& name : option.names) {
        patterns.push_back(fmt::format("\"{} {}\"", bash_path(line), name));
      }
      text += fmt::format("    {})\n      {}\n      return ;;\n", fmt::join(patterns, " | "),
                          bash_fill(option.value));
    }
  }
  text += "  esac\n";
  // Options, commands and arguments.
  text += "  case \"$path\" in\n";
  for (const CommandLine& line : lines) {
    std::vector<std::string> options;
    for (const CommandLine::Option& option : line.options) {
      options.insert(options.end(), option.names.begin(), option.names.end());
    }
    Completion argument;
    if (!line.arguments.empty()) argument = line.arguments.front();
    argument.choices.insert(argument.choices.end(), line.commands.begin(), line.commands.end());
    text += fmt::format(
        "    \"{}\")\n"
        "      if [[ $current == -* ]]; then\n"
        "        _manyworlds_words {}\n"
        "        return\n"
        "      fi\n"
        "      {} ;;\n",
        bash_path(line), bash_words(options), bash_fill(argument));
  }
  text += "  esac\n}\ncomplete -F _manyworlds manyworlds\n";
  return text;
}

}  // namespace manyworlds::cli
