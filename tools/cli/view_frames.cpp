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

// As a value behind '#' in an address.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '.';
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

// Of what was given by its name or by the one that it had before.
double time_of(const std::optional<double>& given, const std::optional<double>& before,
               double otherwise) {
  return given ? *given : before.value_or(otherwise);
}

void refuse_without(bool wanted, const char* option, const char* other) {
  if (!wanted) throw InputError(fmt::format("{}: applies only with {}", option, other));
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
  if (!arguments.follow.empty()) view.push_back("follow=" + escaped(arguments.follow));
  if (!arguments.color.empty()) view.push_back("color=" + escaped(arguments.color));
  if (arguments.dark) view.emplace_back("theme=dark");
  out.frame.view = fmt::format("{}", fmt::join(view, "&"));
  if (arguments.speed && !out.film) throw InputError("--speed: is of --live and --mp4");
  refuse_without(!arguments.time || out.picture, "--time", "--png");
  refuse_without(!arguments.begin || out.film, "--begin", "--mp4");
  refuse_without(!arguments.end || out.film, "--end", "--mp4");
  refuse_without(!arguments.until || out.film, "--until", "--mp4");
  refuse_without(!arguments.at || out.any(), "--at", "--png or --mp4");
  refuse_without(view.empty() || out.any(), "--world, --follow, --color, --dark", "--png or --mp4");
  if (arguments.at && (arguments.time || arguments.begin)) {
    throw InputError("--at: excludes --time and --begin, which replace it");
  }
  if (arguments.until && arguments.end) {
    throw InputError("--until: excludes --end, which replaces it");
  }
  out.time = time_of(arguments.time, arguments.at, kEnd);
  out.begin = time_of(arguments.begin, arguments.at, 0);
  out.end = time_of(arguments.end, arguments.until, kEnd);
  if (out.film) {
    out.speed = parse_film_speed(arguments.speed.value_or("1"));
    if (size.width % 2 != 0 || size.height % 2 != 0) {
      throw InputError(
          fmt::format("--size: must be even numbers for a film, is '{}'", arguments.size));
    }
    if (out.end < out.begin) {
      throw InputError(
          fmt::format("--end: must be {} s (--begin) or later, is {} s", out.begin, out.end));
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
  options.begin = wanted.begin;
  options.end = wanted.end;
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
