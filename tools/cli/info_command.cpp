// `manyworlds info`: what this program is, and what it runs on.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "manyworlds/batch.hpp"

#include "commands.hpp"
#include "recording.hpp"
#include "scene_source.hpp"
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

}  // namespace

int info_command() {
  const Isa in_use = default_isa();  // throws before anything is printed
  const auto row = [](const char* name, const std::string& value) {
    fmt::print("{:<13}{}\n", name, value);
  };
  row("manyworlds", kVersion);
  row("compiler", kCompiler);
  row("cpu", cpu_model());
  row("threads", fmt::format("{}", usable_cpus()));
  row("isa", isa_list());
  row("isa in use", to_string(in_use));
  row("precision", fmt::format("{}, {}", to_string(Precision::f32), to_string(Precision::f64)));
  row("mjcf", reads_mjcf() ? "yes" : "no");
  row("recordings", writes_recordings() ? "yes" : "no");
  return kOk;
}

}  // namespace manyworlds::cli
