// Writes the inputs that fuzzing starts from: make_seeds FOLDER fills FOLDER/<target>/.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "fuzz/snapshot_batches.hpp"
#include "src/base/random.hpp"

namespace manyworlds::fuzz {
namespace {

using Bytes = std::vector<char>;

void write(const std::filesystem::path& folder, int number, const Bytes& bytes) {
  std::filesystem::create_directories(folder);
  std::ofstream out(folder / ("seed" + std::to_string(number)), std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw std::runtime_error("cannot write to " + folder.string());
}

Bytes any_bytes(int seed, int count) {
  const Draws draws(static_cast<std::uint64_t>(seed), 0);
  Bytes bytes(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<char>(static_cast<int>(256 * draws.uniform(i)));
  }
  return bytes;
}

// Any bytes make a scene; these are of many lengths. The last byte says how wild it is.
void scenes(const std::filesystem::path& folder) {
  for (int n = 0; n < 200; ++n) {
    Bytes bytes = any_bytes(n, 64 + 16 * n);
    if (n % 4 != 0) bytes.back() = 0;
    write(folder, n, bytes);
  }
}

// Any bytes are changes of a recording, some five bytes each. The last byte chooses the recording.
void recordings(const std::filesystem::path& folder) {
  for (int n = 0; n < 300; ++n) {
    Bytes bytes = any_bytes(1000 + n, n < 5 ? 1 : 4 + n / 10);
    bytes.back() = static_cast<char>(n % 5);
    write(folder, n, bytes);
  }
}

// Any bytes are changes of a model, some three bytes each, and then controls. The last byte chooses
// the model.
void models(const std::filesystem::path& folder) {
  for (int n = 0; n < 200; ++n) {
    Bytes bytes = any_bytes(2000 + n, n < 20 ? 1 : 8 + n);
    bytes.back() = static_cast<char>(n);
    write(folder, n, bytes);
  }
}

void snapshots(const std::filesystem::path& folder) {
  int number = 0;
  for (int index = 0; index < kBatches; ++index) {
    Batch batch = make_batch(index);
    const auto add = [&](const Snapshot& snapshot) {
      Bytes bytes = {static_cast<char>(index)};
      for (const std::byte b : snapshot.bytes()) bytes.push_back(static_cast<char>(b));
      write(folder, number++, bytes);
    };
    for (int i = 0; i < 3; ++i) {
      add(batch.save());
      add(batch.save(std::vector<int>{i}));
      batch.step(15);
      batch.set_enabled(i, batch.body_in_row(i), i % 2 == 0);
    }
  }
}

}  // namespace
}  // namespace manyworlds::fuzz

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_seeds FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  manyworlds::fuzz::scenes(folder / "scene_fuzz");
  manyworlds::fuzz::snapshots(folder / "snapshot_fuzz");
  manyworlds::fuzz::recordings(folder / "recording_fuzz");
  manyworlds::fuzz::models(folder / "mjcf_fuzz");
}
