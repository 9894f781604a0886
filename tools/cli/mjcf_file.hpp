// MJCF files, which may come from anybody: compiled in a child process with limits first.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/mjcf.hpp"
#include "manyworlds/scene.hpp"

namespace manyworlds::cli {

// How an MJCF file may be read (--mjcf-root, --mjcf-limit).
struct MjcfArguments {
  std::vector<std::string> roots;   // folders besides the model's own
  std::vector<std::string> limits;  // "NAME=N"
};

// True when this program was built with the MJCF reader.
bool reads_mjcf();

// The scene in the file; warnings go to `warnings`, or to standard error. Throws InputError: a file
// that cannot be read, that asks for too much, or that MuJoCo crashes on or is not done with in
// time.
Scene load_mjcf_file(const std::string& path, const MjcfArguments& arguments,
                     std::vector<std::string>* warnings = nullptr);

// Its files, which a child process could compile; only of a program that reads MJCF. Throws
// InputError.
MjcfFiles read_mjcf_files(const std::string& path, const MjcfArguments& arguments);

}  // namespace manyworlds::cli
