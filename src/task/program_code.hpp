// ProgramCode: a Program in a batch's number type, and how it is run for a group of worlds.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "src/step/group_visitor.hpp"
#include "src/task/program.hpp"

namespace manyworlds {

template <class Real>
class ProgramCode {
 public:
  explicit ProgramCode(const Program& program) : calls_(program.calls) {
    for (const auto& i : program.instructions) {
      code_.push_back({i.operation, i.a, i.b, i.c, static_cast<Real>(i.number)});
    }
  }
  std::size_t rows() const { return code_.size(); }

  // `run`: rows of inputs, memory and values, which it fills; `in` has room for what a call takes.
  void run(const VisitedGroup<Real>& g, int lanes, kernels::ProgramRun<Real> run,
           std::vector<const Real*>& in) const {
    const auto row = [lanes](int i) {
      return static_cast<std::size_t>(i) * static_cast<std::size_t>(lanes);
    };
    run.instruction = code_.data();
    run.begin = 0;
    const auto run_to = [&](int end) {
      run.end = end;
      g.kernels.observer->run_program(g.view, g.seen, run);
    };
    for (const Program::Call& call : calls_) {
      run_to(call.at);
      in.clear();
      for (const int i : call.in) in.push_back(run.value + row(i));
      (*call.function)(lanes, std::span<const Real* const>(in), run.value + row(call.at));
      run.begin = call.at + 1;
    }
    run_to(static_cast<int>(code_.size()));
  }

 private:
  std::vector<kernels::Instruction<Real>> code_;
  const std::vector<Program::Call>& calls_;
};

}  // namespace manyworlds
