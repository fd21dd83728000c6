#pragma once

#include "bench/expectations/expectation.h"

#include <string>
#include <vector>

namespace tetrace {

/// How what a run shows compares with what was expected of it. The last two make a check fail.
enum class Judgement { conforms, known_failure, known_flake, unexpected_pass, failure };
template <>
inline constexpr auto enum_names<Judgement> = names_up_to<Judgement::failure>("conforms", "known failure",
                                                                              "known flake", "unexpected pass",
                                                                              "new failure");

[[nodiscard]] constexpr bool fails(Judgement judgement)
{
    return judgement >= Judgement::unexpected_pass;
}

/// A row, an item of a self-test, or a reduced kernel, judged.
struct Judged {
    Judgement judgement = Judgement::conforms;
    std::string expected; ///< a status or a value; "conforms" if no file mentions it
    std::string shown;    ///< the same of this run, or how often: "wrong in 2 of 10"

    [[nodiscard]] bool is_as_expected() const { return expected == shown; }
    /// "unexpected pass: expected wrong, shows bit-exact", or "known failure: wrong".
    [[nodiscard]] std::string text() const;
};

/// Something that does not simply conform.
struct Deviation {
    std::string name;   ///< of a row, or "self_test/denormals_kept", or "defect/loop_of_70000_iterations"
    std::string device; ///< its label
    std::string implementation;
    Judged judged;
};

/// A device of a check.
struct JudgedDevice {
    std::string backend, label, name, driver, implementation;
    bool is_mentioned = false;         ///< whether a file says anything of the implementation
    bool has_self_test = false;        ///< whether a file says how it computes, and the run shows it
    std::vector<Deviation> self_tests; ///< items that are not as expected
    std::vector<std::string> unknown;  ///< what its file says of rows or items that the run cannot have, as sentences
};

/// A check's rows against what was expected of them.
struct CheckJudgement {
    bool has_expectations = false; ///< whether any were given
    std::vector<Judged> rows;      ///< one for each row
    std::vector<JudgedDevice> devices;
    std::vector<Deviation> deviations; ///< of rows, then of self-tests
};

/// Judges the rows of a check and the self-tests of their devices. expectations: null if none were given: then all is
/// expected to conform. flawed_passes: as of fails_check().
[[nodiscard]] CheckJudgement judge_rows(const std::vector<RowRecord>& rows, const Expectations* expectations,
                                        bool flawed_passes);

/// Judges the rows of a run that is no check: they fail as fails() says of them, or by an error.
[[nodiscard]] CheckJudgement judge_answers(const std::vector<RowRecord>& rows);

/// Judges a reduced kernel. expectation: of its implementation; null if there is none.
[[nodiscard]] Judged judge_defect(const Expectation* expectation, const std::string& name, DefectFinding shown);

/// The exit code of a check: 1 if a row or self-test fails; else that of the first error that was not expected; else 0.
[[nodiscard]] int exit_code(const std::vector<RowRecord>& rows, const CheckJudgement& judgement);

/// What the rows show, as the expectations of their implementations: what most conforming rows of a schedule show is
/// that of the schedule, and other rows are exceptions. Rows that differ between repetitions are flakes.
[[nodiscard]] Expectations expectations_of(const std::vector<RowRecord>& rows, bool flawed_passes);

} // namespace tetrace
