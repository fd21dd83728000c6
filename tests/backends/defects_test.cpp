// Reduced kernels of compilers' defects on every device: the result is what tests/expected/<implementation>.json
// says, right or wrong. tests/expected/README.md describes each.
#include "bench/expectations/expectation_files.h"
#include "bench/expectations/judgement.h"
#include "core/base/control_groups.h"
#include "core/base/error.h"
#include "core/device/backend.h"
#include "core/device/defects.h"

#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>
#include <optional>
#include <set>

using namespace tetrace;

namespace tetrace::faults {
// faulty_stressor.cpp
#define FAULT(number, stressor) std::vector<std::uint32_t> fault_##number(const DefectLaunch& launch);
TETRACE_FAULTS
#undef FAULT
} // namespace tetrace::faults

namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t items = 16;
constexpr DefectLaunch one_group{items, items};

/// Whether the device returns the right words in every launch; empty, with the reason, if it lacks what they need.
std::optional<DefectFinding> finding_on(Backend& backend, std::size_t device, const Defect& defect, std::string& reason)
try {
    const bool is_right = std::ranges::all_of(defect.launches(), [&](const DefectLaunch& launch) {
        return wrong_items(
                   defect, launch,
                   backend.run_defect(device, defect.name, launch_on(backend.devices()[device], defect, launch)))
            .empty();
    });
    return is_right ? DefectFinding::right : DefectFinding::wrong;
} catch (const Error& error) {
    if (error.kind() != ErrorKind::unsupported || defect.need == DefectNeed::none) throw;
    reason = error.what();
    return std::nullopt;
}

/// Nothing is expected of an implementation without a file.
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
                const auto known = expectation.defects.find(name);
                if (known != expectation.defects.end() && known->second == DefectFinding::error) {
                    skipped.append(name)
                        .append(" on ")
                        .append(device.name)
                        .append(": it may end this process; CheckDefects runs it in another\n");
                    continue;
                }
                std::string reason;
                const auto finding = finding_on(*backend, i, defect, reason);
                if (!finding) {
                    skipped.append(name).append(" on ").append(device.name).append(": ").append(reason).append("\n");
                    continue;
                }
                const Judged judged = judge_defect(&expectation, name, *finding);
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
        Words words = expected_words(defect, one_group);
        EXPECT_EQ(wrong_items(defect, one_group, words), Words{}) << defect.name;
        words[3] = ~words[3];
        EXPECT_EQ(wrong_items(defect, one_group, words), Words{3}) << defect.name;
        words.pop_back();
        EXPECT_EQ(wrong_items(defect, one_group, words).size(), words.size() + 1) << "too few words do not count";
    }
}

TEST(Defects, expect_other_words_of_most_items)
{
    for (const Defect& defect : all_defects()) {
        const Words words = expected_words(defect, one_group);
        EXPECT_EQ(std::set<std::uint32_t>(words.begin(), words.begin() + items).size(), items)
            << defect.name << ": items that are mixed up would not be seen";
    }
}

TEST(Stressors, may_flush_denormals_in_arithmetic_and_not_in_copies)
{
    const Words zeros(items, 0);
    std::set<std::string_view> flushed;
    for (const Defect& defect : all_defects())
        if (wrong_items(defect, one_group, zeros).empty()) flushed.insert(defect.name);
    EXPECT_EQ(flushed,
              (std::set<std::string_view>{"denormals_in_maxima", "denormals_in_minima", "denormals_multiplied"}));
    const Defect& maxima = *std::ranges::find(all_defects(), "denormals_in_maxima", &Defect::name);
    const Defect& minima = *std::ranges::find(all_defects(), "denormals_in_minima", &Defect::name);
    EXPECT_EQ(wrong_items(maxima, one_group, expected_words(minima, one_group)), Words{}) << "the comparison flushes";
}

