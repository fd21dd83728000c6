// The page of many results: an index, machines compared in the same work, and each machine over its dates.
#include "bench/report/campaign/campaign.h"
#include "bench/results/result_folder.h"
#include "tests/output/report_fixture.h"

#include <algorithm>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// A result of bench on a machine, some days after the first of January.
json result_of_day(const std::string& label, int day, double mrays_per_s = 4)
{
    json result = bench_json();
    json& section = result["tetrace"];
    section["label"] = label;
    section["threads"] = 2;
    section["date"] = fmt::format("2026-{:02}-{:02}T12:00:00Z", 1 + day / 28, 1 + day % 28);
    for (json& row : section["rows"]) {
        if (!row.contains("rates")) continue;
        row["rates"]["mrays_per_s"] = mrays_per_s;
        row["times"]["samples_s"] = json::array();
        for (int i = 0; i < 12; ++i)
            row["times"]["samples_s"].push_back((1 + 0.0001 * i) * 4 / mrays_per_s);
    }
    return result;
}

class CampaignPage : public testing::Test {
protected:
    /// Results 000.json, 001.json, ... in a folder of their own: "0", of the next campaign "1", and so on.
    Campaign campaign_of(const std::vector<json>& results)
    {
        const std::filesystem::path folder = folder_ / std::to_string(campaigns_++);
        for (std::size_t i = 0; i < results.size(); ++i)
            write_file(folder / fmt::format("{:03}.json", i), results[i].dump());
        return read_campaign(files_below({folder}));
    }
    std::string page_of(const std::vector<json>& results) { return campaign_page(campaign_of(results), {}); }

    TemporaryFolder folder_;
    int campaigns_ = 0;
};

} // namespace

TEST_F(CampaignPage, has_an_index_of_a_hundred_results_of_ten_hosts)
{
    std::vector<json> results;
    for (int i = 0; i < 100; ++i)
        results.push_back(result_of_day(fmt::format("host {}", i % 10), i / 10));
    const std::string page = page_of(results);
    const std::string index = section_of(page, "index");
    EXPECT_EQ(occurrences(index, "<tr>"), 1u + 30 + 1 + 100)
        << "a processor, a GPU and an emulated device of each host";
    for (int i = 0; i < 100; ++i)
        EXPECT_TRUE(contains(index, fmt::format("/{:03}.json</code>", i))) << i;
    EXPECT_EQ(occurrences(index, "over dates</a>"), 30u);
    EXPECT_TRUE(contains(page, "100 results"));
    EXPECT_TRUE(contains(page, "2026-01-01 12:00 to 2026-01-10 12:00 UTC"));
    EXPECT_TRUE(contains(page, "400 rows: 300 ok, 100 error"));
    EXPECT_TRUE(contains(page, "</h1><p class=\"trust fair\"><strong>Trust</strong>: 300 of 300 rows noisy, in 100 of "
                               "100 results"));
    EXPECT_EQ(occurrences(index, ">3 of 3</td>"), 100u);
    for (std::size_t at = index.find("href=\"#"); at != std::string::npos; at = index.find("href=\"#", at + 1)) {
        const std::string anchor = index.substr(at + 7, index.find('"', at + 7) - at - 7);
        EXPECT_TRUE(contains(page, "id=\"" + anchor + "\"")) << anchor;
    }
}

// A BVH's row is the same work through other tets, whose rows have a table of their own.
TEST_F(CampaignPage, has_a_bvhs_row_in_the_table_of_each_scene_that_it_was_timed_on)
{
    std::vector<json> results = {result_of_day("one", 0), result_of_day("one", 1)};
    for (json& result : results) {
        json& section = result["tetrace"];
        section["scenes"][0]["source_hash"] = "00000000000000aa";
        for (json& row : section["rows"])
            row["name"] = "bvh/" + row["name"].get<std::string>();
    }
    results[1]["tetrace"]["scenes"][0]["hash"] = "00000000000000bb";
    const Campaign campaign = campaign_of(results);
    EXPECT_EQ(campaign.groups.size(), 6u) << "three kinds of devices, two scenes";
    for (const CampaignGroup& group : campaign.groups) {
        ASSERT_EQ(group.works.size(), 1u) << group.title;
        EXPECT_EQ(group.works[0].rates.size(), 1u) << group.title;
    }
}

