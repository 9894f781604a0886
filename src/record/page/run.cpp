#include "src/record/page/run.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "src/record/page/deflate.hpp"
#include "src/record/page/frames.hpp"
#include "src/record/page/look.hpp"
#include "src/record/recording.hpp"
#include "src/record/run_again.hpp"

namespace manyworlds::record {
namespace {

constexpr std::int64_t kRoomFrames = 40;  // that say how much room a world needs
constexpr double kOutliers = 0.005;       // of the bodies, at either end, that do not count there

struct KindPart {
  std::size_t index, worlds;  // of the recording; the first so many of them
  const Plan* plan;
  std::vector<double> radii;  // of the scene's bodies
  std::unique_ptr<PoseQuantizer> poses;
};

template <class T>
std::string numbers_of(const std::vector<T>& values) {
  return packed({reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)});
}

class RunWriter {
 public:
  RunWriter(const Recording& recording, const PageOptions& options)
      : recording_(recording), all_(recording.impl()), options_(options) {
    if (options.max_worlds < 0 || options.every < 1) {
      throw std::invalid_argument("page: max_worlds is " + std::to_string(options.max_worlds) +
                                  " and every is " + std::to_string(options.every) +
                                  ", must be at least 0 and 1");
    }
    for (std::int64_t s = 0; s < recording.samples(); s += options.every) samples_.push_back(s);
    std::size_t left = options.max_worlds > 0 ? static_cast<std::size_t>(options.max_worlds)
                                              : static_cast<std::size_t>(all_.worlds());
    for (std::size_t k = 0; k < all_.kinds.size() && left > 0; ++k) {
      const std::size_t worlds = std::min(left, all_.kinds[k].worlds.size());
      left -= worlds;
      kinds_.push_back({k, worlds, &all_.kinds[k].plan, {}, {}});
    }
    for (const PageNumber& number : options.numbers) {
      const std::size_t wanted = all_.steps.size() * static_cast<std::size_t>(all_.worlds());
      if (number.values.size() == wanted) continue;
      throw std::invalid_argument("page: number '" + number.name + "' has " +
                                  std::to_string(number.values.size()) + " values, must have " +
                                  std::to_string(wanted) + ", one per sample and world");
    }
  }

  bool write(PageRun& out) {
    Json kinds = Json::array();
    Meshes meshes(all_.space());
    Batch start = batch_of(recording_, {});
    start.restore(all_.start);
    for (KindPart& kind : kinds_) {
      const UsingHdf5 hdf5;
      Json look = look_of_kind(kind, meshes);
      look["first_world"] = all_.first_world[kind.index];
      look["worlds"] = kind.worlds;
      look["names"] = Json(std::vector<std::int64_t>(
          all_.kinds[kind.index].worlds.begin(),
          all_.kinds[kind.index].worlds.begin() + static_cast<std::ptrdiff_t>(kind.worlds)));
      look["orientation"] = orientation_of(kind);
      look["sizes"] = sizes_of(kind, start, meshes);
      kinds.push_back(std::move(look));
      out.worlds += static_cast<int>(kind.worlds);
      out.bodies += static_cast<std::int64_t>(kind.worlds) * kind.plan->bodies();
    }
    if (!find_enabled(start)) return false;
    out.frames = static_cast<std::int64_t>(samples_.size());
    Json chunks = Json::array();
    for (std::size_t first = 0; first < samples_.size(); first += kChunkFrames) {
      if (options_.go_on && !options_.go_on()) return false;
      const std::size_t count = std::min(kChunkFrames, samples_.size() - first);
      ChunkWriter chunk(count);
      write_chunk(first, count, chunk);
      chunks.push_back({{"frames", count}, {"widths", chunk.widths()}});
      out.chunks.push_back(packed(chunk.bytes()));
    }
    const Options& scene = kinds_.front().plan->scene().options;
    std::vector<double> times;
    for (const std::int64_t s : samples_) {
      times.push_back(static_cast<double>(recording_.step(s)) * scene.dt);
    }
    Json numbers = Json::array();
    for (const PageNumber& number : options_.numbers) {
      numbers.push_back({{"name", number.name},
                         {"unit", number.unit},
                         {"values", numbers_of(chosen(number.values))}});
    }
    out.head = {{"origin", recording_.origin()},
                {"space", name_of(all_.space())},
                {"dt", scene.dt},
                {"times", std::move(times)},
                {"position_steps", kPositionSteps},
                {"quaternion_steps", kQuaternionSteps},
                {"angle_steps", kAngleSteps},
                {"slowest", kSlowest},
                {"speed_steps", kSpeedSteps},
                {"enabled", !enabled_.empty()},
                {"meshes", meshes.json()},
                {"kinds", std::move(kinds)},
                {"numbers", std::move(numbers)},
                {"chunks", std::move(chunks)}};
    return true;
  }

