// Which bodies have a form, or a spread of mass over it, that may vary.
#pragma once

#include "src/plan/plan_data.hpp"

namespace manyworlds {

bool may_be_reshaped(const PlanData& plan, int scene_body);

}  // namespace manyworlds
