#include <array>
#include <stdexcept>
#include <utility>

#include "manyworlds/mjcf.hpp"

namespace manyworlds {
namespace {

constexpr std::array<std::pair<const char*, std::int64_t MjcfLimits::*>, 8> kLimits = {{
    {"file_bytes", &MjcfLimits::file_bytes},
    {"total_bytes", &MjcfLimits::total_bytes},
    {"files", &MjcfLimits::files},
    {"depth", &MjcfLimits::depth},
    {"elements", &MjcfLimits::elements},
    {"copies", &MjcfLimits::copies},
    {"samples", &MjcfLimits::samples},
    {"vertices", &MjcfLimits::vertices},
}};

}  // namespace

std::vector<std::string> mjcf_limit_names() {
  std::vector<std::string> names;
  for (const auto& [name, member] : kLimits) names.emplace_back(name);
  return names;
}

std::int64_t& mjcf_limit(MjcfLimits& limits, std::string_view name) {
  std::string all;
  for (const auto& [known, member] : kLimits) {
    if (name == known) return limits.*member;
    all += (all.empty() ? "" : ", ") + std::string(known);
  }
  throw std::invalid_argument("MJCF limit '" + std::string(name) + "' is unknown; there are " +
                              all);
}

}  // namespace manyworlds
