// Recordings: what worlds of a Batch did, in an HDF5 file from which it can be done again, and
// scenes as JSON. A library of its own, manyworlds::record, because it needs HDF5.
//
// A file holds the scenes with all their options, a Snapshot of the worlds at the beginning, every
// input since then, and every k steps the state fields, hashes and status of each world, and its
// contacts where that is asked for. Its layout is in docs/recordings.md.
//
// Any thread may use its own Batch, Recorder and Recording while others do: those that are in HDF5
// at the same time wait for one another.
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

// Everything of the scene, every number exactly. Numbers that JSON has no word for are the strings
// "inf", "-inf" and "nan".
std::string scene_to_json(const Scene& scene);
std::string plan_options_to_json(const PlanOptions& options);
// Throw RecordError with all problems: every member must be there, and no other. Whether the scene
// makes sense is up to validate().
Scene scene_from_json(std::string_view json);
PlanOptions plan_options_from_json(std::string_view json);

// ---- recording ---------------------------------------------------------------------------------

inline constexpr int kMaxWorldsByDefault = 64;

struct RecordOptions {
  std::vector<int> worlds = {};  // of the batch; empty: the first kMaxWorldsByDefault of them
  // A sample is taken at once, and after the first step() call that ends on or beyond each multiple
  // of `every` steps. 0: only when sample() says so.
  int every = 1;
  std::int64_t first_world = 0;  // what the batch's world 0 is called in the file
  // What is older than so many seconds of wall time when a call of the batch ends is flushed, and
  // survives the end of the program, whatever that is (see unfinished_recordings). 0: at each call.
  double flush_seconds = 5;
  // Contact points of a world and sample that are kept at most, those of the largest forces; at
  // most kMaxContactsRecorded. 0: none are recorded. Wants a batch that observes contacts
  // (Observer::contacts).
  int contacts = 0;
};

inline constexpr int kMaxContactsRecorded = 1 << 16;  // of a world and sample

// A contact point that bore a normal force in the last step before a sample.
struct RecordedContact {
  BodyId body_a = {}, body_b = {};  // when one is fixed it is body_a
  Vec3 point = Vec3::Zero();        // m, world, where the narrow phase found it
  Vec3 normal = Vec3::Zero();       // unit, from A to B, world
  double force = 0;                 // N, along the normal: the impulse of the step over its dt
};

// Records from construction to close(): the state of some worlds every few steps, and every input
// to them. The batch reports every call to it, so nothing needs to go through the Recorder.
class Recorder {
 public:
  // Throws std::invalid_argument for options that do not fit the batch, for contacts that it does
  // not observe, and when forces were added for the next step already, which no file would know of;
  // RecordError when the file cannot be written, or exists and is no regular file. A symbolic link
  // is followed.
  Recorder(Batch& batch, const std::filesystem::path& file, const RecordOptions& options = {});
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;
  ~Recorder();  // without close() no file is left

  // One more sample, of the batch that is recorded as it is now.
  void sample(const Batch& batch);
  // Finishes the file and gives it its name, so that a partial file is never seen; an old file of
  // that name stays until then. Throws RecordError, also for what failed since the beginning:
  // step() does not throw. What had been flushed until then is kept, and named in the error.
  void close();
  std::int64_t samples() const;

 private:
  struct Listener;  // receives the batch's calls
  struct Impl;
  Pimpl<Impl> impl_;
};

// Writes small recordings of worlds that get lost: each begins at the last checkpoint before and
// ends when the world is lost. `checkpoint_steps` steps apart, all worlds are saved in memory (as
// Batch::save) and earlier inputs are forgotten.
class LostWorldDumps {
 public:
  struct Options {
    int checkpoint_steps = 600;
    int max_files = 16;            // worlds lost after that are only counted
    std::int64_t first_world = 0;  // what the batch's world 0 is called in the files
  };
  // Makes the folder. Throws as Recorder does.
  LostWorldDumps(Batch& batch, std::filesystem::path folder, const Options& options);
  LostWorldDumps(Batch& batch, std::filesystem::path folder);
  LostWorldDumps(LostWorldDumps&&) noexcept;
  LostWorldDumps& operator=(LostWorldDumps&&) noexcept;
  ~LostWorldDumps();

