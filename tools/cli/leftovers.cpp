#include "leftovers.hpp"

#include <algorithm>

#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::cli {

void tell_of_leftovers(const std::vector<std::filesystem::path>& parts,
                       const std::vector<std::filesystem::path>& recordings) {
  for (const std::filesystem::path& part : parts) {
    const std::string word = tools::shell_word(part.string());
    if (std::count(recordings.begin(), recordings.end(), part) > 0) {
      tools::tell("manyworlds: note: an interrupted run left a recording: manyworlds replay {}\n",
                  word);
    } else {
      tools::tell(
          "manyworlds: note: an interrupted run left a file without readable contents: rm {}\n",
          word);
    }
  }
}

}  // namespace manyworlds::cli
