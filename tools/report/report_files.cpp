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

ReportFiles::ReportFiles(const fs::path& folder, const std::string& name)
    : page_(folder / (name + ".html")), json_(folder / (name + ".json")) {
  guarded([&] { make_folder(folder); }, "--out: ");
  for (const fs::path& file : {page_, json_}) {
    guarded([&] { const OutputFile trial(file); });
  }
}

void ReportFiles::write(const std::string& page, const std::string& json) const {
  guarded([&] {
    OutputFile page_file(page_), json_file(json_);
    report::write(page_file, page);
    report::write(json_file, json);
    page_file.commit();
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