TEST_F(CampaignPage, grows_no_faster_than_its_results)
{
    const auto size_of = [&](int results) {
        std::vector<json> all;
        for (int i = 0; i < results; ++i)
            all.push_back(result_of_day(fmt::format("host {}", i % 5), i / 5));
        return page_of(all).size();
    };
    const std::size_t few = size_of(50);
    EXPECT_LT(size_of(100), 2 * few);
}

TEST_F(CampaignPage, shows_the_newest_rate_of_each_machine_next_to_the_first)
{
    const std::string machines =
        section_of(page_of({result_of_day("one", 3, 8), result_of_day("one", 1, 5), result_of_day("two", 2, 12)}),
                   "compared-machines");
    EXPECT_EQ(occurrences(machines, ">8.00<small>noisy</small></td>"), 3u) << machines;
    EXPECT_EQ(occurrences(machines, ">12.0<small>noisy</small><small>× 1.50</small>"), 3u)
        << "processor, GPU, emulated";
    EXPECT_FALSE(contains(machines, "5.00<"));
    EXPECT_EQ(occurrences(machines, ">1 work, 1 noisy</text>"), 6u) << "means of both machines";
    EXPECT_EQ(occurrences(machines, "<svg"), 3u);
}

TEST_F(CampaignPage, compares_only_rows_of_the_same_work)
{
    json other_hits = result_of_day("two", 1);
    other_hits["tetrace"]["rows"][2]["hit_hash"] = "0000000000000011";
    json other_scene = result_of_day("three", 1);
    other_scene["tetrace"]["scenes"][0]["hash"] = "fedcba9876543210";
    const std::string machines =
        section_of(page_of({result_of_day("one", 1), other_hits, other_scene}), "compared-machines");
    EXPECT_TRUE(contains(machines, "one, 2 threads"));
    EXPECT_TRUE(contains(machines, "two, 2 threads"));
    EXPECT_FALSE(contains(machines, "three")) << "no machine traced its scene";
    EXPECT_EQ(occurrences(machines, "<table>"), 2u) << "emulated devices gave other answers";
    EXPECT_TRUE(contains(section_of(page_of({result_of_day("one", 1)}), "compared-machines"), "no section"));
}

TEST_F(CampaignPage, keeps_segments_apart_from_what_is_traced)
{
    json result = result_of_day("a", 0);
    json& rows = result["tetrace"]["rows"];
    json other = rows[0];
    other.update({{"name", "segments/openmp"}, {"task", "segments"}, {"threads", 1}});
    rows.push_back(other);
    other.update({{"name", "two/openmp"}, {"launches_in_flight", 2}});
    rows.push_back(other);
    const Campaign campaign = campaign_of({result});
    const auto titled = [&](const char* part) {
        return std::ranges::count_if(campaign.groups, [&](const auto& group) { return contains(group.title, part); });
    };
    EXPECT_EQ(titled("segments of primary rays"), 1);
    EXPECT_TRUE(std::ranges::any_of(campaign.machines, [](const CampaignMachine& machine) {
        return machine.name.ends_with(", 1 thread");
    })) << "a row's own number of threads";
    EXPECT_TRUE(std::ranges::any_of(campaign.machines, [](const CampaignMachine& machine) {
        return machine.name.ends_with(", 1 thread, 2 launches in flight");
    })) << "whose rates are compared only with each other";
}

TEST_F(CampaignPage, says_how_much_work_has_no_counterpart)
{
    json more = result_of_day("two", 1);
    more["tetrace"]["rows"].push_back(more["tetrace"]["rows"][0]);
    more["tetrace"]["rows"].back()["name"] = "row/openmp/more";
    EXPECT_TRUE(
        contains(section_of(page_of({result_of_day("one", 1), more}), "compared-machines"), "1 work is not shown"));
}

TEST_F(CampaignPage, keeps_one_gpu_in_two_hosts_apart)
{
    const Campaign campaign = campaign_of({result_of_day("one", 1), result_of_day("two", 1)});
    std::set<std::string> names;
    for (const CampaignMachine& machine : campaign.machines)
        if (machine.kind == DeviceKind::gpu) names.insert(machine.name);
    EXPECT_EQ(names, (std::set<std::string>{"a device of cuda in one", "a device of cuda in two"}));
}

