// Errors of what is read from a recording, with the place in front.
#pragma once

#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "manyworlds/record.hpp"
#include "src/base/printable.hpp"

namespace manyworlds::record {

// Every problem of `error` with `place` in front. What they quote from the file may be anything.
inline RecordError placed(const std::string& place, const std::vector<std::string>& problems) {
  std::vector<std::string> lines;
  for (const std::string& problem : problems) lines.push_back(place + printable(problem));
  return RecordError(std::move(lines));
}

template <class Make>
auto described(const std::string& place, Make&& make) {
  try {
    return make();
  } catch (const RecordError& error) {
    throw placed(place, error.problems());
  } catch (const SceneError& error) {
    std::vector<std::string> problems;
    for (const Issue& issue : error.issues()) problems.push_back(to_string(issue));
    throw placed(place, problems);
  } catch (const SnapshotError& error) {
    throw placed(place, {error.what()});
  } catch (const std::bad_alloc&) {
    throw placed(place, {"needs more memory than is available"});
  } catch (const std::length_error&) {
    throw placed(place, {"needs more memory than is available"});
  }
}

}  // namespace manyworlds::record
