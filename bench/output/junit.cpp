#include "bench/output/junit.h"

#include "bench/measuring/conformity.h"
#include "bench/options/identity.h"
#include "bench/output/check_matrix.h"
#include "bench/terminal/text.h"
#include "core/base/hash.h"

#include <cctype>
#include <fmt/format.h>
#include <map>

namespace tetrace {

namespace {

CaseOutcome outcome_of(const RowRecord& row, const Judged& judged)
{
    const Conformity conformity = conformity_of(row);
    if (fails(judged.judgement)) return conformity == Conformity::error ? CaseOutcome::error : CaseOutcome::failed;
    const bool has_answer = conformity != Conformity::unsupported && conformity != Conformity::skipped;
    return has_answer ? CaseOutcome::passed : CaseOutcome::skipped;
}

/// has_expectations: whether another result could have been expected.
std::string reason_text(const RowRecord& row, const Judged& judged, bool has_expectations)
{
    const std::string reason = reason_of(row);
    const std::string text = conformity_text(row) + (reason.empty() ? "" : ": " + reason);
    return has_expectations && fails(judged.judgement) ? judged.text() + "; " + text : text;
}

/// details: of a failure.
std::string outcome_xml(CaseOutcome outcome, const std::string& message, const std::string& details)
{
    const std::string reason = xml_text(message);
    switch (outcome) {
    case CaseOutcome::passed: return {};
    case CaseOutcome::skipped: return fmt::format("      <skipped message=\"{}\"/>\n", reason);
    case CaseOutcome::error: return fmt::format("      <error message=\"{}\"/>\n", reason);
    case CaseOutcome::failed:
        return fmt::format("      <failure message=\"{}\">{}</failure>\n", reason, xml_text(details));
    }
    return {};
}

/// A device's name as a part of a class name, without what changes with the driver or the machine's memory: what stands
/// in brackets goes, and a dash replaces what is neither letter nor digit. "llvmpipe (LLVM 15.0.6, 256 bits)" becomes
/// "llvmpipe".
std::string stable_name(const std::string& device)
{
    std::string name;
    int depth = 0;
    for (const char c : device) {
        depth += c == '(';
        const bool kept = depth == 0 && std::isalnum(static_cast<unsigned char>(c)) != 0;
        if (kept)
            name += c;
        else if (!name.empty() && name.back() != '-')
            name += '-';
        depth -= c == ')' && depth > 0;
    }
    name.erase(name.find_last_not_of('-') + 1);
    return name;
}

/// CI systems keep a test's history by class and name: both stay the same from one driver to the next.
std::string class_name(const std::string& backend, const std::string& device_name)
{
    const std::string device = stable_name(device_name);
    return fmt::format("tetrace.{}{}{}", backend, device.empty() ? "" : ".", device);
}

std::string output_xml(const std::string& text)
{
    return text.empty() ? text : fmt::format("      <system-out>{}</system-out>\n", xml_text(text));
}

std::string output_xml(const RowRecord& row, const Judged& judged)
{
    std::string text = "conformity: " + conformity_text(row);
    if (judged.judgement == Judgement::known_failure || judged.judgement == Judgement::known_flake)
        text += "\n" + judged.text();
    if (status_of(row) == Status::flawed) text += fmt::format("\n{}: {}", name_of(Status::flawed), reason_of(row));
    const Traced* result = traced(row);
    if (result != nullptr && result->hit_hash != 0) text += "\nhit_hash: " + hash_text(result->hit_hash);
    return output_xml(text);
}

std::string case_xml(const std::string& class_name, const std::string& name, double time_s, const std::string& parts)
{
    return fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.6f}\">\n{}    </testcase>\n",
                       xml_text(class_name), xml_text(name), time_s, parts);
}

std::string case_xml(const RowRecord& row, const Judged& judged, bool has_expectations)
{
    const CaseOutcome outcome = outcome_of(row, judged);
    const Traced* result = traced(row);
    const std::string details = outcome == CaseOutcome::failed ? differences_text(row) : std::string();
    return case_xml(class_name(row.key.backend, row.device.name), row_name(row.key), result ? result->wall_s : 0.0,
                    outcome_xml(outcome, reason_text(row, judged, has_expectations), details) +
                        output_xml(row, judged));
}

struct Suite {
    std::string_view verb;
    std::string scene = {}, cases = {};
    std::map<std::string, std::string> properties = {};
    int tests = 0, failures = 0, errors = 0, skipped = 0;
    double time_s = 0;

    void add(const JunitCase& test)
    {
        count(test.outcome);
        cases += case_xml(class_name(test.backend, test.device), test.name, test.time_s,
                          outcome_xml(test.outcome, test.reason, test.reason) + output_xml(test.output));
        time_s += test.time_s;
        if (!test.device.empty()) properties[test.label + ".device"] = test.device;
        if (!test.driver.empty()) properties[test.label + ".driver"] = test.driver;
        if (!test.library.empty()) properties[test.label + ".library"] = test.library;
    }

