// A small honest recording, and what becomes of it in other hands.
#pragma once

#include <functional>
#include <vector>

#include <hdf5.h>

#include "src/record/frame.hpp"
#include "tests/record/support.hpp"

namespace manyworlds::test {

// A ball that falls on the ground for 12 steps, with impulses at times and reset once.
inline void record_ball(const fs::path& file) {
  Scene scene = empty_scene(Space::planar);
  scene.add(ground(Space::planar));
  scene.add(body_of(shape_of(Circle{0.5}), Vec3(0, 0.55, 0)));
  Batch batch(compile(scene), batch_options({default_isa(), Precision::f32}, 2));
  Recorder recorder(batch, file, {.every = 4});
  batch.add_force(1, batch.body_in_row(0), Vec3(2000, 0, 0));
  batch.step(4);
  batch.add_impulse(0, batch.body_in_row(0), Vec3(0, 500, 0));
  batch.step(4);
  batch.reset(std::vector<std::uint8_t>{0, 1});
  batch.step(4);
  recorder.close();
}

inline const Bytes& honest() {
  static const Bytes bytes = [] {
    const Folder folder;
    record_ball(folder / "ball.h5");
    return bytes_of(folder / "ball.h5");
  }();
  return bytes;
}

// The honest file after `change` had the open file in its hands, and a right checksum.
inline Bytes rebuilt(const std::function<void(hid_t)>& change) {
  const Folder folder;
  const fs::path file = folder / "rebuilt.h5";
  write_bytes(file, honest());
  const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  change(h5);
  H5Fclose(h5);
  Bytes bytes = bytes_of(file);
  record::seal(std::span(bytes));
  return bytes;
}

}  // namespace manyworlds::test
