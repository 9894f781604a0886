// The extension module manyworlds._record: recordings, and scenes as JSON. A module of its own
// because it needs HDF5.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <span>
#include <tuple>
#include <utility>

#include "manyworlds/film.hpp"
#include "manyworlds/page.hpp"
#include "manyworlds/record.hpp"
#include "python/src/arrays.hpp"
#include "python/src/errors.hpp"
#include "python/src/held_batch.hpp"
#include "python/src/interrupts.hpp"
#include "python/src/scene_fields.hpp"

namespace manyworlds::python {

namespace {

// What listens to a batch: it keeps the batch alive, also after its close(), and takes turns with
// it.
template <class Listener>
class Listening {
 public:
  template <class... Arguments>
  explicit Listening(const HeldBatch& batch, const Arguments&... arguments)
      : batch_(batch), listener_(batch_.run([&](Batch& b) { return Listener(b, arguments...); })) {}
  template <class F>
  decltype(auto) run(F f) {
    return batch_.run([&](Batch& b) -> decltype(auto) { return f(listener_, b); });
  }

 private:
  HeldBatch batch_;
  Listener listener_;
};

using HeldRecorder = Listening<Recorder>;
using HeldDumps = Listening<LostWorldDumps>;

void make_recorder(HeldRecorder* self, const HeldBatch& batch, const std::filesystem::path& file,
                   const Ids& worlds, int every, std::int64_t first_world, double flush_seconds,
                   int contacts) {
  const auto chosen = span_of(worlds);
  new (self) HeldRecorder(batch, file,
                          RecordOptions{.worlds = {chosen.begin(), chosen.end()},
                                        .every = every,
                                        .first_world = first_world,
                                        .flush_seconds = flush_seconds,
                                        .contacts = contacts});
}

void make_dumps(HeldDumps* self, const HeldBatch& batch, const std::filesystem::path& folder,
                int checkpoint_steps, int max_files, std::int64_t first_world) {
  new (self)
      HeldDumps(batch, folder, LostWorldDumps::Options{checkpoint_steps, max_files, first_world});
}

class HeldRecording : public Held<Recording> {
 public:
  explicit HeldRecording(Recording recording)
      : Held(std::make_shared<Recording>(std::move(recording)), "Recording") {}
};

void open(HeldRecording* self, const std::filesystem::path& file) {
  const nb::gil_scoped_release release;
  new (self) HeldRecording(Recording::open(file));
}

// The property `name`: f(recording).
template <class F>
void def(nb::class_<HeldRecording>& c, const char* name, F f) {
  c.def_prop_ro(
      name, [f](HeldRecording& self) { return self.with([&](Recording& r) { return f(r); }); },
      nb::rv_policy::move);
}

const Plan& plan_of(const Recording& recording, int kind) {
  if (kind < 0 || kind >= recording.kinds()) {
    throw nb::index_error(("kind is " + std::to_string(kind) + ", must be 0 to " +
                           std::to_string(recording.kinds() - 1))
                              .c_str());
  }
  return recording.plan(kind);
}

auto steps_of(const Recording& r) {
  std::vector<std::int64_t> out;
  for (std::int64_t s = 0; s < r.samples(); ++s) out.push_back(r.step(s));
  return owned(std::move(out), {static_cast<std::size_t>(r.samples())});
}
auto names_of_worlds(const Recording& r) {
  std::vector<std::int64_t> out;
  for (int w = 0; w < r.worlds(); ++w) out.push_back(r.name_of(w));
  return owned(std::move(out), {static_cast<std::size_t>(r.worlds())});
}
// A number of every world at every sample, (samples, worlds).
template <class T, class F>
auto table(const Recording& r, F f) {
  std::vector<T> out;
  for (std::int64_t s = 0; s < r.samples(); ++s) {
    for (int w = 0; w < r.worlds(); ++w) out.push_back(static_cast<T>(f(s, w)));
  }
  return owned(std::move(out),
               {static_cast<std::size_t>(r.samples()), static_cast<std::size_t>(r.worlds())});
}

// (worlds, items, components) of a field of a kind of world.
std::array<int, 3> shape_of(const Recording& recording, Field field, int kind) {
  const Plan& plan = plan_of(recording, kind);
  return {recording.worlds_of(kind), plan.items(info(field).item),
          components(field, plan.scene().space)};
}

// `out`: a field of a kind at the samples from `begin` on, (samples, worlds, items, components).
void read(HeldRecording& self, nb::object field, int kind, std::int64_t begin, const AnyOut& out) {
  const Field which = from_python<Field>(field, "field");
  self.with([&](Recording& r) {
    const auto [worlds, items, n] = shape_of(r, which, kind);
    if (out.ndim() != 4) throw nb::value_error("the array must have four axes");
    const auto samples = static_cast<std::int64_t>(out.shape(0));
    check_size("the array", out.size(),
               out.shape(0) * static_cast<std::size_t>(worlds) * static_cast<std::size_t>(items) *
                   static_cast<std::size_t>(n));
    if (begin < 0 || samples > r.samples() || begin > r.samples() - samples) {
      throw nb::index_error("there is no such sample");
    }
    if (items == 0) return;
    int first = 0;
    for (int k = 0; k < kind; ++k) first += r.worlds_of(k);
    const int last = first + worlds;
    with_reals(out, [&](auto to) {
      const nb::gil_scoped_release release;
      auto at = to.begin();
      for (std::int64_t s = begin; s < begin + samples; ++s) {
        for (int w = first; w < last; ++w) {
          for (const double x : r.read(which, s, w)) {
            *at++ = static_cast<typename decltype(to)::value_type>(x);
          }
        }
      }
    });
  });
}

// (bodies, numbers) of the contacts of a world at a sample, and how many there were: (n, 2) and
// (n, 7) of point, normal, force.
nb::tuple contacts_of(HeldRecording& self, std::int64_t sample, int world) {
  const auto [all, found] = self.with([&](Recording& r) {
    return std::pair(r.contacts(sample, world), r.contacts_found(sample, world));
  });
  std::vector<std::int32_t> bodies;
  std::vector<double> numbers;
  for (const RecordedContact& c : all) {
    bodies.insert(bodies.end(), {c.body_a.index(), c.body_b.index()});
    numbers.insert(numbers.end(), c.point.begin(), c.point.end());
    numbers.insert(numbers.end(), c.normal.begin(), c.normal.end());
    numbers.push_back(c.force);
  }
  return nb::make_tuple(owned(std::move(bodies), {all.size(), 2}),
                        owned(std::move(numbers), {all.size(), 7}), found);
}

nb::dict replay_of(HeldRecording& self, nb::object isa, nb::object threads, nb::object layout) {
  ReplayOptions options{from_python<std::optional<Isa>>(isa, "isa"),
                        from_python<int>(threads, "threads"),
                        from_python<ContactLayout>(layout, "layout")};
  const ReplayResult result = self.run([&](Recording& r) {
    return Interrupts::during([&](const GoOn& go_on) {
      options.go_on = go_on;
      return replay(r, options);
    });
  });
  nb::dict out;
  out["worlds"] = result.worlds, out["samples"] = result.samples, out["steps"] = result.steps;
  out["compared"] = result.compared, out["different"] = result.different;
  out["difference"] = nb::none();
  if (const auto& d = result.difference) {
    out["difference"] = nb::make_tuple(d->world, d->step, d->body.index(), d->what);
  }
  out["lost_worlds"] = result.lost_worlds, out["kernel_table"] = result.kernel_table;
  return out;
}

// f(), with all recordings held, their Recordings being in `found`.
template <class F>
auto with_all(std::span<HeldRecording* const> left, std::vector<const Recording*>& found, F f)
    -> decltype(f()) {
  if (left.empty()) return f();
  return left.front()->with([&](Recording& r) {
    found.push_back(&r);
    return with_all(left.subspan(1), found, f);
  });
}

// The page as text, or (worlds, bodies, frames, bytes) of a file that was written.
nb::object page(const std::vector<HeldRecording*>& recordings, const std::filesystem::path& empty,
                const std::optional<std::filesystem::path>& file, const std::string& title,
                int worlds, std::int64_t every,
                std::vector<std::pair<std::string, std::vector<float>>> numbers) {
  PageOptions options{.title = title, .max_worlds = worlds, .every = every};
  for (auto& [name, values] : numbers) options.numbers.push_back({name, "", std::move(values)});
  std::vector<const Recording*> found;
  return with_all(recordings, found, [&]() -> nb::object {
    if (file) {
      const PageReport report = [&] {
        const nb::gil_scoped_release release;
        return Interrupts::during([&](const GoOn& go_on) {
          options.go_on = go_on;
          return write_page(found, empty, *file, options);
        });
      }();
      return nb::make_tuple(report.worlds, report.bodies, report.frames, report.bytes);
    }
    const std::string text = [&] {
      const nb::gil_scoped_release release;
      return Interrupts::during([&](const GoOn& go_on) {
        options.go_on = go_on;
        return page_of(found, empty, options);
      });
    }();
    return nb::str(text.c_str(), text.size());
  });
}

FrameOptions frame_of(int width, int height, const std::string& view) {
  return {.width = width, .height = height, .view = view};
}

void picture(const std::filesystem::path& page, const std::filesystem::path& file, int width,
             int height, const std::string& view, double time) {
  Interrupts::during([&](const GoOn& go_on) {
    return write_picture(page, file,
                         {.frame = frame_of(width, height, view), .time = time, .go_on = go_on});
  });
}

// Frames, seconds and bytes of it.
std::tuple<std::int64_t, double, std::size_t> film(const std::filesystem::path& page,
                                                   const std::filesystem::path& file, int width,
                                                   int height, const std::string& view, double fps,
                                                   double speed, double begin, double end,
                                                   const std::string& encoder) {
  const FilmReport report = Interrupts::during([&](const GoOn& go_on) {
    return write_film(page, file,
                      {.frame = frame_of(width, height, view),
                       .fps = fps,
                       .speed = speed,
                       .begin = begin,
                       .end = end,
                       .encoder = encoder,
                       .go_on = go_on});
  });
  return {report.frames, report.seconds, report.bytes};
}

void bind_films(nb::module_& m) {
  m.def("picture", &picture, nb::arg("page"), nb::arg("file"), nb::arg("width"), nb::arg("height"),
        nb::arg("view"), nb::arg("time"), nb::call_guard<nb::gil_scoped_release>(),
        "A picture of a page.");
  m.def("film", &film, nb::arg("page"), nb::arg("file"), nb::arg("width"), nb::arg("height"),
        nb::arg("view"), nb::arg("fps"), nb::arg("speed"), nb::arg("begin"), nb::arg("end"),
        nb::arg("encoder"), nb::call_guard<nb::gil_scoped_release>(),
        "A film of a page. Returns frames, seconds and bytes.");
}

void bind_writing(nb::module_& m) {
  nb::class_<HeldRecorder>(m, "Recorder", "Private: use manyworlds.record.Recorder.")
      .def("__init__", &make_recorder, nb::arg("batch"), nb::arg("file"), nb::arg("worlds"),
           nb::arg("every"), nb::arg("first_world"), nb::arg("flush_seconds"), nb::arg("contacts"))
      .def("sample",
           [](HeldRecorder& self) { self.run([](Recorder& r, Batch& b) { r.sample(b); }); })
      .def("close", [](HeldRecorder& self) { self.run([](Recorder& r, Batch&) { r.close(); }); })
      .def_prop_ro("samples", [](HeldRecorder& self) {
        return self.run([](Recorder& r, Batch&) { return r.samples(); });
      });
  nb::class_<HeldDumps>(m, "LostWorldDumps", "Private: use manyworlds.record.LostWorldDumps.")
      .def("__init__", &make_dumps, nb::arg("batch"), nb::arg("folder"),
           nb::arg("checkpoint_steps"), nb::arg("max_files"), nb::arg("first_world"))
      .def("close", [](HeldDumps& self) {
        return self.run([](LostWorldDumps& d, Batch&) { return d.close(); });
      });
}

void bind_reading(nb::module_& m) {
  nb::class_<HeldRecording> c(m, "Recording", "Private: use manyworlds.record.Recording.");
  def(c, "kinds", [](Recording& r) { return r.kinds(); });
  def(c, "samples", [](Recording& r) { return r.samples(); });
  def(c, "inputs", [](Recording& r) { return r.inputs(); });
  def(c, "precision", [](Recording& r) { return name_of(r.precision()); });
  def(c, "sleep", [](Recording& r) { return r.sleep(); });
  def(c, "finished", [](Recording& r) { return r.finished(); });
  def(c, "origin", [](Recording& r) { return r.origin(); });
  def(c, "has_contacts", [](Recording& r) { return r.has_contacts(); });
  def(c, "steps", &steps_of);
  def(c, "worlds", &names_of_worlds);
  def(c, "hashes", [](Recording& r) {
    return table<std::uint64_t>(r, [&](std::int64_t s, int w) { return r.hash(s, w); });
  });
  def(c, "status", [](Recording& r) {
    return table<std::uint32_t>(r, [&](std::int64_t s, int w) { return r.status(s, w); });
  });
  c.def("__init__", &open, nb::arg("file"))
      .def("close", &HeldRecording::close)
      .def_prop_ro("closed", &HeldRecording::closed)
      .def(
          "scene",
          [](HeldRecording& self, int kind) {
            return self.with([&](Recording& r) { return to_python(plan_of(r, kind).scene()); });
          },
          nb::arg("kind"))
      .def(
          "shape",
          [](HeldRecording& self, nb::object field, int kind) {
            const Field which = from_python<Field>(field, "field");
            return self.with([&](Recording& r) {
              const auto [worlds, items, n] = shape_of(r, which, kind);
              return nb::make_tuple(worlds, items, n);
            });
          },
          nb::arg("field").none(), nb::arg("kind"))
      .def("read", &read, nb::arg("field").none(), nb::arg("kind"), nb::arg("begin"),
           nb::arg("out").noconvert())
      .def("contacts", &contacts_of, nb::arg("sample"), nb::arg("world"))
      .def("replay", &replay_of, nb::arg("isa").none(), nb::arg("threads"),
           nb::arg("layout").none());
}

}  // namespace

NB_MODULE(_record, m) {
  m.doc() = "Recordings, scenes as JSON. Private: use manyworlds.record.";
  bind_error<RecordError>(m, "RecordError",
                          "A recording that cannot be written, or an invalid, truncated or corrupt "
                          "file.");
  bind_error<FilmError>(m, "FilmError",
                        "A picture or film failed: a program is missing or failed.");
  bind_writing(m);
  bind_reading(m);
  m.def("page", &page, nb::arg("recordings"), nb::arg("empty"), nb::arg("file").none(),
        nb::arg("title"), nb::arg("worlds"), nb::arg("every"), nb::arg("numbers"),
        "A page as text, or (worlds, bodies, frames, bytes) of a written page.");
  bind_films(m);
  m.def("unfinished_recordings", &unfinished_recordings, nb::arg("file"),
        nb::call_guard<nb::gil_scoped_release>(),
        "Part files of a file, with data and without a running writer.");
  m.def(
      "scene_to_json",
      [](nb::object scene) { return scene_to_json(from_python<Scene>(scene, "scene")); },
      nb::arg("scene").none(), "A scene as JSON, with exact numbers.");
  m.def(
      "scene_from_json",
      [](nb::object json) {
        return to_python(scene_from_json(from_python<std::string>(json, "json")));
      },
      nb::arg("json").none(), "The scene of a JSON text.");
}

}  // namespace manyworlds::python
