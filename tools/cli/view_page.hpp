// Where the page without data is (viewer/), and how a page is shown.
#pragma once

#include <filesystem>

namespace manyworlds::cli {

// MANYWORLDS_VIEWER in the environment, or what was installed or built beside this program. Throws
// InputError that says how to get it.
std::filesystem::path empty_page();

// Hands a page to the desktop's browser. False where there is no desktop.
bool open_in_browser(const std::filesystem::path& page);

}  // namespace manyworlds::cli
