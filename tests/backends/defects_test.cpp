// Reduced kernels of compilers' defects on every device: the result is what tests/expected/<implementation>.json
// says, right or wrong. tests/expected/README.md describes each.
#include "bench/expectations/expectation_files.h"
#include "bench/expectations/judgement.h"
#include "core/device/backend.h"
#include "core/device/defects.h"

#include <filesystem>
#include <gtest/gtest.h>
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

/// Without anything expected where there is no file.
Expectation expectation_of(const std::string& implementation)
{
    const std::filesystem::path path = std::string(TETRACE_EXPECTED_FOLDER "/") + implementation + ".json";
    return std::filesystem::exists(path) ? read_expectations({path}).at(implementation) : Expectation();
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
            const Expectation expectation = expectation_of(device.implementation);
            for (const Defect& defect : all_defects()) {
                const std::string name(defect.name);
                const bool is_right = wrong_items(defect, backend->run_defect(i, defect.name)).empty();
                const Judged judged =
                    judge_defect(&expectation, name, is_right ? DefectFinding::right : DefectFinding::wrong);
                if (!expectation.defects.contains(name)) {
                    skipped += "tests/expected/" + device.implementation + ".json does not say what " + name +
                               " shows; it is " + judged.shown + "\n";
                    continue;
                }
                EXPECT_FALSE(fails(judged.judgement))
                    << name << " on " << device.name << ", " << device.driver << ": " << judged.text()
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