TEST_F(CampaignPage, distinguishes_hosts_by_label_or_processor_or_else_by_folder)
{
    json result = bench_json();
    const auto names_of = [&](const json& one, const json& two) {
        const std::filesystem::path folder = folder_ / std::to_string(campaigns_++);
        write_file(folder / "zen3/a.json", one.dump());
        write_file(folder / "zen5/b.json", two.dump());
        std::set<std::string> names;
        for (const CampaignMachine& machine : read_campaign(files_below({folder})).machines)
            if (machine.kind == DeviceKind::cpu) names.insert(machine.name);
        return names;
    };
    using Names = std::set<std::string>;
    EXPECT_EQ(names_of(result, result), (Names{"a device (folder zen3)", "a device (folder zen5)"}));
    json known = result;
    known["tetrace"]["host"].update({{"family", 25}, {"model", 1}, {"stepping", 1}});
    EXPECT_EQ(names_of(known, known), (Names{"a device (family 25, model 1, stepping 1)"}));
    known["tetrace"]["label"] = "mine";
    EXPECT_EQ(names_of(known, result), (Names{"mine", "a device (folder zen5)"}));
}

TEST_F(CampaignPage, distinguishes_runs_with_other_numbers_of_threads)
{
    json single = result_of_day("one", 1);
    single["tetrace"]["threads"] = 1;
    const std::string page = page_of({result_of_day("one", 2), single});
    EXPECT_TRUE(contains(section_of(page, "compared-machines"), "one, 1 thread"));
    EXPECT_TRUE(contains(section_of(page, "compared-machines"), "one, 2 threads"));
}

TEST_F(CampaignPage, draws_each_machine_over_its_dates_with_a_verdict_of_the_last_step)
{
    const std::string page =
        page_of({result_of_day("one", 3, 4.1), result_of_day("one", 1, 4), result_of_day("one", 2, 5)});
    const std::string trends = section_of(page, "trends");
    EXPECT_EQ(occurrences(trends, "class=\"line\""), 3u) << "a row on the processor, on the GPU, and an emulated one";
    EXPECT_EQ(occurrences(trends, ">SLOWER<"), 3u) << "from 5 to 4.1";
    EXPECT_EQ(occurrences(trends, ">SAME<"), 3u) << "from 4 to 4.1";
    EXPECT_TRUE(contains(trends, "0.820"));
    EXPECT_TRUE(contains(section_of(page_of({result_of_day("one", 1)}), "trends"), "no section"));
}

/// The calibration during the samples of each of its rows, over its fastest.
static json with_pulse_of_rows(json result, double ratio)
{
    for (json& row : result["tetrace"]["rows"])
        if (row.contains("times")) row["times"]["pulse"] = ratio;
    return result;
}

TEST_F(CampaignPage, calls_rates_of_a_machine_that_changed_noisy_as_compare_does)
{
    const std::string trends = section_of(
        page_of({result_of_day("one", 1, 4), with_pulse_of_rows(result_of_day("one", 2, 2), 1.6)}), "trends");
    EXPECT_EQ(occurrences(trends, ">NOISY<"), 6u) << "three rows, the last step and in all";
    EXPECT_EQ(occurrences(trends, ">SLOWER<"), 0u);
    EXPECT_TRUE(contains(trends, "in the second calibration during its samples took 1.60 times its fastest")) << trends;
    json before = result_of_day("one", 1, 4), after = result_of_day("one", 2, 2);
    const auto host = [](double seconds) {
        return json{{{"of", "host"}, {"fastest_s", seconds}, {"ratio", 1}, {"readings", {{0, seconds}}}}};
    };
    before["tetrace"]["pulses"] = host(0.01);
    after["tetrace"]["pulses"] = host(0.02);
    const std::string slower_host = section_of(page_of({before, after}), "trends");
    EXPECT_EQ(occurrences(slower_host, ">NOISY<"), 4u) << "only on the host";
    EXPECT_EQ(occurrences(slower_host, ">SLOWER<"), 2u) << "the GPU has a pulse of its own";
}

TEST_F(CampaignPage, leaves_noisy_rates_out_of_the_means_of_machines)
{
    const std::string noisy =
        section_of(page_of({result_of_day("one", 1, 4), with_pulse_of_rows(result_of_day("two", 2, 2), 1.6)}),
                   "compared-machines");
    EXPECT_EQ(occurrences(noisy, ">NOISY<"), 3u);
    EXPECT_FALSE(contains(noisy, "Means of the rates")) << noisy;
    EXPECT_TRUE(
        contains(section_of(page_of({result_of_day("one", 1, 4), result_of_day("two", 2, 2)}), "compared-machines"),
                 "Means of the rates"));
}