 private:
  int orientation_of(const KindPart& kind) const {
    if (kind.plan->numbers(Field::orientation) == 0) return 0;
    return components(Field::orientation, all_.space());
  }

  std::vector<double> read(Field field, const KindPart& kind, std::int64_t sample) const {
    std::vector<double> out = all_.read(field, kind.index, sample);
    out.resize(kind.worlds * kind.plan->numbers(field));
    return out;
  }

  // The box in which bodies are most of the time, with what is fixed near it.
  Room room_of(const KindPart& kind, const std::vector<double>& radii) const {
    const auto width = static_cast<std::size_t>(components(Field::position, all_.space()));
    const Scene& scene = kind.plan->scene();
    std::vector<double> along[3];
    const std::int64_t stride =
        std::max<std::int64_t>(1, static_cast<std::int64_t>(samples_.size()) / kRoomFrames);
    for (std::size_t i = 0; i < samples_.size(); i += static_cast<std::size_t>(stride)) {
      const std::vector<double> x = read(Field::position, kind, samples_[i]);
      for (std::size_t n = 0; n < x.size(); ++n) {
        if (std::abs(x[n]) < 1e9) along[n % width].push_back(x[n]);
      }
    }
    double radius = 0;
    for (int row = 0; row < kind.plan->bodies(); ++row) {
      const int body = kind.plan->body_in_row(row).index();
      radius = std::max(radius, radii[static_cast<std::size_t>(body)]);
    }
    Room room;
    room.low.setZero(), room.high.setZero();
    for (std::size_t c = 0; c < width; ++c) {
      std::vector<double>& values = along[c];
      if (values.empty()) continue;
      const auto last = static_cast<double>(values.size() - 1);
      const auto quantile = [&](double q) {
        const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::lround(q * last));
        std::nth_element(values.begin(), at, values.end());
        return *at;
      };
      const auto axis = static_cast<Eigen::Index>(c);
      room.low[axis] = quantile(kOutliers), room.high[axis] = quantile(1 - kOutliers);
    }
    const double margin = std::max(radius, 1e-3);
    room.low.array() -= margin, room.high.array() += margin;
    const Room fixed = fixed_room(scene);
    const double extent = (room.high - room.low).maxCoeff();
    if (!fixed.empty()) {
      room.low = room.low.cwiseMin(fixed.low.cwiseMax((room.low.array() - 2 * extent).matrix()));
      room.high =
          room.high.cwiseMax(fixed.high.cwiseMin((room.high.array() + 2 * extent).matrix()));
    }
    for (const Body& body : scene.bodies) add_ground(body, extent, room);
    const Vec3 more = Vec3::Constant(0.01 * extent);
    room.low -= more, room.high += more;
    return room;
  }

