#include "bench/debugging/defect_report.h"
#include "core/device/device_facts.h"
#include "tests/support/fake_backend.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

Device some_device()
{
    Device device;
    device.name = "a device";
    device.driver = "driver 1.2";
    device.kind = DeviceKind::gpu;
    device.memory_bytes = std::uint64_t{64} << 30;
    return device;
}

/// A driver that runs every reduced kernel right, but for one item of one of them, or fails at it.
class Driver : public FakeBackend {
public:
    explicit Driver(std::string name, Device device = some_device()) : FakeBackend(std::move(name), std::move(device))
    {
    }

    std::string wrong, fails, flushes, lacks;
    std::size_t wrong_word = 5;
    std::uint32_t wrong_from = 0; ///< items of a launch

    [[nodiscard]] bool runs_defects() const override { return true; }
    [[nodiscard]] std::vector<std::uint32_t> run_defect(std::size_t, std::string_view name,
                                                        const DefectLaunch& launch) override
    {
        if (name == lacks) throw Error(ErrorKind::unsupported, "it has none");
        if (name == fails) throw Error(ErrorKind::driver, "SIGSEGV");
        for (const Defect& defect : all_defects()) {
            if (defect.name != name) continue;
            auto words = expected_words(defect, launch);
            if (name == wrong && launch.items >= wrong_from) ++words[wrong_word];
            if (name == flushes) words[0] = 0;
            return words;
        }
        return {};
    }
};

constexpr const char* loop = "value_after_divergent_loop";

const auto reduced_count = static_cast<std::size_t>(
    std::ranges::count_if(all_defects(), [](const Defect& defect) { return !defect.is_stressor; }));

std::vector<DefectRun> runs_of(Driver& driver)
{
    return run_defects({}, {&driver});
}

} // namespace

TEST(DefectRuns, are_one_of_each_defect_and_good_where_none_is_seen)
{
    Driver driver("good");
    const auto runs = runs_of(driver);
    EXPECT_EQ(runs.size(), reduced_count);
    for (const DefectRun& run : runs)
        EXPECT_EQ(run.sight, DefectSight::not_seen) << run.defect->name;
    EXPECT_EQ(exit_code(runs), 0);
}

TEST(DefectRuns, fail_where_one_item_is_wrong_and_name_it)
{
    Driver driver("bad");
    driver.wrong = loop;
    const auto runs = runs_of(driver);
    EXPECT_EQ(exit_code(runs), 1);
    EXPECT_EQ(runs.front().sight, DefectSight::seen);
    EXPECT_EQ(runs.front().wrong, std::vector<std::uint32_t>{5});
    EXPECT_EQ(runs.front().first_word, 6u);
    const Report report = defect_report(runs, {}, {});
    EXPECT_TRUE(contains(report.sheet.text(), "SEEN: 1 of 16 items")) << report.sheet.text();
    EXPECT_TRUE(contains(report.sheet.text(), "item 5 returns 6 instead of 5")) << report.sheet.text();
    EXPECT_TRUE(contains(report.sheet.text(), "FAILED    1 of 4 reduced kernels, on bad.")) << report.sheet.text();
    const std::string xml = defect_junit(runs);
    EXPECT_TRUE(contains(xml, "failures=\"1\" errors=\"0\"")) << xml;
    EXPECT_TRUE(contains(xml, "classname=\"tetrace.bad.a-device\" name=\"defect/value_after_divergent_loop\"")) << xml;
}

TEST(DefectRuns, of_stressors_grow_until_a_launch_is_wrong)
{
    Driver driver("bad");
    driver.wrong = "zoo_of_exits";
    driver.wrong_from = 4096;
    Options options;
    options.stress = true;
    const auto runs = run_defects(options, {&driver});
    ASSERT_EQ(runs.size(), all_defects().size() - reduced_count);
    const auto zoo = std::ranges::find(runs, driver.wrong, [](const DefectRun& run) { return run.defect->name; });
    EXPECT_EQ(zoo->sight, DefectSight::seen);
    EXPECT_EQ(zoo->launch.items, 4096u);
    EXPECT_EQ(runs.front().launch.items, 1'000'000u) << "right at every size";
    const std::string text = defect_report(runs, {}, options).sheet.text();
    EXPECT_TRUE(contains(text, "SEEN: 1 of 4,096 items")) << text;
    EXPECT_TRUE(contains(text, "(dump --defect zoo_of_exits:4096:32)")) << text;
    EXPECT_TRUE(contains(text, "ROCm#1182")) << text;
    options.defects = true;
    EXPECT_EQ(run_defects(options, {&driver}).size(), all_defects().size());
}

