// Text that came from an external file or program, for a line of output.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace manyworlds {

// With '?' for what would end the line or steer a terminal, and cut where it is longer than `most`.
inline std::string printable(std::string_view text, std::size_t most = 500) {
  const bool cut = text.size() > most;
  std::string out(text.substr(0, most));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto at = [&](std::size_t k) { return static_cast<unsigned char>(out[k]); };
    // Of UTF-8 the control characters U+0080 to U+009F.
    const bool high = at(i) == 0xc2 && i + 1 < out.size() && at(i + 1) >= 0x80 && at(i + 1) < 0xa0;
    if (at(i) < 0x20 || at(i) == 0x7f || high) out[i] = '?';
    if (high) out[i + 1] = '?';
  }
  return cut ? out + "..." : out;
}

}  // namespace manyworlds
