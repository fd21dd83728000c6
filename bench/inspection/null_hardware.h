#pragma once

#include "bench/inspection/inspected.h"

#include <filesystem>

namespace tetrace {

/// Asks RADV on null hardware for each program of an AMD target, in a child process: a driver reads its environment
/// once, and one that does not support a family aborts. Rows that the child did not reach are errors, with its last
/// output; all are skipped if RADV is missing, or does not support the family.
/// points: a part of all_entry_points(Maker::amd). code: folder for the programs' texts; empty: they are not kept.
/// program: SPIR-V that replaces that of the entry points' one kernel; empty: nothing is replaced.
[[nodiscard]] std::vector<Inspected> ask_null_hardware(const Target& target, const std::vector<EntryPoint>& points,
                                                       const std::filesystem::path& code, const PartDone& tell,
                                                       const std::filesystem::path& program = {});

/// The first word of the child's command line; no verb of users.
inline constexpr const char* null_hardware_word = "compile-for-null-hardware";

/// The child: compiles the entry points with the numbers given, and writes a line of JSON each.
/// arguments: family, RADV's driver file, file to write, what the names of files for code begin with or "-", the
/// program or "-", then numbers in all_entry_points(Maker::amd). Returns the exit code.
[[nodiscard]] int run_null_hardware(const std::vector<std::string>& arguments);

} // namespace tetrace
