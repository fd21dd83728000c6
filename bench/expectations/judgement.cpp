#include "bench/expectations/judgement.h"

#include "bench/measuring/conformity.h"
#include "bench/results/self_test_json.h"

#include <algorithm>
#include <fmt/format.h>

namespace tetrace {

namespace {

using nlohmann::json;

constexpr const char* conforming = "conforms";

const Expectation* find_in(const Expectations* expectations, const std::string& implementation)
{
    if (expectations == nullptr || implementation.empty()) return nullptr;
    const auto found = expectations->find(implementation);
    return found == expectations->end() ? nullptr : &found->second;
}

/// Statuses are in the order from best to worst. expected: null if no file mentions it.
template <class Status>
Judgement judgement_of(const Status* expected, Status shown, bool is_failure)
{
    if (expected == nullptr) return is_failure ? Judgement::failure : Judgement::conforms;
    if (shown != *expected) return shown < *expected ? Judgement::unexpected_pass : Judgement::failure;
    return is_failure ? Judgement::known_failure : Judgement::conforms;
}

Judged judge_row(const RowRecord& row, const Expectation* expectation, bool flawed_passes)
{
    const Finding shown = finding_of(row, flawed_passes);
    const std::string rate = rate_text(row);
    const Finding* const expected = expectation != nullptr ? expectation->status_of(row.key) : nullptr;
    Judged judged{Judgement::conforms, std::string(expected != nullptr ? name_of(*expected) : conforming),
                  rate.empty() ? std::string(name_of(shown)) : rate};
    if (shown == Finding::skipped) return judged;
    if (expectation != nullptr && expectation->is_flake(row_name(row.key)))
        judged.judgement = fails(shown) || !rate.empty() ? Judgement::known_flake : Judgement::conforms;
    else
        judged.judgement = rate.empty() ? judgement_of(expected, shown, fails(shown)) : Judgement::failure;
    return judged;
}

/// Whether a value of a self-test is better than another: fewer ulps, no contraction, and all else true.
bool is_better(const std::string& item, const json& value, const json& than)
{
    if (value.is_number()) return value < than;
    return value.get<bool>() != (item == "contracts");
}

/// "text" says the others in words.
std::vector<Deviation> self_test_deviations(const json& expected, const SelfTest& test)
{
    std::vector<Deviation> deviations;
    const json shown = self_test_json(test);
    for (const auto& [item, value] : expected.items()) {
        const json& found = shown.at(item);
        if (item == "text" || value == found) continue;
        const Judgement judgement = is_better(item, found, value) ? Judgement::unexpected_pass : Judgement::failure;
        deviations.push_back({"self_test/" + item, {}, {}, {judgement, value.dump(), found.dump()}});
    }
    return deviations;
}

/// The row's device among the others.
JudgedDevice& device_of(std::vector<JudgedDevice>& devices, const RowRecord& row, const Expectations* expectations)
{
    const std::string label = device_label(row.key);
    const auto known = std::ranges::find(devices, label, &JudgedDevice::label);
    if (known != devices.end()) return *known;
    const Device& device = row.device;
    const Expectation* const expectation = find_in(expectations, device.implementation);
    JudgedDevice& added = devices.emplace_back(JudgedDevice{row.key.backend,
                                                            label,
                                                            device.name,
                                                            device.driver,
                                                            device.implementation,
                                                            expectation != nullptr,
                                                            false,
                                                            {},
                                                            {}});
    if (const Backend* const backend = find_backend(row.key.backend); expectation != nullptr && backend != nullptr)
        for (const std::string& name : names_of_no_row(*expectation, *backend))
            added.unknown.push_back(
                fmt::format("{}: {}: no row of {} has this name", expectation->file, name, row.key.backend));
    return added;
}

/// An expected self-test that no row of the device shows.
void add_missing_self_test(JudgedDevice& device, const Expectations* expectations)
{
    const Expectation* const expectation = find_in(expectations, device.implementation);
    if (expectation == nullptr || expectation->self_test.empty() || device.has_self_test) return;
    device.unknown.push_back(
        fmt::format("{}: self_test: no row of this run on {} has one in exact mode", expectation->file, device.label));
}

void judge_self_test(JudgedDevice& device, const RowRecord& row, const Expectation* expectation)
{
    const bool is_known = expectation != nullptr && !expectation->self_test.empty();
    if (!is_known || device.has_self_test || !row.self_test || row.key.kernel.math != MathMode::exact) return;
    device.has_self_test = true;
    device.self_tests = self_test_deviations(expectation->self_test, *row.self_test);
    for (Deviation& deviation : device.self_tests) {
        deviation.device = device.label;
        deviation.implementation = device.implementation;
    }
}

} // namespace

std::string Judged::text() const
{
    return fails(judgement) ? fmt::format("{}: expected {}, shows {}", name_of(judgement), expected, shown)
                            : fmt::format("{}: {}", name_of(judgement), shown);
}

CheckJudgement judge_rows(const std::vector<RowRecord>& rows, const Expectations* expectations, bool flawed_passes)
{
    CheckJudgement all{expectations != nullptr, {}, {}, {}};
    for (const RowRecord& row : rows) {
        const Expectation* const expectation = find_in(expectations, row.device.implementation);
        all.rows.push_back(judge_row(row, expectation, flawed_passes));
        if (all.rows.back().judgement != Judgement::conforms)
            all.deviations.push_back(
                {row_name(row.key), device_label(row.key), row.device.implementation, all.rows.back()});
        if (row.device.implementation.empty()) continue; // its scene or its driver could not be loaded
        judge_self_test(device_of(all.devices, row, expectations), row, expectation);
    }
    for (JudgedDevice& device : all.devices)
        add_missing_self_test(device, expectations);
    for (const JudgedDevice& device : all.devices)
        all.deviations.insert(all.deviations.end(), device.self_tests.begin(), device.self_tests.end());
    return all;
}

CheckJudgement judge_answers(const std::vector<RowRecord>& rows)
{
    CheckJudgement all;
    for (const RowRecord& row : rows) {
        const bool has_failed = status_of(row) == Status::error || fails(row, true);
        all.rows.push_back({has_failed ? Judgement::failure : Judgement::conforms, std::string(conforming),
                            std::string(name_of(status_of(row)))});
    }
    return all;
}

Judged judge_defect(const Expectation* expectation, const std::string& name, DefectFinding shown)
{
    const DefectFinding* expected = nullptr;
    if (expectation != nullptr)
        if (const auto found = expectation->defects.find(name); found != expectation->defects.end())
            expected = &found->second;
    Judged judged{judgement_of(expected, shown, shown != DefectFinding::right),
                  std::string(expected != nullptr ? name_of(*expected) : conforming), std::string(name_of(shown))};
    if (expectation != nullptr && expectation->is_flake("defect/" + name))
        judged.judgement = shown == DefectFinding::right ? Judgement::conforms : Judgement::known_flake;
    return judged;
}

int exit_code(const std::vector<RowRecord>& rows, const CheckJudgement& judgement)
{
    int code = 0;
    for (const JudgedDevice& device : judgement.devices)
        if (!device.self_tests.empty()) return 1;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!fails(judgement.rows[i].judgement)) continue;
        const auto* const failed = std::get_if<Failed>(&rows[i].outcome);
        if (failed == nullptr || failed->kind == ErrorKind::wrong_result) return 1;
        if (code == 0) code = exit_code(failed->kind);
    }
    return code;
}

