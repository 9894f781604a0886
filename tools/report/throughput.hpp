// `manyworlds report throughput`: world-steps per second over worlds, threads, instruction sets,
// precisions and bodies per world, how near that is to what the machine can do, and how fast other
// engines are beside it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "manyworlds/batch.hpp"
#include "tools/report/peers.hpp"

namespace manyworlds::report {

// Of one thread, measured.
struct Limits {
  double gflops = 0;           // fused multiply-adds of float32, two operations each, in 1e9/s
  double gigabytes_per_s = 0;  // read and written from memory
};
Limits measure_limits();

struct ThroughputRow {
  std::string sweep, scene, value;  // what was varied, and how far
  int worlds = 0, threads = 1;
  double world_steps_per_s = 0, body_steps_per_s = 0;
  std::size_t bytes_per_world = 0;
  // Share of the memory's bandwidth that reading and writing the state of each world once per step
  // takes; what fits the caches may be above 1.
  double bandwidth_share = 0;
  std::uint64_t hash = 0;
  std::vector<std::pair<std::string, double>> stages;  // share of the time
};
struct Throughput {
  Limits limits;
  std::vector<ThroughputRow> rows;
  std::optional<Peers> peers;
};

struct ThroughputOptions {
  std::vector<std::string> scenes;  // empty: bin-spheres, stack10, chain3d, ball2d
  std::string peers;                // folder of other engines' programs; empty: none
  bool peers_only = false;          // no sweeps
  bool quick = false;
};

Throughput run_throughput(const ThroughputOptions& options,
                          const std::function<void(const std::string&, double)>& tell);

nlohmann::ordered_json to_json(const Throughput& result);

}  // namespace manyworlds::report
