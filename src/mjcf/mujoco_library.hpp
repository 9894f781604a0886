// Owning handles for MuJoCo's C objects, and its error handler as an exception.
#pragma once

#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

namespace manyworlds::mjcf {

struct SpecDeleter {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};
struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using SpecPtr = std::unique_ptr<mjSpec, SpecDeleter>;
using ModelPtr = std::unique_ptr<mjModel, ModelDeleter>;
using DataPtr = std::unique_ptr<mjData, DataDeleter>;

// MuJoCo called its error function, which by default ends the process.
class MujocoFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// While it lives, MuJoCo's errors on this thread throw MujocoFailure and its warnings are kept
// here instead of being printed and written to MUJOCO_LOG.TXT. Messages of other threads go where
// they went before. The handler is one per process, so captures exclude one another.
class LogCapture {
 public:
  LogCapture();
  ~LogCapture();
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::unique_lock<std::mutex> lock_;
  std::vector<std::string> warnings_;
};

// MuJoCo's messages run over several lines; problems and warnings here are one line each.
std::string one_line(std::string text);

}  // namespace manyworlds::mjcf