TEST(DefectRuns, of_a_stressor_that_crashes_name_its_launch)
{
    Driver driver("crashing");
    driver.fails = "pairs_under_pressure";
    Options options;
    options.stress = true;
    const auto runs = run_defects(options, {&driver});
    const std::string launched = "SIGSEGV (dump --defect pairs_under_pressure:1:1)";
    const std::string text = defect_report(runs, {}, options).sheet.text();
    EXPECT_TRUE(contains(text, launched)) << text;
    EXPECT_TRUE(contains(defect_junit(runs), "<error message=\"" + launched + "\"/>")) << defect_junit(runs);
}

TEST(DefectRuns, of_a_stressor_are_skipped_on_a_device_that_lacks_what_it_needs)
{
    Driver driver("without");
    driver.lacks = "jobs_of_lanes";
    Options options;
    options.stress = true;
    const auto runs = run_defects(options, {&driver});
    EXPECT_EQ(exit_code(runs), 0);
    const std::string text = defect_report(runs, {}, options).sheet.text();
    EXPECT_TRUE(contains(text, "jobs_of_lanes on without: it has none")) << text;
    EXPECT_TRUE(contains(text, "; 1 skipped, 0 errors")) << text;
    EXPECT_TRUE(contains(defect_junit(runs), "<skipped message=\"it has none\"/>")) << defect_junit(runs);
    driver.lacks = "zoo_of_exits";
    EXPECT_EQ(exit_code(run_defects(options, {&driver})), exit_code(ErrorKind::unsupported)) << "it needs nothing";
}

TEST(DefectRuns, name_a_wrong_word_that_all_groups_share)
{
    Driver driver("bad");
    driver.wrong = "tallies_in_buffer";
    driver.wrong_word = 7;
    Options options;
    options.stress = true;
    const std::string text = defect_report(run_defects(options, {&driver}), {}, options).sheet.text();
    EXPECT_TRUE(contains(text, "tallies_in_buffer on bad: word 7 is 1 instead of 0 (dump --defect "
                               "tallies_in_buffer:1:1)"))
        << text;
}

TEST(DefectRuns, of_the_largest_buffer_have_its_size_in_the_command_of_their_case)
{
    Device device = some_device();
    device.max_buffer_bytes = (std::uint64_t{1} << 32) - 1;
    Driver driver("bad", device);
    driver.wrong = "words_at_the_end";
    Options options;
    options.stress = true;
    const Report report = defect_report(run_defects(options, {&driver}), {}, options);
    EXPECT_TRUE(contains(report.sheet.text(), "(dump --defect words_at_the_end:64:64:1073740800)"))
        << report.sheet.text();
    EXPECT_TRUE(contains(report.json.dump(), "\"large_words\":1073740800")) << report.json;
}

TEST(DefectRuns, without_a_required_backend_do_not_conform)
{
    Driver driver("good");
    Options options;
    options.required = {"good", "other"};
    const auto runs = run_defects({}, {&driver});
    EXPECT_TRUE(
        defect_report(runs, {}, options).sheet.text().ends_with("FAILED    4 of 8 reduced kernels, all on other.\n"));
    const Expectations none;
    EXPECT_TRUE(contains(defect_report(runs, {}, options, &none).sheet.text(),
                         "FAILED    4 reduced kernels without a result in 8 reduced kernels on 2 devices."));
    options.required = {"good"};
    EXPECT_TRUE(contains(defect_report(runs, {}, options).sheet.text(), "Conforms  4 reduced kernels on 1 device."));
}

