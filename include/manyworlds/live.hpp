// Live: shows a batch in a browser while it steps. Part of the library manyworlds::live.
//
//   Live live(batch, {.page = "share/manyworlds/viewer.html"});
//   std::puts(live.url().c_str());
//   while (training) {
//     live.apply(batch);   // commands of pages, such as the force of a drag
//     batch.step();
//     live.show(batch);    // sends frames; nearly no cost without pages
//   }
//
// A separate thread serves the page on 127.0.0.1. The address contains a random token. Requests
// without the token or from another origin are refused. The thread never accesses the batch. Slow
// or closed pages do not delay the batch: a page gets the newest frame when it requests one.
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

// The page cannot be served: the port is taken, `page` cannot be read, or no thread can be started.
class LiveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct LiveOptions {
  std::filesystem::path page = {};    // viewer.html, built from viewer/
  std::string title = {};             // default: the name of the scene
  int port = 0;                       // 0: any free port
  int worlds = 64;                    // worlds that a page shows at first
  int max_worlds = 1024;              // most worlds that a page can show; the first of the batch
  std::filesystem::path folder = {};  // folder for snapshots; default: the current folder

  // Commands that pages may send. Pages may always drag and hit bodies and save snapshots.
  bool clock = false;       // pause, step, speed: only with run()
  bool resets = false;      // reset of worlds
  bool controls = false;    // sliders of Scene::controls
  bool parameters = false;  // gravity and friction, if Scene::variations has them with Draw::none
};

// Options of run().
struct LiveClock {
  double speed = 1;     // simulated per real second; infinite: as fast as possible
  bool paused = false;  // at the start
  // Called before each step(). Returns the maximum number of its steps, at least 1.
  std::function<int(Batch&)> before = {};
  // Called when a page sets controls.
  std::function<void()> controls_set = {};
};

class Live {
 public:
  // Starts to serve. Throws LiveError, and std::invalid_argument for invalid options.
  explicit Live(Batch& batch, const LiveOptions& options);
  ~Live();  // calls close()
  Live(Live&&) noexcept;
  Live& operator=(Live&&) noexcept;

  std::string url() const;  // "http://127.0.0.1:41233/<token>/"
  int port() const;
  int pages() const;  // number of connected pages
  // Notifies the pages, ends the thread and frees the port.
  void close();

  // Call both between steps, on the thread that made the Live and uses the batch.

  // Executes the commands of pages, such as impulses and writes. Adds the forces of drags for the
  // next step() call, which has `steps` steps: call it once before each. Allocates if there are
  // commands.
  void apply(Batch& batch, int steps = 1);
  // Copies the worlds that pages show, if a page waits for a frame. Allocates then.
  void show(const Batch& batch);

  // Steps the batch as its pages command, until go_on returns false; go_on is called about 15 times
  // a second. Returns the number of steps. Without pages, step() calls have more steps.
  std::int64_t run(Batch& batch, const LiveClock& clock, const GoOn& go_on);

  struct Impl;

 private:
  Pimpl<Impl> impl_;
};

}  // namespace manyworlds
