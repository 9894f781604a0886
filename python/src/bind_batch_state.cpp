// State as arrays: fields, parameters and observed quantities by name; state in place; controls.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>

#include "arrays.hpp"
#include "bind.hpp"
#include "held_batch.hpp"
#include "quantities.hpp"
#include "read_quantity.hpp"

namespace nb = nanobind;

namespace manyworlds::python {

namespace {

nb::list list_quantities(HeldBatch& self, int kind) {
  return self.with([&](Batch& b) {
    nb::list out;
    for (const Quantity& q : quantities_of(b, self.range(kind))) {
      out.append(nb::make_tuple(q.name, q.group, q.observer, q.item, q.items, q.components, q.unit,
                                q.meaning));
    }
    return out;
  });
}

Quantity quantity(HeldBatch& self, const std::string& name, int kind) {
  return self.with(
      [&](Batch& b) { return find_quantity(quantities_of(b, self.range(kind)), name); });
}

// The batch's indices of worlds of a kind: those given, or all.
std::vector<std::int32_t> worlds_of(const HeldBatch& self, const KindRange& of,
                                    const std::optional<Ids>& worlds) {
  std::vector<std::int32_t> out;
  if (worlds) {
    for (const std::int32_t world : span_of(*worlds)) out.push_back(self.world_of(of, world));
  } else {
    for (int w = 0; w < of.worlds; ++w) out.push_back(of.first + w);
  }
  return out;
}

void read(HeldBatch& self, const std::string& name, const AnyOut& out,
          const std::optional<Ids>& worlds, int kind) {
  const Quantity q = quantity(self, name, kind);
  const std::size_t each =
      static_cast<std::size_t>(q.items) * static_cast<std::size_t>(q.components);
  const bool whole = !worlds && self.kinds() == 1;
  const auto chosen =
      whole ? std::vector<std::int32_t>() : worlds_of(self, self.range(kind), worlds);
  if (!whole) check_size(q.name, out.size(), each * chosen.size());
  with_reals(out, [&](auto numbers) {
    self.run([&](Batch& b) {
      if (whole) return read_quantity(b, q, numbers);
      std::vector<double> own(each);
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        std::visit([&](auto what) { b.read(what, chosen[i], std::span(own)); }, q.what);
        using Number = typename decltype(numbers)::value_type;
        std::transform(own.begin(), own.end(), numbers.begin() + static_cast<long>(i * each),
                       [](double x) { return static_cast<Number>(x); });
      }
    });
  });
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
           const std::optional<Ids>& worlds, int kind) {
  const Quantity q = quantity(self, name, kind);
  if (std::holds_alternative<Observed>(q.what)) {
    throw nb::value_error((name + " is observed and cannot be set").c_str());
  }
  const std::size_t each =
      static_cast<std::size_t>(q.items) * static_cast<std::size_t>(q.components);
  const bool whole = !worlds && self.kinds() == 1;
  const auto chosen =
      whole ? std::vector<std::int32_t>() : worlds_of(self, self.range(kind), worlds);
  if (!whole) check_size(q.name, in.size(), each * chosen.size());
  with_reals(in, [&](auto numbers) {
    self.run([&](Batch& b) {
      if (whole) return write_all(b, q, numbers);
      if constexpr (std::is_same_v<decltype(numbers), std::span<const double>>) {
        if (const auto* field = std::get_if<Field>(&q.what)) {
          write_worlds<Field>(b, *field, chosen, numbers);
        } else {
          write_worlds<Parameter>(b, std::get<Parameter>(q.what), chosen, numbers);
        }
      } else {
        throw std::invalid_argument("parameters of some worlds must be float64");
      }
    });
  });
}

template <class Real>
nb::object blocks_array(const LaneBlocks& at, nb::handle owner) {
  const auto size = [](int n) { return static_cast<std::size_t>(n); };
  const std::size_t shape[] = {size(at.groups), size(at.items), size(at.components),
                               size(at.lanes)};
  const std::int64_t strides[] = {static_cast<std::int64_t>(at.group_stride),
                                  static_cast<std::int64_t>(at.item_stride),
                                  static_cast<std::int64_t>(at.component_stride), 1};
  return nb::cast(nb::ndarray<nb::numpy, Real>(at.data, 4, shape, owner, strides));
}

// None: the plan leaves the field out.
nb::object blocks(HeldBatch& self, const std::string& name, int kind) {
  const Quantity q = quantity(self, name, kind);
  const auto* field = std::get_if<Field>(&q.what);
  if (!field) throw nb::value_error((name + " is not a state field").c_str());
  return self.with([&](Batch& b) -> nb::object {
    const LaneBlocks at = b.lane_blocks(*field, kind);
    if (at.data == nullptr) return nb::none();
    auto* kept = new std::shared_ptr<Batch>(self.share());
    const nb::capsule owner(
        kept, [](void* p) noexcept { delete static_cast<std::shared_ptr<Batch>*>(p); });
    return b.precision() == Precision::f32 ? blocks_array<float>(at, owner)
                                           : blocks_array<double>(at, owner);
  });
}

void lane_indices(HeldBatch& self, const Out<std::int32_t>& out, int kind) {
  self.with([&](Batch& b) {
    const KindRange& of = self.range(kind);
    check_size("out", out.size(), static_cast<std::size_t>(of.worlds));
    for (int w = 0; w < of.worlds; ++w) out.data()[w] = b.lane_index(of.first + w);
  });
}

std::size_t controls_of(const Batch& b, const KindRange& of) {
  return static_cast<std::size_t>(b.controls(of.first));
}

void read_controls(HeldBatch& self, const AnyOut& out, int kind) {
  with_reals(out, [&](auto numbers) {
    self.run([&](Batch& b) {
      if (self.kinds() == 1) return b.read_controls(numbers);
      // Those of all worlds lie one after the other.
      std::size_t before = 0, all = 0;
      for (int k = 0; k < self.kinds(); ++k) {
        if (k == kind) before = all;
        const KindRange& of = self.range(k);
        all += controls_of(b, of) * static_cast<std::size_t>(of.worlds);
      }
      const KindRange& of = self.range(kind);
      check_size("out", numbers.size(), controls_of(b, of) * static_cast<std::size_t>(of.worlds));
      std::vector<typename decltype(numbers)::value_type> values(all);
      b.read_controls(std::span(values));
      std::copy_n(values.begin() + static_cast<long>(before), numbers.size(), numbers.begin());
    });
  });
}

void write_controls(HeldBatch& self, const AnyIn& in, const std::optional<Ids>& worlds, int kind) {
  with_reals(in, [&](auto numbers) {
    self.run([&](Batch& b) {
      if (!worlds && self.kinds() == 1) return b.set_controls(numbers);
      const KindRange& of = self.range(kind);
      const auto chosen = worlds_of(self, of, worlds);
      const std::size_t each = controls_of(b, of);
      check_size("controls", numbers.size(), each * chosen.size());
      std::vector<double> own(each);
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        std::copy_n(numbers.data() + i * each, each, own.begin());
        b.set_controls(chosen[i], std::span<const double>(own));
      }
    });
  });
}

}  // namespace

