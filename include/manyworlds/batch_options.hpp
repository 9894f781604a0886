// What a Batch is made with.
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
// What a Batch takes when BatchOptions::isa is empty: MANYWORLDS_ISA, else the widest available.
// Throws std::invalid_argument when MANYWORLDS_ISA names one that is unknown or not available.
Isa default_isa();

inline constexpr int kMaxThreads = 1024;  // of a Batch, its own or its executor's

struct BatchOptions {
  int worlds = 1;
  int threads = 0;         // 0: as many as the process may run on (affinity mask) and can start
  std::uint64_t seed = 0;  // world i draws from seed + i
  Precision precision = Precision::f32;
  std::optional<Isa> isa = std::nullopt;  // default_isa()
  // Of contacts in memory, by what each group of worlds needs in a step. Chosen, all passes over
  // contacts run, even where nothing touches. No bit depends on it.
  ContactLayout layout = ContactLayout::automatic;
  // Bodies at rest fall asleep, island by island (SleepOptions::speed), and cost little until
  // something wakes them; worlds in which everything sleeps cost nothing.
  bool sleep = false;
  // Every so many steps of its own a world's energy is audited over one step: what it gains beyond
  // the work of forces, controls, drives and kinematic bodies adds up to Status::diverged. 0:
  // never; at most 255. Worlds with robots, with the penalty solver, and in which nothing but free
  // flight happens are not audited.
  int audit_every = 16;
  Observers observe = {};                        // what to watch beside the step (observe.hpp)
  std::shared_ptr<Executor> executor = nullptr;  // step on these threads; threads must then be 0
};

}  // namespace manyworlds
