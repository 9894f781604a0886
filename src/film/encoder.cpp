#include "src/film/encoder.hpp"

#include <charconv>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "manyworlds/film.hpp"

namespace manyworlds::film {

namespace {

namespace fs = std::filesystem;
using Time = Child::Time;

std::string text_of(double number) {
  char text[32];
  const auto [end, error] =
      std::to_chars(text, text + sizeof text, number, std::chars_format::fixed, 6);
  return error == std::errc{} ? std::string(text, end) : std::string("30");
}

// As a file, whatever its name looks like.
std::string address_of(const fs::path& file) { return "file:" + fs::absolute(file).string(); }

std::vector<std::string> words(const std::string& program, const fs::path& file, double fps) {
  return {
      program, "-hide_banner", "-nostdin", "-loglevel", "error", "-xerror",
      // The pictures that come in.
      "-f", "image2pipe", "-framerate", text_of(fps), "-c:v", "mjpeg", "-i", "pipe:0",
      // JPEG has the colours of BT.601 in full range, players take those of BT.709 in the range of
      // video.
      "-vf",
      "scale=in_color_matrix=bt601:in_range=pc:out_color_matrix=bt709:out_range=tv,format=yuv420p",
      "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range",
      "tv",
      // What every player has; fine lines stay fine.
      "-c:v", "libx264", "-preset", "medium", "-crf", "18", "-movflags", "+faststart", "-f", "mp4",
      "-y", address_of(file)};
}

}  // namespace

Encoder::Encoder(const std::string& program, const fs::path& file, const fs::path& name, double fps,
                 const fs::path& folder, GoOn go_on)
    : child_(words(program, file, fps), {0}, folder / "encoder.log", std::move(go_on)),
      file_(address_of(file)),
      name_(name.string()) {}

void Encoder::add(std::string_view jpeg) {
  if (child_.send(jpeg)) return;
  fail(child_.wait(std::chrono::steady_clock::now() + std::chrono::seconds(5)));
}

void Encoder::finish() {
  child_.finish_sending();
  if (const int code = child_.wait(Time::max()); code != 0) fail(code);
}

void Encoder::fail(int code) {
  std::string words = child_.last_words();
  for (std::size_t at; (at = words.find(file_)) != std::string::npos;) {
    words.replace(at, file_.size(), "it");
  }
  throw FilmError("'" + name_ + "': " + child_.name() + " failed (exit code " +
                  std::to_string(code) + ")" + words);
}

}  // namespace manyworlds::film
