#pragma once

#include "bench/debugging/defect_run.h"
#include "bench/output/report.h"
#include "bench/results/result_value.h"

#include <string>
#include <vector>

namespace tetrace {

/// Defects for people, and every run flat.
struct ShownDefects {
    Sheet sheet;
    Table table;
};

/// What `check --defects` prints, and `show` prints again. section: of its result. Throws Error{invalid_input} naming
/// the key that is missing or of another kind.
[[nodiscard]] ShownDefects shown_defects(const ResultValue& section);

/// Drivers against defects: a line a device, a column a defect; what each defect is, and the first wrong word of each
/// that was seen. missing: sentences on backends without a device.
[[nodiscard]] Report defect_report(const std::vector<DefectRun>& runs, const std::vector<std::string>& missing,
                                   const Options& options);

/// One suite, a test case for each device and defect, which fails where the defect is seen. problem: as in junit_xml().
[[nodiscard]] std::string defect_junit(const std::vector<DefectRun>& runs, const std::string& problem = {});

} // namespace tetrace
