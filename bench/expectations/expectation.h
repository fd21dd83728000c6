#pragma once

#include "bench/options/name_filter.h"
#include "bench/results/result_value.h"
#include "bench/rows/row_record.h"

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace tetrace {

/// What a reduced kernel of a defect shows, from best to worst: right if it does not show its defect.
enum class DefectFinding { right, wrong, error };
template <>
inline constexpr auto enum_names<DefectFinding> = names_up_to<DefectFinding::error>("right", "wrong", "error");

/// What an implementation of an API (Device::implementation) is expected to show. tests/expected/README.md describes
/// its form in JSON.
struct Expectation {
    /// Names of rows that may fail in some runs: regular expressions on row_name(), and on "defect/NAME".
    struct Flakes {
        std::string expression;
        NameFilter names;
    };

    nlohmann::json self_test = nlohmann::json::object(); ///< values of self_test_json() by key; missing ones: anything
    std::map<std::string, Finding> rows;                 ///< of our kernels in exact mode, by schedule
    std::map<std::string, Finding> exceptions;           ///< by expected_name(), or "scene/" and that
    std::map<std::string, DefectFinding> defects;        ///< by name
    std::vector<Flakes> flakes;
    std::set<std::string> judged = {}; ///< names of exceptions that a run would have made; not in files
    std::string file = {};             ///< that it was read from

    /// Null if the file does not mention the row, which is then expected to conform.
    [[nodiscard]] const Finding* status_of(const RowKey& key) const;
    [[nodiscard]] bool is_flake(const std::string& name) const;
    /// Adds exactly this name to those of flakes, unless it is there.
    void add_flake(const std::string& name);
};

/// What implementations are expected to show, by Device::implementation.
using Expectations = std::map<std::string, Expectation>;

/// A row's name among exceptions: "cdt/maria/tet80", followed by what is not usual of it: "/persistent", "/shadow",
/// "/rays:morton", "/order:hilbert", "/math:fast".
[[nodiscard]] std::string expected_name(const RowKey& key);

/// Those of exceptions that no row of the backend has in any scene: of a kernel that it lacks, or with a mistake.
[[nodiscard]] std::vector<std::string> names_of_no_row(const Expectation& expectation, const Backend& backend);

/// Throws Error{invalid_input} naming file, key and the accepted values.
[[nodiscard]] Expectation expectation_from(const ResultValue& value);

/// Leaves out defects and flakes where there are none.
[[nodiscard]] nlohmann::json expectation_json(const Expectation& expectation);

} // namespace tetrace
