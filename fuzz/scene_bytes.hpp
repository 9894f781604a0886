// Scenes, options and inputs out of a fuzzer's bytes. Zeros, and what comes after the last byte,
// are ordinary: so that many inputs are valid scenes and get as far as the step.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "manyworlds/batch.hpp"

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
  Options options();
  Spring spring();
  std::optional<Limit> limit();
  std::optional<Drive> drive();
  JointType joint_type();
  Joint joint(int bodies);
  Control control(int bodies, int joints);
  Variation variation(int bodies);

  FuzzedDataProvider bytes_;
  std::uint8_t wildness_;  // of 256 numbers, how many are anything
  bool planar_ = false;
};

}  // namespace manyworlds::fuzz
