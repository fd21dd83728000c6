#pragma once

#include "bench/report/sections.h"

namespace tetrace {

/// The whole page, self-contained: it has no script and loads nothing, which its content security policy enforces.
/// Throws as the sections do.
[[nodiscard]] std::string report_page(const ReportInput& input);

/// Reads the results. Throws as read_result() and report_rows() do.
[[nodiscard]] ReportInput read_report_input(const std::vector<std::filesystem::path>& results,
                                            std::vector<std::filesystem::path> pictures);

} // namespace tetrace
