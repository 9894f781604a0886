// Options of a Batch.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "manyworlds/executor.hpp"
#include "manyworlds/observe.hpp"

namespace manyworlds {

enum class Precision { f32, f64 };
enum class Isa { scalar, avx2, avx512 };
enum class ContactLayout { automatic, dense, rows };
const char* to_string(Precision precision);
const char* to_string(Isa isa);
const char* to_string(ContactLayout layout);

// Instruction sets that this CPU and this build can run, narrowest first. Never empty.
std::vector<Isa> available_isas();
// Instruction set of a Batch whose BatchOptions::isa is empty: MANYWORLDS_ISA, else the widest
// available. Throws std::invalid_argument if MANYWORLDS_ISA is unknown or not available.
Isa default_isa();

inline constexpr int kMaxThreads = 1024;  // threads of a Batch, or of its executor

struct BatchOptions {
  int worlds = 1;
  int threads = 0;         // 0: as many as the affinity mask allows and the process can start
  std::uint64_t seed = 0;  // world i draws from seed + i
  Precision precision = Precision::f32;
  std::optional<Isa> isa = std::nullopt;  // empty: default_isa()
  // Memory layout of contacts. automatic chooses it per step for each group of worlds. With another
  // value all contact stages run, even without contacts. The layout does not affect the results.
  ContactLayout layout = ContactLayout::automatic;
  // Islands of bodies at rest fall asleep (SleepOptions::speed) until something wakes them.
  // Sleeping bodies cost little; worlds in which all bodies sleep cost nothing.
  bool sleep = false;
  // Each world audits its energy over one of this many of its steps, at most 255; 0: never. The
  // audit adds up the energy gained beyond the work of forces, controls, drives and kinematic
  // bodies, and may set Status::diverged (docs/batch.md). Worlds with robots, with the penalty
  // solver or in free motion are not audited.
  int audit_every = 16;
  Observers observe = {};                        // what to measure (observe.hpp)
  std::shared_ptr<Executor> executor = nullptr;  // steps on these threads; threads must then be 0
};

}  // namespace manyworlds
