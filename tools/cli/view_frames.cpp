#include "view_frames.hpp"

#ifdef MW_HAVE_RECORD

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "progress.hpp"
#include "tools/base/interrupt.hpp"
#include "view_page.hpp"

namespace manyworlds::cli {

namespace {

namespace fs = std::filesystem;

double parse_film_speed(const std::string& text) {
  double speed = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, speed);
  if (error == std::errc{} && stop == end && speed >= 0.001 && speed <= 1000) return speed;
  throw InputError(fmt::format("--speed: must be 0.001 to 1000 for a film, is '{}'", text));
}

}  // namespace

FramesWanted frames_wanted(const ViewArguments& arguments) {
  FramesWanted out;
  out.picture = !arguments.png.empty();
  out.film = !arguments.mp4.empty();
  const PictureSize size = parse_size(arguments.size);
  out.frame.width = size.width, out.frame.height = size.height;
  std::vector<std::string> view;
  if (arguments.world) view.push_back(fmt::format("world={}", *arguments.world));
  if (!arguments.color.empty()) view.push_back("color=" + arguments.color);
  if (arguments.dark) view.emplace_back("theme=dark");
  out.frame.view = fmt::format("{}", fmt::join(view, "&"));
  if (arguments.speed && !out.film) throw InputError("--speed: is of --live and --mp4");
  if (arguments.until && !out.film) throw InputError("--until: is of --mp4");
  if (arguments.at && !out.any()) throw InputError("--at: is of --png and --mp4");
  if (!view.empty() && !out.any()) {
    throw InputError("--world, --color and --dark: are of --png and --mp4");
  }
  if (out.film) {
    out.speed = parse_film_speed(arguments.speed.value_or("1"));
    if (size.width % 2 != 0 || size.height % 2 != 0) {
      throw InputError(
          fmt::format("--size: must be even numbers for a film, is '{}'", arguments.size));
    }
    if (arguments.until && *arguments.until < arguments.at.value_or(0)) {
      throw InputError(fmt::format("--until: must be {} s (--at) or later, is {} s",
                                   arguments.at.value_or(0), *arguments.until));
    }
    find_encoder();
  }
  if (out.any()) find_browser();
  out.samples_per_second = arguments.fps / out.speed;
  return out;
}

FilmReport make_film(const fs::path& page, const ViewArguments& arguments,
                     const FramesWanted& wanted) {
  FilmOptions options;
  options.frame = wanted.frame;
  options.fps = arguments.fps;
  options.speed = wanted.speed;
  options.begin = arguments.at.value_or(0);
  options.end = arguments.until.value_or(kEnd);
  std::optional<Progress> progress;
  options.told = [&](std::int64_t, std::int64_t frames) {
    if (!progress) progress.emplace(arguments.mp4, frames);
    progress->advance(1);
  };
  options.go_on = [] { return tools::interrupted() == 0; };
  return write_film(page, arguments.mp4, options);
}

}  // namespace manyworlds::cli

#endif
