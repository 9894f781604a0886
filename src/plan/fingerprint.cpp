// The fingerprint of a plan: equal for plans that step worlds alike and store them alike. What of a
// scene counts is said in members.hpp.
#include <string_view>

#include "manyworlds/members.hpp"
#include "src/base/hash.hpp"
#include "src/plan/plan_data.hpp"

namespace manyworlds {

namespace {

class Fingerprint {
 public:
  void add(double x) { hasher_.add(x); }
  void add(bool x) { hasher_.add(std::uint64_t{x}); }
  void add(int x) { hasher_.add(static_cast<std::uint64_t>(x)); }
  void add(std::uint32_t x) { hasher_.add(std::uint64_t{x}); }
  template <class Of>
  void add(Id<Of> id) {
    add(id.index());
  }
  void add(ShapeId id) { add(id.body()), add(id.index()); }
  template <class E>
  requires std::is_enum_v<E>
  void add(E x) { add(static_cast<int>(x)); }
  void add(const std::string& text) {
    add(static_cast<int>(text.size()));
    for (const char c : text) add(int{c});
  }
  template <int n>
  void add(const Eigen::Matrix<double, n, 1>& v) {
    for (int i = 0; i < n; ++i) add(v[i]);
  }
  void add(const Mat3& m) {
    for (int i = 0; i < 9; ++i) add(m(i / 3, i % 3));
  }
  void add(const Quat& q) { add(q.w()), add(q.x()), add(q.y()), add(q.z()); }
  void add(const Eigen::AlignedBox3d& box) { add(Vec3(box.min())), add(Vec3(box.max())); }
  template <class T>
  void add(const std::optional<T>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(static_cast<int>(values.size()));
    for (const T& value : values) add(value);
  }
  template <class... Ts>
  void add(const std::variant<Ts...>& value) {
    add(static_cast<int>(value.index()));
    std::visit([this](const auto& alternative) { this->add(alternative); }, value);
  }
  template <HasMembers Struct>
  void add(const Struct& value) {
    Members<Struct>::visit(value, [&](const char* name, const auto& member, Counted counted = {}) {
      if (!counted.yes) return;
      if constexpr (std::is_same_v<Struct, SolverOptions>) {  // to name the default changes nothing
        if (std::string_view(name) == "iterations") return add(iterations_of(value));
      }
      add(member);
    });
  }
  // How a number is drawn does not matter to a world that has it.
  void add(const VariedNumber& n) {
    add(n.parameter), add(n.of.body), add(n.of.shape), add(n.component), add(n.low), add(n.high);
    if (n.of.attractor >= 0) add(n.of.attractor);
    if (n.of.joint >= 0 || n.of.control >= 0) add(n.of.joint), add(n.of.control);
  }
  std::uint64_t value() const { return hasher_.value(); }

 private:
  Hasher hasher_;
};

}  // namespace

std::uint64_t fingerprint(const Scene& scene) {
  Fingerprint out;
  out.add(scene);
  return out.value();
}

std::uint64_t fingerprint(const PlanData& plan) {
  Fingerprint out;
  out.add(plan.scene);
  out.add(plan.varied);
  for (const bool in : plan.in) out.add(in);
  for (const int capacity : plan.capacity) out.add(capacity);
  if (plan.sparse) out.add(plan.sparse);  // keys of contacts mean something else
  return out.value();
}

}  // namespace manyworlds
