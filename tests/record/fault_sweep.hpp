// Work with files during which the n-th call of the system fails, for every n.
#pragma once

#include <cerrno>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include <hdf5.h>

#include "tests/record/faults.hpp"
#include "tests/record/support.hpp"

namespace manyworlds::test {

inline std::string read_text(const fs::path& file) {
  const auto bytes = bytes_of(file);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline const std::string kOld = "what was there before";
inline const std::string kNoMemory = "not enough memory";

// Where all later allocations fail, too, there may be none for a better text.
inline const std::string kNoWords = "not enough memory, not even for words";

inline std::string text_of(const std::exception_ptr& thrown) {
  if (!thrown) return {};
  try {
    std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    return kNoMemory;
  } catch (const std::exception& error) {
    return error.what();
  }
}

// `work` with the n-th call failing, for every n; `check(message)` says what is wrong then.
// Messages are one line and name `named`.
template <class Work, class Check>
std::string sweep(Call call, int error, bool all_later, const Progress& progress,
                  const fs::path& named, Work work, Check check) {
  for (long n = 1;; ++n) {
    const std::string where = std::string(to_string(call)) + " " + std::to_string(n) + ", " +
                              std::strerror(error) + (all_later ? ", and later" : "");
    progress(where);
    std::exception_ptr thrown;
    fail_call(call, n, error, all_later);
    try {
      work();
    } catch (...) {
      thrown = std::current_exception();
    }
    const bool failed = end_failing();  // from here on there is memory for words again
    std::string message = text_of(thrown);
    if (all_later && message == kNoMemory) message = kNoWords;
    if (!failed) return message.empty() ? "" : where + ": no fault, but " + message;
    const std::string problem = check(message);
    if (!problem.empty()) return where + ": " + problem + " (" + message + ")";
    if (message.find('\n') != std::string::npos) return where + ": two lines (" + message + ")";
    const bool named_there = message.find(named.string()) != std::string::npos;
    if (call != Call::allocate && !message.empty() && !named_there) {
      return where + ": which file? (" + message + ")";
    }
    if (H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL) > 0) {
      return where + ": HDF5 still holds something (" + message + ")";
    }
  }
}

// All calls of files, once and from there on.
template <class Work, class Check>
std::string sweep_calls(const Progress& progress, const fs::path& named, Work work, Check check) {
  for (const Call call : kFileCalls) {
    for (const bool all_later : {false, true}) {
      const bool broken = call == Call::read || (call == Call::write && !all_later);
      const std::string problem =
          sweep(call, broken ? EIO : ENOSPC, all_later, progress, named, work, check);
      if (!problem.empty()) return problem;
    }
  }
  return {};
}

template <class Work, class Check>
std::string sweep_memory(const Progress& progress, const fs::path& named, Work work, Check check) {
  for (const bool all_later : {false, true}) {
    const std::string problem =
        sweep(Call::allocate, ENOMEM, all_later, progress, named, work, check);
    if (!problem.empty()) return problem;
  }
  return {};
}

}  // namespace manyworlds::test
