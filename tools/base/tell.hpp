// Words for people on standard error.
#pragma once

#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace manyworlds::tools {

// As fmt::print, which throws where output is closed: losing it is no error.
template <class... Values>
void tell(fmt::format_string<Values...> format, Values&&... values) {
  std::fputs(fmt::format(format, std::forward<Values>(values)...).c_str(), stderr);
}

}  // namespace manyworlds::tools
