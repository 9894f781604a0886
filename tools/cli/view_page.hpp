// Where the page without data is (viewer/), and how a page is shown.
#pragma once

#include <filesystem>
#include <string>

namespace manyworlds::cli {

// MANYWORLDS_VIEWER in the environment, or what was installed or built beside this program. Throws
// InputError that says how to get it.
std::filesystem::path empty_page();

// Hands a page to the desktop's browser. False where there is no desktop.
bool open_in_browser(const std::filesystem::path& page);

// "1280x720" as width and height, pixels. Throws InputError.
struct PictureSize {
  int width = 0, height = 0;
};
PictureSize parse_size(const std::string& text);

}  // namespace manyworlds::cli
