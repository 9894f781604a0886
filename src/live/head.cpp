#include "src/live/head.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/base/enum_names.hpp"
#include "src/page/base64.hpp"
#include "src/page/frames.hpp"
#include "src/page/room.hpp"

namespace manyworlds::live {
namespace {

using page::Json;

Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

// The variation of a parameter that is about all that have it and is not drawn.
const Variation* kept(const Scene& scene, Parameter parameter) {
  for (const Variation& v : scene.variations) {
    if (v.parameter == parameter && !v.body && !v.shape && v.draw == Draw::none) return &v;
  }
  return nullptr;
}

std::vector<double> positions_of(const Batch& batch, const KindOfWorlds& kind, int worlds) {
  std::vector<double> out, one(kind.plan.numbers(Field::position));
  for (int w = 0; w < worlds; ++w) {
    batch.read(Field::position, kind.first + w, one);
    out.insert(out.end(), one.begin(), one.end());
  }
  return out;
}

Json controls_of(const KindOfWorlds& kind) {
  Json out = Json::array();
  for (const Control& control : kind.plan.scene().controls) {
    // A slider has ends.
    const bool ends = std::isfinite(control.low) && std::isfinite(control.high);
    out.push_back({{"name", control.name},
                   {"low", ends ? control.low : -1.0},
                   {"high", ends ? control.high : 1.0},
                   {"value", std::isfinite(control.initial) ? control.initial : 0.0}});
  }
  return out;
}

}  // namespace

Sliders sliders_of(const Sizes& sizes) {
  Sliders out;
  out.gravity = out.friction = true;
  const double infinite = std::numeric_limits<double>::infinity();
  out.gravity_low.setConstant(-infinite), out.gravity_high.setConstant(infinite);
  out.friction_low = 0, out.friction_high = infinite;
  for (const KindOfWorlds& kind : sizes.kinds) {
    const Scene& scene = kind.plan.scene();
    if (const Variation* v = kept(scene, Parameter::gravity)) {
      out.gravity_low = out.gravity_low.cwiseMax(v->low);
      out.gravity_high = out.gravity_high.cwiseMin(v->high);
    } else {
      out.gravity = false;
    }
    const Variation* v = kept(scene, Parameter::friction);
    bool rough = false;
    for (const Body& body : scene.bodies) {
      for (const Shape& shape : body.shapes) {
        const double mu = shape.material.friction;
        if (v == nullptr || !(mu > 0)) continue;
        rough = true;
        out.friction_low = std::max(out.friction_low, v->low.x() / mu);
        out.friction_high = std::min(out.friction_high, v->high.x() / mu);
      }
    }
    out.friction = out.friction && rough;
  }
  out.gravity = out.gravity && (out.gravity_low.array() <= out.gravity_high.array()).all() &&
                out.gravity_low != out.gravity_high;
  out.friction = out.friction && out.friction_low < out.friction_high;
  return out;
}

Head::Head(const Batch& batch, const Sizes& sizes, const LiveOptions& options)
    : sizes_(sizes),
      meshes_(sizes.kinds.front().plan.scene().space),
      first_worlds_(std::min(options.worlds, sizes.shown)),
      steps_itself_(options.clock) {
  for (const KindOfWorlds& kind : sizes.kinds) {
    const Scene& scene = kind.plan.scene();
    const int shown = std::clamp(sizes.shown - kind.first, 1, kind.worlds);
    const std::vector<double> radii = page::drawn_radii(scene);
    const std::vector<double> positions = positions_of(batch, kind, shown);
    Json look =
        page::look_of(kind.plan, radii, page::room_of(kind.plan, radii, positions), meshes_);
    look["first_world"] = kind.first;
    look["orientation"] = kind.plan.numbers(Field::orientation) == 0
                              ? 0
                              : components(Field::orientation, scene.space);
    look["controls"] = options.controls ? controls_of(kind) : Json::array();
    looks_.push_back(std::move(look));
    any_varies_ = any_varies_ ||
                  std::any_of(scene.variations.begin(), scene.variations.end(),
                              [](const Variation& v) { return v.parameter == Parameter::size; });
  }
  static_cast<void>(measure(batch));  // adds what meshes it needs
  const Scene& scene = sizes.kinds.front().plan.scene();
  const Sliders sliders = sliders_of(sizes);
  Json can = {{"clock", options.clock}, {"resets", options.resets}};
  can["gravity"] = Json();
  can["friction"] = Json();
  if (options.parameters && sliders.gravity) {
    can["gravity"] = {{"low", numbers(sliders.gravity_low)},
                      {"high", numbers(sliders.gravity_high)}};
  }
  if (options.parameters && sliders.friction) {
    can["friction"] = {{"low", sliders.friction_low}, {"high", sliders.friction_high}};
  }
  rest_ = {{"title", options.title.empty() ? scene.name : options.title},
           {"origin", batch.kernel_table() + ", " + std::to_string(batch.threads()) + " threads"},
           {"space", name_of(scene.space)},
           {"dt", scene.options.dt},
           {"slowest", page::kSlowest},
           {"speed_steps", page::kSpeedSteps},
           {"all_worlds", sizes.worlds()},
           {"most_worlds", sizes.shown},
           {"first_worlds", first_worlds_},
           {"can", std::move(can)},
           {"meshes", meshes_.json()},
           {"numbers", Json::array()}};
}

VariedSizes Head::measure(const Batch& batch) {
  VariedSizes out;
  for (const KindOfWorlds& kind : sizes_.kinds) {
    const int shown = std::clamp(sizes_.shown - kind.first, 0, kind.worlds);
    out.push_back(page::sizes_of(batch, kind.first, shown, meshes_));
  }
  return out;
}

Json Head::kinds_of(int worlds, const VariedSizes& varied) const {
  Json out = Json::array();
  for (std::size_t k = 0; k < looks_.size(); ++k) {
    const KindOfWorlds& kind = sizes_.kinds[k];
    const int shown = std::clamp(worlds - kind.first, 0, kind.worlds);
    if (shown == 0) break;
    Json sizes = Json::array();
    for (const page::VariedSize& one : varied[k]) {
      const auto bytes =
          std::min(one.values.size(), 6 * static_cast<std::size_t>(shown)) * sizeof(float);
      sizes.push_back(
          {{"shape", one.shape},
           {"values",
            page::base64({reinterpret_cast<const std::uint8_t*>(one.values.data()), bytes})}});
    }
    Json names = Json::array();
    for (int w = 0; w < shown; ++w) names.push_back(kind.first + w);
    Json one = looks_[k];
    one["worlds"] = shown;
    one["names"] = std::move(names);
    one["sizes"] = std::move(sizes);
    out.push_back(std::move(one));
  }
  return out;
}

std::string Head::of(int worlds, const VariedSizes& varied) const {
  Json head = rest_;
  head["kinds"] = kinds_of(worlds, varied);
  return Json{{"head", std::move(head)}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string Head::sizes_of(int worlds, const VariedSizes& varied) const {
  Json out = Json::array();
  for (Json& kind : kinds_of(worlds, varied)) out.push_back(std::move(kind["sizes"]));
  return Json{{"sizes", std::move(out)}}.dump();
}

}  // namespace manyworlds::live
