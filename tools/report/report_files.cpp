#include "tools/report/report_files.hpp"

#include <span>
#include <stdexcept>
#include <system_error>

#include "src/base/output_file.hpp"
#include "src/base/output_folder.hpp"

namespace manyworlds::report {
namespace {

namespace fs = std::filesystem;

// What a FileError tells, with the option that named the file in front.
template <class Do>
auto guarded(Do&& what, const std::string& front = "--out: cannot write ") {
  try {
    return what();
  } catch (const FileError& error) {
    throw std::runtime_error(front + error.what());
  }
}

void write(OutputFile& file, const std::string& text) {
  file.write(std::as_bytes(std::span(text)), 0);
  file.sync();
}

}  // namespace

ReportFiles::ReportFiles(const fs::path& folder, const std::string& name, bool with_page)
    : page_(folder / (name + ".html")), json_(folder / (name + ".json")) {
  guarded([&] { make_folder(folder); }, "--out: ");
  guarded([&] { const OutputFile trial(json_); });
  if (with_page) guarded([&] { const OutputFile trial(page_); });
}

void ReportFiles::write(const std::string& json, const std::optional<std::string>& page) const {
  guarded([&] {
    std::optional<OutputFile> page_file;
    if (page) page_file.emplace(page_);
    OutputFile json_file(json_);
    if (page) report::write(*page_file, *page);
    report::write(json_file, json);
    if (page) page_file->commit();
    json_file.commit();
  });
}

std::vector<fs::path> ReportFiles::leftovers() const {
  return guarded([&] {
    std::vector<fs::path> parts = leftover_parts(page_);
    for (fs::path& part : leftover_parts(json_)) parts.push_back(std::move(part));
    return parts;
  });
}

}  // namespace manyworlds::report
