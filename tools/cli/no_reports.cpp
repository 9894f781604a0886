// `manyworlds report` in a program without reports (MW_REPORT=OFF).
#include "commands.hpp"
#include "not_built.hpp"

namespace manyworlds::cli {
namespace {

[[noreturn]] void no_report(const char* name) {
  throw not_built(std::string("report ") + name, "reports", "MW_REPORT=ON");
}

}  // namespace

int report_accuracy_command(const ReportOptions&) { no_report("accuracy"); }
int report_stability_command(const ReportOptions&) { no_report("stability"); }
int report_invariants_command(const ReportOptions&) { no_report("invariants"); }
int report_plan_command(const ReportOptions&) { no_report("plan"); }
int report_throughput_command(const ReportOptions&) { no_report("throughput"); }

}  // namespace manyworlds::cli
