// Live: a batch in a browser while it steps. Of the library manyworlds::live.
//
//   Live live(batch, {.page = "share/manyworlds/viewer.html"});
//   std::puts(live.url().c_str());
//   while (training) {
//     live.apply(batch);   // what pages asked for since, such as the force of a drag
//     batch.step();
//     live.show(batch);    // to those who look; nearly nothing where nobody does
//   }
//
// A thread of its own serves the page on 127.0.0.1. Whoever has the address has the page: it holds
// a random token, without which, or from another origin, nothing is served. The thread never
// touches the batch, and a page that is slow or gone keeps nobody waiting: it gets a frame when it
// asks for one, the newest.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "manyworlds/batch.hpp"
#include "manyworlds/pimpl.hpp"

namespace manyworlds {

// The page cannot be served: the port is taken, `page` cannot be read, no thread can be started.
class LiveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct LiveOptions {
  std::filesystem::path page = {};    // viewer.html, as viewer/ builds it
  std::string title = {};             // default: the name of the scene
  int port = 0;                       // 0: any that is free
  int worlds = 64;                    // that a page shows at first
  int max_worlds = 1024;              // that it can be asked to show; the first of the batch
  std::filesystem::path folder = {};  // where snapshots are saved; default: the current folder

  // What a page may command. Dragging, pushing and saving snapshots are always among it.
  bool clock = false;     // pause, step, speed: run() alone carries them out
  bool resets = false;    // worlds begin anew
  bool controls = false;  // sliders of Scene::controls
  bool parameters =
      false;  // gravity and friction, where Scene::variations has them with Draw::none
};

// How run() steps.
struct LiveClock {
  double speed = 1;     // simulated per real second; infinite: as fast as it goes
  bool paused = false;  // at the beginning
  // Before each call of step(): how many steps it may have at most, at least 1.
  std::function<int(Batch&)> before = {};
  // Called when a page sets controls.
  std::function<void()> controls_set = {};
};

class Live {
 public:
  // Serves at once. Throws LiveError, std::invalid_argument for options that make no sense.
  explicit Live(Batch& batch, const LiveOptions& options);
  ~Live();  // as close()
  Live(Live&&) noexcept;
  Live& operator=(Live&&) noexcept;

  std::string url() const;  // "http://127.0.0.1:41233/<token>/"
  int port() const;
  int pages() const;  // that are connected
  // Pages are told, the thread ends, the port is free again. Nothing is served from then on.
  void close();

  // Both by the thread that has the batch, the one that the Live was made with, between steps.

  // Carries out what pages asked for: pushes, writes; forces of drags are added for the next step()
  // call, of `steps` steps: so once before each. Allocates where there is something.
  void apply(Batch& batch, int steps = 1);
  // Takes a copy of the worlds that pages show, where one waits for it. Allocates then.
  void show(const Batch& batch);

  // Steps the batch as its pages ask, until go_on, which is asked some 15 times a second, says no.
  // Returns how many steps were taken. Where nobody looks, calls of step() are long.
  std::int64_t run(Batch& batch, const LiveClock& clock, const GoOn& go_on);

  struct Impl;

 private:
  Pimpl<Impl> impl_;
};

}  // namespace manyworlds
