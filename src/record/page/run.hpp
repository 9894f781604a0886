// One recording as a page holds it: a head in JSON, and chunks of frames.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "manyworlds/page.hpp"
#include "src/page/json.hpp"

namespace manyworlds::record {

inline constexpr std::size_t kChunkFrames = 32;

struct PageRun {
  page::Json head;
  std::vector<std::string> chunks;  // base64 of zlib
  int worlds = 0;
  std::int64_t frames = 0, bodies = 0;
};

// False: go_on said no. Throws what write_page() throws.
bool run_of(const Recording& recording, const PageOptions& options, PageRun& out);

}  // namespace manyworlds::record
