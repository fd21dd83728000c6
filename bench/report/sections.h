#pragma once

#include "bench/report/html/html_table.h"
#include "bench/report/report_rows.h"

#include <vector>

namespace tetrace {

/// All that a page is made of.
struct ReportInput {
    std::vector<ResultFile> files;
    std::vector<ReportRow> rows; ///< of all files; they refer to `files`
    std::vector<std::filesystem::path> pictures;
};

/// The row's device, with its result's letter where there are several.
[[nodiscard]] std::string device_text(const ReportRow& row, std::size_t files);

/// The series style (see svg.h) of a backend, the same in all charts; all that are not known share the last one.
[[nodiscard]] std::size_t api_series(const std::string& backend);

/// Rows with their status and reason, those with one reason together.
[[nodiscard]] Html reason_table(const std::vector<const ReportRow*>& rows, std::size_t files);

// The page's parts, in their order. One for which the results hold nothing says so in a sentence, and what would bring
// it. All throw Error{invalid_input} naming file and key where a result is not as results/README.md has it.

[[nodiscard]] Section machine_section(const ReportInput& input);     ///< results, devices, scenes
[[nodiscard]] Section conformance_section(const ReportInput& input); ///< the matrix of `check`
[[nodiscard]] Section rate_section(const ReportInput& input);        ///< bars per scene, and rows without a rate
[[nodiscard]] Section ratio_section(const ReportInput& input);       ///< APIs beside each other
[[nodiscard]] Section roofline_section(const ReportInput& input);    ///< every device with its rows
[[nodiscard]] Section time_section(const ReportInput& input);        ///< where each row's time goes
[[nodiscard]] Section paper_section(const ReportInput& input);       ///< tables and figures of `reproduce`
/// Also throws Error{missing} for a picture that is not there.
[[nodiscard]] Section picture_section(const ReportInput& input);

} // namespace tetrace
