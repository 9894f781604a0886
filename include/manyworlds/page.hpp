// Pages: recordings as HTML files that a browser shows without anything else: no server, no
// network. Of the library manyworlds::record.
//
// The program on the page (viewer/) is built with Node, apart from this library, into one file, the
// page without data. write_page() puts recordings into a copy of it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "manyworlds/record.hpp"

namespace manyworlds {

// A number of every world at every sample, which the page can colour worlds by: a reward, say.
struct PageNumber {
  std::string name = {};
  std::string unit = {};
  std::vector<float> values = {};  // [sample][world], as many as the recording has
};

struct PageOptions {
  std::string title = {};                // default: the name of the scene
  int max_worlds = 0;                    // of each recording the first so many; 0: all
  std::int64_t every = 1;                // of the samples every so many
  std::vector<PageNumber> numbers = {};  // of the first recording
  GoOn go_on = {};                       // asked now and then; where it says no, nothing is written
};

// No point of a body is drawn farther from where it was than this share of the body's radius, which
// is that of a sphere about its origin around all its shapes: positions are rounded to 1/512 of it,
// quaternions to 1/1024, angles in the plane to 2 pi / 4096.
inline constexpr double kPageError = 1.0 / 250;

struct PageReport {
  int worlds = 0;                       // of all recordings
  std::int64_t frames = 0, bodies = 0;  // most frames of a recording; moving bodies of all worlds
  std::size_t bytes = 0;                // of the file
  bool written = false;                 // false where go_on said no
};

// The page `empty`, with `recordings` in it: one, or two of the same scene to be compared, or more.
// A file of that name is replaced once the new one is complete.
//
// Throws RecordError when the file cannot be written, `empty` is no page of this version or a
// recording cannot be read, std::invalid_argument for options that are out of range or for no
// recording at all.
PageReport write_page(std::span<const Recording* const> recordings,
                      const std::filesystem::path& empty, const std::filesystem::path& file,
                      const PageOptions& options = {});

// The same as text, for those who show it elsewhere.
std::string page_of(std::span<const Recording* const> recordings,
                    const std::filesystem::path& empty, const PageOptions& options = {});

}  // namespace manyworlds
