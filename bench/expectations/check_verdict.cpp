#include "bench/expectations/check_verdict.h"

#include "bench/measuring/conformity.h"
#include "bench/terminal/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

namespace tetrace {

namespace {

struct RowTally : CheckTally {
    std::size_t unanswered = 0;

    void add_row(const RowRecord& row, const Judged& result, bool is_required)
    {
        const Conformity conformity = conformity_of(row);
        const bool has_answer = conformity != Conformity::unsupported && conformity != Conformity::skipped;
        if (!has_answer && !is_required && !fails(result.judgement)) return;
        const bool is_missing = is_required && !has_answer && !result.is_as_expected();
        unanswered += is_missing && !fails(result.judgement) ? 1 : 0;
        add(device_label(row.key), is_missing || fails(result.judgement));
    }
};

std::size_t count_of(const std::vector<Deviation>& deviations, Judgement judgement)
{
    return static_cast<std::size_t>(std::ranges::count_if(
        deviations, [&](const Deviation& deviation) { return deviation.judged.judgement == judgement; }));
}

} // namespace

void CheckTally::add(const std::string& device, bool fails)
{
    ++judged;
    devices.insert(device);
    if (!fails) return;
    ++failed;
    failed_on.insert(device);
}

std::string CheckTally::judged_text() const
{
    return fmt::format("{} on {}", counted(judged, one, many), counted(devices.size(), "device", "devices"));
}

Sheet CheckVerdict::line() const
{
    Sheet sheet;
    sheet.labelled(conforms ? "Conforms" : "FAILED", text);
    return sheet;
}

CheckVerdict verdict_by_count(const CheckTally& tally, const std::string& end)
{
    if (tally.failed == 0) return {true, tally.judged_text() + end};
    return {false, fmt::format("{} of {}, {}on {}{}", tally.failed, counted(tally.judged, tally.one, tally.many),
                               tally.failed > 1 && tally.failed_on.size() == 1 ? "all " : "",
                               fmt::join(tally.failed_on, ", "), end)};
}

CheckVerdict verdict_by_expectations(const CheckTally& tally, const std::vector<Deviation>& deviations,
                                     std::size_t unanswered, const std::string& end)
{
    std::string failures, known;
    const auto add = [](std::string& text, std::size_t count, const char* one, const char* many) {
        if (count > 0) append_item(text, ", ", counted(count, one, many));
    };
    add(failures, count_of(deviations, Judgement::failure), "new failure", "new failures");
    add(failures, count_of(deviations, Judgement::unexpected_pass), "unexpected pass", "unexpected passes");
    if (unanswered > 0) append_item(failures, ", ", counted(unanswered, tally.one, tally.many) + " without a result");
    add(known, count_of(deviations, Judgement::known_failure), "failure as expected", "failures as expected");
    add(known, count_of(deviations, Judgement::known_flake), "known flake", "known flakes");
    const std::string all = tally.judged_text() + (known.empty() ? "" : ", " + known) + end;
    return failures.empty() ? CheckVerdict{true, all} : CheckVerdict{false, failures + " in " + all};
}

std::optional<CheckVerdict> verdict_of(const std::vector<RowRecord>& rows, const CheckJudgement& judgement,
                                       const std::vector<std::string>& required)
{
    RowTally tally{{"row", "rows"}};
    for (std::size_t i = 0; i < rows.size(); ++i)
        tally.add_row(rows[i], judgement.rows[i], std::ranges::find(required, rows[i].key.backend) != required.end());
    if (tally.judged == 0) return std::nullopt;
    const std::size_t others = rows.size() - tally.judged;
    const std::string end =
        others == 0 ? "." : fmt::format("; {} more {} no result.", others, others == 1 ? "has" : "have");
    if (judgement.has_expectations) return verdict_by_expectations(tally, judgement.deviations, tally.unanswered, end);
    return verdict_by_count(tally, end);
}

void set_verdict(nlohmann::json& section, const std::optional<CheckVerdict>& verdict)
{
    if (verdict) section["verdict"] = {{"conforms", verdict->conforms}, {"text", verdict->text}};
}

Sheet verdict_line(const ResultValue& section)
{
    const auto verdict = section.find("verdict");
    return verdict ? CheckVerdict{verdict->at("conforms").flag(), verdict->at("text").line()}.line() : Sheet();
}

void set_expectations(nlohmann::json& section, const Expectations& expectations,
                      const std::set<std::string>& implementations, const std::vector<Deviation>& deviations,
                      const std::vector<std::string>& unmentioned, const std::vector<std::string>& unknown)
{
    std::set<std::string> files;
    for (const auto& [implementation, expectation] : expectations)
        if (implementations.contains(implementation)) files.insert(expectation.file);
    nlohmann::json list = nlohmann::json::array();
    for (const Deviation& one : deviations) {
        nlohmann::json& object = list.emplace_back();
        object = {{"name", one.name},
                  {"device", one.device},
                  {"judgement", name_of(one.judged.judgement)},
                  {"expected", one.judged.expected},
                  {"shown", one.judged.shown}};
        if (!one.implementation.empty()) object["implementation"] = one.implementation;
    }
    section["expectations"] = {{"files", files}, {"deviations", std::move(list)}, {"unmentioned", unmentioned}};
    if (!unknown.empty()) section["expectations"]["unknown"] = unknown;
}

std::set<std::string> implementations_of(const CheckJudgement& judgement)
{
    std::set<std::string> implementations;
    for (const JudgedDevice& device : judgement.devices)
        implementations.insert(device.implementation);
    return implementations;
}

std::vector<std::string> unknown_of(const CheckJudgement& judgement)
{
    std::vector<std::string> sentences;
    for (const JudgedDevice& device : judgement.devices)
        for (const std::string& sentence : device.unknown)
            if (std::ranges::find(sentences, sentence) == sentences.end()) sentences.push_back(sentence);
    return sentences;
}

std::vector<std::string> unmentioned_of(const CheckJudgement& judgement)
{
    std::set<std::string> implementations;
    for (const JudgedDevice& device : judgement.devices)
        if (!device.is_mentioned) implementations.insert(device.implementation);
    return {implementations.begin(), implementations.end()};
}

std::set<std::string> known_failures(const ResultValue& section)
{
    std::set<std::string> names;
    if (const auto expectations = section.find("expectations"))
        for (const ResultValue& one : expectations->at("deviations").items())
            if (one.at("judgement").line() == name_of(Judgement::known_failure)) names.insert(one.at("name").line());
    return names;
}

Sheet expectation_lines(const ResultValue& section)
{
    Sheet sheet;
    const auto expectations = section.find("expectations");
    if (!expectations) return sheet;
    for (const ResultValue& one : expectations->at("deviations").items()) {
        const std::string name = one.at("name").line();
        const bool is_row = name.find("/api:") != std::string::npos;
        Judged judged{Judgement::conforms, one.at("expected").line(), one.at("shown").line()};
        read_into(judged.judgement, one.at("judgement"));
        const std::string where = is_row ? "" : " on " + one.at("device").line();
        sheet.labelled("Judged", fmt::format("{}{}: {}", name, where, judged.text()));
    }
    for (const ResultValue& implementation : expectations->at("unmentioned").items())
        sheet.labelled("Unknown", fmt::format("no file of --expect mentions {}: it is expected to conform.",
                                              implementation.line()));
    if (const auto unknown = expectations->find("unknown"))
        for (const ResultValue& sentence : unknown->items())
            sheet.labelled("Unknown", sentence.line() + ".");
    return sheet;
}

} // namespace tetrace
