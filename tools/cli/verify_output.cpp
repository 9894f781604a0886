#include "verify_output.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/base/interrupt.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::cli {

using tools::hex;

void VerifyTotals::add(const Tally& tally) {
  for (const int count : tally.compared) compared += count;
  for (const int count : tally.different) different += count;
  differences.insert(differences.end(), tally.differences.begin(), tally.differences.end());
}

bool available(Isa isa) {
  const std::vector<Isa> isas = available_isas();
  return std::find(isas.begin(), isas.end(), isa) != isas.end();
}

void print_head(const VerifyOptions& options) {
  std::string isas;
  std::string missing;
  for (const Isa isa : {Isa::scalar, Isa::avx2, Isa::avx512}) {
    std::string& list = available(isa) ? isas : missing;
    list += fmt::format("{}{}", list.empty() ? "" : ", ", to_string(isa));
  }
  fmt::print(
      "Hashes and status of single worlds, compared with those of a batch of {} (seed {}, {},\n",
      kWorlds, options.seed, to_string(default_isa()));
  fmt::print("1 thread, step(1) calls); on {}:\n", isas);
  fmt::print("  alone     each world as a batch of 1\n");
  fmt::print("  position  all worlds shifted by 1, 3 and 7 indices\n");
  fmt::print("  size      batches of {}\n", options.quick ? "1, 4, ... 40" : "1, 2, ... 40");
  fmt::print("  threads   1, 2, 3 and 4\n");
  fmt::print(
      "  kernels   layouts auto, dense, rows x broad phases all-pairs, "
      "sort-and-sweep, sparse; robots have one\n");
  fmt::print("  calls     step(7) and one call for all steps\n");
  fmt::print("  masks     a third of the worlds takes up to 5 steps, then the others do\n");
  fmt::print("  saved     half of the steps, a snapshot, the rest in another batch\n");
  fmt::print("  reset     a reset after a third of the run, then the whole run\n");
  fmt::print("  frozen    next to a world that a NaN force freezes half way\n");
  fmt::print("  energy    worlds of the batch of {} whose energy grows without a cause\n", kWorlds);
  fmt::print("Robots get random controls every 5 steps, and resets at random times.\n");
  if (!missing.empty()) fmt::print("Not on this CPU or not in this build: {}\n", missing);
  fmt::print("\n{:<14}{:<6}", "scene", "");
  for (const char* name : kNames) fmt::print("{:>9}", name);
  fmt::print("  hash of all\n");
  std::fflush(stdout);
}

void print_row(const VerifyRow& row) {
  fmt::print("{:<14}{:<6}", row.scene, to_string(row.precision));
  for (std::size_t column = 0; column < kColumns; ++column) {
    const int different = row.tally.different[column];
    const int compared = row.tally.compared[column];
    fmt::print("{:>9}", different > 0  ? fmt::format("{} BAD", different)
                        : compared > 0 ? fmt::format("{}", compared)
                                       : "-");
  }
  fmt::print("  {}\n", hex(row.hash));
  std::fflush(stdout);
}

void print_sum(const VerifyTotals& totals) {
  if (totals.different == 0) {
    fmt::print("\nall {} comparisons equal{}\n", totals.compared, totals.whole ? "" : " so far");
  } else {
    fmt::print("\n{} of {} comparisons differ\n", totals.different, totals.compared);
  }
  std::fflush(stdout);
  for (const std::string& difference : totals.differences) {
    tools::tell("manyworlds: {}\n", difference);
  }
}

void print_json(const VerifyOptions& options, const VerifyTotals& totals) {
  nlohmann::ordered_json isas = nlohmann::ordered_json::array();
  for (const Isa isa : available_isas()) isas.push_back(to_string(isa));
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const VerifyRow& row : totals.rows) {
    nlohmann::ordered_json compared = nlohmann::ordered_json::object();
    nlohmann::ordered_json different = nlohmann::ordered_json::object();
    for (std::size_t column = 0; column < kColumns; ++column) {
      compared[kNames[column]] = row.tally.compared[column];
      different[kNames[column]] = row.tally.different[column];
    }
    rows.push_back({{"scene", row.scene},
                    {"precision", to_string(row.precision)},
                    {"compared", compared},
                    {"different", different},
                    {"hash", hex(row.hash)}});
  }
  nlohmann::ordered_json json = {{"seed", options.seed},
                                 {"worlds", kWorlds},
                                 {"isas", isas},
                                 {"rows", rows},
                                 {"compared", totals.compared},
                                 {"different", totals.different},
                                 {"differences", totals.differences}};
  if (!totals.whole) json["interrupted"] = tools::interrupt_name();
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace manyworlds::cli
