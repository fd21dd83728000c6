#include "bench/report/page.h"
#include "bench/report/sections.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <regex>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

namespace {

using nlohmann::json;

/// Names that would leave their place if anything forgot to escape them; or their innocent counterpart.
struct Names {
    std::string device, reason, title;
};
const Names innocent = {"a device", "a reason", "a title"};
const Names hostile = {R"(<script>alert("1")</script> & 'Co' </svg></title>)",
                       "</td></table><img src=https://example.org/x onerror=alert(1)>",
                       "\"><style>body{background:url(https://example.org/x)}</style><!-- "};

json row_json(const std::string& name, const std::string& backend, const std::string& type, const Names& names)
{
    return {{"name", name},
            {"scene", "cubes"},
            {"structure", "cdt"},
            {"method", "maria"},
            {"layout", "tet80"},
            {"backend", backend},
            {"rays", "primary"},
            {"math", "exact"},
            {"order", "hilbert"},
            {"status", "ok"},
            {"device", {{"name", names.device + " of " + backend}, {"type", type}, {"driver", names.device}}},
            {"device_index", 0},
            {"hit_hash", "00000000000000ff"},
            {"bytes", 1000000},
            {"counts", {{"mean_steps", 10.5}}},
            {"times",
             {{"samples_s", {1.0, 1.1, 1.2}},
              {"median_s", 1.1},
              {"lower_quartile_s", 1.05},
              {"upper_quartile_s", 1.15},
              {"noisy", true},
              {"overhead_s", 0.01},
              {"wall_s", 1.11}}},
            {"rates", {{"mrays_per_s", 4.0}, {"msteps_per_s", 40.0}, {"bytes_per_step", 44}}}};
}

json device_json(const std::string& backend, const std::string& type, const Names& names)
{
    return {{"backend", backend}, {"index", 0},           {"name", names.device + " of " + backend},
            {"type", type},       {"driver", "a driver"}, {"copy_bytes_per_s", 1e10},
            {"launch_s", 1e-5}};
}

json head_json(const char* verb, const Names& names)
{
    return {{"schema_version", 2},
            {"verb", verb},
            {"date", "2026-01-31T12:00:00Z"},
            {"version", "0.1.0"},
            {"commit", "abc1234"},
            {"host", {{"cpu", names.device}, {"system", names.title}, {"threads", 2}}}};
}

json scenes_json(const Names& names)
{
    return {{{"name", "cubes"},
             {"hash", "0123456789abcdef"},
             {"source", names.title},
             {"camera_set", "smoke"},
             {"views", {0, 3}},
             {"width", 24},
             {"height", 16}}};
}

/// A row on the processor, on a GPU, on an emulated device, and one that could not run.
json bench_json(const Names& names = innocent)
{
    json section = head_json("bench", names);
    section["scenes"] = scenes_json(names);
    section["devices"] = {device_json("openmp", "cpu", names), device_json("cuda", "gpu", names),
                          device_json("vulkan", "emulated", names)};
    section["rows"] = {row_json("row/openmp", "openmp", "cpu", names), row_json("row/cuda", "cuda", "gpu", names),
                       row_json("row/vulkan", "vulkan", "emulated", names)};
    json failed = row_json("row/opencl", "opencl", "emulated", names);
    failed.erase("rates");
    failed.erase("times");
    failed["status"] = "error";
    failed["reason"] = names.reason;
    section["rows"].push_back(failed);
    section["ratios"] = {
        {{"row", "row/vulkan"}, {"reference", "row/openmp"}, {"ratio", 1.1}, {"low", 0.9}, {"high", 1.2}}};
    return {{"tetrace", section}};
}

json check_json(const Names& names = innocent)
{
    json section = head_json("check", names);
    section["scenes"] = scenes_json(names);
    section["rows"] = json::array();
    section["missing_devices"] = {names.reason};
    section["matrix"]["cubes"]["cdt maria tet80"] = {{"openmp", {{"cell", "reference"}, {"conformity", "reference"}}},
                                                     {"vulkan", {{"cell", names.reason}, {"conformity", "wrong"}}}};
    return {{"tetrace", section}};
}

json reproduce_json(const Names& names = innocent)
{
    const json claims = {{{"id", "1"}, {"text", names.title}, {"verdict", "holds"}, {"evidence", names.reason}},
                         {{"id", "2"}, {"text", "another"}, {"verdict", "does not hold"}, {"evidence", ""}}};
    json section = head_json("reproduce", names);
    section["tables"] = {
        {{"id", "table4"},
         {"title", names.title},
         {"source", names.reason},
         {"columns", {{{"key", "method"}, {"title", names.title}}, {{"key", "rate"}, {"title", "rate"}}}},
         {"rows",
          {{{"method", names.device},
            {"rate", {{"value", 12.5}, {"low", 12}, {"high", 13}, {"paper", 25}, {"ratio", 0.5}}}}}},
         {"claims", claims},
         {"notes", {names.reason}}}};
    section["figures"] = {{{"id", "figure6"},
                           {"title", names.title},
                           {"source", "the paper"},
                           {"x", {{"title", names.title}, {"unit", ""}}},
                           {"y", {{"title", "time"}, {"unit", "ms"}}},
                           {"series", {{{"name", names.device}, {"points", {{0, 1}, {1, 2}}}}}},
                           {"claims", json::array()},
                           {"pictures", json::array()},
                           {"notes", json::array()}}};
    return {{"tetrace", section}};
}

/// The tags of a page in their order, attributes and text left out. What quotes enclose is no tag.
std::vector<std::string> tags_of(const std::string& page)
{
    std::vector<std::string> tags;
    const std::regex tag("<(/?[a-z0-9]+)(?: [-a-zA-Z0-9]+=\"[^\"]*\")*>");
    for (auto it = std::sregex_iterator(page.begin(), page.end(), tag); it != std::sregex_iterator(); ++it)
        tags.push_back((*it)[1]);
    return tags;
}

std::multiset<std::string> rows_of(const std::string& page, const std::string& css_class)
{
    std::multiset<std::string> rows;
    const std::regex mark("class=\"" + css_class + "[^\"]*\" data-row=\"([^\"]*)\"");
    for (auto it = std::sregex_iterator(page.begin(), page.end(), mark); it != std::sregex_iterator(); ++it)
        rows.insert((*it)[1]);
    return rows;
}

std::vector<std::string> drawings_of(const std::string& page)
{
    std::vector<std::string> drawings;
    for (std::size_t at = page.find("<svg"); at != std::string::npos; at = page.find("<svg", at + 1))
        drawings.push_back(page.substr(at, page.find("</svg>", at) - at));
    return drawings;
}

/// The part of a page from the heading of one section to the next.
std::string section_of(const std::string& page, const std::string& id)
{
    const std::size_t begin = page.find("<section id=\"" + id + "\"");
    if (begin == std::string::npos) return "no section " + id;
    return page.substr(begin, page.find("</section>", begin) - begin);
}

class ReportPage : public testing::Test {
protected:
    std::string page_of(const std::vector<json>& results, std::vector<std::filesystem::path> pictures = {})
    {
        std::vector<std::filesystem::path> files;
        for (const json& result : results) {
            files.push_back(folder_ / fmt::format("{}.json", files.size()));
            write_file(files.back(), result.dump());
        }
        return tetrace::report_page(read_report_input(files, std::move(pictures)));
    }
    std::string error_of_page(const json& result, std::vector<std::filesystem::path> pictures = {})
    {
        return error_of([&] { static_cast<void>(page_of({result}, std::move(pictures))); });
    }

