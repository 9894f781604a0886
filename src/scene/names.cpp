// Names of a scene's and a plan's enumerations, as people type and read them.
#include "src/base/enum_names.hpp"

namespace manyworlds {

const char* to_string(Feature feature) { return name_of(feature); }
const char* to_string(BroadPhase broad_phase) { return name_of(broad_phase); }
const char* to_string(Integrator integrator) { return name_of(integrator); }
const char* to_string(Rotation rotation) { return name_of(rotation); }
const char* to_string(Solver solver) { return name_of(solver); }
const char* to_string(JointMethod method) { return name_of(method); }
const char* to_string(FrictionCone cone) { return name_of(cone); }

bool has_hard_rows(Solver solver) {
  return solver != Solver::tgs_soft && solver != Solver::penalty && solver != Solver::newton;
}
int iterations_of(const SolverOptions& solver) {
  return solver.iterations.value_or(solver.method == Solver::newton ? 100
                                    : has_hard_rows(solver.method)  ? 10
                                                                    : 1);
}

}  // namespace manyworlds
