#pragma once

#include "bench/expectations/judgement.h"
#include "bench/rows/row_record.h"

#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// How a test case ended.
enum class CaseOutcome { passed, failed, error, skipped };

/// A test case that is not a row. The device's label and driver become properties of the suite.
struct JunitCase {
    std::string backend, label, device, driver;
    std::string name;
    CaseOutcome outcome = CaseOutcome::passed;
    std::string reason; ///< where it did not pass
    double time_s = 0;
    std::string output = {};  ///< of the test; empty: none
    std::string library = {}; ///< of the driver; becomes a property, too
};

/// The rows of `tetrace check`, or of another verb, as JUnit XML, valid by the schema of Jenkins' xUnit plugin
/// (junit-10.xsd), which GitLab and GitHub read too: one test suite per scene, one test case per row. The test case's
/// class is API and device without any version, "tetrace.vulkan.llvmpipe"; versions and self-tests are properties of
/// the suite, by device. judgement: of these rows; what it fails has a failure element, or an error element if the row
/// is an error, each with its reason. Known failures and flakes pass, and the test's output names them, after cell and
/// hash. Other rows that are unsupported or skipped have a skipped element. With expectations, each device that they
/// mention has a test case "self_test". problem: why the check itself failed; it becomes a test case of its own, in
/// error; none if it is empty.
[[nodiscard]] std::string junit_xml(const std::vector<RowRecord>& rows, const CheckJudgement& judgement,
                                    const std::string& problem = {}, std::string_view verb = "check");

/// The same of one suite of other test cases: "tetrace check <suite>".
[[nodiscard]] std::string junit_suite(const std::string& suite, const std::vector<JunitCase>& cases,
                                      const std::string& problem = {}, std::string_view verb = "check");

} // namespace tetrace
