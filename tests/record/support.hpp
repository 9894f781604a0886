// A folder for files, a scene of every kind of member, a batch that is disturbed in every way.
#pragma once

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "manyworlds/record.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

namespace fs = std::filesystem;

// A folder of its own, gone with the object.
class Folder {
 public:
  Folder() {
    static int count = 0;
    path_ = fs::temp_directory_path() /
            ("manyworlds_record_test_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }
  const fs::path& path() const { return path_; }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_))
      names.push_back(entry.path().filename());
    return names;
  }

 private:
  fs::path path_;
};

inline std::vector<std::byte> bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto raw = std::as_bytes(std::span(text));
  return {raw.begin(), raw.end()};
}

inline BatchOptions batch_options(const Table& table, int worlds, bool sleep = false,
                                  int threads = 1) {
  BatchOptions options = options_of(table, worlds, threads);
  options.sleep = sleep;
  options.seed = 5;
  return options;
}

// Every call of Batch that changes a world, spread over worlds and steps.
inline void disturb(Batch& batch, int round) {
  const bool planar = space_of(batch) == Space::planar;
  const int worlds = batch.worlds(), world = (3 * round) % worlds,
            body = round % batch.bodies(world);
  const Vec3 impulse = planar ? Vec3(40, 300, 0) : Vec3(40, -30, 300);
  const Vec3 angular_impulse = planar ? Vec3(0, 0, 20) : Vec3(5, 6, 7);
  const Vec3 at = position(batch, world, body) + 0.1 * Vec3(1, 1, planar ? 0 : 1);
  int other = (world + 1) % worlds;
  if (batch.kind_of(other) != batch.kind_of(world)) other = world;
  switch (round % 17) {
    case 16: {
      const std::vector<double> controls(static_cast<std::size_t>(batch.controls(world)), 300.0);
      batch.set_controls(world, controls);
      break;
    }
    case 0: batch.add_force(world, in_row(batch, world, body), 20 * impulse); break;
    case 1: batch.add_torque(world, in_row(batch, world, body), 20 * angular_impulse); break;
    case 2: batch.add_force_at(world, in_row(batch, world, body), 20 * impulse, at); break;
    case 3: batch.add_impulse(world, in_row(batch, world, body), impulse); break;
    case 4: batch.add_angular_impulse(world, in_row(batch, world, body), angular_impulse); break;
    case 5: batch.add_impulse_at(world, in_row(batch, world, body), impulse, at); break;
    case 6: batch.set_enabled(world, in_row(batch, world, body), false); break;
    case 7:
      batch.set_enabled((3 * (round - 1)) % worlds, batch.body_in_row((round - 1) % batch.bodies()),
                        true);
      break;
    case 8:
      batch.spawn(world, in_row(batch, world, body),
                  {.position = planar ? Vec3(0, 4, 0) : Vec3(0, 0, 4)});
      break;
    case 9: batch.wake(world); break;
    case 10: set_vector(batch, Field::position, world, body, at); break;
    case 11: set_vector(batch, Field::linear_velocity, world, body, angular_impulse); break;
    case 12: {
      std::vector<float> spins(batch.size(Field::angular_velocity));
      batch.read(Field::angular_velocity, spins);
      for (float& x : spins) x *= 0.5f;
      batch.write(Field::angular_velocity, spins);
      break;
    }
    case 13: {  // the force before it never acts, the one after it does
      batch.add_force(world, in_row(batch, world, body), 50 * impulse);
      std::vector<std::uint8_t> mask(static_cast<std::size_t>(worlds), 0);
      mask[static_cast<std::size_t>(world)] = mask[static_cast<std::size_t>(other)] = 1;
      batch.reset(mask);
      batch.add_force(other, batch.body_in_row(0), 20 * impulse);
      break;
    }
    case 14: batch.copy_world(world, other); break;
    case 15: batch.restore(batch.save(std::array{world}), 0, other); break;
  }
}

using Bytes = std::vector<std::byte>;

inline void write_bytes(const fs::path& file, const Bytes& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
}

}  // namespace manyworlds::test
