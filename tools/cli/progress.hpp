// A progress bar on standard error. It appears if that is a terminal which takes escape sequences
// (TERM is set and not "dumb"), once a job has run for two seconds.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

namespace manyworlds::cli {

class Progress {
 public:
  // `total` in any unit of work, at least 1.
  Progress(std::string label, std::int64_t total);
  ~Progress();  // erases the bar
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void set_label(std::string label) { label_ = std::move(label); }
  void advance(std::int64_t amount);
  // Takes the bar off the screen, so that a line can be printed; the next advance redraws it.
  void erase();

 private:
  void draw(std::chrono::steady_clock::time_point now);

  std::string label_;
  std::int64_t total_;
  std::int64_t done_ = 0;
  bool terminal_;
  bool visible_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_draw_;
};

}  // namespace manyworlds::cli
