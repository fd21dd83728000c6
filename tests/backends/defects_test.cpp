// Reduced kernels of compilers' defects on every device: the result is what tests/expected/<implementation>.json
// says, right or wrong. tests/expected/README.md describes each.
#include "core/device/backend.h"
#include "core/device/defects.h"

#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>

using namespace tetrace;

namespace {

using Words = std::vector<std::uint32_t>;

Words right_words(const Defect& defect)
{
    Words words;
    for (std::uint32_t item = 0; item < defect_items; ++item)
        words.push_back(defect.expected(item));
    return words;
}

nlohmann::json expected_defects(const std::string& implementation)
{
    std::ifstream file(std::string(TETRACE_EXPECTED_FOLDER "/") + implementation + ".json");
    if (!file) return nlohmann::json::object();
    return nlohmann::json::parse(file).value("defects", nlohmann::json::object());
}

/// Which kernels are right and which are wrong, as the expected file has it.
nlohmann::json outcomes_of(Backend& runner, std::size_t device)
{
    nlohmann::json outcomes = nlohmann::json::object();
    for (const Defect& defect : all_defects())
        outcomes[std::string(defect.name)] =
            wrong_items(defect, runner.run_defect(device, defect.name)).empty() ? "right" : "wrong";
    return outcomes;
}

} // namespace

TEST(Defects, are_those_that_each_implementation_is_known_for)
{
    std::string skipped;
    for (Backend* backend : all_backends()) {
        for (std::size_t i = 0; backend->runs_defects() && i < backend->devices().size(); ++i) {
            const Device& device = backend->devices()[i];
            if (!device.usable) {
                skipped += backend->name() + ": " + device.reason + "\n";
                continue;
            }
            const nlohmann::json expected = expected_defects(device.implementation), found = outcomes_of(*backend, i);
            for (const auto& [name, outcome] : found.items()) {
                if (!expected.contains(name)) {
                    skipped += "tests/expected/" + device.implementation + ".json does not say what " + name +
                               " shows; it is " + outcome.dump() + "\n";
                    continue;
                }
                EXPECT_EQ(expected[name], outcome)
                    << name << " on " << device.name << ", " << device.driver
                    << ". If it was right before, report it upstream as tests/expected/README.md describes it; "
                    << "then correct tests/expected/" << device.implementation << ".json";
            }
        }
    }
    if (!skipped.empty()) GTEST_SKIP() << skipped;
}

TEST(Defects, a_kernels_wrong_items_are_named)
{
    for (const Defect& defect : all_defects()) {
        Words words = right_words(defect);
        EXPECT_EQ(wrong_items(defect, words), Words{}) << defect.name;
        ++words[3];
        EXPECT_EQ(wrong_items(defect, words), Words{3}) << defect.name;
        words.pop_back();
        EXPECT_EQ(wrong_items(defect, words).size(), defect_items) << "too few words do not count";
    }
}

TEST(Defects, expect_other_words_of_most_items)
{
    for (const Defect& defect : all_defects()) {
        const Words words = right_words(defect);
        EXPECT_EQ(std::set<std::uint32_t>(words.begin(), words.end()).size(), defect_items)
            << defect.name << ": items that are mixed up would not be seen";
    }
}
