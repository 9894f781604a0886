#include "manyworlds/film.hpp"

#include <cmath>
#include <deque>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/base/float_mode.hpp"
#include "src/base/output_file.hpp"
#include "src/base/scratch_folder.hpp"
#include "src/film/browser.hpp"
#include "src/film/encoder.hpp"
#include "src/film/programs.hpp"
#include "src/page/base64.hpp"

namespace manyworlds {

namespace {

namespace fs = std::filesystem;
using film::Browser, film::Encoder, film::Json;

constexpr int kLeastSize = 64, kMostSize = 8192;  // pixels
// Frames that the page works on at once: one is drawn while another is encoded.
constexpr std::size_t kAtOnce = 2;

void require(bool good, const std::string& what) {
  if (!good) throw std::invalid_argument("film: " + what);
}

void check(const FrameOptions& frame) {
  for (const int side : {frame.width, frame.height}) {
    require(side >= kLeastSize && side <= kMostSize,
            "width and height must be 64 to 8192, one is " + std::to_string(side));
  }
}

bool is_in(double x, double low, double high) { return x >= low && x <= high; }

void check(const FilmOptions& options) {
  check(options.frame);
  for (const int side : {options.frame.width, options.frame.height}) {
    require(side % 2 == 0, "width and height must be even, one is " + std::to_string(side));
  }
  require(is_in(options.fps, 0.01, 1000), "fps must be 0.01 to 1000");
  require(is_in(options.speed, 1e-6, 1e6), "speed must be 1e-6 to 1e6");
  require(is_in(options.begin, 0, 1e12), "begin must be 0 s or later");
  require(options.end >= options.begin, "end must not be before begin");
}

// The page opened as one that draws frames when it is asked; when its worlds end, s.
double open(Browser& browser, const fs::path& page, const FrameOptions& frame) {
  browser.open(page, "film" + (frame.view.empty() ? "" : "&" + frame.view), frame.width,
               frame.height);
  const Json end = browser.answer(browser.ask("manyworldsReady.then((page) => page.film())"));
  if (!end.is_number()) throw FilmError("'" + page.string() + "' is not a page of this version");
  return end.get<double>();
}

int ask_for(Browser& browser, double time, const char* type, bool moment) {
  // As the page reads it, digit by digit.
  return browser.ask("manyworldsFilm.frame(" + Json(time).dump() + ", '" + type + "', " +
                     (moment ? "true" : "false") + ")");
}

std::string picture_of(const Json& answer) {
  std::string bytes =
      answer.is_string() ? page::from_base64(answer.get_ref<const std::string&>()) : "";
  if (bytes.empty()) throw FilmError("the page drew no picture");
  return bytes;
}

// f, with all that can go wrong as FilmError; false where it was stopped.
template <class F>
bool unless_stopped(F f) {
  try {
    f();
    return true;
  } catch (const film::Stopped&) {
    return false;
  } catch (const FileError& error) {
    throw FilmError(error.what());
  } catch (const Json::exception&) {
    throw FilmError("the browser sent an unexpected answer");
  }
}

}  // namespace

bool write_picture(const fs::path& page, const fs::path& file, const PictureOptions& options) {
  const FloatMode mode;
  check(options.frame);
  require(options.time >= 0, "time must be 0 s or later");
  return unless_stopped([&] {
    OutputFile out(file);
    const ScratchFolder folder;
    Browser browser(folder.path(), options.go_on);
    const double end = open(browser, page, options.frame);
    const int question = ask_for(browser, std::fmin(options.time, end), "image/png", false);
    const std::string bytes = picture_of(browser.answer(question));
    browser.close();
    out.write(std::as_bytes(std::span(bytes)), 0);
    out.commit();
  });
}

FilmReport write_film(const fs::path& page, const fs::path& file, const FilmOptions& options) {
  const FloatMode mode;
  check(options);
  FilmReport report;
  report.written = unless_stopped([&] {
    OutputFile out(file);
    const ScratchFolder folder;
    const std::string program =
        film::encoder_program(options.encoder.string());  // before anything is drawn
    Browser browser(folder.path(), options.go_on);
    const double end = std::fmin(options.end, open(browser, page, options.frame));
    if (options.begin > end) {
      throw FilmError("the film would start at " + Json(options.begin).dump() +
                      " s, but worlds end at " + Json(end).dump() + " s");
    }
    const double step = options.speed / options.fps;
    const double last = std::floor((end - options.begin) / step + 1e-6);
    require(last < 1e7, "the film would have more than ten million frames");
    const auto frames = static_cast<std::int64_t>(last) + 1;
    Encoder encoder(program, out.part(), file, options.fps, folder.path(), options.go_on);
    std::deque<int> questions;
    std::int64_t asked = 0;
    for (std::int64_t done = 0; done < frames; ++done) {
      while (asked < frames && questions.size() < kAtOnce) {
        const double time = options.begin + static_cast<double>(asked++) * step;
        questions.push_back(ask_for(browser, std::fmin(time, end), "image/jpeg", true));
      }
      encoder.add(picture_of(browser.answer(questions.front())));
      questions.pop_front();
      if (options.told) options.told(done + 1, frames);
    }
    browser.close();
    encoder.finish();
    out.commit();
    report.frames = frames;
    report.seconds = static_cast<double>(frames) / options.fps;
    report.bytes = static_cast<std::size_t>(fs::file_size(out.target()));
  });
  return report;
}

}  // namespace manyworlds
