// What `view` says of pictures and films.
#pragma once

#include <filesystem>
#include <limits>

#include "manyworlds/film.hpp"
#include "options.hpp"

namespace manyworlds::cli {

// Beyond all recordings, s.
inline constexpr double kEnd = std::numeric_limits<double>::infinity();

struct FramesWanted {
  bool picture = false, film = false;
  FrameOptions frame;
  double time = kEnd;             // s, of the picture
  double begin = 0, end = kEnd;   // s, of the film
  double speed = 1;               // of the film
  double samples_per_second = 0;  // of scenes, simulated time

  bool any() const { return picture || film; }
};

// Checked before anything is done, also that the programs are there. Throws InputError, FilmError.
FramesWanted frames_wanted(const ViewArguments& arguments);

// With a bar of how far it is; until Ctrl-C.
FilmReport make_film(const std::filesystem::path& page, const ViewArguments& arguments,
                     const FramesWanted& wanted);

}  // namespace manyworlds::cli
