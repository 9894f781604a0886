// What is wrong with a task, and with an expression that is evaluated beside it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "manyworlds/plan.hpp"
#include "manyworlds/task.hpp"

namespace manyworlds {

// "observation 3 'lean'", as issues name it.
std::string place_of(const char* what, std::size_t index, const std::string& name);

// Adds issues of an expression by itself, not of its operands. `plan`: of the task's scene, null if
// the scene has issues.
void check_term(const Task& task, const Plan* plan, const std::string& place,
                const Expression& term, std::vector<Issue>& issues);

// Of a task that has no issues, and its plan.
std::vector<Issue> check_expression(const Task& task, const Plan& plan,
                                    const Expression& expression, const std::string& place);

}  // namespace manyworlds
