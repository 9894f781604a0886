// Program: the expressions of a task as instructions for a plan (kernels/data/program.hpp), in
// double. What several expressions have in common is worked out once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "manyworlds/observed.hpp"
#include "manyworlds/plan.hpp"
#include "manyworlds/task.hpp"
#include "src/task/node.hpp"

namespace manyworlds {

// What the host puts into a row of ProgramRun::input: a random number, or a number of the scene.
struct HostNumber {
  enum Kind { of_episode, of_step, parameter, level } kind = parameter;
  std::uint64_t stream = 0;  // of a random number
  std::uint64_t count = 0;   // which one of the stream; of a step, beside what its age says
  Parameter of = {};
  std::size_t item = 0;  // as Batch::read has the parameter, or the level's index
  bool operator==(const HostNumber&) const = default;
};

// Rows of ProgramRun::input: the actions, then these.
struct InputRows {
  int actions = 0;
  std::vector<HostNumber> numbers = {};
  std::vector<std::string> levels = {};  // their names
  int age() const { return actions; }
  int lost() const { return actions + 1; }
  int first_number() const { return actions + 2; }
  int count() const { return first_number() + static_cast<int>(numbers.size()); }
};

struct Program {
  // A function of the user's, worked out before instruction `at`, whose row it fills.
  struct Call {
    int at;
    std::shared_ptr<const LaneFunction> function;
    std::vector<int> in;  // rows
  };
  std::vector<kernels::Instruction<double>> instructions;
  std::vector<Call> calls;  // in the order of `at`

  bool asks(Observer observer) const {
    return std::any_of(instructions.begin(), instructions.end(), [observer](const auto& i) {
      return i.operation == kernels::Operation::seen && i.b == static_cast<int>(observer);
    });
  }
};

// What is remembered from step to step: number i is put down from row[i] of the program that looks
// at worlds after their steps.
struct MemoryRows {
  std::vector<int> row;
};

class ProgramBuilder {
 public:
  // `memory` of the program itself; of one that runs before the steps (`looks_back`) of the one
  // that ran after the last ones, which has everything that this one remembers.
  // Numbers of the host are added to `inputs`.
  ProgramBuilder(const Plan& plan, const Task& task, InputRows& inputs, MemoryRows& memory,
                 ProgramBuilder* looks_back = nullptr)
      : plan_(plan),
        task_(task),
        inputs_(inputs),
        memory_(memory),
        looks_back_(looks_back),
        named_(task.memories.size()) {}

  int add(const Expression& expression);  // its row
  // The number of a parameter's expression as Batch::read has it.
  HostNumber number_of(const Expression::Node& node) const;
  Program take() { return std::move(program_); }

 private:
  using Key = std::tuple<int, int, int, int, std::uint64_t>;
  // Of one of Task::memories: its number, and rows of what it begins with, what it was before the
  // step and what it is after it; -1: not yet.
  struct Named {
    int number = -1, begin = -1, before = -1, after = -1;
  };

  int add_node(const Expression::Node& node);
  int add_function(const Expression::Node& node);
  int add_observed(const Expression::Node& node);
  int add_coordinate(Field field, int item);
  int add_parameter(const Expression::Node& node);
  int add_level(const std::string& name);
  int add_memory(const std::string& name);
  int add_previous(const Expression& value);
  int add_accumulated(const Expression::Node& node);
  int add_number(const HostNumber& number);
  int emit(kernels::Operation operation, int a = -1, int b = -1, int c = -1, double number = 0);
  int remember(int row);
  // In terms of what the kernels have.
  Expression position(int body, int axis) const;
  Expression velocity(int body, int axis) const;
  Expression angular_velocity(int body, int axis) const;
  Expression angle(int body) const;
  Expression direction(int body, int of, int axis) const;
  Expression state(int body, int component) const;

  const Plan& plan_;
  const Task& task_;
  InputRows& inputs_;
  MemoryRows& memory_;
  ProgramBuilder* looks_back_;
  std::vector<Named> named_;  // [memory]
  bool updates_ = false;      // what is added is of a `next`, where memories are as before the step
  Program program_;
  std::map<Key, int> same_;
  std::unordered_map<const Expression::Node*, int> known_[2];  // [updates_]
  std::vector<Expression> kept_;  // so that what `known_` points to stays
};

}  // namespace manyworlds
