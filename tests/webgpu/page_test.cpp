// The page of `tetrace page` in Chromium, whose GPU is SwiftShader, which emulates one.
#include "bench/browser/browser_page.h"
#include "tests/support/bvh_scene.h"
#include "tests/support/chromium.h"
#include "tests/support/given_scene.h"
#include "tests/support/program_fixture.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <gtest/gtest.h>
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
        page.kernels.back().views.push_back(page_view(7, job, packed, answers()));
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
    Browsed run(const std::vector<PageScene>& scenes, const char* options = with_webgpu)
    {
        return browse(folder_.path(), browser_page(scenes), "?start&seconds=0", options);
    }

    TemporaryFolder folder_;
};

} // namespace

TEST_F(PageInChromium, verifies_and_measures_each_row)
{
    PageCase tets(half32, "cdt project half32"), bvh(bvh2, "bvh bvh2");
    tets.page.kernels.push_back(bvh.page.kernels.front());
    const Browsed browsed = run({tets.page});
    EXPECT_TRUE(contains(browsed.document, "data-verdict=\"conforms\"")) << browsed.document << browsed.console;
    for (const char* const part : {"Self-test: exact",
                                   "<td>cdt project half32</td><td>cubes</td><td>576</td>"
                                   "<td class=\"good\">bit-exact</td>",
                                   "<td>bvh bvh2</td>", "of 2 rows has the right answer"})
        EXPECT_TRUE(contains(browsed.document, part)) << part << "\n" << browsed.console;
    EXPECT_TRUE(contains(browsed.document, "%22samples_s%22")) << "the result to save";
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
    const Browsed browsed = run({tets.page});
    const std::string pixel = fmt::format("{},{}", first % 24, first / 24);
    for (const std::string& part : {std::string("data-verdict=\"failed\""), fmt::format("{} rays wrong</td>", count),
                                    fmt::format("cdt project half32, cubes, view 7: pixel {} is wrong", pixel),
                                    fmt::format("tetrace trace --scene cubes --view 7 --pixel {}</pre>", pixel)})
        EXPECT_TRUE(contains(browsed.document + "\n", part)) << part << browsed.document;
}

TEST_F(PageInChromium, finds_words_outside_of_the_output)
{
    PageCase tets(half32, "cdt project half32");
    ++tets.page.kernels.front().views.front().launch.width; // rows of the output are longer than there is space for
    const Browsed browsed = run({tets.page});
    EXPECT_TRUE(contains(browsed.document, "writes outside its output</td>")) << browsed.document;
    EXPECT_TRUE(contains(browsed.document, "data-verdict=\"failed\""));
}

TEST_F(PageInChromium, says_what_to_do_without_webgpu)
{
    PageCase tets(half32, "cdt project half32");
    const Browsed browsed = run({tets.page}, "--disable-features=WebGPU,WebGPUService");
    EXPECT_TRUE(contains(browsed.document, "data-verdict=\"error\"")) << browsed.document;
    EXPECT_TRUE(contains(browsed.document, "Stopped by an error: ")) << browsed.document;
}

TEST(BrowserPage, has_each_kernel_of_ours_and_no_markup_from_its_data)
{
    PageCase tets(half32, "</script><b>");
    const std::string page = browser_page({tets.page});
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

TEST_F(PageCommand, writes_a_row_for_each_layout)
{
    const Ended ended = run("page --layout tet20,bvh2,tet80 --size 16 --views 1,3 --out page.html");
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
