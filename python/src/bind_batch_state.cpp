// State as arrays: fields, parameters and observed quantities by name; state in place; controls.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "bind.hpp"
#include "held_batch.hpp"
#include "quantities.hpp"
#include "read_quantity.hpp"

namespace nb = nanobind;

namespace manyworlds::python {

namespace {

nb::list list_quantities(HeldBatch& self) {
  return self.with([](Batch& b) {
    nb::list out;
    for (const Quantity& q : quantities_of(b)) {
      out.append(nb::make_tuple(q.name, q.group, q.observer, q.item, q.items, q.components, q.unit,
                                q.meaning));
    }
    return out;
  });
}

Quantity quantity(HeldBatch& self, const std::string& name) {
  return self.with([&](Batch& b) { return find_quantity(quantities_of(b), name); });
}

void read(HeldBatch& self, const std::string& name, const AnyOut& out) {
  const Quantity q = quantity(self, name);
  with_reals(out, [&](auto numbers) { self.run([&](Batch& b) { read_quantity(b, q, numbers); }); });
}

void write_all(Batch& batch, const Quantity& q, auto numbers) {
  if (const auto* field = std::get_if<Field>(&q.what)) {
    batch.write(*field, numbers);
  } else if (const auto* parameter = std::get_if<Parameter>(&q.what)) {
    if constexpr (std::is_same_v<decltype(numbers), std::span<const double>>) {
      batch.write(*parameter, numbers);
    } else {
      throw std::invalid_argument("parameters are float64");
    }
  }
}

// Some worlds, one after the other. When the batch refuses the numbers of one, all have what they
// had before.
template <class What>
void write_worlds(Batch& batch, What what, std::span<const std::int32_t> worlds,
                  std::span<const double> numbers) {
  const std::size_t each = worlds.empty() ? 0 : numbers.size() / worlds.size();
  std::vector<double> before(numbers.size());
  std::size_t done = 0;
  try {
    for (; done < worlds.size(); ++done) {
      batch.read(what, worlds[done], std::span(before).subspan(done * each, each));
      batch.write(what, worlds[done], numbers.subspan(done * each, each));
    }
  } catch (...) {
    while (done-- > 0) {
      batch.write(what, worlds[done], std::span<const double>(before).subspan(done * each, each));
    }
    throw;
  }
}

void write(HeldBatch& self, const std::string& name, const AnyIn& in,
           const std::optional<Ids>& worlds) {
  const Quantity q = quantity(self, name);
  if (std::holds_alternative<Observed>(q.what)) {
    throw nb::value_error((name + " is observed and cannot be set").c_str());
  }
  const std::size_t each =
      static_cast<std::size_t>(q.items) * static_cast<std::size_t>(q.components);
  if (worlds) check_size(q.name, in.size(), each * worlds->size());
  with_reals(in, [&](auto numbers) {
    self.run([&](Batch& b) {
      if (!worlds) return write_all(b, q, numbers);
      if constexpr (std::is_same_v<decltype(numbers), std::span<const double>>) {
        if (const auto* field = std::get_if<Field>(&q.what)) {
          write_worlds(b, *field, span_of(*worlds), numbers);
        } else {
          write_worlds(b, std::get<Parameter>(q.what), span_of(*worlds), numbers);
        }
      } else {
        throw std::invalid_argument("numbers of some worlds are float64");
      }
    });
  });
}

template <class Real>
nb::object blocks_array(const LaneBlocks& at, nb::handle owner) {
  const auto size = [](int n) { return static_cast<std::size_t>(n); };
  const std::size_t shape[] = {size(at.groups), size(at.bodies), size(at.components),
                               size(at.lanes)};
  const std::int64_t strides[] = {static_cast<std::int64_t>(at.group_stride),
                                  static_cast<std::int64_t>(at.body_stride),
                                  static_cast<std::int64_t>(at.component_stride), 1};
  return nb::cast(nb::ndarray<nb::numpy, Real>(at.data, 4, shape, owner, strides));
}

// None: the plan leaves the field out.
nb::object blocks(HeldBatch& self, const std::string& name) {
  const Quantity q = quantity(self, name);
  const auto* field = std::get_if<Field>(&q.what);
  if (!field) throw nb::value_error((name + " is no state field").c_str());
  return self.with([&](Batch& b) -> nb::object {
    const LaneBlocks at = b.lane_blocks(*field);
    if (at.data == nullptr) return nb::none();
    auto* kept = new std::shared_ptr<Batch>(self.share());
    const nb::capsule owner(
        kept, [](void* p) noexcept { delete static_cast<std::shared_ptr<Batch>*>(p); });
    return b.precision() == Precision::f32 ? blocks_array<float>(at, owner)
                                           : blocks_array<double>(at, owner);
  });
}

void slots(HeldBatch& self, const Out<std::int32_t>& out) {
  self.with([&](Batch& b) {
    check_size("out", out.size(), static_cast<std::size_t>(b.worlds()));
    for (int w = 0; w < b.worlds(); ++w) out.data()[w] = b.slot(w);
  });
}

void read_controls(HeldBatch& self, const AnyOut& out) {
  with_reals(out, [&](auto numbers) { self.run([&](Batch& b) { b.read_controls(numbers); }); });
}

void write_controls(HeldBatch& self, const AnyIn& in, const std::optional<Ids>& worlds) {
  with_reals(in, [&](auto numbers) {
    self.run([&](Batch& b) {
      if (!worlds) return b.set_controls(numbers);
      const auto each = static_cast<std::size_t>(b.controls());
      check_size("controls", numbers.size(), each * worlds->size());
      std::vector<double> own(each);
      for (std::size_t i = 0; i < worlds->size(); ++i) {
        std::copy_n(numbers.data() + i * each, each, own.begin());
        b.set_controls(worlds->data()[i], std::span<const double>(own));
      }
    });
  });
}

}  // namespace

void bind_batch_state(nb::class_<HeldBatch>& c) {
  c.def("quantities", &list_quantities,
        "(name, group, observer, item, items, components, unit, meaning) of every field.")
      .def("read", &read, nb::arg("name"), nb::arg("out").noconvert(),
           "Fills an array (worlds, items, components).")
      .def("write", &write, nb::arg("name"), nb::arg("numbers").noconvert(),
           nb::arg("worlds").none(),
           "Takes an array (worlds, items, components), or those of some worlds in float64.")
      .def("blocks", &blocks, nb::arg("name"),
           "A state field in place, (groups, bodies, components, lanes); None: left out.")
      .def("slots", &slots, nb::arg("out").noconvert(), "Fills slots, (worlds).")
      .def_prop_ro("controls",
                   [](HeldBatch& s) { return s.with([](Batch& b) { return b.controls(); }); })
      .def("read_controls", &read_controls, nb::arg("out").noconvert(),
           "Fills an array (worlds, controls).")
      .def("write_controls", &write_controls, nb::arg("numbers").noconvert(),
           nb::arg("worlds").none(), "Takes an array (worlds, controls), or that of some worlds.");
}

}  // namespace manyworlds::python
