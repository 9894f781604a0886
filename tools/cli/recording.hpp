// Recordings of a job and dumps of its lost worlds, where this program was built with them
// (MW_RECORD). Without, asking for one is an InputError that says how to build it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "manyworlds/batch.hpp"

#include "options.hpp"

namespace manyworlds::cli {

// True when this program was built with recordings.
bool writes_recordings();

// Of --record-worlds: "0,5,10-20", ascending, each once. Throws InputError.
std::vector<int> parse_worlds(const std::string& list, int worlds);

// How many steps a call may take so that calls end where samples are due.
int steps_per_call(const JobOptions& options);

// What --record asks for, of a batch; nothing if it was not given.
class JobRecorder {
 public:
  // Throws InputError and RecordError.
  JobRecorder(Batch& batch, const JobOptions& options);
  ~JobRecorder();
  JobRecorder(const JobRecorder&) = delete;
  JobRecorder& operator=(const JobRecorder&) = delete;
  // The last sample, and the file gets its name. Returns a line for people, empty if nothing was
  // recorded. Throws nothing: what went wrong, now or before, is failure().
  std::string finish(const Batch& batch);
  const std::string& failure() const { return failure_; }  // one line; empty if there is none

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::string failure_;
};

// What --dump-lost asks for, over the batches of a job.
class LostDumps {
 public:
  explicit LostDumps(const JobOptions& options);  // throws InputError
  ~LostDumps();
  LostDumps(const LostDumps&) = delete;
  LostDumps& operator=(const LostDumps&) = delete;
  // From now on watches `batch`, whose world 0 is world `first` of the job.
  void watch(Batch& batch, std::int64_t first);
  void finish();       // with that batch; what goes wrong is failure()
  void print() const;  // the files, and what to do with them, on standard error
  const std::string& failure() const { return failure_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::string failure_;
};

// Tells on standard error of what failed while something was written. Returns the exit code for
// that, or else `code`.
int finish_code(const JobRecorder& recorder, const LostDumps& dumps, int code);
int finish_code(const LostDumps& dumps, int code);

}  // namespace manyworlds::cli
