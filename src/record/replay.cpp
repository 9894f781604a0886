// Compares a recording with what it does when it is simulated again.
#include <bit>
#include <cstdio>

#include "src/base/float_mode.hpp"
#include "src/record/described.hpp"
#include "src/record/recording.hpp"
#include "src/record/run_again.hpp"

namespace manyworlds {

namespace {

class Comparison {
 public:
  Comparison(const Recording& recording, const Batch& batch, ReplayResult& result)
      : recording_(recording), all_(recording.impl()), batch_(batch), result_(result) {}

  void compare(std::int64_t sample) {
    for (std::size_t k = 0; k < all_.kinds.size(); ++k) {
      const auto fields = read(k, sample);
      const int count = static_cast<int>(all_.kinds[k].worlds.size());
      for (int i = 0; i < count; ++i) compare(sample, k, i, all_.first_world[k] + i, fields);
    }
  }

 private:
  using Fields = std::array<std::vector<double>, kFieldCount>;

  Fields read(std::size_t kind, std::int64_t sample) const {
    const record::UsingHdf5 hdf5;
    Fields out;
    for (const Field field : kFields) {
      out[static_cast<std::size_t>(field)] = all_.read(field, kind, sample);
    }
    return out;
  }

  void compare(std::int64_t sample, std::size_t kind, int in_kind, int world,
               const Fields& fields) {
    ++result_.compared;
    const Plan& plan = all_.kinds[kind].plan;
    int first_body = -1;
    std::string what;
    for (const Field field : kFields) {
      const auto width = static_cast<std::size_t>(components(field, all_.space()));
      found_.resize(plan.numbers(field));
      batch_.read(field, world, found_);
      const double* recorded = fields[static_cast<std::size_t>(field)].data() +
                               found_.size() * static_cast<std::size_t>(in_kind);
      for (std::size_t i = 0; i < found_.size(); ++i) {
        if (equal(found_[i], recorded[i])) continue;
        const bool of_body = info(field).item == ItemKind::body;
        const int body = of_body ? static_cast<int>(i / width) : first_body;
        if (!what.empty() && body >= first_body) break;
        first_body = body;
        what = describe(field, i % width, found_[i], recorded[i]);
        break;
      }
    }
    const std::uint64_t hash = batch_.hash(world), recorded_hash = recording_.hash(sample, world);
    // In which steps energies were audited is not recorded.
    const Status status = batch_.status(world) & ~Status::diverged;
    const Status recorded_status = recording_.status(sample, world) & ~Status::diverged;
    if (what.empty() && status != recorded_status) {
      what = "status is " + to_string(status) + ", recorded " + to_string(recorded_status);
    }
    if (what.empty() && hash != recorded_hash) {
      what = "hash is " + hex(hash) + ", recorded " + hex(recorded_hash);
    }
    if (what.empty()) return;
    if (result_.different++ > 0) return;
    result_.difference = Difference{recording_.name_of(world), recording_.step(sample),
                                    first_body < 0 ? BodyId() : plan.body_in_row(first_body), what};
  }

  // Bits, in the number type of the recording: NaN equals itself, and 0 is not -0.
  bool equal(double a, double b) const {
    if (all_.precision == Precision::f64) {
      return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
    }
    return std::bit_cast<std::uint32_t>(static_cast<float>(a)) ==
           std::bit_cast<std::uint32_t>(static_cast<float>(b));
  }
  static std::string hex(std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
  }
  std::string describe(Field field, std::size_t component, double found, double recorded) const {
    std::string names = component_names(field, all_.space());
    for (; component > 0; --component) names.erase(0, names.find(' ') + 1);
    const std::string name = std::string(info(field).name) + "." + names.substr(0, names.find(' '));
    char text[128];
    std::snprintf(text, sizeof text, "%s is %.9g, recorded %.9g", name.c_str(), found, recorded);
    return text;
  }

  const Recording& recording_;
  const Recording::Impl& all_;
  const Batch& batch_;
  ReplayResult& result_;
  std::vector<double> found_;
};

ReplayResult compared(const Recording& recording, const ReplayOptions& options) {
  Batch batch = record::batch_of(recording, options);
  ReplayResult result;
  result.worlds = recording.worlds();
  result.kernel_table = batch.kernel_table();
  Comparison comparison(recording, batch, result);
  result.steps = record::run_again(recording, batch, options.go_on, [&](std::int64_t sample) {
    comparison.compare(sample);
    ++result.samples;
  });
  result.lost_worlds = batch.lost_worlds();
  return result;
}

}  // namespace

ReplayResult replay(const Recording& recording, const ReplayOptions& options) {
  const FloatMode mode;
  return record::described(recording.impl().label, [&] { return compared(recording, options); });
}

}  // namespace manyworlds