void bind_batch_state(nb::class_<HeldBatch>& c) {
  const auto of_kind = nb::arg("kind") = 0;
  c.def("quantities", &list_quantities, of_kind,
        "(name, group, observer, item, items, components, unit, meaning) of every field.")
      .def("read", &read, nb::arg("name"), nb::arg("out").noconvert(), nb::arg("worlds").none(),
           of_kind, "Fills an array (worlds, items, components), of all or some worlds.")
      .def("write", &write, nb::arg("name"), nb::arg("numbers").noconvert(),
           nb::arg("worlds").none(), of_kind,
           "Sets an array (worlds, items, components), or float64 values of some worlds.")
      .def("blocks", &blocks, nb::arg("name"), of_kind,
           "Memory of a state field, (groups, items, components, lanes); None if omitted.")
      .def("lane_indices", &lane_indices, nb::arg("out").noconvert(), of_kind,
           "Fills lane indices, (worlds).")
      .def(
          "controls",
          [](HeldBatch& s, int kind) {
            return s.with([&](Batch& b) { return controls_of(b, s.range(kind)); });
          },
          of_kind, "Number of controls of a world.")
      .def("read_controls", &read_controls, nb::arg("out").noconvert(), of_kind,
           "Fills an array (worlds, controls).")
      .def("write_controls", &write_controls, nb::arg("numbers").noconvert(),
           nb::arg("worlds").none(), of_kind,
           "Sets an array (worlds, controls), of all or some worlds.");
}

}  // namespace manyworlds::python
