#pragma once

#include "bench/expectations/judgement.h"
#include "bench/terminal/sheet.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tetrace {

/// The verdict of a check, and the line that it ends with.
struct CheckVerdict {
    bool conforms = true;
    std::string text; ///< "13 rows on 2 devices.", or "6 of 13 rows, all on opencl."

    [[nodiscard]] Sheet line() const;
};

/// What a check counts: rows, or reduced kernels.
struct CheckTally {
    const char *one, *many; ///< "row", "rows"
    std::size_t judged = 0, failed = 0;
    std::set<std::string> devices{}, failed_on{}; ///< labels

    void add(const std::string& device, bool fails);
    [[nodiscard]] std::string judged_text() const; ///< "13 rows on 2 devices"
};

/// Empty if no row was judged. judgement: of these rows. required: backends of which each row must have an answer, or
/// be without one as expected.
[[nodiscard]] std::optional<CheckVerdict> verdict_of(const std::vector<RowRecord>& rows,
                                                     const CheckJudgement& judgement,
                                                     const std::vector<std::string>& required);

/// The verdict without expectations. end: of the sentence.
[[nodiscard]] CheckVerdict verdict_by_count(const CheckTally& tally, const std::string& end = ".");

/// The verdict on what was judged by expectations. unanswered: how many of the tally were required to have a result and
/// have none. end: of the sentence.
[[nodiscard]] CheckVerdict verdict_by_expectations(const CheckTally& tally, const std::vector<Deviation>& deviations,
                                                   std::size_t unanswered = 0, const std::string& end = ".");

/// In a result, under "verdict".
void set_verdict(nlohmann::json& section, const std::optional<CheckVerdict>& verdict);

/// The line of a result's verdict; nothing for a result without.
[[nodiscard]] Sheet verdict_line(const ResultValue& section);

/// In a result, under "expectations": the files on implementations of the run, what is not simply as it should be, the
/// implementations that no file mentions, and sentences on what files say of rows and items that the run cannot have.
void set_expectations(nlohmann::json& section, const Expectations& expectations,
                      const std::set<std::string>& implementations, const std::vector<Deviation>& deviations,
                      const std::vector<std::string>& unmentioned, const std::vector<std::string>& unknown = {});

/// Of a judgement's devices.
[[nodiscard]] std::set<std::string> implementations_of(const CheckJudgement& judgement);

/// Of a judgement's devices, those that no file mentions, each implementation once.
[[nodiscard]] std::vector<std::string> unmentioned_of(const CheckJudgement& judgement);

/// JudgedDevice::unknown of all devices, each sentence once.
[[nodiscard]] std::vector<std::string> unknown_of(const CheckJudgement& judgement);

/// The names of what failed as expected, by a result's "expectations".
[[nodiscard]] std::set<std::string> known_failures(const ResultValue& section);

/// What a result says under "expectations", line by line; nothing for a result without. Throws Error{invalid_input}
/// naming the key that is missing or of another kind.
[[nodiscard]] Sheet expectation_lines(const ResultValue& section);

} // namespace tetrace
