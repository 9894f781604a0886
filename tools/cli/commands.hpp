// The subcommands. Each takes parsed options, writes its result to standard output and everything
// else to standard error, and returns an exit code. They throw InputError, SceneError and
// std::invalid_argument for input that cannot be used, before anything is written.
#pragma once

#include "options.hpp"

namespace manyworlds::cli {

int scenes_command(bool json);
int run_command(const JobOptions& options);
int plan_command(const JobOptions& options);
int model_command(const JobOptions& options);
int bench_command(const BenchOptions& options);
int verify_command(const VerifyOptions& options);
int compare_command(const CompareOptions& options);
int soak_command(const JobOptions& options);
int replay_command(const ReplayArguments& arguments);
int view_command(const ViewArguments& arguments);  // with --live, live_command
int live_command(const ViewArguments& arguments);
int report_accuracy_command(const ReportOptions& options);
int report_stability_command(const ReportOptions& options);
int report_invariants_command(const ReportOptions& options);  // with --world, invariant_world()
int report_plan_command(const ReportOptions& options);
int report_throughput_command(const ReportOptions& options);
int report_page_command(const ReportPageOptions& options);
int info_command(bool json);
int list_options_command(bool json);  // those of a scene, for --set

}  // namespace manyworlds::cli
