// The page claims no more than the terminal: it says first whether to trust the rates, and judges none that are noisy.
#include "tests/output/report_fixture.h"

#include <regex>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// A walk and a BVH on one GPU, twice as slow; quiet.
json pair_json(double bvh_mrays_per_s = 2)
{
    json result = bench_json();
    json& rows = result["tetrace"]["rows"];
    rows = {row_json("row/cuda", "cuda", "gpu", innocent), row_json("row/bvh", "cuda", "gpu", innocent)};
    rows[1].update({{"structure", "bvh"}, {"method", "single"}, {"layout", "bvh2"}});
    for (json& row : rows) {
        row["times"]["noisy"] = false;
        row["times"]["samples_s"] = {1.09, 1.095, 1.1, 1.1, 1.105, 1.11};
    }
    rows[1]["rates"]["mrays_per_s"] = bvh_mrays_per_s;
    rows[0]["rates"].update({{"best_bvh", "row/bvh"}, {"ratio_to_best_bvh", 2.0}});
    result["tetrace"]["ratios"] = {
        {{"row", "row/bvh"}, {"reference", "row/cuda"}, {"ratio", 0.5}, {"low", 0.49}, {"high", 0.51}}};
    result["tetrace"]["load"] = {{"others", 0.01}, {"average", 1.0}, {"processors", 2}};
    return result;
}

json with_noise(json result, std::size_t row)
{
    result["tetrace"]["rows"][row]["times"].update({{"noisy", true}, {"disturbed", "others used the processors"}});
    return result;
}

/// Slower by a factor, in each sample.
json slower(json result, double factor)
{
    for (json& row : result["tetrace"]["rows"]) {
        for (json& sample : row["times"]["samples_s"])
            sample = factor * sample.get<double>();
        row["rates"]["mrays_per_s"] = row["rates"]["mrays_per_s"].get<double>() / factor;
    }
    return result;
}

/// What a page has in bold.
std::string bold_of(const std::string& page)
{
    std::string bold;
    const std::regex element("<(h[1-6]|b|strong|th)[ >].*?</\\1>");
    for (auto it = std::sregex_iterator(page.begin(), page.end(), element); it != std::sregex_iterator(); ++it)
        bold += it->str() + "\n";
    return bold;
}

} // namespace

TEST_F(ReportPage, begins_with_whether_to_trust_its_rates)
{
    EXPECT_TRUE(contains(page_of({pair_json()}),
                         "</h1><p class=\"trust\"><strong>Trust</strong>: other processes used 0.01 of 2 CPUs while "
                         "measuring, load average 1.0; 0 of 2 rows noisy.</p>"));
    const std::string noisy = page_of({pair_json(), with_noise(pair_json(), 0), check_json()});
    EXPECT_TRUE(contains(noisy, "</h1><p class=\"trust\"><strong>Trust A</strong>"));
    EXPECT_TRUE(contains(noisy, "1 of 2 rows noisy: do not trust the noisy ones; measure again on a quieter machine "
                                "(docs/calm-machine.md).</p>"));
    EXPECT_FALSE(contains(noisy, "Trust C")) << "nothing was timed";
    std::vector<json> many(7, pair_json());
    many[2] = with_noise(pair_json(), 1);
    const std::string sum = page_of(many);
    EXPECT_TRUE(contains(sum, "</h1><p class=\"trust fair\"><strong>Trust</strong>: 1 of 14 rows noisy, in 1 of 7 "
                              "results, which are listed below.</p>"));
    EXPECT_TRUE(contains(section_of(sum, "machines"), ">1 of 2</td>"));
}

TEST_F(ReportPage, names_a_governor_and_a_battery_as_the_terminal_does)
{
    json result = pair_json();
    result["tetrace"]["conditions"] = {{"governor", "powersave"}, {"on_battery", true}, {"turbo", true}};
    EXPECT_TRUE(contains(page_of({result}), "; the CPUs&apos; frequency governor is powersave, on battery; 0 of 2"));
}

TEST_F(ReportPage, has_a_ratio_in_bold_only_of_two_quiet_rows)
{
    const std::string times = "2.00 times as fast";
    EXPECT_TRUE(contains(bold_of(page_of({pair_json()})), times));
    for (const std::size_t row : {0, 1}) {
        const std::string page = page_of({with_noise(pair_json(), row)});
        EXPECT_FALSE(contains(bold_of(page), times));
        EXPECT_TRUE(contains(bold_of(page), "noisy, no ratio to rely on"));
        EXPECT_TRUE(contains(section_of(page, "answer"), "<figcaption>noisy: cubes on a device of cuda: rays go "
                                                         "through the tets 2.00 times as fast"));
    }
}

TEST_F(ReportPage, a_noisy_ratio_is_hollow_and_says_so)
{
    const std::string quiet = section_of(page_of({pair_json()}), "ratios");
    EXPECT_TRUE(contains(quiet, "class=\"solid\"")) << quiet;
    EXPECT_TRUE(contains(quiet, ">2.00</td>"));
    for (const std::size_t row : {0, 1}) {
        const std::string noisy = section_of(page_of({with_noise(pair_json(), row)}), "ratios");
        EXPECT_TRUE(contains(noisy, "class=\"hollow\""));
        EXPECT_FALSE(contains(noisy, "class=\"solid\""));
        EXPECT_TRUE(contains(noisy, ">noisy</text>"));
        EXPECT_TRUE(contains(noisy, ">2.00<small>noisy</small></td>"));
    }
}

TEST_F(ReportPage, of_two_results_begins_with_b_over_a_and_its_verdict)
{
    const std::string page = page_of({pair_json(), slower(pair_json(), 2)});
    const std::string head = page.substr(0, page.find("<nav>"));
    EXPECT_TRUE(contains(head, "<strong>B over A</strong>: 2 of 2 rows: 2 SLOWER; geometric mean of B / A 0.500.</p>"))
        << head;
    EXPECT_LT(head.find("B over A"), head.find("class=\"summary\""));
    EXPECT_LT(page.find("<section id=\"compared\""), page.find("<section id=\"machines\""));
    const std::string section = section_of(page, "compared");
    EXPECT_TRUE(contains(section, "<td>cubes: bvh bvh2 cuda</td>")) << section;
    EXPECT_TRUE(contains(section, "0.50 [0.4"));
    EXPECT_TRUE(contains(section, "class=\"badge bad\""));
    EXPECT_FALSE(contains(section, "<small>noisy"));
    EXPECT_TRUE(
        contains(section_of(page_of({pair_json(), with_noise(pair_json(), 1)}), "compared"), "]<small>noisy</small>"));
}

TEST_F(ReportPage, compares_only_two_results_of_the_same_work)
{
    json other = pair_json();
    other["tetrace"]["scenes"][0]["hash"] = "fedcba9876543210";
    const std::string page = page_of({pair_json(), other});
    EXPECT_TRUE(contains(page, "A and B have no row of the same work"));
    EXPECT_TRUE(contains(section_of(page, "compared"), "no section"));
    for (const auto& results :
         std::vector<std::vector<json>>{{pair_json(), check_json()}, {pair_json(), pair_json(), pair_json()}}) {
        EXPECT_FALSE(contains(page_of(results), "class=\"verdict\""));
        EXPECT_TRUE(contains(section_of(page_of(results), "compared"), "no section"));
    }
}
