#pragma once

#include "bench/report/html/html.h"
#include "bench/report/report_rows.h"
#include "bench/results/result_comparison.h"

#include <vector>

namespace tetrace {

/// All input of a page.
struct ReportInput {
    std::vector<ResultFile> files;
    std::vector<ReportRow> rows; ///< of all files; they refer to `files`
    std::vector<std::filesystem::path> pictures;
    std::optional<ResultComparison> comparison; ///< of two results with samples that share work; refers to `files`
};

/// How two results with samples compare; empty for others, and if they share no work.
[[nodiscard]] std::optional<ResultComparison> comparison_of(const std::vector<ResultFile>& files);

/// The row's device, with its result's letter if there are several results.
[[nodiscard]] std::string device_text(const ReportRow& row, std::size_t files);

/// The series style (see svg.h) of a backend, the same in all charts; all unknown backends share the last one.
[[nodiscard]] std::size_t api_series(const std::string& backend);

/// Whether the row has a rate that is not to be relied on.
[[nodiscard]] inline bool is_noisy(const ReportRow& row)
{
    return row.rate && row.row->noisy;
}

/// Remarks on a row's rate: why it is flawed, and whether it is noisy; empty if neither.
[[nodiscard]] std::string remark_of(const ReportRow& row);

/// Leads to the row in a reason_table().
[[nodiscard]] Html row_link(const ReportRow& row, const Html& content);

/// Rows with their status and reason; rows with the same reason are grouped.
[[nodiscard]] Html reason_table(const std::vector<const ReportRow*>& rows, std::size_t files);

/// The answer, for the page's first screen: CDT and BVH compared, on GPUs first, and whether `check` found wrong rows.
/// Empty if the results have neither.
[[nodiscard]] Html headline(const ReportInput& input);

/// How two results compare, in one sentence, for the page's first screen; empty unless there are two with samples.
[[nodiscard]] Html comparison_summary(const ReportInput& input);

// The page's sections, in order; without content if the results have nothing for them. All throw Error{invalid_input}
// naming file and key where a result is not as results/README.md describes.

[[nodiscard]] Section comparison_section(const ReportInput& input);  ///< two results: B over A, row by row
[[nodiscard]] Section machine_section(const ReportInput& input);     ///< results, devices, scenes
[[nodiscard]] Section conformance_section(const ReportInput& input); ///< the matrix of `check`
[[nodiscard]] Section
compiler_section(const ReportInput& input);                   ///< what compilers reported to `inspect` for each kernel
[[nodiscard]] Section rate_section(const ReportInput& input); ///< bars per scene, and rows without a rate
[[nodiscard]] Section size_section(const ReportInput& input); ///< rates by size, of `bench` with several sizes
[[nodiscard]] Section thread_section(const ReportInput& input);   ///< the same of threads
[[nodiscard]] Section ratio_section(const ReportInput& input);    ///< APIs compared with each other
[[nodiscard]] Section roofline_section(const ReportInput& input); ///< every device with its rows
[[nodiscard]] Section time_section(const ReportInput& input);     ///< where each row's time goes
[[nodiscard]] Section paper_section(const ReportInput& input);    ///< tables and figures of `reproduce`
/// Also throws Error{missing} where a picture's file is missing.
[[nodiscard]] Section picture_section(const ReportInput& input);

} // namespace tetrace
