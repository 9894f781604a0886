// Options of a scene by their paths, from the list of members: --set contact.slop=0.01.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/options.hpp"

namespace manyworlds::cli {

// Sets what "PATH=VALUE" says. Returns what is wrong with it, or nothing.
std::string set_option(Options& options, const std::string& assignment);

struct OptionLine {
  std::string path;   // "contact.slop"
  std::string takes;  // "a number"
  std::string value;  // as --set takes it
};
// Every option of these, in the order of the lists.
std::vector<OptionLine> option_lines(const Options& options);

}  // namespace manyworlds::cli