    TemporaryFolder folder_;
};

/// A PNG of one white pixel.
const std::string
    white_pixel("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\0\0\0\0\x3a\x7e\x9b\x55\0\0\0\nIDAT"
                "\x78\x9c\x63\xf8\x0f\0\x01\x01\x01\0\x1b\xb6\xee\x56\0\0\0\0IEND\xae\x42\x60\x82",
                67);

} // namespace

TEST_F(ReportPage, tags_are_balanced)
{
    write_file(folder_ / "a.png", white_pixel);
    std::vector<std::string> open;
    for (const std::string& tag : tags_of(page_of({bench_json(), check_json(), reproduce_json()}, {folder_ / "a.png"})))
        if (tag[0] == '/') {
            ASSERT_FALSE(open.empty());
            EXPECT_EQ(open.back(), tag.substr(1));
            open.pop_back();
        } else if (tag != "meta" && tag != "img") {
            open.push_back(tag);
        }
    EXPECT_TRUE(open.empty());
}

TEST_F(ReportPage, names_of_whatever_characters_change_no_markup)
{
    const auto tags = [&](const Names& names) {
        return tags_of(page_of({bench_json(names), check_json(names), reproduce_json(names)}));
    };
    EXPECT_EQ(tags(hostile), tags(innocent));
    const std::string page = page_of({bench_json(hostile)});
    EXPECT_TRUE(contains(page, "&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt; &amp; &apos;Co&apos;"));
}

