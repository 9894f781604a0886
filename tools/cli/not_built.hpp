// What a build may leave out, and the command that adds it.
#pragma once

#include <string>

#include "options.hpp"

namespace manyworlds::cli {

// For what was asked for and is not there: "--record: this program was built without recordings;
// ...".
inline InputError not_built(const std::string& asked, const std::string& part,
                            const std::string& option) {
  return InputError(asked + ": this program was built without " + part + "; cmake -D " + option +
                    " adds it, tools/run --all in the repository adds all parts");
}

}  // namespace manyworlds::cli
