// Program: what a task works out for each world after its steps, as a list of instructions over
// registers. Each instruction leaves one number per lane in the row of its own index; operands are
// rows of instructions before it. src/task makes programs and owns their rows.
#pragma once

#include <cstdint>

#include "kernels/data/group.hpp"

namespace manyworlds::kernels {

template <class Real>
struct ObserverView;  // kernels/data/observer.hpp

// a, b, c: operands, or as said.
enum class Operation : std::int32_t {
  // of the world
  constant,  // number
  state,     // a: row of GroupView::state
  control,   // a: row of GroupView::control
  seen,      // a: row of ObserverView::rows[b]; what a step makes is 0 where an episode begins
  input,     // a: row of ProgramRun::input
  // of what was before in the episode; b: row of ProgramRun::memory, which the owner puts down anew
  previous,  // a of the step before; a itself at the beginning
  held,      // steps in a row at whose end a was not 0; 0 at the beginning
  largest,   // of a since the beginning
  latched,   // 1 once a was not 0, the beginning included
  summed,    // of a over the steps; 0 at the beginning
  smoothed,  // moves towards a by c times the difference; a at the beginning
  phase,     // grows by a in each step, within 0 and 1; 0 at the beginning
  // of the beginning alone
  begins,  // a at the beginning, else b
  // arithmetic; truth is 1, and what is not 0
  add,
  subtract,
  multiply,
  divide,
  negate,
  absolute,
  square_root,
  minimum,
  maximum,
  round_down,
  sine,         // of up to 1e5 rad
  cosine,       // of up to 1e5 rad
  arc_tangent,  // the angle of (b, a), -pi to pi
  exponential,
  logarithm,  // natural
  power,      // a to the power of b
  hyperbolic_tangent,
  arc_cosine,  // 0 to pi
  remainder,   // of a by b, with the sign of b
  sign,
  less,
  less_equal,
  equal,
  both,
  either,
  opposite,
  choose,  // b where a, else c
};

template <class Real>
struct Instruction {
  Operation operation;
  std::int32_t a, b, c;
  Real number;
};

template <class Real>
struct ProgramRun {
  const Instruction<Real>* instruction;
  std::int32_t begin, end;  // those to run
  const Real* input;        // [input][lane]
  const Real* memory;       // [number that is remembered][lane]
  Real* value;              // [instruction][lane]
  bool beginning;           // of an episode: nothing was before
};

// `seen` may be null where the program asks for nothing of it.
template <class Real>
using RunProgram = void (*)(const GroupView<Real>&, const ObserverView<Real>* seen,
                            const ProgramRun<Real>&);

}  // namespace manyworlds::kernels
