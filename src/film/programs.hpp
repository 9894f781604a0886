// Where the programs are that draw and encode.
#pragma once

#include <string>

namespace manyworlds::film {

// Full paths. Throw FilmError, which says how to get it.
std::string browser_program();
std::string encoder_program(const std::string& given = {});  // empty: looked for

}  // namespace manyworlds::film
