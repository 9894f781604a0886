#include "src/record/page/run.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "src/base/enum_names.hpp"
#include "src/page/contacts.hpp"
#include "src/page/deflate.hpp"
#include "src/page/frames.hpp"
#include "src/page/look.hpp"
#include "src/page/room.hpp"
#include "src/page/sizes.hpp"
#include "src/record/page/presence.hpp"
#include "src/record/recording.hpp"
#include "src/record/run_again.hpp"

namespace manyworlds::record {

using namespace page;  // NOLINT(google-build-using-namespace): what a page is made of

namespace {

constexpr std::int64_t kRoomFrames = 40;  // that say how much room a world needs

struct KindPart {
  std::size_t index, worlds;  // of the recording; the first so many of them
  const Plan* plan;
  std::vector<double> radii;  // of the scene's bodies
  std::unique_ptr<PoseQuantizer> poses;
  std::unique_ptr<ContactCoder> contacts;  // where they were recorded
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
      kinds_.push_back({k, worlds, &all_.kinds[k].plan, {}, {}, {}});
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
      look["sizes"] = sizes_of_kind(kind, start, meshes);
      kinds.push_back(std::move(look));
      out.worlds += static_cast<int>(kind.worlds);
      out.bodies += static_cast<std::int64_t>(kind.worlds) * kind.plan->bodies();
    }
    std::vector<Presence::Kind> present;
    for (const KindPart& kind : kinds_) {
      present.push_back({kind.plan, all_.first_world[kind.index], kind.worlds});
    }
    presence_ = Presence(std::move(present));
    if (!presence_.find(recording_, start, options_.every, samples_.size(), options_.go_on)) {
      return false;
    }
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
                {"enabled", presence_.any_body_gone()},
                {"joints_enabled", presence_.any_joint_gone()},
                {"contacts", recording_.has_contacts()},
                {"normal_steps", kNormalSteps},
                {"force_steps", kForceSteps},
                {"least_force", kLeastForce},
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

  // Where bodies of a kind are, at some moments of the recording.
  std::vector<double> some_positions(const KindPart& kind) const {
    std::vector<double> out;
    const std::int64_t stride =
        std::max<std::int64_t>(1, static_cast<std::int64_t>(samples_.size()) / kRoomFrames);
    for (std::size_t i = 0; i < samples_.size(); i += static_cast<std::size_t>(stride)) {
      const std::vector<double> x = read(Field::position, kind, samples_[i]);
      out.insert(out.end(), x.begin(), x.end());
    }
    return out;
  }

  Json look_of_kind(KindPart& kind, Meshes& meshes) {
    kind.radii = drawn_radii(kind.plan->scene());
    Json out = look_of(*kind.plan, kind.radii,
                       room_of(*kind.plan, kind.radii, some_positions(kind)), meshes);
    std::vector<double> steps;
    double smallest = 1;  // m, radius of a body that moves
    for (int row = 0; row < kind.plan->bodies(); ++row) {
      const auto body = static_cast<std::size_t>(kind.plan->body_in_row(row).index());
      steps.push_back(kind.radii[body] / kPositionSteps);
      smallest = row == 0 ? kind.radii[body] : std::min(smallest, kind.radii[body]);
    }
    kind.poses = std::make_unique<PoseQuantizer>(
        std::move(steps), kind.worlds,
        static_cast<std::size_t>(components(Field::position, all_.space())),
        static_cast<std::size_t>(orientation_of(kind)), kChunkFrames);
    if (recording_.has_contacts()) {
      const double step = smallest / kContactSteps;
      kind.contacts = std::make_unique<ContactCoder>(
          step, kind.worlds, static_cast<std::size_t>(components(Field::position, all_.space())));
      out["contact_step"] = step;
    }
    return out;
  }

  // Sizes of shapes that vary from world to world: [{shape, [world] size x y z, stretch x y z}].
  Json sizes_of_kind(const KindPart& kind, const Batch& start, Meshes& meshes) const {
    Json out = Json::array();
    for (const VariedSize& one :
         sizes_of(start, all_.first_world[kind.index], static_cast<int>(kind.worlds), meshes)) {
      out.push_back({{"shape", one.shape}, {"values", numbers_of(one.values)}});
    }
    return out;
  }

  // Of each kind: poses, then status of its worlds, then which bodies and joints are there, then
  // contacts.
  void write_chunk(std::size_t first, std::size_t count, ChunkWriter& chunk) {
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
      KindPart& kind = kinds_[k];
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
      presence_.write_bodies(k, first, count, chunk);
      presence_.write_joints(k, first, count, chunk);
      if (kind.contacts) write_contacts(kind, first, count, chunk);
    }
  }

  void write_contacts(KindPart& kind, std::size_t first, std::size_t count, ChunkWriter& chunk) {
    const UsingHdf5 hdf5;
    const auto& recorded = all_.kinds[kind.index];
    for (std::size_t f = 0; f < count; ++f) {
      const std::int64_t sample = samples_[first + f];
      // All worlds at once: they lie one after the other.
      const std::vector<RecordedContact> all =
          all_.read_contacts(kind.index, sample, 0, kind.worlds);
      auto from = all.begin();
      std::size_t i = static_cast<std::size_t>(sample) * recorded.worlds.size();
      for (std::size_t w = 0; w < kind.worlds; ++w, ++i) {
        const auto& end = recorded.contacts.end;
        const std::int64_t n =
            end.empty() ? 0 : end[i] - (i == 0 ? 0 : end[i - 1]);  // none, where others have some
        std::vector<ContactPoint> points(static_cast<std::size_t>(n));
        for (ContactPoint& to : points) {
          const RecordedContact& c = *from++;
          to.body_a = c.body_a.index(), to.body_b = c.body_b.index(), to.force = c.force;
          std::copy_n(c.point.data(), 3, to.point.begin());
          std::copy_n(c.normal.data(), 3, to.normal.begin());
        }
        kind.contacts->add(w, std::move(points));
      }
    }
    kind.contacts->write(chunk);
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
  Presence presence_{{}};
};

}  // namespace

bool run_of(const Recording& recording, const PageOptions& options, PageRun& out) {
  return RunWriter(recording, options).write(out);
}

}  // namespace manyworlds::record
