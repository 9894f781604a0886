// Recordings of worlds of a Batch in HDF5 files, from which the run can be simulated again, and
// scenes as JSON. A separate library, manyworlds::record, because it needs HDF5.
//
// A file contains the scenes with all options, a Snapshot of the worlds at the start, every later
// input, and every k steps the state fields, hashes and status of each world, optionally with its
// contacts. docs/recordings.md describes the layout.
//
// Threads may each use their own Batch, Recorder and Recording at the same time. Calls of HDF5 are
// serialised.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "manyworlds/batch.hpp"
#include "manyworlds/pimpl.hpp"

namespace manyworlds {

// A file that cannot be written, read or understood; what() has one line per problem: "'run.h5':
// scene of kind 0, /bodies/3/shapes/0: has no member 'material'".
class RecordError : public std::runtime_error {
 public:
  explicit RecordError(std::vector<std::string> problems);
  explicit RecordError(const std::string& problem) : RecordError(std::vector{problem}) {}
  const std::vector<std::string>& problems() const { return problems_; }  // never empty

 private:
  std::vector<std::string> problems_;
};

// ---- scenes as JSON ----------------------------------------------------------------------------

// The whole scene, with every number exact. Numbers that JSON cannot represent are the strings
// "inf",
// "-inf" and "nan".
std::string scene_to_json(const Scene& scene);
std::string plan_options_to_json(const PlanOptions& options);
// Throw RecordError with all problems: every member must be present, and no other. validate()
// checks the scene itself.
Scene scene_from_json(std::string_view json);
PlanOptions plan_options_from_json(std::string_view json);

// ---- recording ---------------------------------------------------------------------------------

inline constexpr int kMaxWorldsByDefault = 64;

struct RecordOptions {
  std::vector<int> worlds = {};  // worlds of the batch; empty: the first kMaxWorldsByDefault
  // A sample is taken at the start, and after the first step() call that ends at or after each
  // multiple of `every` steps. 0: only by sample().
  int every = 1;
  std::int64_t first_world = 0;  // the name of the batch's world 0 in the file
  // Data older than this, in s of wall time, is flushed when a call of the batch ends. Flushed data
  // survives any end of the program (see unfinished_recordings). 0: flush at each call.
  double flush_seconds = 5;
  // Maximum number of contact points recorded per world and sample, those of the largest forces; at
  // most kMaxContactsRecorded. 0: none. Requires a batch that observes contacts
  // (Observer::contacts).
  int contacts = 0;
};

inline constexpr int kMaxContactsRecorded = 1 << 16;  // per world and sample

// A contact point that had a normal force in the last step before a sample.
struct RecordedContact {
  BodyId body_a = {}, body_b = {};  // when one is fixed it is body_a
  Vec3 point = Vec3::Zero();        // m, world, where the narrow phase found it
  Vec3 normal = Vec3::Zero();       // unit, from A to B, world
  double force = 0;                 // N, along the normal: the impulse of the step over its dt
};

// Records the state of some worlds every few steps, and every input to them, from construction to
// close(). The batch reports its calls to the Recorder; use the batch as usual.
class Recorder {
 public:
  // Throws std::invalid_argument if the options do not fit the batch, if contacts are requested
  // that it does not observe, or if forces have been added for the next step, since the file could
  // not contain them. Throws RecordError if the file cannot be written, or exists and is not a
  // regular file. Symbolic links are followed.
  Recorder(Batch& batch, const std::filesystem::path& file, const RecordOptions& options = {});
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;
  ~Recorder();  // without close() there is no file

  // Takes one more sample of the recorded batch.
  void sample(const Batch& batch);
  // Completes the file and renames it to its final name; a previous file of that name stays until
  // then. Throws RecordError, also for failures of earlier calls, since step() does not throw. Data
  // flushed before a failure is kept, and the error names its file.
  void close();
  std::int64_t samples() const;

