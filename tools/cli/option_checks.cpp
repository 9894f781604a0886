#include "option_checks.hpp"

#include <charconv>
#include <cmath>

namespace manyworlds::cli {

std::string any_of(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 == names.size() ? " or " : ", ";
    list += names[i];
  }
  return list;
}

CLI::Validator whole_number(std::int64_t least, std::int64_t most) {
  return CLI::Validator(
      [least, most](std::string& text) -> std::string {
        std::int64_t value = 0;
        const char* end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        if (error == std::errc::invalid_argument || stop != end) {
          return fmt::format("must be a whole number, is '{}'", text);
        }
        const bool beyond = error == std::errc::result_out_of_range;
        const bool negative = text.front() == '-';
        if (beyond ? negative : value < least) {
          return fmt::format("must be at least {}, is {}", least, text);
        }
        if (beyond || value > most) return fmt::format("must be at most {}, is {}", most, text);
        text = fmt::format("{}", value);
        return {};
      },
      std::string());
}

CLI::Validator real_number(bool above_zero) {
  return CLI::Validator(
      [above_zero](std::string& text) -> std::string {
        double value = 0;
        const char* end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        if (error == std::errc::invalid_argument || stop != end) {
          return fmt::format("must be a number, is '{}'", text);
        }
        const bool fits = above_zero ? value > 0 : value >= 0;
        if (error != std::errc{} || !std::isfinite(value) || !fits) {
          return fmt::format("must be a finite number {} 0, is {}",
                             above_zero ? "above" : "of at least", text);
        }
        text = fmt::format("{}", value);
        return {};
      },
      std::string());
}

CLI::Validator name_of_a(const char* what) {
  return CLI::Validator(
      [what](std::string& text) -> std::string {
        return text.empty() ? fmt::format("must be the name of a {}, is ''", what) : std::string();
      },
      std::string());
}

}  // namespace manyworlds::cli
