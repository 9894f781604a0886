// A recording of which something was changed: refused with a reason, or taken, and then everything
// in it can be read and it is replayed to its end, or refused there.
#include <optional>

#include "fuzz/check.hpp"
#include "fuzz/recording_edit.hpp"
#include "fuzz/recordings.hpp"

namespace manyworlds::fuzz {
namespace {

constexpr std::int64_t kMaxWork = 20'000;  // worlds x substeps

void check_refusal(const RecordError& error) {
  require(!error.problems().empty(), "a recording was refused without a problem");
  for (const std::string& problem : error.problems()) {
    require(!problem.empty(), "a problem says nothing");
  }
}

void look(const Recording& recording) {
  require(recording.samples() > 0 && recording.worlds() > 0, "a recording of nothing was taken");
  int worlds = 0;
  for (int k = 0; k < recording.kinds(); ++k) worlds += recording.worlds_of(k);
  require(worlds == recording.worlds(), "the kinds have other worlds than the recording");
  (void)recording.origin();
  for (std::int64_t s = 0; s < recording.samples(); ++s) {
    (void)recording.step(s);
    for (int w = 0; w < worlds; ++w) {
      (void)recording.hash(s, w);
      (void)to_string(recording.status(s, w));
      (void)recording.name_of(w);
      (void)recording.contacts(s, w);
      (void)recording.contacts_found(s, w);
      for (int f = 0; f < kFieldCount; ++f) (void)recording.read(static_cast<Field>(f), s, w);
    }
  }
}

// Any number of steps is a recording's right; not all of them are worth our time.
bool short_enough(const Recording& recording) {
  const std::int64_t steps = recording.step(recording.samples() - 1);
  std::int64_t cost = 0;
  for (int k = 0; k < recording.kinds(); ++k) {
    const Plan& plan = recording.plan(k);
    int candidates = 0;
    for (const auto& c : plan.report().pairs) candidates += c.candidates;
    if (candidates > 20'000) return false;
    cost += std::int64_t{recording.worlds_of(k)} * *plan.resolved().substeps;
  }
  return steps <= kMaxWork / std::max<std::int64_t>(cost, 1);
}

void run(FuzzedDataProvider& in) {
  RecordingEdit edited(recording(in.ConsumeIntegralInRange(0, kRecordings - 1)));
  for (int i = 0; i < 8 && in.remaining_bytes() > 0; ++i) edited.edit(in);
  const std::vector<std::byte> bytes = edited.close();
  std::optional<Recording> recording;
  try {
    recording = Recording::from_bytes(bytes);
  } catch (const RecordError& error) {
    return check_refusal(error);
  }
  look(*recording);
  if (!short_enough(*recording) || recording->precision() == Precision::f64) return;
  try {
    const ReplayResult result = replay(*recording, {.threads = 1});
    require(result.compared == recording->samples() * recording->worlds(),
            "a replay has not compared every sample");
    require(result.different == 0 || result.difference, "a replay does not tell what differs");
  } catch (const RecordError& error) {
    check_refusal(error);
  }
}

}  // namespace
}  // namespace manyworlds::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider in(data, size);
  manyworlds::fuzz::run(in);
  manyworlds::fuzz::require(H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL) == 0,
                            "something of a file is still open");
  return 0;
}
