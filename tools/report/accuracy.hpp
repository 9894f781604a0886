// `manyworlds report accuracy`: error against run time of cases whose solution is known. A case is
// a scene, a reference, and what counts as the error; it is run by several methods (integrators,
// substeps) with steps of several lengths, once for the error and once more for the time.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "manyworlds/batch.hpp"

namespace manyworlds::report {

struct Method {
  std::string name;
  std::function<void(Options&)> choose;
};

// What another engine is known to reach; not measured here.
struct Published {
  std::string engine;
  double step = 0;                                            // s
  double error = 0;                                           // in the unit of the case
  double seconds = std::numeric_limits<double>::quiet_NaN();  // of wall time, on its machine
};

enum class Over { end, largest, mean };  // of the errors after each step

struct Case {
  std::string id, title;
  std::string metric, unit;  // of the error
  double level = 0;          // the error for which the run time is asked
  double seconds = 0;        // simulated
  double quick_seconds = 0;
  std::vector<double> steps, quick_steps;  // s
  std::vector<Method> methods;
  std::function<Scene()> scene;
  std::function<void(Batch&)> before_step = {};  // before each step
  std::vector<Observer> observe = {};            // what the error asks for
  // Error of world 0 at t s; called after each step, or after the last only.
  std::function<double(const Batch&, double)> error;
  Over over = Over::end;
  std::vector<Published> published = {};
};

// All of the report, in the order in which it is shown.
std::vector<Case> accuracy_cases();
std::vector<Case> free_cases();     // A1 to A5
std::vector<Case> joint_cases();    // A6 to A11
std::vector<Case> contact_cases();  // A15 to A22
std::vector<Case> robot_cases();    // A23 to A27

std::vector<Method> all_integrators();
// The default integrator with these numbers of substeps.
std::vector<Method> substeps(const std::vector<int>& counts);
// One substep of each of the other solvers; split impulses are for contacts.
std::vector<Method> other_solvers(bool contacts);
// first, first / 2, ... (count of them)
std::vector<double> halvings(double first, int count);

struct Point {
  std::string method;
  Precision precision = Precision::f64;
  double step = 0;          // s
  double error = 0;         // infinite where the world was lost
  double microseconds = 0;  // of wall time per world, for the whole run
  double steps_per_s = 0;   // of a world, one thread
};
struct CaseResult {
  Case of;
  double seconds = 0;
  std::vector<Point> points;
  // The cheapest point of each method and precision that reaches the level.
  std::vector<Point> reached() const;
};

struct AccuracyOptions {
  std::vector<std::string> cases;  // ids; empty: all
  bool quick = false;
  std::vector<Precision> precisions = {Precision::f32, Precision::f64};
};

// `tell` is called before each point with what comes next and the share that is done.
std::vector<CaseResult> run_accuracy(const AccuracyOptions& options,
                                     const std::function<void(const std::string&, double)>& tell);

nlohmann::ordered_json to_json(const std::vector<CaseResult>& results);

}  // namespace manyworlds::report
