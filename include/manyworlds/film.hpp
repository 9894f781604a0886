// Pictures and films of pages (page.hpp). A headless Chromium draws each frame at its exact
// simulated time, not in real time. ffmpeg encodes the frames. Part of the library
// manyworlds::record.
//
// Both run as separate processes and are looked up when needed. The browser is the program in the
// environment variable CHROMIUM, else chromium, chromium-browser or google-chrome. The encoder is
// the program in FFMPEG, else ffmpeg. Without a graphics card the browser draws in software. Both
// write to a temporary folder, which is removed at the end of the call, also after an error.
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

// A program is missing or fails, a file cannot be written, or a page cannot be drawn.
class FilmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Size and content of the frames.
struct FrameOptions {
  int width = 1280, height = 720;  // pixels, 64 to 8192
  // Settings, as after '#' in the address of a page: "world=3&follow=torso&color=speed&theme=dark".
  // `follow` is a body's name or its index in the scene; without `world`, in world 0.
  std::string view = {};
};

struct PictureOptions {
  FrameOptions frame = {};
  double time = std::numeric_limits<double>::infinity();  // s; at most the end of the page
  GoOn go_on = {};  // polled; when it returns false, nothing is written
};

struct FilmOptions {
  FrameOptions frame = {};  // both sizes even, as the encoder requires
  double fps = 30;          // frames per second of the film, up to 1000
  double speed = 1;         // simulated seconds per second of the film
  double begin = 0;         // s, simulated
  double end =
      std::numeric_limits<double>::infinity();  // s, simulated; at most the end of the page
  // ffmpeg. Empty: the program in the environment variable FFMPEG, else ffmpeg in PATH.
  std::filesystem::path encoder = {};
  std::function<void(std::int64_t done, std::int64_t all)> told = {};  // after each frame
  GoOn go_on = {};  // polled; when it returns false, nothing is written
};

struct FilmReport {
  std::int64_t frames = 0;
  double seconds = 0;     // duration of the film
  std::size_t bytes = 0;  // size of the file
  bool written = false;   // false if go_on returned false
};

// Throw FilmError, which says how to get the program, if it is not found. Use them to check before
// long work.
void find_browser();
void find_encoder();

// Writes a PNG file of a page. Returns false if go_on returned false.
//
// Throws FilmError, also if `view` requests something that the page lacks, and
// std::invalid_argument if an option is out of range. Replaces an existing file when the new one is
// complete.
bool write_picture(const std::filesystem::path& page, const std::filesystem::path& file,
                   const PictureOptions& options = {});

// Writes an MP4 file (H.264, 4:2:0) of a page. Frame k shows the time begin + k speed / fps; the
// last frame is not later than end. Throws as write_picture does.
FilmReport write_film(const std::filesystem::path& page, const std::filesystem::path& file,
                      const FilmOptions& options = {});

}  // namespace manyworlds
