// `manyworlds info`: what this program is, and what it runs on.
#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "manyworlds/batch.hpp"
#include "manyworlds/scenes.hpp"

#include "commands.hpp"
#include "recording.hpp"
#include "scene_source.hpp"
#include "set_option.hpp"
#include "tools/base/machine.hpp"
#include "tools/base/version.hpp"

namespace manyworlds::cli {
namespace {

using tools::cpu_model, tools::kCompiler, tools::kVersion, tools::usable_cpus;

std::string isa_list() {
  const std::vector<Isa> available = available_isas();
  std::string list;
  for (const Isa isa : {Isa::scalar, Isa::avx2, Isa::avx512}) {
    const bool usable = std::find(available.begin(), available.end(), isa) != available.end();
    list += fmt::format("{}{}{}", list.empty() ? "" : ", ", to_string(isa),
                        usable ? "" : " (not available)");
  }
  return list;
}

// Those that this build and this CPU have kernels for.
std::string precision_list() {
  std::string list;
  for (const Precision precision : {Precision::f32, Precision::f64}) {
    BatchOptions options;
    options.threads = 1;
    options.precision = precision;
    try {
      const Batch probe(compile(scenes::find("ball2d")->make()), options);
    } catch (const std::invalid_argument&) {
      continue;
    }
    list += (list.empty() ? "" : ", ") + std::string(to_string(precision));
  }
  return list;
}

}  // namespace

int info_command(bool json) {
  const Isa in_use = default_isa();  // throws before anything is printed
  if (json) {
    nlohmann::ordered_json isas = nlohmann::ordered_json::array();
    for (const Isa isa : available_isas()) isas.push_back(to_string(isa));
    const nlohmann::ordered_json all = {
        {"manyworlds", kVersion}, {"compiler", kCompiler},
        {"cpu", cpu_model()},     {"threads", usable_cpus()},
        {"isas", isas},           {"isa", to_string(in_use)},
        {"mjcf", reads_mjcf()},   {"recordings", writes_recordings()}};
    fmt::print("{}\n", all.dump(2));
    return kOk;
  }
  const auto row = [](const char* name, const std::string& value) {
    fmt::print("{:<13}{}\n", name, value);
  };
  row("manyworlds", kVersion);
  row("compiler", kCompiler);
  row("cpu", cpu_model());
  row("threads", fmt::format("{}", usable_cpus()));
  row("isa", isa_list());
  row("isa in use", to_string(in_use));
  row("precision", precision_list());
  row("mjcf", reads_mjcf() ? "yes" : "no");
  row("recordings", writes_recordings() ? "yes" : "no");
  return kOk;
}

int list_options_command(bool json) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const OptionLine& line : option_lines(Options())) {
    if (json) {
      all.push_back({{"path", line.path}, {"takes", line.takes}, {"default", line.value}});
    } else {
      fmt::print("{:<30} {:<16} {}\n", line.path, line.value, line.takes);
    }
  }
  if (json) fmt::print("{}\n", all.dump(2));
  return kOk;
}

}  // namespace manyworlds::cli