TEST_F(ReportPage, loads_nothing_and_runs_nothing)
{
    write_file(folder_ / "a.png", white_pixel);
    const std::string page = page_of({bench_json(hostile), check_json(hostile)}, {folder_ / "a.png"});
    for (const std::string& tag : tags_of(page))
        EXPECT_TRUE(tag != "script" && tag != "link" && tag != "iframe" && tag != "object") << tag;
    const std::regex source("<[^>\"]*(?: [-a-zA-Z0-9]+=\"[^\"]*\")* (src|href|srcset|data|on[a-z]+)=\"([^\"]{0,30})");
    for (auto it = std::sregex_iterator(page.begin(), page.end(), source); it != std::sregex_iterator(); ++it) {
        const std::string target = (*it)[2];
        EXPECT_TRUE(target.rfind("#", 0) == 0 || target.rfind("data:image/png;base64,", 0) == 0) << it->str();
    }
    const std::string style = page.substr(page.find("<style>"), page.find("</style>") - page.find("<style>"));
    EXPECT_EQ(style.find("url("), std::string::npos);
    EXPECT_EQ(style.find("@import"), std::string::npos);
    EXPECT_TRUE(contains(page, "content=\"default-src &apos;none&apos;; style-src"));
}

TEST_F(ReportPage, every_row_has_its_mark_or_its_reason)
{
    const std::string page = page_of({bench_json()});
    using Rows = std::multiset<std::string>;
    EXPECT_EQ(rows_of(section_of(page, "rates"), "mark "), (Rows{"row/openmp", "row/cuda", "row/vulkan"}));
    EXPECT_EQ(rows_of(section_of(page, "rates"), "unrated"), (Rows{"row/opencl"}));
    EXPECT_EQ(rows_of(section_of(page, "roofline"), "mark "), (Rows{"row/openmp", "row/cuda", "row/vulkan"}));
    EXPECT_EQ(rows_of(section_of(page, "ratios"), "mark "), (Rows{"row/vulkan"}));
    EXPECT_TRUE(contains(section_of(page, "rates"), "a reason"));
}

TEST_F(ReportPage, emulated_devices_and_gpus_share_no_chart)
{
    const std::string rates = section_of(page_of({bench_json(), bench_json()}), "rates");
    const auto drawings = drawings_of(rates);
    EXPECT_EQ(drawings.size(), 3u);
    for (const std::string& drawing : drawings) {
        const auto rows = rows_of(drawing, "mark ");
        EXPECT_EQ(rows.size(), 2u) << "the same rays of both results stand in one chart";
        EXPECT_EQ(std::set<std::string>(rows.begin(), rows.end()).size(), 1u);
    }
}

TEST(ReportColours, are_those_of_earlier_pages_and_one_for_each_backend)
{
    const std::vector<std::string> first = {"openmp", "embree", "opencl", "vulkan", "cuda", "cuda-host"};
    for (std::size_t i = 0; i < first.size(); ++i)
        EXPECT_EQ(api_series(first[i]), i) << first[i];
    std::set<std::size_t> seen;
    for (const Backend* backend : all_backends())
        EXPECT_TRUE(seen.insert(api_series(backend->name())).second) << backend->name();
}

TEST_F(ReportPage, other_rays_have_a_chart_of_their_own)
{
    json other = bench_json();
    other["tetrace"]["scenes"][0]["hash"] = "fedcba9876543210";
    const std::string rates = section_of(page_of({bench_json(), other}), "rates");
    EXPECT_EQ(drawings_of(rates).size(), 6u);
}

