// On every device of every API that can be used here: rays cross the tets that they cross on openmp, bit for
// bit, and the tets have the same sums of their lengths.
#include "tests/backends/each_device.h"
#include "tests/support/crossed_tets.h"
#include "tests/support/given_scene.h"
#include "tests/support/hard_rays.h"

using namespace tetrace;
using namespace tetrace::test;

namespace {

class DeviceSegments : public EachDevice {};

std::size_t different_answers(const std::vector<Hit>& a, const std::vector<Hit>& b)
{
    std::size_t count = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        if (segments_of(a[i]) != segments_of(b[i])) ++count; // in any word, whatever it is
    return count;
}

} // namespace

TEST_P(DeviceSegments, have_openmps_bits_for_each_method_and_layout)
{
    const GivenScene cubes{24, false, 6};
    const std::vector<RaySet> sets = {hard_ray_set(cubes.scene, 0, 1800), make_rays(RayKind::primary, cubes.source()),
                                      make_rays(RayKind::diffuse, cubes.source())};
    std::vector<KernelId> kernels = kernels_of(Task::segments);
    std::ranges::copy(kernels_of(Task::absorb), std::back_inserter(kernels));
    for (const KernelId& kernel : kernels) {
        if (!backend.has_kernel(kernel)) continue;    // packets and methods in double are openmp's
        if (kernel.layout == Layout::tet96) continue; // the text of tet80's kernels; compiling each takes a second
        const CrossedScene tets(cubes.scene, kernel.method, kernel.layout, kernel.task);
        for (const std::size_t device : usable) {
            const auto session = open(device, kernel, {&cubes.scene.mesh, &tets.packed()});
            for (const RaySet& set : sets)
                EXPECT_EQ(different_answers(tets.answers(*session, set), tets.answers(set)), 0u)
                    << backend.devices()[device].name << ' ' << name_of(kernel);
        }
    }
}

TEST_P(DeviceSegments, have_openmps_sums_per_tet_in_any_number_of_passes)
{
    const GivenScene cubes{24, false, 6};
    const std::vector<RaySet> sets = {hard_ray_set(cubes.scene, 0, 1800), make_rays(RayKind::diffuse, cubes.source())};
    for (const KernelId& kernel : kernels_of(Task::tally)) {
        if (!backend.has_kernel(kernel)) continue;
        const CrossedScene tets(cubes.scene, kernel.method, kernel.layout, Task::tally);
        const auto reference = tets.session(1);
        for (const std::size_t device : usable) {
            const auto session = open(device, kernel, {&cubes.scene.mesh, &tets.packed()});
            for (const RaySet& set : sets) {
                const std::vector<Hit> expected = tets.answers(*reference, set);
                EXPECT_EQ(different_answers(tets.answers(*session, set), expected), 0u) << name_of(kernel);
                EXPECT_EQ(session->tally(), reference->tally()) << name_of(kernel);
                TraceJob job = given_job(set.rays.size(), tets.packed().tet_count + 1, false);
                job.passes = 3;
                std::vector<Hit> answers(set.rays.size());
                static_cast<void>(session->trace(job, answers));
                EXPECT_EQ(session->tally(), reference->tally()) << name_of(kernel) << ", three passes";
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(each, DeviceSegments, ::testing::ValuesIn(apis()), case_name);
