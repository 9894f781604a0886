// Scenes, options and inputs out of a fuzzer's bytes. Zeros, and what comes after the last byte,
// are ordinary: so that many inputs are valid scenes and get as far as the step.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "manyworlds/batch.hpp"
#include "manyworlds/members.hpp"

namespace manyworlds::fuzz {

class SceneBytes {
 public:
  SceneBytes(const std::uint8_t* data, std::size_t size);

  Scene scene();
  PlanOptions plan_options();
  BatchOptions batch_options();

  bool done() { return bytes_.remaining_bytes() == 0; }
  int integer(int low, int high) { return bytes_.ConsumeIntegralInRange(low, high); }
  // Mostly between low and high; in wild inputs also not finite, huge, tiny, negative, any bits.
  double number(double low, double high);
  Vec3 vector(double half);

 private:
  std::uint8_t byte() { return bytes_.ConsumeIntegral<std::uint8_t>(); }
  bool rarely() { return byte() > 240; }
  bool wild() { return byte() < wildness_; }
  Vec3 planar_vector(double half);
  Vec3 axial_vector(double half);
  Quat rotation();
  std::string name();
  Polygon polygon();
  Hull hull();
  HeightField height_field();
  Terrain terrain();
  Geometry geometry(bool fixed);
  Shape shape(bool fixed);
  MassProperties mass_properties();
  Body body(int index);
  // What a member may become, from what it is; of a struct (members.hpp), some of its members.
  void fill(double& value);
  void fill(bool& value);
  void fill(int& value);
  void fill(std::uint32_t& value);
  void fill(std::string& value);
  void fill(ShapeId& value);
  template <class Of>
  void fill(Id<Of>& value);
  template <class E>
  requires std::is_enum_v<E>
  void fill(E& value);
  template <int n>
  void fill(Eigen::Matrix<double, n, 1>& value);
  void fill(Mat3& value);
  void fill(Quat& value);
  void fill(Eigen::AlignedBox3d& value);
  void fill(Limit& value);
  void fill(Spring& value);
  template <class T>
  void fill(std::optional<T>& value);
  template <class T>
  void fill(std::vector<T>& value);
  template <class... Ts>
  void fill(std::variant<Ts...>& value);
  template <HasMembers Struct>
  void fill(Struct& value);
  // Fills what has that many members before it; whether there is one.
  template <class T>
  bool change(T& value, int& before);
  template <class T>
  bool change_inside(T& value, int& before);
  template <class T>
  bool change_inside(std::optional<T>& value, int& before);
  template <class T>
  bool change_inside(std::vector<T>& values, int& before);
  template <class... Ts>
  bool change_inside(std::variant<Ts...>& value, int& before);
  void change_any(Scene& scene);
  Options options();
  Joint joint(int bodies);
  Control control(int bodies, int joints);
  Variation variation(int bodies);

  FuzzedDataProvider bytes_;
  std::uint8_t wildness_;  // of 256 numbers, how many are anything
  bool planar_ = false;
};

}  // namespace manyworlds::fuzz
