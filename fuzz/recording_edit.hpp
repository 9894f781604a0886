// A recording with its contents changed. HDF5 itself makes the changes and seal() a right checksum:
// what is tried is our reader, not how HDF5 reads files that it would never write.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "src/record/h5.hpp"

namespace manyworlds::fuzz {

class RecordingEdit {
 public:
  explicit RecordingEdit(std::span<const std::byte> bytes);

  // One change of something in the file, or none where it cannot be.
  void edit(FuzzedDataProvider& in);
  std::vector<std::byte> close();  // the file, sealed

 private:
  struct Target {
    std::string object, attribute;  // no attribute: the dataset or group itself
  };

  void change(const Target& target, FuzzedDataProvider& in);
  void change_numbers(const Target& target, FuzzedDataProvider& in);
  void change_text(const Target& target, FuzzedDataProvider& in);
  void resize(const Target& target, FuzzedDataProvider& in);
  void remove(const Target& target);
  void rename(const Target& target, const Target& to);
  void link(const Target& target, const Target& to, bool soft);
  void remake(const Target& target, FuzzedDataProvider& in);
  void mend_fingerprint(const Target& target);

  record::UsingHdf5 hdf5_;
  record::Handle h5_;
  std::vector<Target> targets_;
};

}  // namespace manyworlds::fuzz
