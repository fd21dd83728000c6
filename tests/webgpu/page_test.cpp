// The page of `tetrace page` in Chromium, whose GPU is SwiftShader, which emulates one.
#include "bench/browser/browser_page.h"
#include "bench/expectations/expectation_files.h"
#include "bench/expectations/judgement.h"
#include "bench/show/recorded_rows.h"
#include "tests/support/bvh_scene.h"
#include "tests/support/chromium.h"
#include "tests/support/given_scene.h"
#include "tests/support/program_fixture.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

using namespace tetrace;
using namespace tetrace::test;

namespace {

constexpr const char* with_webgpu = "--enable-unsafe-webgpu";

/// A view of the cubes in a layout, answered by openmp.
struct PageCase {
    KernelId kernel;
    Scene scene = make_cubes(9);
    PackedScene packed;
    TraceJob job;
    PageScene page;

    explicit PageCase(const KernelId& id, const std::string& name, std::uint32_t size = 24)
        : kernel(id), packed(kernel.structure == Structure::bvh ? make_bvh_scene(scene.mesh, kernel.layout)
                                                                : pack(scene, kernel.layout, TetOrder::chains))
    {
        job.view = make_view(make_cameras(CameraSet::smoke, scene.mesh).front(), size, size);
        job.width = job.height = size;
        job.start_tet = NO_TET;
        job.max_steps = 10'000;
        page = {"cubes", "tetrace trace --scene cubes", scene.mesh.triangles.size(), packed.tet_count, size, size, {}};
        page.kernels.push_back({name, kernel, &packed, {}});
        page.kernels.back().views.push_back(page_view(7, job, packed, {}, answers()));
    }

    /// A result with as many rows as the page has kernels.
    [[nodiscard]] nlohmann::json result() const
    {
        nlohmann::json section = {{"host", nlohmann::json::object()},
                                  {"devices", {{{"self_test", {{"exact", nlohmann::json::object()}}}}}}};
        for (std::size_t i = 0; i < page.kernels.size(); ++i)
            section["rows"].push_back({{"device", nlohmann::json::object()},
                                       {"self_test", nlohmann::json::object()},
                                       {"counts", {{"hit_share", 0.25}}}});
        return {{"tetrace", section}};
    }

    /// openmp's, through the packed scene as it is now.
    [[nodiscard]] std::vector<Hit> answers() const
    {
        std::vector<Hit> hits(job.rays());
        const auto session = openmp_backend().open(0, kernel, {&scene.mesh, &packed}, {.threads = 2});
        static_cast<void>(session->trace(job, hits));
        return hits;
    }

    PageCase(const PageCase&) = delete;
    PageCase& operator=(const PageCase&) = delete;
};

const KernelId half32 = {.method = Method::project, .layout = Layout::half32};
const KernelId bvh2 = {.structure = Structure::bvh, .method = Method::single, .layout = Layout::bvh2};

class PageInChromium : public testing::Test {
protected:
    void SetUp() override
    {
        if (find_chromium().empty())
            GTEST_SKIP() << "no Chromium (Debian's package chromium-headless-shell): the page was opened by nobody";
    }
    Browsed run(const PageCase& of, const char* options = with_webgpu)
    {
        return browse(folder_.path(), browser_page({of.page}, of.result()), "?start&seconds=0", options);
    }

    TemporaryFolder folder_;
};

} // namespace

TEST_F(PageInChromium, verifies_and_measures_each_row)
{
    PageCase tets(half32, "cdt project half32"), bvh(bvh2, "bvh bvh2");
    tets.page.kernels.push_back(bvh.page.kernels.front());
    const Browsed browsed = run(tets);
    EXPECT_TRUE(contains(browsed.document, "data-verdict=\"conforms\"")) << browsed.document << browsed.console;
    for (const char* const part : {"Self-test: exact",
                                   "<td>cdt project half32</td><td>cubes</td><td>576</td><td>25 %</td>"
                                   "<td class=\"good\">bit-exact</td>",
                                   "<td>bvh bvh2</td>", "of 2 rows has the right answer"})
        EXPECT_TRUE(contains(browsed.document, part)) << part << "\n" << browsed.console;
}

