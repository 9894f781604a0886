// Runs a program for the worlds of a group.
#include "kernels/data/program.hpp"

#include "kernels/lane/logarithm.hpp"
#include "kernels/lane/solve.hpp"
#include "kernels/observe/observe.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

// Not a number beyond -1 to 1.
MW_INLINE Float arc_cosine(Float x) {
  const Float one(Real(1));
  const Mask inside = abs(x) <= one;
  const Float angle = arc_tangent(sqrt((one - x) * (one + x)), x);
  return select(inside, angle, Float(Real(0)) / Float(Real(0)));
}

}  // namespace

void run_program(const Group& g, const ObserverView* seen, const kernels::ProgramRun<Real>& run) {
  using kernels::Operation;
  const Float zero(Real(0)), one(Real(1));
  const auto row = [](const Real* rows, int i) { return Float::load(rows + i * kLanes); };
  const auto truth = [&](Mask m) { return select(m, one, zero); };
  const auto holds = [&](Float x) { return !(x == zero); };
  for (int i = run.begin; i < run.end; ++i) {
    const kernels::Instruction<Real>& at = run.instruction[i];
    const auto a = [&] { return row(run.value, at.a); };
    const auto b = [&] { return row(run.value, at.b); };
    const auto c = [&] { return row(run.value, at.c); };
    const auto evaluate = [&]() -> Float {
      switch (at.operation) {
        case Operation::constant: return at.number;
        case Operation::state: return row(g.state, at.a);
        case Operation::control: return row(g.control, at.a);
        case Operation::seen:
          return run.beginning && kObserverInfo[at.b].of == ObservedOf::step
                     ? zero
                     : row(seen->rows[at.b], at.a);
        case Operation::input: return row(run.input, at.a);
        case Operation::previous: return run.beginning ? a() : row(run.memory, at.b);
        case Operation::held:
          return run.beginning ? zero : select(holds(a()), row(run.memory, at.b) + one, zero);
        case Operation::largest: return run.beginning ? a() : max(row(run.memory, at.b), a());
        case Operation::latched:
          return truth(run.beginning ? holds(a()) : holds(a()) | holds(row(run.memory, at.b)));
        case Operation::summed: return run.beginning ? zero : row(run.memory, at.b) + a();
        case Operation::smoothed:
          return run.beginning ? a() : row(run.memory, at.b) + c() * (a() - row(run.memory, at.b));
        case Operation::phase:
          return run.beginning ? zero : modulo(row(run.memory, at.b) + a(), one);
        case Operation::begins: return run.beginning ? a() : b();
        case Operation::add: return a() + b();
        case Operation::subtract: return a() - b();
        case Operation::multiply: return a() * b();
        case Operation::divide: return a() / b();
        case Operation::negate: return -a();
        case Operation::absolute: return abs(a());
        case Operation::square_root: return sqrt(a());
        case Operation::minimum: return min(a(), b());
        case Operation::maximum: return max(a(), b());
        case Operation::round_down: return round_down(a());
        case Operation::sine: return sine_and_cosine(a()).sine;
        case Operation::cosine: return sine_and_cosine(a()).cosine;
        case Operation::arc_tangent: return arc_tangent(a(), b());
        case Operation::exponential: return exponential(a());
        case Operation::logarithm: return logarithm(a());
        case Operation::power: return power(a(), b());
        case Operation::hyperbolic_tangent: return hyperbolic_tangent(a());
        case Operation::arc_cosine: return arc_cosine(a());
        case Operation::remainder: return modulo(a(), b());
        case Operation::sign: return sign(a());
        case Operation::less: return truth(a() < b());
        case Operation::less_equal: return truth(a() <= b());
        case Operation::equal: return truth(a() == b());
        case Operation::both: return truth(holds(a()) & holds(b()));
        case Operation::either: return truth(holds(a()) | holds(b()));
        case Operation::opposite: return truth(!holds(a()));
        case Operation::choose: return select(holds(a()), b(), c());
      }
      return zero;
    };
    evaluate().store(run.value + i * kLanes);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
