#include "manyworlds/page.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string_view>

#include "src/base/float_mode.hpp"
#include "src/base/output_file.hpp"
#include "src/record/described.hpp"
#include "src/record/page/run.hpp"
#include "src/record/recording.hpp"

namespace manyworlds {
namespace {

// Where in the page the recordings go, and how it says which data it reads.
constexpr std::string_view kPlace = "<!-- manyworlds: recordings -->";
constexpr std::string_view kVersion = "<meta name=\"manyworlds-page\" content=\"1\">";

std::string read_empty(const std::filesystem::path& file) {
  const std::string label = "page '" + file.string() + "': ";
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw RecordError(label + "cannot be read");
  if (text.find(kVersion) == std::string::npos || text.find(kPlace) == std::string::npos) {
    throw RecordError(label +
                      "is not a page of this version; expected viewer.html as viewer/ builds it");
  }
  return text;
}

struct Page {
  std::string text;
  PageReport report;
};

Page make_page(std::span<const Recording* const> recordings, const std::filesystem::path& empty,
               const PageOptions& options) {
  const FloatMode mode;
  if (recordings.empty()) throw std::invalid_argument("page: no recording is given");
  std::string text = read_empty(empty);
  Page out;
  page::Json runs = page::Json::array();
  std::string data;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    PageOptions own = options;
    if (r > 0) own.numbers.clear();
    record::PageRun run;
    const bool whole = record::described(recordings[r]->impl().label,
                                         [&] { return record::run_of(*recordings[r], own, run); });
    if (!whole) return out;
    runs.push_back(std::move(run.head));
    for (std::size_t c = 0; c < run.chunks.size(); ++c) {
      data += "<script type=\"text/plain\" id=\"mw-" + std::to_string(r) + "-" + std::to_string(c) +
              "\">" + run.chunks[c] + "</script>\n";
    }
    out.report.worlds += run.worlds;
    out.report.bodies += run.bodies;
    out.report.frames = std::max(out.report.frames, run.frames);
  }
  const page::Json head = {
      {"title", options.title.empty() ? recordings[0]->plan().scene().name : options.title},
      {"runs", std::move(runs)}};
  data = "<script type=\"application/json\" id=\"mw-head\">" + page::embedded(head) +
         "</script>\n" + data;
  text.replace(text.find(kPlace), kPlace.size(), data);
  out.text = std::move(text);
  out.report.bytes = out.text.size();
  out.report.written = true;
  return out;
}

}  // namespace

PageReport write_page(std::span<const Recording* const> recordings,
                      const std::filesystem::path& empty, const std::filesystem::path& file,
                      const PageOptions& options) {
  const Page page = make_page(recordings, empty, options);
  if (!page.report.written) return page.report;
  try {
    write_file(file, page.text);
  } catch (const FileError& error) {
    throw RecordError(error.what());
  }
  return page.report;
}

std::string page_of(std::span<const Recording* const> recordings,
                    const std::filesystem::path& empty, const PageOptions& options) {
  return make_page(recordings, empty, options).text;
}

}  // namespace manyworlds
