#pragma once

#include "bench/options/options.h"

#include <string>
#include <vector>

namespace tetrace {

// One function for each verb. Returns the exit code; throws Error where the verb ends early.
int devices_command(const Options& options);
int scenes_command(const Options& options);
int build_command(const Options& options);
int bench_command(const Options& options);
int check_command(const Options& options);
int render_command(const Options& options);
int reproduce_command(const Options& options);
int inspect_command(const Options& options);
int trace_command(const Options& options);
int dump_command(const Options& options);
int compare_command(const Options& options);
int show_command(const Options& options);
int report_command(const Options& options);

/// `check --defects`. options: with the default layouts of check.
int check_defects(const Options& options);

/// Throws Error{missing} naming the first backend of the list that has no usable device, with the reason.
void require_devices(const std::vector<std::string>& backends);

/// The command line that run_program() was given, with one more option unless it has that, as a shell takes it.
[[nodiscard]] std::string command_with(const std::string& option);

/// Runs the program on a command line without its name; prints errors; returns the exit code.
int run_program(const std::vector<std::string>& arguments);

} // namespace tetrace