  // Of planes, the feet of the corners of the room, where they are near.
  static void add_ground(const Body& body, double extent, Room& room) {
    for (const Shape& shape : body.shapes) {
      Vec3 n;
      double offset;
      if (const auto* plane = std::get_if<Plane>(&shape.geometry)) {
        n = plane->normal, offset = plane->offset;
      } else if (const auto* half = std::get_if<HalfPlane>(&shape.geometry)) {
        n = {half->normal.x(), half->normal.y(), 0}, offset = half->offset;
      } else {
        continue;
      }
      const Quat turn = body.rotation.normalized();
      n = turn * (shape.rotation.normalized() * n);
      offset += n.dot(turn * shape.position + body.position);
      const Room was = room;
      for (int i = 0; i < 8; ++i) {
        const Vec3 corner(i & 1 ? was.high.x() : was.low.x(), i & 2 ? was.high.y() : was.low.y(),
                          i & 4 ? was.high.z() : was.low.z());
        const double above = n.dot(corner) - offset;
        if (above > 0 && above < extent / 2) room.add(corner - above * n);
      }
    }
  }

  Json look_of_kind(KindPart& kind, Meshes& meshes) {
    const Scene& scene = kind.plan->scene();
    kind.radii = radii_of(scene, 0);
    double largest = 0;
    for (const double r : kind.radii) largest = std::max(largest, r);
    for (double& r : kind.radii) r = r > 0 ? r : largest > 0 ? largest : 1;
    Json out = look_of(*kind.plan, kind.radii, room_of(kind, kind.radii), meshes);
    std::vector<double> steps;
    for (int row = 0; row < kind.plan->bodies(); ++row) {
      const auto body = static_cast<std::size_t>(kind.plan->body_in_row(row).index());
      steps.push_back(kind.radii[body] / kPositionSteps);
    }
    kind.poses = std::make_unique<PoseQuantizer>(
        std::move(steps), kind.worlds,
        static_cast<std::size_t>(components(Field::position, all_.space())),
        static_cast<std::size_t>(orientation_of(kind)), kChunkFrames);
    return out;
  }

  // Sizes of shapes that vary from world to world: [{shape, [world] size x y z, stretch x y z}].
  Json sizes_of(const KindPart& kind, const Batch& start, Meshes& meshes) const {
    Json out = Json::array();
    const Scene& scene = kind.plan->scene();
    const bool vary =
        std::any_of(scene.variations.begin(), scene.variations.end(),
                    [](const Variation& v) { return v.parameter == Parameter::size; });
    if (!vary) return out;
    std::vector<std::vector<float>> found;
    std::vector<bool> differs;
    std::vector<const Shape*> shapes;
    for (const Body& body : scene.bodies) {
      for (const Shape& shape : body.shapes) shapes.push_back(&shape);
    }
    found.resize(shapes.size()), differs.resize(shapes.size());
    std::vector<double> sizes(3 * shapes.size());
    for (std::size_t w = 0; w < kind.worlds; ++w) {
      start.read(Parameter::size, all_.first_world[kind.index] + static_cast<int>(w), sizes);
      for (std::size_t s = 0; s < shapes.size(); ++s) {
        const Vec3 size(sizes[3 * s], sizes[3 * s + 1], sizes[3 * s + 2]);
        if (!(size.x() > 0)) continue;
        const Meshes::Use use = meshes.use(shapes[s]->geometry, size);
        const Meshes::Use plain = meshes.use(shapes[s]->geometry);
        // Sizes are kept in the number type of the batch.
        const double near = 1e-5 * plain.size.norm();
        if (!use.size.isApprox(plain.size, 1e-5) || (use.stretch - plain.stretch).norm() > near) {
          differs[s] = true;
        }
        for (const Vec3& v : {use.size, use.stretch}) {
          for (const double x : v) found[s].push_back(static_cast<float>(x));
        }
      }
    }
    for (std::size_t s = 0; s < shapes.size(); ++s) {
      if (differs[s]) out.push_back({{"shape", s}, {"values", numbers_of(found[s])}});
    }
    return out;
  }

