#pragma once

#include "bench/rows/row_run.h"

#include <string>
#include <vector>

namespace tetrace {

/// The rows of `tetrace check` as JUnit XML, as Jenkins, GitLab and GitHub read it: one test suite per scene, one test
/// case per row; the test case's class is the device. failed: whether the row fails the check (a method's own flaws may
/// pass).
/// Wrong rows have a failure element, errors an error element, unsupported and skipped rows a skipped element, each
/// with its reason. Hashes, cells and self-tests are properties. problem: why the check itself failed; it becomes a test
/// case of its own, in error; none where it is empty.
[[nodiscard]] std::string junit_xml(const std::vector<RowRun>& rows, const std::vector<bool>& failed,
                                    const std::string& problem = {});

} // namespace tetrace
