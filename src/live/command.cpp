#include "src/live/command.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "src/page/json.hpp"

namespace manyworlds::live {
namespace {

using page::Json;

constexpr double kLargest = 1e9;  // m, N s, of anything

struct Named {
  const char* name;
  Command::Kind kind;
};
constexpr std::array kNames = {
    Named{"open", Command::open},       Named{"show", Command::look},
    Named{"frame", Command::frame},     Named{"pause", Command::pause},
    Named{"play", Command::play},       Named{"step", Command::step},
    Named{"speed", Command::speed},     Named{"reset", Command::reset},
    Named{"drag", Command::drag},       Named{"drop", Command::drop},
    Named{"push", Command::push},       Named{"controls", Command::controls},
    Named{"gravity", Command::gravity}, Named{"friction", Command::friction},
    Named{"save", Command::save},
};

// Reads the members of a message. Each that is there must have been asked for in the end.
class Message {
 public:
  explicit Message(const Json& json) : json_(json) {}

  bool has(const char* name) const { return json_.contains(name); }
  const Json& member(const char* name) {
    const auto found = json_.find(name);
    if (found == json_.end()) throw BadMessage(std::string("the message has no '") + name + "'");
    ++read_;
    return *found;
  }
  double number(const char* name, double low, double high) {
    return number_of(member(name), name, low, high);
  }
  int whole(const char* name, int low, int high) { return whole_of(member(name), name, low, high); }
  Vec3 vector(const char* name) {
    const Json& j = member(name);
    if (!j.is_array() || j.size() != 3) {
      throw BadMessage(std::string("'") + name + "' must be three numbers");
    }
    Vec3 out;
    for (std::size_t i = 0; i < 3; ++i) {
      out[static_cast<int>(i)] = number_of(j[i], name, -kLargest, kLargest);
    }
    return out;
  }
  static double number_of(const Json& j, const char* name, double low, double high) {
    const double value = j.is_number() ? j.get<double>() : std::nan("");
    if (!(value >= low && value <= high)) {
      throw BadMessage(std::string("'") + name + "' is not a number in its range");
    }
    return value;
  }
  static int whole_of(const Json& j, const char* name, int low, int high) {
    const double value = number_of(j, name, low, high);
    if (value != std::floor(value)) {
      throw BadMessage(std::string("'") + name + "' is not a whole number");
    }
    return static_cast<int>(value);
  }
  void done() const {
    if (read_ != json_.size()) throw BadMessage("the message has unknown members");
  }

 private:
  const Json& json_;
  std::size_t read_ = 0;
};

void read_body(Message& message, const Sizes& sizes, Command& out) {
  out.world = message.whole("world", 0, sizes.worlds() - 1);
  const Plan& plan = sizes.kind_of(out.world).plan;
  const int bodies = static_cast<int>(plan.scene().bodies.size());
  out.body = BodyId(message.whole("body", 0, bodies - 1));
  if (!plan.find_row(out.body)) throw BadMessage("'body' must be a body that moves");
  out.at = message.vector("at");
}

void read_worlds(Message& message, const Sizes& sizes, Command& out) {
  const Json& j = message.member("worlds");
  if (!j.is_array() || j.size() > static_cast<std::size_t>(sizes.shown)) {
    throw BadMessage("'worlds' must be a list of worlds on the page");
  }
  int before = -1;
  for (const Json& one : j) {
    out.worlds.push_back(Message::whole_of(one, "worlds", before + 1, sizes.shown - 1));
    before = out.worlds.back();
  }
}

void read_controls(Message& message, const Sizes& sizes, Command& out) {
  if (message.has("world")) out.world = message.whole("world", 0, sizes.worlds() - 1);
  const Json& j = message.member("values");
  if (!j.is_array()) throw BadMessage("'values' must be a list of numbers");
  for (const Json& one : j) {
    out.values.push_back(Message::number_of(one, "values", -kLargest, kLargest));
  }
  for (const KindOfWorlds& kind : sizes.kinds) {
    if (out.world >= 0 && &kind != &sizes.kind_of(out.world)) continue;
    if (out.values.size() != kind.plan.scene().controls.size() || out.values.empty()) {
      throw BadMessage("'values' must have a number for each control");
    }
  }
}

void read_members(Message& message, const Sizes& sizes, Command& out) {
  switch (out.kind) {
    case Command::open: out.number = message.whole("worlds", 1, sizes.shown); break;
    case Command::look:
      read_worlds(message, sizes, out);
      out.number = message.number("fps", 1, kMaxFps);
      break;
    case Command::step: out.number = message.whole("steps", 1, static_cast<int>(kMaxSteps)); break;
    case Command::speed: {
      const Json& factor = message.member("factor");  // JSON has no word for the infinite
      out.number = factor.is_null() ? std::numeric_limits<double>::infinity()
                                    : Message::number_of(factor, "factor", 1e-3, kMaxSpeed);
      break;
    }
    case Command::reset:
      if (message.has("world")) out.world = message.whole("world", 0, sizes.worlds() - 1);
      break;
    case Command::drag:
      read_body(message, sizes, out);
      out.to = message.vector("to");
      break;
    case Command::push:
      read_body(message, sizes, out);
      out.to = message.vector("impulse");
      break;
    case Command::controls: read_controls(message, sizes, out); break;
    case Command::gravity: out.to = message.vector("value"); break;
    case Command::friction: out.number = message.number("factor", 0, kLargest); break;
    default: break;
  }
}

// Nothing that a page sends lies deeper.
bool shallow(int depth, Json::parse_event_t, Json&) {
  if (depth > 3) throw BadMessage("the message is nested too deeply");
  return true;
}

}  // namespace

const KindOfWorlds& Sizes::kind_of(int world) const {
  std::size_t k = kinds.size() - 1;
  while (k > 0 && kinds[k].first > world) --k;
  return kinds[k];
}

Command parse_command(std::string_view text, const Sizes& sizes) {
  const Json json = Json::parse(text, shallow, false);
  if (json.is_discarded() || !json.is_object())
    throw BadMessage("the message is not a JSON object");
  Message message(json);
  const Json& what = message.member("do");
  Command out;
  bool known = false;
  for (const Named& one : kNames) {
    if (what == one.name) out.kind = one.kind, known = true;
  }
  if (!known) throw BadMessage("'do' is not a command");
  read_members(message, sizes, out);
  message.done();
  return out;
}

}  // namespace manyworlds::live
