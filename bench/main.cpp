// The micro benchmarks: Google Benchmark's program with a shorter default for the time of each
// benchmark, since most of an iteration prepares the state and is not counted.
#include <string>
#include <vector>

#include "bench/report.hpp"

int main(int argc, char** argv) {
  std::string min_time = "--benchmark_min_time=0.02";
  std::vector<char*> args(argv, argv + argc);
  args.insert(args.begin() + 1, min_time.data());  // later arguments win
  int count = static_cast<int>(args.size());
  args.push_back(nullptr);
  benchmark::Initialize(&count, args.data());
  if (benchmark::ReportUnrecognizedArguments(count, args.data())) return 2;
  manyworlds::bench::register_steps();
  manyworlds::bench::register_stages();
  manyworlds::bench::register_pairs();
  manyworlds::bench::register_batch();
  manyworlds::bench::register_observers();
  manyworlds::bench::register_sizes();
  manyworlds::bench::register_tasks();
  manyworlds::bench::register_robots();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