 private:
  struct Listener;  // receives the batch's calls
  struct Impl;
  Pimpl<Impl> impl_;
};

// Writes short recordings of worlds that are lost, from the last checkpoint to the step in which
// the world is lost. Every `checkpoint_steps` steps all worlds are saved in memory (as by
// Batch::save) and earlier inputs are discarded.
class LostWorldDumps {
 public:
  struct Options {
    int checkpoint_steps = 600;
    int max_files = 16;            // later lost worlds are only counted
    std::int64_t first_world = 0;  // the name of the batch's world 0 in the files
  };
  // Creates the folder. Throws as Recorder does.
  LostWorldDumps(Batch& batch, std::filesystem::path folder, const Options& options);
  LostWorldDumps(Batch& batch, std::filesystem::path folder);
  LostWorldDumps(LostWorldDumps&&) noexcept;
  LostWorldDumps& operator=(LostWorldDumps&&) noexcept;
  ~LostWorldDumps();

  // Writes the worlds lost since the last checkpoint and stops recording. Returns all files, such
  // as "world_17.h5". Throws RecordError, also for earlier failures.
  std::vector<std::filesystem::path> close();

 private:
  struct Listener;  // receives the batch's calls
  struct Impl;
  Pimpl<Impl> impl_;
};

// Recordings of `file` left by programs that were killed (kill -9, power failure): files next to it
// such as "run.h5.part-8c1f03ab5e6d7790" that have contents and no writer, sorted by name. Each can
// be opened and replayed up to its last flush. Throws RecordError if `file` is not a file name.
std::vector<std::filesystem::path> unfinished_recordings(const std::filesystem::path& file);

// ---- replay ------------------------------------------------------------------------------------

// An opened recording, whose sizes, indices, types and texts have all been checked. It keeps the
// inputs in memory and reads fields from the file on demand.
class Recording {
 public:
  // Both throw RecordError if the data is not a recording, or is truncated, corrupt or
  // inconsistent. A file of unfinished_recordings() is read up to its last flush.
  static Recording open(const std::filesystem::path& file);
  static Recording from_bytes(std::span<const std::byte> bytes);
  Recording(Recording&&) noexcept;
  Recording& operator=(Recording&&) noexcept;
  ~Recording();

  int worlds() const;
  int kinds() const;
  const Plan& plan(int kind = 0) const;
  int worlds_of(int kind) const;          // worlds of a kind are consecutive
  std::int64_t name_of(int world) const;  // the world's index in the recorded batch
  bool finished() const;                  // false for a file of unfinished_recordings()
  std::int64_t samples() const;
  std::int64_t step(std::int64_t sample) const;  // steps since the recording began
  std::int64_t inputs() const;
  Precision precision() const;
  bool sleep() const;
  std::uint64_t hash(std::int64_t sample, int world) const;
  Status status(std::int64_t sample, int world) const;
  // A field of one world, [body][component].
  std::vector<double> read(Field field, std::int64_t sample, int world) const;
  bool has_contacts() const;  // RecordOptions::contacts was not 0
  // Contacts of the last step before the sample, in canonical order; empty if not recorded.
  std::vector<RecordedContact> contacts(std::int64_t sample, int world) const;
  // Number of contacts found, of which at most RecordOptions::contacts are recorded.
  int contacts_found(std::int64_t sample, int world) const;
  // Program version, instruction set, threads, seed and so on of the recording, as text.
  std::string origin() const;

  struct Impl;
  const Impl& impl() const;  // throws std::invalid_argument after a move

 private:
  explicit Recording(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

struct ReplayOptions {
  std::optional<Isa> isa = std::nullopt;
  int threads = 0;
  ContactLayout layout = ContactLayout::automatic;
  GoOn go_on = {};  // polled; when it returns false, the result covers the samples compared so far
};

struct Difference {
  std::int64_t world = 0;  // index in the recorded batch (Recording::name_of)
  std::int64_t step = 0;   // since the recording began
  BodyId body = {};        // none: no field differs, but hash or status does
  std::string what = {};   // "position.x is 1.5, recorded 1.25"
};

struct ReplayResult {
  int worlds = 0;
  std::int64_t samples = 0;
  std::int64_t steps = 0;
  std::int64_t compared = 0;                  // hashes compared, each with its status and fields
  std::int64_t different = 0;                 // hashes that differ
  std::optional<Difference> difference = {};  // the first difference
  int lost_worlds = 0;                        // at the end
  std::string kernel_table = {};
};

// Simulates a recording again from its first snapshot and its inputs, and compares hash, status and
// fields at every sample. Throws RecordError if the snapshot does not fit; throws as Batch does for
// invalid options.
ReplayResult replay(const Recording& recording, const ReplayOptions& options = {});

}  // namespace manyworlds