    void add(const RowRecord& row, const Judged& judged, bool has_expectations)
    {
        count(outcome_of(row, judged));
        cases += case_xml(row, judged, has_expectations);
        if (const Traced* result = traced(row)) time_s += result->wall_s;
        const std::string device = device_label(row.key);
        if (!row.device.name.empty()) properties[device + ".device"] = row.device.name;
        if (!row.device.driver.empty()) properties[device + ".driver"] = row.device.driver;
        if (!row.device.library.empty()) properties[device + ".library"] = row.device.library;
        if (row.self_test)
            properties[fmt::format("{}.self_test.{}", device, name_of(row.key.kernel.math))] = row.self_test->text();
    }

    void add_problem(const std::string& problem)
    {
        cases += fmt::format("    <testcase classname=\"tetrace.{}\" name=\"has a result\" time=\"0.000000\">\n"
                             "      <error message=\"{}\"/>\n    </testcase>\n",
                             verb, xml_text(problem));
        ++tests;
        ++errors;
    }

    void count(CaseOutcome outcome)
    {
        ++tests;
        failures += outcome == CaseOutcome::failed;
        errors += outcome == CaseOutcome::error;
        skipped += outcome == CaseOutcome::skipped;
    }

    [[nodiscard]] std::string properties_xml() const
    {
        std::string text;
        for (const auto& [name, value] : properties)
            text += fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", xml_text(name), xml_text(value));
        return "    <properties>\n" + text + "    </properties>\n";
    }

    [[nodiscard]] std::string xml() const
    {
        return fmt::format("  <testsuite name=\"tetrace {}{}{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" "
                           "skipped=\"{}\" time=\"{:.6f}\">\n{}{}  </testsuite>\n",
                           verb, scene.empty() ? "" : " ", xml_text(scene), tests, failures, errors, skipped, time_s,
                           properties_xml(), cases);
    }
};

std::map<std::string, std::string> program_properties()
{
    const BuildIdentity build = build_identity();
    const HostIdentity host = host_identity();
    return {{"tetrace.version", build.version},
            {"tetrace.commit", build.commit},
            {"host.cpu", host.cpu},
            {"host.system", host.system}};
}

std::string document_xml(std::vector<Suite> suites, std::string_view verb)
{
    Suite sum{verb};
    std::string text;
    for (Suite& suite : suites) {
        suite.properties.merge(program_properties());
        sum.tests += suite.tests;
        sum.failures += suite.failures;
        sum.errors += suite.errors;
        text += suite.xml();
    }
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"tetrace {}\" tests=\"{}\" "
                       "failures=\"{}\" errors=\"{}\">\n{}</testsuites>\n",
                       verb, sum.tests, sum.failures, sum.errors, text);
}

} // namespace

namespace {

/// Of a device whose self-test was expected to be something.
JunitCase self_test_case(const JudgedDevice& device)
{
    JunitCase test{device.backend, device.label, device.name, device.driver, "self_test", CaseOutcome::passed, {}, 0};
    for (const Deviation& item : device.self_tests) {
        test.outcome = CaseOutcome::failed;
        append_item(test.reason, "; ", item.name + ": " + item.judged.text());
    }
    return test;
}

} // namespace

std::string junit_xml(const std::vector<RowRecord>& rows, const CheckJudgement& judgement, const std::string& problem,
                      std::string_view verb)
{
    std::vector<Suite> suites;
    if (!problem.empty()) suites.emplace_back(Suite{verb}).add_problem(problem);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (suites.empty() || suites.back().scene != rows[i].key.scene)
            suites.push_back(Suite{verb, rows[i].key.scene});
        suites.back().add(rows[i], judgement.rows[i], judgement.has_expectations);
    }
    bool is_first = true;
    for (const JudgedDevice& device : judgement.devices) {
        if (!device.has_self_test) continue;
        if (std::exchange(is_first, false)) suites.push_back(Suite{verb, "self-tests"});
        suites.back().add(self_test_case(device));
    }
    return document_xml(std::move(suites), verb);
}

std::string junit_suite(const std::string& suite, const std::vector<JunitCase>& cases, const std::string& problem,
                        std::string_view verb)
{
    std::vector<Suite> suites;
    if (!problem.empty()) suites.emplace_back(Suite{verb}).add_problem(problem);
    if (!cases.empty()) suites.push_back(Suite{verb, suite});
    for (const JunitCase& test : cases)
        suites.back().add(test);
    return document_xml(std::move(suites), verb);
}

} // namespace tetrace
