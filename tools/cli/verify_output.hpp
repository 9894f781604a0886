// What `manyworlds verify` compares, and how it prints that: as a table or as JSON.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "commands.hpp"
#include "manyworlds/batch.hpp"

namespace manyworlds::cli {

inline constexpr int kWorlds = 40;  // of the reference batch

// What is varied. The order is the order of the table's columns.
enum Column {
  kAlone,
  kPosition,
  kSize,
  kThreads,
  kKernels,
  kCalls,
  kMasks,
  kSaved,
  kReset,
  kFrozen,
  kEnergy,
  kColumns
};
inline constexpr std::array<const char*, kColumns> kNames = {
    "alone", "position", "size",  "threads", "kernels", "calls",
    "masks", "saved",    "reset", "frozen",  "energy"};

struct Tally {
  std::array<int, kColumns> compared{};
  std::array<int, kColumns> different{};
  std::vector<std::string> differences;  // the first of each column
};

// A scene in one precision.
struct VerifyRow {
  std::string scene;
  Precision precision{};
  Tally tally;
  std::uint64_t hash = 0;  // of all worlds of the reference batch
};

// All rows, and the sums over them.
struct VerifyTotals {
  std::vector<VerifyRow> rows;
  long long compared = 0, different = 0;
  std::vector<std::string> differences;
  bool whole = true;  // not interrupted

  void add(const Tally& tally);
};

bool available(Isa isa);
void print_head(const VerifyOptions& options);
void print_row(const VerifyRow& row);
void print_sum(const VerifyTotals& totals);
void print_json(const VerifyOptions& options, const VerifyTotals& totals);

}  // namespace manyworlds::cli
