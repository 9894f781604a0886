// Pictures and films of pages (page.hpp). A headless Chromium draws each frame, of exactly its
// moment and not in real time; ffmpeg encodes them. Of the library manyworlds::record.
//
// Both programs run apart from this one and are looked for when they are needed: the browser is
// what CHROMIUM in the environment names, or chromium, chromium-browser or google-chrome; the
// encoder what FFMPEG names, or ffmpeg. Without a graphics card the browser draws in software. What
// they write lies in a folder of its own below the temporary one, and is gone when the call ends,
// however it ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "manyworlds/batch.hpp"

namespace manyworlds {

// A program that is missing or fails, a file that cannot be written, a page that cannot be drawn.
class FilmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What frames look like.
struct FrameOptions {
  int width = 1280, height = 720;  // pixels, 64 to 8192
  // As behind '#' in the address of a page: "world=3&follow=torso&color=speed&theme=dark". The
  // camera follows a body by its name or its index in the scene, of world 0 where none is given.
  std::string view = {};
};

struct PictureOptions {
  FrameOptions frame = {};
  double time = std::numeric_limits<double>::infinity();  // s; beyond the end: the end
  GoOn go_on = {};  // asked now and then; where it says no, nothing is written
};

struct FilmOptions {
  FrameOptions frame = {};  // both sizes even, as the encoder wants them
  double fps = 30;          // frames per second of the film, up to 1000
  double speed = 1;         // simulated seconds per second of the film
  double begin = 0;         // s, simulated
  double end = std::numeric_limits<double>::infinity();  // s, simulated; beyond the end: the end
  // ffmpeg; empty: the one that FFMPEG in the environment names, or that of PATH.
  std::filesystem::path encoder = {};
  std::function<void(std::int64_t done, std::int64_t all)> told = {};  // after each frame
  GoOn go_on = {};  // asked now and then; where it says no, nothing is written
};

struct FilmReport {
  std::int64_t frames = 0;
  double seconds = 0;     // of the film
  std::size_t bytes = 0;  // of the file
  bool written = false;   // false where go_on said no
};

// Throw FilmError, which says how to get it, where a program is not found. For those who want to
// know before the work that comes before a film.
void find_browser();
void find_encoder();

// A PNG file of a page. False where go_on said no.
//
// Throws FilmError, also where `view` asks for what the page does not have; std::invalid_argument
// for options that are out of range. A file of that name is replaced once the new one is complete.
bool write_picture(const std::filesystem::path& page, const std::filesystem::path& file,
                   const PictureOptions& options = {});

// An MP4 file (H.264, 4:2:0) of a page. Frame k is the page at begin + k speed / fps, the last one
// no later than end. Throws as write_picture does.
FilmReport write_film(const std::filesystem::path& page, const std::filesystem::path& file,
                      const FilmOptions& options = {});

}  // namespace manyworlds
