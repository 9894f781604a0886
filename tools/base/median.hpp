// The median: what runs on a machine with other work on it are summed up by.
#pragma once

#include <algorithm>
#include <vector>

namespace manyworlds::tools {

// Of at least one value; the mean of the middle two where there is no middle one.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace manyworlds::tools
