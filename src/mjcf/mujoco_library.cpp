#include "src/mjcf/mujoco_library.hpp"

#include <atomic>
#include <cstddef>
#include <utility>

namespace manyworlds::mjcf {
namespace {

std::mutex handler_mutex;
std::atomic<mjfLogHandler> previous_handler{nullptr};
// Where this thread's warnings go; null on threads that are not inside a LogCapture.
thread_local std::vector<std::string>* captured_warnings = nullptr;

void handle_log(const mjLogMessage* message) {
  if (captured_warnings == nullptr) {
    if (const mjfLogHandler previous = previous_handler) previous(message);
    return;
  }
  std::string text = message->subject;
  if (message->body != nullptr) text += std::string("\n") + message->body;
  if (message->level == mjLOG_ERROR) throw MujocoFailure(one_line(std::move(text)));
  if (message->level == mjLOG_WARNING) captured_warnings->push_back(one_line(std::move(text)));
}

}  // namespace

LogCapture::LogCapture() : lock_(handler_mutex) {
  captured_warnings = &warnings_;
  previous_handler = mju_setLogHandler(handle_log);
}

LogCapture::~LogCapture() {
  mju_setLogHandler(previous_handler);
  captured_warnings = nullptr;
}

std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 2)) {
    text.replace(at, 1, "; ");
  }
  return text;
}

}  // namespace manyworlds::mjcf
