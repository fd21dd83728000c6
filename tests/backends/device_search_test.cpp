// On every device of every API that can be used here: searches find openmp's exits, of the rays that they were given
// last.
#include "core/rays/search_set.h"
#include "tests/backends/each_device.h"
#include "tests/support/temporary_folder.h"

using namespace tetrace;
using namespace tetrace::test;

namespace {

class DeviceSearches : public EachDevice {};

/// The faces of one launch.
std::vector<std::uint32_t> searched(Session& session, const SearchRays& rays)
{
    session.set_rays(rays.quads);
    std::vector<std::uint32_t> faces(rays.count());
    EXPECT_GT(session.search(search_job(rays.count()), faces), 0);
    return faces;
}

std::size_t wrong_searches(const SearchRays& rays, const std::vector<std::uint32_t>& faces)
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < faces.size(); ++i)
        if (judge(rays, i, faces[i]) != SearchVerdict::right) ++count;
    return count;
}

} // namespace

TEST_P(DeviceSearches, find_openmps_exits_for_each_method_and_layout)
{
    const auto first = search_rays(0, 30, 512), second = search_rays(30, 9, 200); // of another number
    for (const KernelId& kernel : kernels_of(Task::search)) {
        // The layouts are one piece of text for all methods: one method shows it, and compiling each takes a second.
        if (kernel.math != MathMode::exact || (kernel.layout == Layout::tet96 && kernel.method != Method::maria))
            continue;
        const PackedScene tets = search_tets(39, kernel.layout);
        const auto on_host = openmp_backend().open(0, kernel, {nullptr, &tets}, {.threads = 2});
        for (const std::size_t device : usable) {
            const auto session = open(device, kernel, {nullptr, &tets}, {.threads = 2});
            for (const SearchRays* rays : {&first, &second, &first})
                EXPECT_EQ(searched(*session, *rays), searched(*on_host, *rays)) << name_of(kernel);
        }
    }
}

TEST_P(DeviceSearches, search_exits_of_the_rays_that_they_were_given_last)
{
    const KernelId kernel{.task = Task::search};
    const PackedScene tets = search_tets(2, kernel.layout);
    const auto first = search_rays(0, 1, 4096), second = search_rays(1, 1, 4096); // as many
    for (const std::size_t device : usable) {
        const auto session = open(device, kernel, {nullptr, &tets});
        session->set_rays(first.quads);
        session->launch(search_job(first.count())); // nobody waits for it
        EXPECT_EQ(wrong_searches(second, searched(*session, second)), 0u);
        EXPECT_EQ(wrong_searches(first, searched(*session, first)), 0u);
    }
}

TEST_P(DeviceSearches, refuse_rays_that_exceed_a_buffer)
{
    const KernelId kernel{.task = Task::search};
    const PackedScene tets = search_tets(1, kernel.layout);
    const auto rays = search_rays(0, 1, 2048);
    for (const std::size_t device : usable) {
        const auto session = open(device, kernel, {nullptr, &tets}, {.max_buffer_bytes = 50'000});
        const std::string problem = error_of([&] { session->set_rays(rays.quads); });
        EXPECT_TRUE(problem.starts_with("unsupported: ")) << problem;
        EXPECT_TRUE(contains(problem, "98304") && contains(problem, "50000; give fewer")) << problem;
    }
}

INSTANTIATE_TEST_SUITE_P(each, DeviceSearches, ::testing::ValuesIn(apis()), case_name);