TEST_F(ReportPage, what_is_not_in_the_results_is_a_sentence)
{
    json empty = bench_json();
    for (const char* const key : {"devices", "rows", "ratios", "scenes"})
        empty["tetrace"].erase(key);
    const std::string page = page_of({empty});
    EXPECT_EQ(page.find("<svg"), std::string::npos);
    for (const char* const id : {"rates", "ratios", "roofline", "conformance", "paper", "pictures", "times"})
        EXPECT_TRUE(contains(section_of(page, id), "<p>")) << id;
    EXPECT_TRUE(contains(section_of(page, "rates"), "No row of these results has a rate"));
}

TEST_F(ReportPage, a_row_of_an_unmeasured_device_is_on_no_roofline)
{
    json result = bench_json();
    for (json& device : result["tetrace"]["devices"])
        device.erase("copy_bytes_per_s");
    EXPECT_TRUE(contains(section_of(page_of({result}), "roofline"), "No device of these results"));
}

TEST_F(ReportPage, the_papers_values_stand_beside_ours_with_the_verdicts)
{
    const std::string paper = section_of(page_of({reproduce_json()}), "paper");
    EXPECT_TRUE(contains(paper, "12.5<small>12.0 to 13.0</small><small class=\"paper\">paper 25.0, × 0.500</small>"));
    EXPECT_TRUE(contains(paper, "✓</span> holds"));
    EXPECT_TRUE(contains(paper, "✗</span> does not hold"));
    EXPECT_TRUE(contains(paper, "class=\"line\""));
    EXPECT_TRUE(contains(page_of({reproduce_json()}), "2 claims of the paper: 1 hold, 1 do not hold"));
}

TEST_F(ReportPage, numbers_have_the_decimals_of_their_column)
{
    json result = reproduce_json();
    json& table = result["tetrace"]["tables"][0];
    table["columns"][1]["decimals"] = 0;
    table["rows"][0]["rate"] = {{"value", 9}, {"paper", 1282}, {"ratio", 9.0 / 1282}};
    const std::string paper = section_of(page_of({result}), "paper");
    EXPECT_TRUE(contains(paper, ">9<small class=\"paper\">paper 1,282, × 0.00702</small>")) << paper;
    table["columns"][1]["decimals"] = 16;
    EXPECT_TRUE(contains(error_of_page(result), "columns[1].decimals: is no number of decimals"));
}

TEST_F(ReportPage, pictures_are_in_the_page_byte_for_byte)
{
    write_file(folder_ / "bunny-0-normals.png", white_pixel);
    const std::string page = page_of({bench_json()}, {folder_ / "bunny-0-normals.png"});
    EXPECT_TRUE(contains(page, "data:image/png;base64," + base64(white_pixel)));
    json result = reproduce_json();
    result["tetrace"]["figures"][0]["pictures"] = {"bunny-0-normals.png"};
    EXPECT_TRUE(contains(section_of(page_of({result}), "paper"), base64(white_pixel))) << "relative to the result";
}

TEST_F(ReportPage, a_named_picture_that_is_missing_is_a_sentence_and_one_asked_for_an_error)
{
    json result = reproduce_json();
    result["tetrace"]["figures"][0]["pictures"] = {"none.png"};
    const std::string paper = section_of(page_of({result}), "paper");
    EXPECT_TRUE(contains(paper, "The picture &apos;none.png&apos;, which the result names, is not shown: there is no"));
    EXPECT_TRUE(contains(error_of_page(bench_json(), {folder_ / "none.png"}), "missing: reading the picture"));
}