TEST_F(PageInChromium, names_the_first_ray_that_is_wrong)
{
    PageCase tets(half32, "cdt project half32");
    // The last exit of each record becomes the domain's boundary.
    for (std::size_t quad = 1; quad < tets.packed.tets.size(); quad += HALF32_QUADS)
        tets.packed.tets[quad].z = NO_HALF_FACE;
    const auto right = tets.page.kernels.front().views.front().answers.rays, wrong = answer_hashes(tets.answers()).rays;
    const auto first = std::ranges::mismatch(right, wrong).in1 - right.begin();
    std::size_t count = 0;
    for (std::size_t ray = 0; ray < right.size(); ++ray)
        count += right[ray] == wrong[ray] ? 0 : 1;
    const Browsed browsed = run(tets);
    const std::string pixel = fmt::format("{},{}", first % 24, first / 24);
    for (const std::string& part : {std::string("data-verdict=\"failed\""), fmt::format("{} rays wrong</td>", count),
                                    fmt::format("cdt project half32, cubes, view 7: pixel {} is wrong", pixel),
                                    fmt::format("tetrace trace --scene cubes --view 7 --pixel {}\n", pixel)})
        EXPECT_TRUE(contains(browsed.document + "\n", part)) << part << browsed.document;
}

TEST_F(PageInChromium, finds_words_outside_of_the_output)
{
    PageCase tets(half32, "cdt project half32");
    ++tets.page.kernels.front().views.front().launch.width; // rows of the output are longer than there is space for
    const Browsed browsed = run(tets);
    EXPECT_TRUE(contains(browsed.document, "writes outside its output</td>")) << browsed.document;
    EXPECT_TRUE(contains(browsed.document, "data-verdict=\"failed\""));
}

TEST_F(PageInChromium, says_what_to_do_without_webgpu)
{
    PageCase tets(half32, "cdt project half32");
    const Browsed browsed = run(tets, "--disable-features=WebGPU,WebGPUService");
    EXPECT_TRUE(contains(browsed.document, "data-verdict=\"error\"")) << browsed.document;
    EXPECT_TRUE(contains(browsed.document, "Stopped by an error: ")) << browsed.document;
}

TEST(BrowserPage, has_each_kernel_of_ours_and_no_markup_from_its_data)
{
    PageCase tets(half32, "</script><b>");
    const std::string page = browser_page({tets.page}, tets.result());
    EXPECT_FALSE(contains(page, "</script><b>"));
    EXPECT_TRUE(contains(page, "\\u003c/script>\\u003cb>"));
    EXPECT_FALSE(contains(page, "@DATA@"));
    EXPECT_TRUE(has_page_kernel(bvh2));
    EXPECT_NO_THROW(require_page_layout(Layout::tet64));
    try {
        require_page_layout(Layout::embree);
        FAIL() << "Embree is not WGSL";
    } catch (const Error& error) {
        EXPECT_TRUE(contains(error.what(), "half32, tet64")) << error.what();
    }
}

using PageCommand = ProgramTest;

/// A page of the program in Chromium.
class SavedResult : public ProgramTest {
protected:
    void SetUp() override
    {
        if (find_chromium().empty())
            GTEST_SKIP() << "no Chromium (Debian's package chromium-headless-shell): the page was opened by nobody";
    }
    /// Opens the page that `tetrace page` writes, and saves its result. change: of the page's text.
    void save(const std::string& arguments, const char* name, const std::function<void(std::string&)>& change = {})
    {
        const Ended ended = run("page " + arguments + " --out page.html");
        ASSERT_EQ(ended.code, 0) << ended.errors;
        std::string page = file("page.html");
        if (change) change(page);
        const Browsed browsed = browse(folder_.path(), page, "?start&seconds=0", with_webgpu);
        const std::string_view before = "href=\"data:application/json,";
        const std::size_t begin = browsed.document.find(before);
        ASSERT_NE(begin, std::string::npos) << browsed.document << browsed.console;
        const std::size_t first = begin + before.size();
        write_file(folder_ / name, decoded(browsed.document.substr(first, browsed.document.find('"', first) - first)));
    }

private:
    /// Text of an address: %20 is a space.
    static std::string decoded(const std::string& text)
    {
        std::string plain;
        for (std::size_t i = 0; i < text.size(); ++i)
            if (text[i] == '%') {
                plain += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
                i += 2;
            } else
                plain += text[i];
        return plain;
    }
};

