// `manyworlds report invariants --world`: one world of a family, recorded.
#pragma once

#include "options.hpp"
#include "tools/report/invariants.hpp"

namespace manyworlds::cli {

// As a subcommand (commands.hpp). `what` is the family, the seed, the units and the precision.
int invariant_world(const report::InvariantsOptions& what, const ReportOptions& options);

}  // namespace manyworlds::cli
