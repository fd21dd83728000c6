#include "bench/output/junit.h"

#include "bench/measuring/conformity.h"
#include "bench/output/check_differences.h"
#include "bench/terminal/text.h"
#include "core/base/hash.h"

#include <fmt/format.h>

namespace tetrace {

namespace {

enum class CaseOutcome { passed, failed, error, skipped };

CaseOutcome outcome_of(const RowRun& row, bool failed)
{
    switch (conformity_of(row)) {
    case Conformity::error: return CaseOutcome::error;
    case Conformity::unsupported:
    case Conformity::skipped: return CaseOutcome::skipped;
    default: return failed ? CaseOutcome::failed : CaseOutcome::passed;
    }
}

std::string reason_text(const RowRun& row)
{
    const std::string reason = reason_of(row);
    return conformity_text(row) + (reason.empty() ? "" : ": " + reason);
}

std::string outcome_xml(const RowRun& row, CaseOutcome outcome)
{
    const std::string reason = xml_text(reason_text(row));
    switch (outcome) {
    case CaseOutcome::passed: return {};
    case CaseOutcome::skipped: return fmt::format("      <skipped message=\"{}\"/>\n", reason);
    case CaseOutcome::error: return fmt::format("      <error message=\"{}\"/>\n", reason);
    case CaseOutcome::failed:
        return fmt::format("      <failure message=\"{}\">{}</failure>\n", reason, xml_text(differences_text(row)));
    }
    return {};
}

std::string property_xml(const char* name, const std::string& value)
{
    return fmt::format("        <property name=\"{}\" value=\"{}\"/>\n", name, xml_text(value));
}

std::string properties_xml(const RowRun& row)
{
    std::string text = property_xml("conformity", conformity_text(row));
    if (const Traced* result = traced(row)) text += property_xml("hit_hash", hash_text(result->hit_hash));
    if (row.self_test) text += property_xml("self_test", row.self_test->text());
    if (!row.device.driver.empty()) text += property_xml("driver", row.device.driver);
    return "      <properties>\n" + text + "      </properties>\n";
}

std::string case_xml(const RowRun& row, CaseOutcome outcome)
{
    const Traced* result = traced(row);
    const std::string device = device_label(row.key) + (row.device.name.empty() ? "" : " " + row.device.name);
    return fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.6f}\">\n{}{}    </testcase>\n",
                       xml_text(device), xml_text(row_name(row.key)), result ? result->wall_s : 0.0,
                       properties_xml(row), outcome_xml(row, outcome));
}

struct Suite {
    std::string scene, cases;
    int tests = 0, failures = 0, errors = 0, skipped = 0;
    double time_s = 0;

    void add(const RowRun& row, bool failed)
    {
        const CaseOutcome outcome = outcome_of(row, failed);
        cases += case_xml(row, outcome);
        ++tests;
        failures += outcome == CaseOutcome::failed;
        errors += outcome == CaseOutcome::error;
        skipped += outcome == CaseOutcome::skipped;
        if (const Traced* result = traced(row)) time_s += result->wall_s;
    }

    void add_problem(const std::string& problem)
    {
        cases += fmt::format("    <testcase classname=\"tetrace.check\" name=\"has a result\">\n"
                             "      <error message=\"{}\"/>\n    </testcase>\n",
                             xml_text(problem));
        ++tests;
        ++errors;
    }

    [[nodiscard]] std::string xml() const
    {
        return fmt::format("  <testsuite name=\"tetrace check{}{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" "
                           "skipped=\"{}\" time=\"{:.6f}\">\n{}  </testsuite>\n",
                           scene.empty() ? "" : " ", xml_text(scene), tests, failures, errors, skipped, time_s, cases);
    }
};

} // namespace

std::string junit_xml(const std::vector<RowRun>& rows, const std::vector<bool>& failed, const std::string& problem)
{
    std::vector<Suite> suites;
    if (!problem.empty()) suites.emplace_back().add_problem(problem);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (suites.empty() || suites.back().scene != rows[i].key.scene) suites.emplace_back().scene = rows[i].key.scene;
        suites.back().add(rows[i], failed[i]);
    }
    Suite sum;
    std::string text;
    for (const Suite& suite : suites) {
        sum.tests += suite.tests;
        sum.failures += suite.failures;
        sum.errors += suite.errors;
        sum.skipped += suite.skipped;
        text += suite.xml();
    }
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"tetrace check\" tests=\"{}\" "
                       "failures=\"{}\" errors=\"{}\" skipped=\"{}\">\n{}</testsuites>\n",
                       sum.tests, sum.failures, sum.errors, sum.skipped, text);
}

} // namespace tetrace
