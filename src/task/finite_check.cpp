#include "src/task/finite_check.hpp"

#include <algorithm>

namespace manyworlds {

using kernels::Operation;

std::array<int, 3> operands_of(const kernels::Instruction<double>& at) {
  switch (at.operation) {
    case Operation::constant:
    case Operation::state:
    case Operation::control:
    case Operation::seen:
    case Operation::input:
    case Operation::previous: return {-1, -1, -1};  // of the step before
    case Operation::held:
    case Operation::largest:
    case Operation::latched:
    case Operation::summed:
    case Operation::phase: return {at.a, -1, -1};
    case Operation::smoothed: return {at.a, at.c, -1};
    case Operation::begins: return {at.b, -1, -1};  // after steps
    default: return {at.a, at.b, at.c};
  }
}

namespace {

// How many of its operands an instruction compares or takes as truths.
std::size_t compared_by(Operation operation) {
  switch (operation) {
    case Operation::less:
    case Operation::less_equal:
    case Operation::equal:
    case Operation::both:
    case Operation::either: return 2;
    case Operation::opposite:
    case Operation::choose:
    case Operation::held:
    case Operation::latched: return 1;
    default: return 0;
  }
}

}  // namespace

std::vector<int> compared_rows(const Program& program, std::span<const int> ends) {
  std::vector<std::uint8_t> reached(program.instructions.size(), 0);
  std::vector<int> out;
  for (const int row : ends) reached[static_cast<std::size_t>(row)] = 1;
  for (std::size_t i = reached.size(); i-- > 0;) {  // operands come before what takes them
    if (!reached[i]) continue;
    const auto& at = program.instructions[i];
    const std::array<int, 3> of = operands_of(at);
    for (std::size_t k = 0; k < of.size() && of[k] >= 0; ++k) {
      reached[static_cast<std::size_t>(of[k])] = 1;
      if (k < compared_by(at.operation)) out.push_back(of[k]);
    }
  }
  // Truths are numbers: only what they compare may not be one.
  std::erase_if(out, [&](int row) {
    const Operation of = program.instructions[static_cast<std::size_t>(row)].operation;
    return of == Operation::constant ||
           (compared_by(of) > 0 && of != Operation::choose && of != Operation::held);
  });
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace manyworlds
