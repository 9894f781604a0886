// How numbers are written for people.
#pragma once

#include <cstdint>
#include <string>

namespace manyworlds::tools {

// Three significant digits and a prefix: "263 k", "12.3 M", "870", "0.5".
std::string with_prefix(double value);

// "1.25 M/s"
std::string speed_text(double per_second);

// Sixteen hexadecimal digits.
std::string hex(std::uint64_t hash);

// "4.20 mm", "0.613 m": lengths of overlaps.
std::string length(double meters);

// As a POSIX shell takes it: file names may hold blanks and quotes.
std::string shell_word(const std::string& word);

// "1 world", "3 worlds"
std::string counted(long long count, const std::string& noun);

}  // namespace manyworlds::tools