TEST_F(ReportPage, values_that_cannot_be_drawn_are_named_with_their_key)
{
    const auto error_with = [&](json result, const char* pointer, const json& value) {
        result[json::json_pointer(std::string("/tetrace") + pointer)] = value;
        return error_of_page(result);
    };
    EXPECT_TRUE(contains(error_with(bench_json(), "/rows/0/rates/mrays_per_s", 0), "rows[0].rates.mrays_per_s"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/rows/0/rates/mrays_per_s", nullptr), "rows[0].rates.mrays_per_s"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/rows/1/times/median_s", "1"), "rows[1].times.median_s"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/devices/0/type", "fpga"), "devices[0].type: is 'fpga'"));
    json nowhere = bench_json();
    nowhere["tetrace"]["rows"][1].erase("device");
    EXPECT_TRUE(contains(error_of_page(nowhere), "rows[1]: has a rate and no device"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/devices/0/copy_bytes_per_s", -1), "devices[0].copy_bytes_per_s"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/ratios/0/low", 0), "ratios[0].low"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/ratios/0/row", "none"), "no row of that name"));
    EXPECT_TRUE(contains(error_with(bench_json(), "/rows/0/scene", "none"), "not among its scenes"));
    EXPECT_TRUE(
        contains(error_with(reproduce_json(), "/figures/0/series/0/points/1", {1}), "points[1]: is not a point"));
    EXPECT_TRUE(contains(error_with(reproduce_json(), "/figures/0/series/0/points/1/0", 1e300), "points[1][0]"));
    EXPECT_TRUE(contains(error_with(reproduce_json(), "/figures/0/x/scale", "cubic"), "is no scale"));
    json logarithmic = reproduce_json();
    logarithmic["tetrace"]["figures"][0]["x"]["scale"] = "logarithmic";
    EXPECT_TRUE(contains(error_with(logarithmic, "/figures/0/series/0/points/1/0", 0), "on a logarithmic axis"));
    EXPECT_TRUE(contains(error_with(reproduce_json(), "/tables/0/rows/0/rate", false), "rows[0].rate"));
}

TEST(Base64, is_that_of_the_standards_examples)
{
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

namespace {

std::string find_chromium()
{
    for (const char* const name : {"chromium", "chromium-headless-shell", "google-chrome", "chrome"})
        if (std::system(fmt::format("command -v {} > /dev/null 2>&1", name).c_str()) == 0) return name;
    return {};
}

/// What a browser makes of a page: its document as text, and what it wrote to its console.
struct Browsed {
    std::string document, console;
};

class ReportInChromium : public ReportPage {
protected:
    void SetUp() override
    {
        browser_ = find_chromium();
        if (browser_.empty())
            GTEST_SKIP() << "no Chromium (Debian's package chromium-headless-shell): the page was opened by nobody";
    }
    Browsed browse(const std::string& page)
    {
        write_file(folder_ / "page.html", page);
        const auto document = folder_ / "document", log = folder_ / "log";
        const std::string command = fmt::format(
            "HOME='{0}' timeout 60 {1} --headless --no-sandbox --disable-gpu --disable-dev-shm-usage "
            "--user-data-dir='{0}/profile' --enable-logging=stderr --dump-dom 'file://{0}/page.html' > '{2}' 2> '{3}'",
            folder_.path().string(), browser_, document.string(), log.string());
        EXPECT_EQ(std::system(command.c_str()), 0) << read_text(log);
        Browsed browsed{read_text(document), {}};
        const std::string text = read_text(log);
        for (std::size_t at = text.find("CONSOLE"); at != std::string::npos; at = text.find("CONSOLE", at + 1))
            browsed.console += text.substr(at, text.find('\n', at) - at) + "\n";
        return browsed;
    }

    std::string browser_;
};

} // namespace

TEST_F(ReportInChromium, opens_without_a_word_on_the_console_and_every_chart_has_its_data)
{
    write_file(folder_ / "a.png", white_pixel);
    const Browsed browsed =
        browse(page_of({bench_json(hostile), check_json(hostile), reproduce_json(hostile)}, {folder_ / "a.png"}));
    EXPECT_EQ(browsed.console, "");
    using Rows = std::multiset<std::string>;
    EXPECT_EQ(rows_of(section_of(browsed.document, "rates"), "mark "), (Rows{"row/openmp", "row/cuda", "row/vulkan"}));
    EXPECT_EQ(rows_of(section_of(browsed.document, "rates"), "unrated"), (Rows{"row/opencl"}));
    EXPECT_EQ(rows_of(section_of(browsed.document, "roofline"), "mark ").size(), 3u);
    EXPECT_EQ(rows_of(section_of(browsed.document, "ratios"), "mark ").size(), 1u);
    EXPECT_TRUE(contains(section_of(browsed.document, "paper"), "class=\"line\""));
}

TEST_F(ReportInChromium, a_page_that_loads_or_runs_something_would_be_told)
{
    std::string page = page_of({bench_json()});
    const std::size_t body = page.find("<body>") + 6;
    page.insert(body, "<script>document.title = 1</script><img src=\"https://example.org/x.png\">");
    const std::string console = browse(page).console;
    EXPECT_TRUE(contains(console, "script"));
    EXPECT_TRUE(contains(console, "example.org"));
}
