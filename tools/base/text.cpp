#include "tools/base/text.hpp"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace manyworlds::tools {
namespace {

std::string three_digits(double value) {
  const double size = std::abs(value);
  if (size >= 99.95 || size == std::floor(size)) return fmt::format("{:.0f}", value);
  if (size >= 9.995) return fmt::format("{:.1f}", value);
  return fmt::format("{:.3g}", value);
}

}  // namespace

std::string with_prefix(double value) {
  constexpr std::string_view kPrefixes[] = {"", " k", " M", " G", " T"};
  std::size_t prefix = 0;
  // 999.5 rounds to 1000, which has a shorter name with the next prefix.
  while (std::abs(value) >= 999.5 && prefix + 1 < std::size(kPrefixes)) {
    value /= 1000;
    ++prefix;
  }
  return three_digits(value) + std::string(kPrefixes[prefix]);
}

std::string speed_text(double per_second) { return with_prefix(per_second) + "/s"; }

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

std::string length(double meters) {
  if (std::abs(meters) < 0.1) return fmt::format("{:.2f} mm", 1000 * meters);
  return fmt::format("{:.3g} m", meters);
}

std::string counted(long long count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string shell_word(const std::string& word) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+,";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace manyworlds::tools
