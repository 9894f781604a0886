// Part files that programs left when they were cut off, beside what is about to be written.
#pragma once

#include <filesystem>
#include <vector>

namespace manyworlds::cli {

// A note for each on standard error: how it can be replayed, if it is one of `recordings`.
void tell_of_leftovers(const std::vector<std::filesystem::path>& parts,
                       const std::vector<std::filesystem::path>& recordings);

}  // namespace manyworlds::cli