TEST_F(SavedResult, is_shown_and_has_the_answers_of_the_same_rows_of_openmp)
{
    const std::string rows = "--scene cubes --layout tet80,bvh2 --rays primary,random --size 24 --views 1,3 ";
    save(rows, "page.json");
    const Ended shown = run("show page.json");
    EXPECT_EQ(shown.code, 0) << shown.errors;
    for (const char* const part : {"cdt maria tet80, random  webgpu", "bvh bvh2 ", "dawn-swiftshader", "steps per ray",
                                   "all with exact arithmetic"})
        EXPECT_TRUE(contains(shown.out, part)) << part << shown.out;
    const Expectations expected = read_expectations({TETRACE_EXPECTED_FOLDER});
    const CheckJudgement judgement = judge_rows(read_rows(read_result(folder_.path() / "page.json")), &expected, false);
    ASSERT_EQ(judgement.devices.size(), 1u);
    EXPECT_TRUE(judgement.devices.front().is_mentioned) << judgement.devices.front().implementation;
    EXPECT_TRUE(judgement.devices.front().has_self_test);
    EXPECT_TRUE(judgement.deviations.empty()) << judgement.deviations.front().name;
    ASSERT_EQ(run("bench --backend openmp --schedule tiles --samples 5 --sample-time 0 --out here.json " + rows).code,
              0);
    const Ended compared = run("compare here.json page.json");
    EXPECT_EQ(compared.code, 0) << compared.errors;
    EXPECT_TRUE(contains(compared.out, "4 of another API with the SAME ANSWERS")) << compared.out;
    EXPECT_EQ(run("report page.json --out report.html").code, 0);
}

TEST_F(SavedResult, has_no_rate_of_rows_that_are_wrong)
{
    // The right answers of the first view are those of the second.
    save("--layout tet80 --size 24 --views 1,3", "page.json", [](std::string& page) {
        const std::size_t first = page.find("\"hash\":["), second = page.find("\"hash\":[", first + 1);
        const auto hash_at = [&](std::size_t at) { return page.substr(at, page.find(']', at) - at); };
        page.replace(first, hash_at(first).size(), hash_at(second));
    });
    const Ended shown = run("show page.json");
    EXPECT_TRUE(contains(shown.out, "wrong: 1 ray wrong: not the answers of openmp")) << shown.out << shown.errors;
    EXPECT_FALSE(contains(file("page.json"), "mrays_per_s"));
}

TEST_F(SavedResult, has_given_rays_of_every_task_that_crosses_the_domain)
{
    save("--layout tet80 --task segments,tally,absorb --rays diffuse --size 24 --views 1,3", "page.json");
    const nlohmann::json rows = nlohmann::json::parse(file("page.json")).at("tetrace").at("rows");
    ASSERT_EQ(rows.size(), 3u);
    for (const auto& row : rows)
        EXPECT_EQ(row.at("status"), "ok") << row;
    const Ended shown = run("show page.json");
    for (const char* const part : {"absorb maria tet80, diffuse", "tally maria tet80, diffuse"})
        EXPECT_TRUE(contains(shown.out, part)) << shown.out << shown.errors;
}

TEST_F(SavedResult, is_right_where_the_last_view_has_fewer_rays)
{
    save("--layout tet80 --rays diffuse --size 32 --camera-set orbit --views 0,300,900", "page.json");
    const nlohmann::json rows = nlohmann::json::parse(file("page.json")).at("tetrace").at("rows");
    EXPECT_EQ(rows.at(0).at("status"), "ok") << rows;
}

