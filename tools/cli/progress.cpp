#include "progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "tools/base/tell.hpp"

namespace manyworlds::cli {
namespace {

constexpr std::chrono::seconds kPatience{2};
constexpr std::chrono::milliseconds kRedraw{100};
constexpr int kBarWidth = 30;  // characters

// A terminal that can erase a line; TERM=dumb says that it cannot.
bool takes_escapes() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && term != nullptr && std::string_view(term) != "dumb";
}

double seconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

}  // namespace

Progress::Progress(std::string label, std::int64_t total)
    : label_(std::move(label)),
      total_(std::max<std::int64_t>(total, 1)),
      terminal_(takes_escapes()),
      start_(std::chrono::steady_clock::now()),
      last_draw_(start_) {}

Progress::~Progress() { erase(); }

void Progress::advance(std::int64_t amount) {
  done_ = std::min(done_ + amount, total_);
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - start_ < kPatience || now - last_draw_ < kRedraw) return;
  draw(now);
}

void Progress::draw(std::chrono::steady_clock::time_point now) {
  const double fraction = static_cast<double>(done_) / static_cast<double>(total_);
  const int filled = static_cast<int>(fraction * kBarWidth);
  const double elapsed = seconds(now - start_);
  const double left = fraction > 0 ? elapsed * (1 - fraction) / fraction : 0;
  tools::tell("\r\x1b[K{} [{:#<{}}{:.<{}}] {:3.0f} %, {:.0f} s left", label_, "", filled, "",
              kBarWidth - filled, 100 * fraction, left);
  std::fflush(stderr);
  last_draw_ = now;
  visible_ = true;
}

void Progress::erase() {
  if (!visible_) return;
  tools::tell("\r\x1b[K");
  std::fflush(stderr);
  visible_ = false;
}

}  // namespace manyworlds::cli
