// The families of random scenes, which the program of a wheel is too small to hold.
#include "options.hpp"
#include "tools/invariants/family.hpp"

namespace manyworlds::invariants {
namespace {

[[noreturn]] void not_here() {
  throw cli::InputError(
      "report invariants: the program of a wheel was built without families of random scenes; "
      "'tools/run report invariants' in the repository has them");
}

}  // namespace

std::vector<Family> families() { not_here(); }
Outcome run(const Family&, const RunOptions&) { not_here(); }
Drawn draw_world(const Family&, const RunOptions&, int) { not_here(); }
Batch batch_of(const Family&, const RunOptions&, int) { not_here(); }
std::vector<double> values_of(const Family&, const RunOptions&, int) { not_here(); }

}  // namespace manyworlds::invariants