TEST_F(SavedResult, has_the_message_of_a_compiler_and_the_first_wrong_ray_of_another_row)
{
    save("--layout bvh2,tet80 --size 24 --views 1,3", "page.json", [](std::string& page) {
        page.replace(page.find("fn run_item(", page.find("\"name\":\"bvh bvh2\"")), 3, "fm ");
        const std::size_t hash = page.rfind("\"hash\":["); // of tet80's last view
        page.insert(hash + 8, "1");
    });
    EXPECT_TRUE(contains(file("page.json"), "of its WGSL: ")) << file("page.json");
    EXPECT_TRUE(contains(file("document"), "cdt maria tet80, cubes, view 3: ")) << file("document");
}

TEST_F(SavedResult, says_which_sums_of_tets_are_wrong)
{
    save("--layout tet80 --task tally,segments --rays diffuse --size 24 --views 1", "page.json", [](std::string& page) {
        page.insert(page.find("\"tally\":[") + 9, "1"); // not the hash of these sums
    });
    EXPECT_TRUE(contains(run("show page.json").out, "wrong: wrong sums of tets: not the answers of openmp"));
    EXPECT_TRUE(contains(file("page.json"), "\"status\": \"ok\"")) << "the row of segments";
}

TEST_F(SavedResult, has_an_error_of_the_row_that_lost_the_device_and_all_other_rows)
{
    save("--layout bvh2,tet80,bvh4 --size 24 --views 1", "page.json", [](std::string& page) {
        const std::string_view opened = "this.pipeline = pipeline;";
        page.insert(page.find(opened), "if (this.kernel.name.includes(\"tet80\")) this.gpu.device.destroy(); ");
    });
    const nlohmann::json rows = nlohmann::json::parse(file("page.json")).at("tetrace").at("rows");
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].at("status"), "ok");
    EXPECT_EQ(rows[1].at("status"), "error");
    EXPECT_TRUE(contains(rows[1].at("reason"), "the device was lost")) << rows[1].at("reason");
    EXPECT_EQ(rows[2].at("status"), "ok");
    EXPECT_TRUE(rows[0].at("times").contains("samples_s"));
}

TEST_F(PageCommand, leaves_out_the_tets_that_no_ray_meets)
{
    const auto length_of = [&](const std::string& arguments) {
        EXPECT_EQ(run("page --layout half32 " + arguments + " --out page.html").code, 0);
        return file("page.html").size();
    };
    EXPECT_GT(length_of("--size 64 --views 0,1,2,3"), length_of("--size 1 --views 0") + 100'000);
}

TEST_F(PageCommand, has_its_kernels_dumped)
{
    EXPECT_EQ(run("dump --backend webgpu --layout tet64 --out kernels").code, 0);
    EXPECT_TRUE(contains(file("kernels/project_tet64_rays.wgsl"), "@compute @workgroup_size(8, tile_height)"));
    const Ended ended = run("dump --backend webgpu --layout embree --out kernels");
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(contains(ended.errors, "a page has no kernel of cdt/single/embree") ||
                contains(ended.errors, "a page has no kernel of bvh/single/embree"))
        << ended.errors;
    EXPECT_EQ(run("bench --backend webgpu").code, 2);
}

TEST_F(PageCommand, writes_a_row_for_each_layout)
{
    const Ended ended = run("page --layout tet20,bvh2,bvh2,tet80 --size 16 --views 1,3 --out page.html");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    const std::string page = file("page.html");
    for (const char* const part :
         {R"("name":"cdt project tet20")", R"("name":"bvh bvh2")", R"("name":"cdt maria tet80")", R"("number":3)",
          R"("trace_command":"tetrace trace --scene cubes)"})
        EXPECT_TRUE(contains(page, part)) << part;
}

TEST_F(PageCommand, refuses_what_no_browser_runs)
{
    const Ended ended = run("page --layout half32,embree");
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(contains(ended.errors, "--layout embree: a page has kernels of tetrace's own only: tet80, "))
        << ended.errors;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "tetrace.html"));
}