  // Writes what has been lost since the last checkpoint and stops watching. Throws RecordError,
  // also for what failed before. Returns all files, "world_17.h5".
  std::vector<std::filesystem::path> close();

 private:
  struct Listener;  // receives the batch's calls
  struct Impl;
  Pimpl<Impl> impl_;
};

// What programs that were cut off (kill -9, a power cut) had recorded of `file`: the files beside
// it, "run.h5.part-8c1f03ab5e6d7790", that have contents and no writer any more, by name.
// Each can be opened and replayed up to where it was last flushed. Throws RecordError when `file`
// is no name of a file.
std::vector<std::filesystem::path> unfinished_recordings(const std::filesystem::path& file);

// ---- replay ------------------------------------------------------------------------------------

// A recording that was opened and checked: every size, index, type and text in it. It holds the
// inputs in memory, and reads fields from the file as they are asked for.
class Recording {
 public:
  // Both throw RecordError for what is no recording, cut, corrupted or inconsistent. A file of
  // unfinished_recordings() is read as it was when it was last flushed.
  static Recording open(const std::filesystem::path& file);
  static Recording from_bytes(std::span<const std::byte> bytes);
  Recording(Recording&&) noexcept;
  Recording& operator=(Recording&&) noexcept;
  ~Recording();

  int worlds() const;
  int kinds() const;
  const Plan& plan(int kind = 0) const;
  int worlds_of(int kind) const;          // kinds lie one after the other
  std::int64_t name_of(int world) const;  // which world of the recorded batch it was
  bool finished() const;                  // false for one of unfinished_recordings()
  std::int64_t samples() const;
  std::int64_t step(std::int64_t sample) const;  // steps since the recording began
  std::int64_t inputs() const;
  Precision precision() const;
  bool sleep() const;
  std::uint64_t hash(std::int64_t sample, int world) const;
  Status status(std::int64_t sample, int world) const;
  // The field of one world, canonical [body][component].
  std::vector<double> read(Field field, std::int64_t sample, int world) const;
  bool has_contacts() const;  // RecordOptions::contacts was not 0
  // As of the last step before the sample, in canonical order; none where they were not recorded.
  std::vector<RecordedContact> contacts(std::int64_t sample, int world) const;
  // How many there were, of which RecordOptions::contacts were kept.
  int contacts_found(std::int64_t sample, int world) const;
  // As it was recorded: program version, instruction set, threads, seed, ...; for people.
  std::string origin() const;

  struct Impl;
  const Impl& impl() const;  // throws std::invalid_argument when it was moved from

 private:
  explicit Recording(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

struct ReplayOptions {
  std::optional<Isa> isa = std::nullopt;
  int threads = 0;
  ContactLayout layout = ContactLayout::automatic;
  GoOn go_on = {};  // asked now and then; where it says no, the result is of what was compared
};

struct Difference {
  std::int64_t world = 0;  // of the recorded batch (Recording::name_of)
  std::int64_t step = 0;   // since the recording began
  BodyId body = {};        // none: no field differs, but hash or status does
  std::string what = {};   // "position.x is 1.5, recorded 1.25"
};

struct ReplayResult {
  int worlds = 0;
  std::int64_t samples = 0;
  std::int64_t steps = 0;
  std::int64_t compared = 0;                  // hashes, each with its status and fields
  std::int64_t different = 0;                 // of them
  std::optional<Difference> difference = {};  // the first
  int lost_worlds = 0;                        // at the end
  std::string kernel_table = {};
};

// Simulates a recording again from its first snapshot and its inputs, and compares hash, status
// and fields at every sample. Throws RecordError when the snapshot does not fit, and what Batch
// throws for options.
ReplayResult replay(const Recording& recording, const ReplayOptions& options = {});

}  // namespace manyworlds
