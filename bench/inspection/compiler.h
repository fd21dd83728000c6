#pragma once

#include "scenes/child_process.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tetrace {

/// The program of that name along PATH, else in the folders; empty if there is none.
[[nodiscard]] std::filesystem::path find_compiler(const char* name, const std::vector<std::filesystem::path>& folders);

/// Ended after 5 minutes at the latest. Throws Error{interrupted} if the user ends the run.
[[nodiscard]] ChildOutcome run_compiler(const std::filesystem::path& program,
                                        const std::vector<std::string>& arguments);

[[nodiscard]] bool succeeded(const ChildOutcome& outcome);

/// Of a compiler's messages: printable, and cut.
[[nodiscard]] std::string first_line(const std::string& text);

} // namespace tetrace
