#include "fuzz/json_edit.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace manyworlds::fuzz {

namespace {

using Tokens = std::vector<std::string>;

constexpr std::array kWords = {"0",
                               "-1",
                               "1",
                               "0.5",
                               "2",
                               "1e308",
                               "1e-320",
                               "1e999",
                               "1e10",
                               "-0.0",
                               "\"nan\"",
                               "\"inf\"",
                               "\"-inf\"",
                               "null",
                               "true",
                               "[]",
                               "{}",
                               "\"\"",
                               "4294967296",
                               "-1e5",
                               "false",
                               "[{}]",
                               "[1,2,3]",
                               "{\"circle\":{\"radius\":0.5}}",
                               "2147483647",
                               "65536",
                               "1e-9",
                               "[[]]",
                               "\"mass\"",
                               "{\"capsule\":null}",
                               "-2147483649",
                               "18446744073709551615",
                               "-9223372036854775808",
                               "{\"sphere\":{\"radius\":-1}}"};

// Strings, numbers and words whole, every other character for itself.
Tokens tokens_of(const std::string& text) {
  Tokens out;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    if (text[at] == '"') {
      while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
      end = std::min(end + 1, text.size());
    } else if (std::string_view(",:{}[]").find(text[at]) == std::string_view::npos) {
      end = std::min(text.find_first_of(",:{}[]\"", at), text.size());
    }
    out.push_back(text.substr(at, end - at));
    at = end;
  }
  return out;
}

// `text` in that many brackets.
std::string nested(const std::string& text, std::size_t deep) {
  return std::string(deep, '[') + text + std::string(deep, ']');
}

}  // namespace

std::string edit_json(const std::string& text, FuzzedDataProvider& in) {
  Tokens tokens = tokens_of(text);
  if (tokens.empty()) return in.ConsumeRandomLengthString(64);
  const auto index = [&] { return in.ConsumeIntegralInRange<std::size_t>(0, tokens.size() - 1); };
  const std::size_t at = index();
  const auto first = tokens.begin() + static_cast<std::ptrdiff_t>(at);
  const auto some = [&] {
    return first + static_cast<std::ptrdiff_t>(
                       std::min(in.ConsumeIntegralInRange<std::size_t>(1, 40), tokens.size() - at));
  };
  switch (in.ConsumeIntegralInRange(0, 9)) {
    case 0: tokens[at] = '"' + in.ConsumeRandomLengthString(64) + '"'; break;
    case 1: tokens[at] = in.ConsumeRandomLengthString(64); break;
    case 2: tokens.erase(first, some()); break;
    case 3: {
      const Tokens copy(first, some());
      tokens.insert(tokens.begin() + static_cast<std::ptrdiff_t>(index()), copy.begin(),
                    copy.end());
      break;
    }
    case 4: std::swap(tokens[at], tokens[index()]); break;
    case 5:
      tokens[at] = nested(tokens[at], std::size_t{1} << in.ConsumeIntegralInRange(0, 17));
      break;
    default: tokens[at] = in.PickValueInArray(kWords);
  }
  return std::accumulate(tokens.begin(), tokens.end(), std::string());
}

}  // namespace manyworlds::fuzz