namespace {

/// What rows of one name showed, by scene: the worst of all devices.
using ByScene = std::map<std::string, Finding>;

/// Of the schedule's rows that conform; empty if none does.
std::optional<Finding> most_common(const std::map<Finding, std::size_t>& counts)
{
    std::optional<Finding> common;
    for (const auto& [shown, count] : counts)
        if (!fails(shown) && (!common || count > counts.at(*common))) common = shown;
    return common;
}

/// In one line if all scenes agree.
void add_exceptions(Expectation& expectation, const RowKey& key, const ByScene& shown)
{
    const Finding* const known = expectation.status_of(key);
    const auto deviates = [&](Finding one) { return known != nullptr ? one != *known : fails(one); };
    const bool agree = std::ranges::all_of(shown, [&](const auto& one) { return one.second == shown.begin()->second; });
    for (const auto& [scene, one] : shown)
        if (deviates(one)) expectation.exceptions[(agree ? "" : scene + "/") + expected_name(key)] = one;
}

Expectation expectation_of(const std::vector<const RowRecord*>& rows, bool flawed_passes)
{
    Expectation expectation;
    std::map<Schedule, std::map<Finding, std::size_t>> counts;
    std::map<std::string, std::pair<RowKey, ByScene>> names;
    for (const RowRecord* row : rows) {
        const RowKey& key = row->key;
        if (row->self_test && key.kernel.math == MathMode::exact)
            expectation.self_test = self_test_json(*row->self_test);
        if (!rate_text(*row).empty()) {
            expectation.add_flake(row_name(key));
            continue;
        }
        const Finding shown = finding_of(*row, flawed_passes);
        if (is_portable(key.kernel) && key.kernel.math == MathMode::exact) ++counts[key.kernel.schedule][shown];
        auto& found = names.try_emplace(expected_name(key), key, ByScene()).first->second;
        expectation.judged.insert({expected_name(key), key.scene + "/" + expected_name(key)});
        Finding& worst = found.second.emplace(key.scene, shown).first->second;
        worst = std::max(worst, shown);
    }
    for (const auto& [schedule, shown] : counts)
        if (const auto common = most_common(shown)) expectation.rows[std::string(name_of(schedule))] = *common;
    for (const auto& [name, found] : names)
        add_exceptions(expectation, found.first, found.second);
    return expectation;
}

} // namespace

Expectations expectations_of(const std::vector<RowRecord>& rows, bool flawed_passes)
{
    std::map<std::string, std::vector<const RowRecord*>> by_implementation;
    for (const RowRecord& row : rows)
        if (!row.device.implementation.empty() && finding_of(row, flawed_passes) != Finding::skipped)
            by_implementation[row.device.implementation].push_back(&row);
    Expectations shown;
    for (const auto& [implementation, own] : by_implementation)
        shown[implementation] = expectation_of(own, flawed_passes);
    return shown;
}

} // namespace tetrace