TEST_F(CampaignPage, compares_exit_searches_too)
{
    const auto searched = [](const char* label, double rate) {
        json result = reproduce_json();
        result["tetrace"]["label"] = label;
        json row = row_json("search/maria/tet80/random-tets/math:exact/api:openmp", "openmp", "cpu", innocent);
        row["face_hash"] = row["hit_hash"];
        row["msearches_per_s"] = rate;
        result["tetrace"]["searches"] = {{"tets", 100}, {"rays_a_tet", 80}, {"rows", {row}}};
        return result;
    };
    const std::string machines = section_of(page_of({searched("one", 50), searched("two", 60)}), "compared-machines");
    EXPECT_TRUE(contains(machines, "exit searches only, 100 x 80 (Table 5)")) << machines;
    EXPECT_TRUE(contains(machines, "maria tet80 api:openmp"));
    EXPECT_TRUE(contains(machines, "60.0<small>noisy</small><small>× 1.20</small>"));
}

TEST_F(CampaignPage, leaves_out_what_is_no_result_with_the_reason)
{
    write_file(folder_ / "0/schema.json", R"({"$schema": "a schema"})");
    write_file(folder_ / "0/cut.json", R"({"tetrace": {)");
    json bad = result_of_day("bad", 1);
    bad["tetrace"]["rows"][0]["rates"]["mrays_per_s"] = 0;
    const std::string index = section_of(page_of({result_of_day("one", 1), bad}), "index");
    EXPECT_TRUE(contains(index, "schema.json&apos;: section"));
    EXPECT_TRUE(contains(index, "cut.json"));
    EXPECT_TRUE(contains(index, "rows[0].rates.mrays_per_s"));
    const TemporaryFolder nothing;
    write_file(nothing / "a.json", "{}");
    EXPECT_TRUE(contains(error_of([&] { static_cast<void>(read_campaign(files_below({nothing.path()}))); }),
                         "none of the 1 files is a result"));
    EXPECT_TRUE(contains(error_of([&] { static_cast<void>(files_below({folder_ / "none"})); }), "does not exist"));
}

TEST_F(CampaignPage, names_of_whatever_characters_change_no_markup)
{
    const auto tags_with = [&](const Names& names) {
        json one = bench_json(names), two = bench_json(names);
        two["tetrace"]["label"] = names.title;
        two["tetrace"]["date"] = "2026-02-01T12:00:00Z";
        json three = two;
        three["tetrace"]["date"] = names.reason;
        const std::string page = page_of({one, two, three});
        return std::pair(occurrences(page, "<"), occurrences(page, ">"));
    };
    // as long as the hostile ones, since charts break long names into lines
    const auto harmless = [](std::string name) {
        for (char& c : name)
            if (std::string_view("<>&\"'").find(c) != std::string_view::npos) c = 'a';
        return name;
    };
    EXPECT_EQ(tags_with(hostile),
              tags_with({harmless(hostile.device), harmless(hostile.reason), harmless(hostile.title)}));
}

TEST(CampaignDays, are_those_of_the_calendar)
{
    EXPECT_EQ(day_of("1970-01-02T12:00:00Z"), 1.5);
    EXPECT_EQ(day_of("2026-11-21T00:00:00Z"), 20'778.0);
    for (const char* const bad : {"", "2026-11-21", "2026-02-30T00:00:00Z", "2026-11-21T24:00:00Z", "today"})
        EXPECT_FALSE(day_of(bad)) << bad;
}

TEST(FilesBelow, are_the_json_files_of_a_folder_by_path_each_once)
{
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "b/c");
    for (const char* const name : {"z.json", "a.json", "b/c/d.json", "b/e.txt"})
        write_file(folder / name, "{}");
    using Paths = std::vector<std::filesystem::path>;
    EXPECT_EQ(files_below({folder.path(), folder / "a.json"}),
              (Paths{folder / "a.json", folder / "b/c/d.json", folder / "z.json"}));
    EXPECT_TRUE(has_folder({folder / "a.json", folder / "b"}));
    EXPECT_FALSE(has_folder({folder / "a.json", folder / "none"}));
}
