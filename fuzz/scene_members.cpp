// Every member of a scene out of a fuzzer's bytes, from the list of members: one that is added to a
// struct needs nothing here.
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "fuzz/scene_bytes.hpp"
#include "src/base/enum_names.hpp"

namespace manyworlds::fuzz {

void SceneBytes::fill(double& value) {
  if (!std::isfinite(value)) {
    value = number(0, 1e4);
  } else if (value == 0) {
    value = byte() > 192 ? number(-1, 1) : number(0, byte() > 128 ? 100 : 1);
  } else {
    value *= rarely() ? number(0, 100) : number(0, 1.5);
  }
}
void SceneBytes::fill(bool& value) { value = !value; }
void SceneBytes::fill(int& value) {
  value = rarely() ? integer(-2, 1 << 17) : integer(1, 2 * std::clamp(value, 5, 1 << 16));
}
void SceneBytes::fill(std::uint32_t& value) { value = bytes_.ConsumeIntegral<std::uint32_t>(); }
void SceneBytes::fill(std::string& value) { value = name(); }
void SceneBytes::fill(ShapeId& value) { value = ShapeId(BodyId(integer(-1, 4)), integer(-1, 2)); }
template <class Of>
void SceneBytes::fill(Id<Of>& value) {
  value = Id<Of>(integer(-1, 4));
}
template <class E>
requires std::is_enum_v<E>
void SceneBytes::fill(E& value) {
  value = static_cast<E>(integer(0, static_cast<int>(EnumTable<E>::names.size()) - 1));
}
template <int n>
void SceneBytes::fill(Eigen::Matrix<double, n, 1>& value) {
  value = planar_vector(std::max(1.0, 2 * value.norm())).template head<n>();
}
void SceneBytes::fill(Mat3& value) { fill(value(integer(0, 2), integer(0, 2))); }
void SceneBytes::fill(Quat& value) { value = rotation(); }
void SceneBytes::fill(Eigen::AlignedBox3d& value) {
  const Vec3 low = vector(5), size = vector(5);
  value = Eigen::AlignedBox3d(low, low + (rarely() ? size : size.cwiseAbs().eval()));
}
void SceneBytes::fill(Limit& value) {
  value.low = number(-1, 0), value.high = number(0, 1);
  if (rarely()) fill(value.spring.emplace());
}
void SceneBytes::fill(Spring& value) {
  if (byte() > 128) {
    value.frequency = number(0.1, 60), value.damping_ratio = number(0, 3);
  } else {
    value.stiffness = number(1, 1e4), value.damping = number(0, 100);
  }
}
template <class T>
void SceneBytes::fill(std::optional<T>& value) {
  fill(value.emplace());
}
template <class T>
void SceneBytes::fill(std::vector<T>& value) {
  value.emplace_back();
}
template <class... Ts>
void SceneBytes::fill(std::variant<Ts...>& value) {
  const int chosen = integer(0, static_cast<int>(sizeof...(Ts)) - 1);
  int i = 0;
  ((i++ == chosen ? fill(value.template emplace<Ts>()) : void()), ...);
}
template <HasMembers Struct>
void SceneBytes::fill(Struct& value) {
  Members<Struct>::visit(value, [this](const char*, auto& member, Counted = {}) {
    if constexpr (HasMembers<std::remove_reference_t<decltype(member)>>) {
      fill(member);
    } else if (byte() > 192) {
      fill(member);
    }
  });
}

template <class T>
bool SceneBytes::change(T& value, int& before) {
  if constexpr (HasMembers<T>) {
    bool found = false;
    Members<T>::visit(value, [&](const char*, auto& member, Counted = {}) {
      found = found || change(member, before);
    });
    return found;
  } else {
    if (before-- == 0) return fill(value), true;
    return change_inside(value, before);
  }
}
template <class T>
bool SceneBytes::change_inside(T&, int&) {
  return false;
}
template <class T>
bool SceneBytes::change_inside(std::optional<T>& value, int& before) {
  return value && change(*value, before);
}
template <class T>
bool SceneBytes::change_inside(std::vector<T>& values, int& before) {
  return std::any_of(values.begin(), values.end(), [&](T& one) { return change(one, before); });
}
template <class... Ts>
bool SceneBytes::change_inside(std::variant<Ts...>& value, int& before) {
  return std::visit([&](auto& alternative) { return change(alternative, before); }, value);
}

// Any one of all members of a scene becomes something else.
void SceneBytes::change_any(Scene& scene) {
  constexpr int kAll = std::numeric_limits<int>::max();
  int left = kAll;
  change(scene, left);  // counts them
  int before = integer(0, kAll - left - 1);
  change(scene, before);
}

Options SceneBytes::options() {
  Options o;
  if (planar_) o.gravity = {0, -10, 0};
  fill(o);
  return o;
}

Joint SceneBytes::joint(int bodies) {
  Joint out;
  fill(out);
  if (byte() > 32) fill(out.type);
  if (planar_ && std::holds_alternative<BallJoint>(out.type) && !rarely()) out.type = HingeJoint{};
  out.body_a = BodyId(integer(-1, bodies - (rarely() ? 0 : 1)));
  out.body_b = BodyId(integer(0, bodies - (rarely() ? 0 : 1)));
  return out;
}

}  // namespace manyworlds::fuzz
