// Calls of the system that fail when a test wants them to. This program's own write, fsync, close,
// rename, ... stand in front of the C library's, for HDF5's calls, too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#if defined(__has_feature)  // clang's way of saying what GCC says by a macro
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__ 1
#endif
#endif

namespace manyworlds::test {

enum class Call { write, sync, close, rename, truncate, open, read, allocate };
inline constexpr Call kFileCalls[] = {Call::write,    Call::sync, Call::close, Call::rename,
                                      Call::truncate, Call::open, Call::read};
const char* to_string(Call call);

// Of allocations, those by new: HDF5's own (malloc) are left alone, since HDF5 1.10 does not get
// over one that fails. Not under a sanitizer, whose checks would be lost with its operators.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
inline constexpr bool kAllocationsFail = !kSanitized;

// Of many like cases (places of a file that are damaged, members that are changed) one in so many
// is tried. What comes of each is tested by other builds than a sanitizer's, which takes ten times
// as long; wrong accesses, which are what that looks for, recording_fuzz looks for, too.
inline constexpr std::size_t kOneIn = kSanitized ? 5 : 1;

// From here on the n-th such call (from 1) of this thread fails with `error`; the others do not.
// While `all_later`, those after it fail, too, as on a full disk.
void fail_call(Call call, long n, int error, bool all_later = false);
// Ends that. Returns whether the call was made.
bool end_failing();

// What was written to files by this thread, while `log` lives.
struct Written {
  std::uint64_t at = 0;
  std::vector<std::byte> bytes;
  bool truncated = false;  // to `at`
  bool synced = false;     // all before is on the disk
  bool renamed = false;
};
void log_writes(std::vector<Written>* log);

// Runs `work` in a child process, to its exit handlers. Returns what is wrong: what `work`
// returned, how the process ended, or what it said on standard error; empty if nothing is.
// `progress(text)` says where it is.
using Progress = std::function<void(const std::string&)>;
std::string in_child(const std::function<std::string(const Progress&)>& work);

}  // namespace manyworlds::test
