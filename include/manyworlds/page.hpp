// Pages: recordings as self-contained HTML files, which a browser shows without a server or
// network. Part of the library manyworlds::record.
//
// The viewer on the page (viewer/) is built separately, with Node, into one file: the empty page.
// write_page() writes a copy that contains recordings.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "manyworlds/record.hpp"

namespace manyworlds {

// A value of every world at every sample, such as a reward. The page can color worlds by it.
struct PageNumber {
  std::string name = {};
  std::string unit = {};
  std::vector<float> values = {};  // [sample][world], as many as the recording has
};

struct PageOptions {
  std::string title = {};                // default: the name of the scene
  int max_worlds = 0;                    // worlds taken from each recording; 0: all
  std::int64_t every = 1;                // take every n-th sample
  std::vector<PageNumber> numbers = {};  // values of the first recording's worlds
  GoOn go_on = {};                       // polled; when it returns false, nothing is written
};

// Upper bound of the drawing error of any point of a body, relative to the body's radius: the
// radius of the sphere about its origin that contains all its shapes. Positions are rounded to
// 1/512 of the radius, quaternions to 1/1024, planar angles to 2 pi / 4096.
inline constexpr double kPageError = 1.0 / 250;

struct PageReport {
  int worlds = 0;                       // worlds of all recordings
  std::int64_t frames = 0, bodies = 0;  // most frames of a recording; moving bodies of all worlds
  std::size_t bytes = 0;                // size of the file
  bool written = false;                 // false if go_on returned false
};

// Writes a copy of the page `empty` that contains `recordings`: one, two of the same scene to
// compare, or more. Replaces an existing file when the new one is complete.
//
// Throws RecordError if the file cannot be written, `empty` is not a page of this version or a
// recording cannot be read; std::invalid_argument if an option is out of range or `recordings` is
// empty.
PageReport write_page(std::span<const Recording* const> recordings,
                      const std::filesystem::path& empty, const std::filesystem::path& file,
                      const PageOptions& options = {});

// The same page as text.
std::string page_of(std::span<const Recording* const> recordings,
                    const std::filesystem::path& empty, const PageOptions& options = {});

}  // namespace manyworlds
