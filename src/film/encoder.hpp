// ffmpeg, which makes an MP4 file of pictures that it is sent one after the other.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "src/film/child.hpp"

namespace manyworlds::film {

class Encoder {
 public:
  // Runs `program`. Writes over `file`, which is there and is called `name` for people. Throws
  // FilmError, and Stopped where go_on says no, as all do.
  Encoder(const std::string& program, const std::filesystem::path& file,
          const std::filesystem::path& name, double fps, const std::filesystem::path& folder,
          GoOn go_on);
  void add(std::string_view jpeg);
  void finish();  // the file is complete

 private:
  [[noreturn]] void fail(int code);

  Child child_;
  std::string file_, name_;
};

}  // namespace manyworlds::film
