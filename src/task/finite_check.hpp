// FiniteCheck: which worlds of a group have an observation, a reward or an end that is not a finite
// number. Where all are finite, this costs one comparison for each of these rows.
//
// An end that is not a number is not true, and neither is one that follows from comparing what is
// not a number. This matters in few worlds, so only for those is the way to the end walked, lane by
// lane: a row is unknown where it is not a number, compares an unknown row, or is chosen by one.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "kernels/data/group.hpp"
#include "src/task/program.hpp"

namespace manyworlds {

// Rows of a program that its instruction takes; those after the last one are -1.
std::array<int, 3> operands_of(const kernels::Instruction<double>& instruction);
// Rows that the ends in `ends` compare, or take as truths. A NaN in one may make an end unknown.
std::vector<int> compared_rows(const Program& program, std::span<const int> ends);

template <class Real>
class FiniteCheck {
 public:
  FiniteCheck(const Program& program, std::vector<int> results, std::span<const int> ends,
              int lanes)
      : program_(program),
        results_(std::move(results)),
        compared_(compared_rows(program, ends)),
        lanes_(lanes) {}

  // Lanes with a result that is not finite, or an end that compares what is not a number.
  std::uint32_t suspects(const Real* values) const {
    switch (lanes_) {
      case 4: return suspects_of<4>(values);
      case 8: return suspects_of<8>(values);
      case 16: return suspects_of<16>(values);
      default: return suspects_of<1>(values);
    }
  }

  // Fills `unknown`, [row] of the program, for a lane.
  void find_unknown(const Real* values, int lane, std::vector<std::uint8_t>& unknown) const {
    unknown.assign(program_.instructions.size(), 0);
    for (std::size_t i = 0; i < program_.instructions.size(); ++i) {
      unknown[i] = std::isnan(value(values, static_cast<int>(i), lane)) ||
                   follows_from_unknown(values, lane, program_.instructions[i], unknown);
    }
  }

 private:
  template <int kLanes>
  std::uint32_t suspects_of(const Real* values) const {
    constexpr Real kMost = std::numeric_limits<Real>::max();
    std::array<std::uint8_t, kLanes> bad{};
    for (const int row : results_) {
      const Real* at = values + row * kLanes;
      for (std::size_t l = 0; l < kLanes; ++l) bad[l] |= !(std::abs(at[l]) <= kMost);
    }
    for (const int row : compared_) {
      const Real* at = values + row * kLanes;
      for (std::size_t l = 0; l < kLanes; ++l) bad[l] |= at[l] != at[l];
    }
    std::uint32_t lanes = 0;
    for (std::size_t l = 0; l < kLanes; ++l) lanes |= std::uint32_t{bad[l]} << l;
    return lanes;
  }

  Real value(const Real* values, int row, int lane) const {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(lanes_) +
                  static_cast<std::size_t>(lane)];
  }

  bool follows_from_unknown(const Real* values, int lane, const kernels::Instruction<double>& at,
                            const std::vector<std::uint8_t>& unknown) const {
    using kernels::Operation;
    const std::array<int, 3> of = operands_of(at);
    const auto is_unknown = [&](int row) { return unknown[static_cast<std::size_t>(row)] != 0; };
    const auto is_known = [&](int row, bool truth) {
      return !is_unknown(row) && (value(values, row, lane) != 0) == truth;
    };
    const auto any = [&] {
      return std::any_of(of.begin(), of.end(),
                         [&](int row) { return row >= 0 && is_unknown(row); });
    };
    switch (at.operation) {
      case Operation::both: return any() && !is_known(of[0], false) && !is_known(of[1], false);
      case Operation::either: return any() && !is_known(of[0], true) && !is_known(of[1], true);
      case Operation::choose:
        return is_unknown(of[0]) || is_unknown(value(values, of[0], lane) != 0 ? of[1] : of[2]);
      // Of two, one that is not a number is left out.
      case Operation::minimum:
      case Operation::maximum:
        return std::any_of(of.begin(), of.begin() + 2, [&](int row) {
          return is_unknown(row) && !std::isnan(value(values, row, lane));
        });
      default: return any();
    }
  }

  const Program& program_;
  std::vector<int> results_, compared_;
  int lanes_;
};

}  // namespace manyworlds
