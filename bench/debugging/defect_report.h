#pragma once

#include "bench/debugging/defect_run.h"
#include "bench/output/report.h"

#include <string>
#include <vector>

namespace tetrace {

/// Drivers against defects: a line a device, a column a defect; what each defect is, and the first wrong word of each
/// that was seen. missing: sentences on backends without a device.
[[nodiscard]] Report defect_report(const std::vector<DefectRun>& runs, const std::vector<std::string>& missing,
                                   const Options& options);

/// One suite, a test case for each device and defect, which fails where the defect is seen. problem: as in junit_xml().
[[nodiscard]] std::string defect_junit(const std::vector<DefectRun>& runs, const std::string& problem = {});

} // namespace tetrace
