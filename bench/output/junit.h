#pragma once

#include "bench/rows/row_run.h"

#include <string>
#include <vector>

namespace tetrace {

/// The rows of `tetrace check` as JUnit XML, as Jenkins, GitLab and GitHub read it: a test suite a scene, a test case a
/// row, whose class is the device. failed: whether the row fails the check (a method's own flaws may pass).
/// Rows that are wrong have a failure, errors an error, unsupported and skipped ones a skipped element, with the
/// reason; hashes, cells and self-tests are properties.
[[nodiscard]] std::string junit_xml(const std::vector<RowRun>& rows, const std::vector<bool>& failed);

} // namespace tetrace