TEST(DefectRuns, that_flush_denormals_pass_and_say_so)
{
    Driver driver("flushing");
    driver.flushes = "denormals_multiplied";
    Options options;
    options.stress = true;
    const auto runs = run_defects(options, {&driver});
    EXPECT_EQ(exit_code(runs), 0);
    const Report report = defect_report(runs, {}, options);
    EXPECT_TRUE(contains(report.sheet.text(), "denormals_multiplied on flushing: flushed: ")) << report.sheet.text();
    EXPECT_TRUE(contains(report.json.dump(), "\"reason\":\"flushed: "));
    EXPECT_FALSE(report.json["tetrace"]["defects"].front().contains("reason"));

    driver.flushes = "denormals_copied";
    EXPECT_EQ(exit_code(run_defects(options, {&driver})), 1) << "a copy may not";
}

TEST(DefectRuns, that_show_what_is_known_pass_and_changes_in_either_direction_fail)
{
    Device device = some_device();
    device.implementation = "some-1.2";
    Driver driver("bad", device);
    driver.wrong = loop;
    const Expectations known = expectations_of(runs_of(driver));
    ASSERT_EQ(known.at("some-1.2").defects.at(loop), DefectFinding::wrong);
    const auto judged = [&] { return run_defects({}, {&driver}, &known); };
    const auto text = [&] { return defect_report(judged(), {}, {}, &known).sheet.text(); };

    EXPECT_EQ(exit_code(judged()), 0);
    EXPECT_TRUE(contains(text(), "Conforms  4 reduced kernels on 1 device, 1 failure as expected.")) << text();
    EXPECT_TRUE(contains(text(), "known: 1 of 16 items")) << text();
    EXPECT_TRUE(contains(defect_junit(judged()), "failures=\"0\" errors=\"0\""));

    driver.wrong = "";
    EXPECT_EQ(exit_code(judged()), 1);
    EXPECT_TRUE(
        contains(text(), "defect/value_after_divergent_loop on bad: unexpected pass: expected wrong, shows right"))
        << text();
    EXPECT_TRUE(contains(defect_junit(judged()), "<failure message=\"unexpected pass: expected wrong, shows right\">"));

    driver.wrong = "steps_of_nested_loops";
    EXPECT_EQ(exit_code(judged()), 1);
    EXPECT_TRUE(contains(text(), "FAILED    1 new failure, 1 unexpected pass in 4 reduced kernels on 1 device."))
        << text();

    driver.wrong = loop, driver.fails = "steps_of_nested_loops";
    EXPECT_EQ(exit_code(judged()), exit_code(ErrorKind::driver));
}

TEST(DefectRuns, of_a_driver_that_crashes_are_errors_and_the_next_ones_run)
{
    Driver driver("crashing");
    driver.fails = loop;
    const auto runs = runs_of(driver);
    EXPECT_EQ(runs[0].sight, DefectSight::error);
    EXPECT_EQ(runs[0].reason, "SIGSEGV");
    EXPECT_EQ(runs[1].sight, DefectSight::not_seen);
    EXPECT_EQ(exit_code(runs), 1);
    EXPECT_TRUE(contains(defect_junit(runs), "<error message=\"SIGSEGV\"/>"));
}

TEST(DefectRuns, on_nothing_usable_are_skipped_and_no_success)
{
    Driver driver("none", unusable_device("none", "install it"));
    Options options;
    options.backends = {"none"};
    const auto runs = run_defects(options, {&driver});
    ASSERT_EQ(runs.size(), reduced_count);
    EXPECT_EQ(runs[0].sight, DefectSight::skipped);
    EXPECT_FALSE(defect_report(runs, {}, options).json["tetrace"]["defects"][0].contains("items")) << "of no launch";
    EXPECT_EQ(exit_code(runs), 3);
    EXPECT_EQ(exit_code(std::vector<DefectRun>()), 3);
}

TEST(DefectRuns, leave_out_backends_that_compile_nothing)
{
    FakeBackend embree("embree", some_device());
    Driver driver("good");
    EXPECT_EQ(run_defects({}, {&embree, &driver}).size(), reduced_count);
}