TEST(Stressors, of_a_large_buffer_are_refused_where_the_device_or_its_memory_admits_less)
{
    const auto refusal = [](std::string_view name, std::uint64_t max_buffer_mib, std::uint64_t memory_mib) {
        Device device;
        device.kind = DeviceKind::gpu;
        device.max_buffer_bytes = max_buffer_mib << 20;
        device.memory_bytes = memory_mib << 20;
        try {
            (void)launch_on(device, *find_defect(name), {});
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::unsupported);
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal("words_past_64_mib", 128, 1024), "");
    EXPECT_EQ(refusal("words_past_2_gib", 128, 16384), "it admits buffers of 128 MiB, and the kernel needs 2052 MiB");
    EXPECT_EQ(refusal("words_past_4_gib", 4099, 16384), "it admits buffers of 4099 MiB, and the kernel needs 4100 MiB");
    EXPECT_EQ(refusal("words_past_4_gib", 4100, 16384), "");
    EXPECT_EQ(refusal("words_past_4_gib", 0, 8000), "half of its memory is 4000 MiB, and the kernel needs 4100 MiB");
    EXPECT_EQ(refusal("words_at_the_end", 11, 16384), "it admits buffers of 11 MiB, and the kernel needs 12 MiB");
    EXPECT_EQ(refusal("words_at_the_end", 12, 24), "");
}

TEST(Stressors, of_the_largest_buffer_have_one_that_the_device_and_its_memory_admit)
{
    const auto bytes_on = [](std::uint64_t max_buffer_bytes, std::uint64_t memory_bytes) {
        Device device;
        device.kind = DeviceKind::gpu;
        device.max_buffer_bytes = max_buffer_bytes;
        device.memory_bytes = memory_bytes;
        return launch_on(device, *find_defect("words_at_the_end"), {}).large_bytes();
    };
    constexpr std::uint64_t gib = std::uint64_t{1} << 30;
    EXPECT_EQ(bytes_on(gib, 24 * gib), gib);
    EXPECT_EQ(bytes_on(4 * gib - 1, 24 * gib), 4 * gib - 4096) << "what Vulkan calls no limit";
    EXPECT_EQ(bytes_on(4 * gib - 1, 3 * gib), 3 * gib / 2);
    EXPECT_EQ(bytes_on(0, 140 * gib), 16 * gib - 4096) << "a word's number has 32 bits";
    Device processor;
    processor.kind = DeviceKind::cpu;
    processor.memory_bytes = 1024 * gib;
    EXPECT_LE(launch_on(processor, *find_defect("words_at_the_end"), {}).large_bytes(), available_memory_bytes());
}

TEST(Stressors, are_chosen_with_a_launch_and_the_size_of_the_largest_buffer)
{
    const auto words_of = [](const char* text) -> std::int64_t {
        const auto chosen = chosen_defect(text);
        return chosen ? std::int64_t{chosen->launch.large_words} : -1;
    };
    EXPECT_EQ(words_of("zoo_of_exits:64:16"), 0);
    EXPECT_EQ(words_of("words_past_64_mib:64:16"), 0x1000000 + 0x100000);
    EXPECT_EQ(words_of("words_at_the_end"), 1 << 25) << "what Vulkan guarantees";
    EXPECT_EQ(words_of("words_at_the_end:64:16"), 1 << 25);
    EXPECT_EQ(words_of("words_at_the_end:64:16:1073740800"), 1073740800);
    for (const char* wrong :
         {"words_at_the_end:64:16:", "words_at_the_end:64:16:1000", "words_at_the_end:64:16:4294967296",
          "words_at_the_end:64:16:33554432:1", "zoo_of_exits:64:16:33554432", "words_past_64_mib:64:16:33554432"})
        EXPECT_EQ(words_of(wrong), -1) << wrong;
}

TEST(Stressors, are_wrong_if_a_compiler_makes_a_fault)
{
    std::set<std::string_view> seen;
    const auto expect_seen = [&](std::string_view name, int number,
                                 std::vector<std::uint32_t> (*fault)(const DefectLaunch&)) {
        const Defect& defect = *std::ranges::find(all_defects(), name, &Defect::name);
        for (const DefectLaunch& tried : {DefectLaunch{64, 16}, DefectLaunch{4096, 32}})
            EXPECT_FALSE(wrong_items(defect, tried, fault(tried)).empty()) << name << ", fault " << number;
        seen.insert(name);
    };
#define FAULT(number, stressor) expect_seen(#stressor, number, faults::fault_##number);
    TETRACE_FAULTS
#undef FAULT
    for (const Defect& defect : all_defects())
        EXPECT_EQ(seen.contains(defect.name), defect.is_stressor) << defect.name << ": no fault is tried";
}
