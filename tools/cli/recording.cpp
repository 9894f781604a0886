#include "recording.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#ifdef MW_HAVE_RECORD
#include "leftovers.hpp"
#include "manyworlds/record.hpp"
#include "src/base/output_file.hpp"
#include "src/base/output_folder.hpp"
#else
#include "not_built.hpp"
#endif
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::cli {
namespace {

using tools::counted, tools::shell_word, tools::with_prefix;

constexpr std::size_t kMaxLines = 1000000;  // worlds in one list

// A whole number at the front of `text`, which it takes off.
std::optional<int> take_number(std::string_view& text) {
  int value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || value < 0) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return value;
}

}  // namespace

std::vector<int> parse_worlds(const std::string& list, int worlds) {
  std::set<int> chosen;
  std::string_view rest = list;
  for (bool more = true; more;) {
    const std::optional<int> first = take_number(rest);
    std::optional<int> last = first;
    if (first && !rest.empty() && rest.front() == '-') {
      rest.remove_prefix(1);
      last = take_number(rest);
    }
    more = !rest.empty() && rest.front() == ',';
    if (more) rest.remove_prefix(1);
    if (!first || !last || *last < *first || (!more && !rest.empty())) {
      throw InputError(fmt::format("--record-worlds: must be like 0,5,10-20, is '{}'", list));
    }
    if (*last >= worlds) {
      throw InputError(fmt::format("--record-worlds: holds {}, must be below --worlds, which is {}",
                                   *last, worlds));
    }
    for (int world = *first; world <= *last && chosen.size() < kMaxLines; ++world) {
      chosen.insert(world);
    }
  }
  return {chosen.begin(), chosen.end()};
}

int steps_per_call(const JobOptions& options) {
  if (options.record.empty()) return options.steps_per_call;
  int n = std::min(options.steps_per_call, options.record_every);
  while (options.record_every % n != 0) --n;
  return n;
}

#ifdef MW_HAVE_RECORD

bool writes_recordings() { return true; }

namespace {

// What fails in it is told with the option that asked for it in front.
template <class Do>
auto asked_by(const char* option, Do&& what) {
  try {
    return what();
  } catch (const RecordError& error) {
    throw InputError(fmt::format("{}: {}", option, error.what()));
  } catch (const FileError& error) {
    throw InputError(fmt::format("{}: {}", option, error.what()));
  }
}

}  // namespace

struct JobRecorder::Impl {
  Recorder recorder;
  std::filesystem::path file;
  std::size_t worlds;
  int all, every;
};

JobRecorder::JobRecorder(Batch& batch, const JobOptions& options) {
  if (options.record.empty()) return;
  RecordOptions record;
  if (!options.record_worlds.empty()) {
    record.worlds = parse_worlds(options.record_worlds, batch.worlds());
  }
  record.every = options.record_every;
  record.flush_seconds = options.record_flush;
  record.contacts = options.record_contacts;
  const std::size_t worlds =
      record.worlds.empty()
          ? static_cast<std::size_t>(std::min(batch.worlds(), kMaxWorldsByDefault))
          : record.worlds.size();
  asked_by("--record", [&] {
    impl_ = std::make_unique<Impl>(Impl{Recorder(batch, options.record, record), options.record,
                                        worlds, batch.worlds(), record.every});
    tell_of_leftovers(leftover_parts(options.record), unfinished_recordings(options.record));
  });
}
JobRecorder::~JobRecorder() = default;

std::string JobRecorder::finish(const Batch& batch) {
  if (!impl_) return {};
  try {
    impl_->recorder.sample(batch);
    impl_->recorder.close();
  } catch (const std::exception& error) {
    failure_ = fmt::format("--record: {}", error.what());
    return {};
  }
  std::error_code ignored;
  const double bytes = static_cast<double>(std::filesystem::file_size(impl_->file, ignored));
  return fmt::format("{} of {}, {} samples every {}, {}B in {}", impl_->worlds,
                     counted(impl_->all, "world"), impl_->recorder.samples(),
                     counted(impl_->every, "step"), with_prefix(bytes), impl_->file.string());
}

struct LostDumps::Impl {
  std::filesystem::path folder;
  std::optional<LostWorldDumps> dumps;
  std::vector<std::filesystem::path> files;
};

LostDumps::LostDumps(const JobOptions& options) {
  if (options.dump_lost.empty()) return;
  impl_ = std::make_unique<Impl>(Impl{options.dump_lost, {}, {}});
  asked_by("--dump-lost", [&] {
    make_folder(impl_->folder);
    // No world is lost yet; that no file can be made is better known now.
    const OutputFile trial(impl_->folder / "world_0.h5");
  });
  tell_of_leftovers(leftover_parts_in(options.dump_lost), {});
}
LostDumps::~LostDumps() = default;

void LostDumps::watch(Batch& batch, std::int64_t first) {
  if (!impl_) return;
  LostWorldDumps::Options options;
  options.max_files -= static_cast<int>(impl_->files.size());
  options.first_world = first;
  impl_->dumps.emplace(batch, impl_->folder, options);
}
void LostDumps::finish() {
  if (!impl_ || !impl_->dumps) return;
  try {
    for (auto& file : impl_->dumps->close()) impl_->files.push_back(std::move(file));
  } catch (const std::exception& error) {
    if (failure_.empty()) failure_ = fmt::format("--dump-lost: {}", error.what());
  }
  impl_->dumps.reset();
}
void LostDumps::print() const {
  if (!impl_) return;
  for (const auto& file : impl_->files) {
    tools::tell("manyworlds: dumped: manyworlds replay {}\n", shell_word(file.string()));
  }
}

#else

namespace {

InputError no_recordings(const char* asked) {
  return not_built(asked, "recordings", "MW_RECORD=ON");
}

}  // namespace

bool writes_recordings() { return false; }

struct JobRecorder::Impl {};
JobRecorder::JobRecorder(Batch&, const JobOptions& options) {
  if (!options.record.empty()) throw no_recordings("--record");
}
JobRecorder::~JobRecorder() = default;
std::string JobRecorder::finish(const Batch&) { return {}; }

struct LostDumps::Impl {};
LostDumps::LostDumps(const JobOptions& options) {
  if (!options.dump_lost.empty()) throw no_recordings("--dump-lost");
}
LostDumps::~LostDumps() = default;
void LostDumps::watch(Batch&, std::int64_t) {}
void LostDumps::finish() {}
void LostDumps::print() const {}

#endif

int finish_code(const LostDumps& dumps, int code) {
  if (dumps.failure().empty()) return code;
  tools::tell("manyworlds: {}\n", dumps.failure());
  return kBadInput;
}
int finish_code(const JobRecorder& recorder, const LostDumps& dumps, int code) {
  code = finish_code(dumps, code);
  if (recorder.failure().empty()) return code;
  tools::tell("manyworlds: {}\n", recorder.failure());
  return kBadInput;
}

}  // namespace manyworlds::cli