  // Which bodies are there is in no field: where some come and go, it is simulated again.
  bool find_enabled(Batch& batch) {
    bool any = std::any_of(all_.inputs.begin(), all_.inputs.end(), [](const InputRow& row) {
      return row.input == Input::enable || row.input == Input::disable ||
             row.input == Input::spawn || brings_state(row.input);
    });
    for_each_body(batch, [&](int, BodyId, bool there) { any = any || !there; });
    if (!any) return true;
    run_again(recording_, batch, options_.go_on, [&](std::int64_t sample) {
      if (sample % options_.every != 0) return;
      for_each_body(batch, [&](int, BodyId, bool there) { enabled_.push_back(there); });
    });
    std::size_t each = 0;
    for_each_body(batch, [&](int, BodyId, bool) { ++each; });
    if (enabled_.size() != each * samples_.size()) return false;
    if (std::all_of(enabled_.begin(), enabled_.end(), [](bool there) { return there; })) {
      enabled_.clear();
    }
    return true;
  }
  void for_each_body(const Batch& batch, auto&& visit) const {
    for (const KindPart& kind : kinds_) {
      for (std::size_t w = 0; w < kind.worlds; ++w) {
        const int world = all_.first_world[kind.index] + static_cast<int>(w);
        for (int row = 0; row < kind.plan->bodies(); ++row) {
          const BodyId body = kind.plan->body_in_row(row);
          visit(world, body, batch.enabled(world, body));
        }
      }
    }
  }

  // Of each kind: poses, then status of its worlds, then what is there.
  void write_chunk(std::size_t first, std::size_t count, ChunkWriter& chunk) {
    std::size_t before = 0, each = 0;
    for (const KindPart& kind : kinds_) {
      each += kind.worlds * static_cast<std::size_t>(kind.plan->bodies());
    }
    for (KindPart& kind : kinds_) {
      std::vector<std::int32_t> status(kind.worlds * count);
      {
        const UsingHdf5 hdf5;
        for (std::size_t f = 0; f < count; ++f) {
          const std::int64_t sample = samples_[first + f];
          kind.poses->add(read(Field::position, kind, sample),
                          read(Field::orientation, kind, sample),
                          read(Field::linear_velocity, kind, sample),
                          read(Field::angular_velocity, kind, sample));
          for (std::size_t w = 0; w < kind.worlds; ++w) {
            status[w * count + f] = static_cast<std::int32_t>(
                recording_.status(sample, all_.first_world[kind.index] + static_cast<int>(w)));
          }
        }
      }
      kind.poses->write(chunk);
      chunk.add(status);
      const std::size_t items = kind.worlds * static_cast<std::size_t>(kind.plan->bodies());
      if (!enabled_.empty()) {
        std::vector<std::int32_t> there(items * count);
        for (std::size_t i = 0; i < items; ++i) {
          for (std::size_t f = 0; f < count; ++f) {
            there[i * count + f] = enabled_[(first + f) * each + before + i];
          }
        }
        chunk.add(there);
      }
      before += items;
    }
  }

  // Of [sample][world], what is on the page.
  std::vector<float> chosen(const std::vector<float>& values) const {
    const auto all = static_cast<std::size_t>(all_.worlds());
    std::size_t shown = 0;
    for (const KindPart& kind : kinds_) shown += kind.worlds;
    std::vector<float> out;
    for (const std::int64_t s : samples_) {
      const auto row =
          values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(s) * all);
      out.insert(out.end(), row, row + static_cast<std::ptrdiff_t>(shown));
    }
    return out;
  }

  const Recording& recording_;
  const Recording::Impl& all_;
  const PageOptions& options_;
  std::vector<std::int64_t> samples_;
  std::vector<KindPart> kinds_;
  std::vector<bool> enabled_;  // [frame][kind][world][row]; empty: all bodies are there
};

}  // namespace

bool run_of(const Recording& recording, const PageOptions& options, PageRun& out) {
  return RunWriter(recording, options).write(out);
}

}  // namespace manyworlds::record
