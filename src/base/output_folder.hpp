// A folder that files are to be written into.
#pragma once

#include <filesystem>

namespace manyworlds {

// Makes it, and what leads to it; one that is there will do. Throws FileError (output_file.hpp):
// "'lost': is a file, not a folder".
void make_folder(const std::filesystem::path& folder);

}  // namespace manyworlds
