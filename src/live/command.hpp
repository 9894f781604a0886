// What a page asks for: its messages, checked.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "manyworlds/plan.hpp"

namespace manyworlds::live {

// A message that a page of ours would not send; what() is short enough for a WebSocket's close
// frame.
class BadMessage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Command {
  enum Kind {
    open,   // a head of `number` worlds
    look,   // from now on frames of `worlds`, at most `number` per second
    frame,  // the next one
    pause,
    play,
    step,   // `number` steps, then pause
    speed,  // `number` simulated per real second, perhaps infinite
    reset,  // `world` or all
    drag,   // the point `at` of a body (body frame) towards `to` (world), until drop
    drop,
    push,      // an impulse `to`, N s, at `at` of a body (body frame)
    controls,  // `values` of `world` or all
    gravity,   // `to`, of all worlds
    friction,  // the scene's coefficients times `number`, in all worlds
    save,      // a snapshot
    gone,      // the page is closed
  };
  Kind kind = frame;
  int page = 0;    // whose it is
  int world = -1;  // -1: all
  BodyId body = {};
  Vec3 at = Vec3::Zero(), to = Vec3::Zero();
  double number = 0;
  std::vector<double> values = {};
  std::vector<int> worlds = {};
};

// What messages are about.
struct KindOfWorlds {
  Plan plan;
  int first, worlds;
};
struct Sizes {
  std::vector<KindOfWorlds> kinds;
  int shown = 0;  // worlds that a page can be asked to show, the first ones

  int worlds() const { return kinds.back().first + kinds.back().worlds; }
  const KindOfWorlds& kind_of(int world) const;
};

inline constexpr std::size_t kMaxMessage = 1 << 16;  // bytes
inline constexpr double kMaxFps = 120;
inline constexpr double kMaxSteps = 10'000;
inline constexpr double kMaxSpeed = 1e4;

// Throws BadMessage for whatever is not one of the messages above, whole and within its range.
Command parse_command(std::string_view text, const Sizes& sizes);

}  // namespace manyworlds::live
