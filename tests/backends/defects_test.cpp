// Reduced kernels of compilers' defects on every device: the result is what tests/expected/<implementation>.json
// says, right or wrong. tests/expected/README.md describes each.
#include "bench/expectations/expectation_files.h"
#include "bench/expectations/judgement.h"
#include "core/device/backend.h"
#include "core/device/defects.h"

#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>
#include <set>

using namespace tetrace;

namespace tetrace::faults {
// faulty_stressor.cpp
#define FAULT(number, stressor) std::vector<std::uint32_t> fault_##number(std::uint32_t items);
TETRACE_FAULTS
#undef FAULT
} // namespace tetrace::faults

namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t items = 16;

/// Whether the device returns the right words in every launch.
bool is_right(Backend& backend, std::size_t device, const Defect& defect)
{
    return std::ranges::all_of(defect.launches(), [&](const DefectLaunch& launch) {
        return wrong_items(defect, launch.items, backend.run_defect(device, defect.name, launch)).empty();
    });
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
                const Judged judged = judge_defect(
                    &expectation, name, is_right(*backend, i, defect) ? DefectFinding::right : DefectFinding::wrong);
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
        Words words = expected_words(defect, items);
        EXPECT_EQ(wrong_items(defect, items, words), Words{}) << defect.name;
        words[3] = ~words[3];
        EXPECT_EQ(wrong_items(defect, items, words), Words{3}) << defect.name;
        words.pop_back();
        EXPECT_EQ(wrong_items(defect, items, words).size(), items) << "too few words do not count";
    }
}

TEST(Defects, expect_other_words_of_most_items)
{
    for (const Defect& defect : all_defects()) {
        const Words words = expected_words(defect, items);
        EXPECT_EQ(std::set<std::uint32_t>(words.begin(), words.end()).size(), items)
            << defect.name << ": items that are mixed up would not be seen";
    }
}

TEST(Stressors, may_flush_denormals_in_arithmetic_and_not_in_copies)
{
    const Words zeros(items, 0);
    std::set<std::string_view> flushed;
    for (const Defect& defect : all_defects())
        if (wrong_items(defect, items, zeros).empty()) flushed.insert(defect.name);
    EXPECT_EQ(flushed,
              (std::set<std::string_view>{"denormals_in_maxima", "denormals_in_minima", "denormals_multiplied"}));
    const Defect& maxima = *std::ranges::find(all_defects(), "denormals_in_maxima", &Defect::name);
    const Defect& minima = *std::ranges::find(all_defects(), "denormals_in_minima", &Defect::name);
    EXPECT_EQ(wrong_items(maxima, items, expected_words(minima, items)), Words{}) << "the comparison flushes";
}

TEST(Stressors, are_wrong_if_a_compiler_makes_a_fault)
{
    std::set<std::string_view> seen;
    const auto expect_seen = [&](std::string_view name, int number,
                                 std::vector<std::uint32_t> (*fault)(std::uint32_t)) {
        const Defect& defect = *std::ranges::find(all_defects(), name, &Defect::name);
        for (const std::uint32_t count : {64u, 4096u})
            EXPECT_FALSE(wrong_items(defect, count, fault(count)).empty()) << name << ", fault " << number;
        seen.insert(name);
    };
#define FAULT(number, stressor) expect_seen(#stressor, number, faults::fault_##number);
    TETRACE_FAULTS
#undef FAULT
    for (const Defect& defect : all_defects())
        EXPECT_EQ(seen.contains(defect.name), defect.is_stressor) << defect.name << ": no fault is tried";
}
