// The kernels' WGSL as C++, compiled with -Ofast and fused instructions, on rays that are hard for walks: no word of an
// answer differs from openmp's, even if the device's quotients are some units off. Without keep() some do.
#include "backends/openmp/backend.h"
#include "core/device/launch.h"
#include "core/device/scene_buffers.h"
#include "tests/support/bvh_scene.h"
#include "tests/support/hard_rays.h"
#include "tests/support/hard_scenes.h"

#include <cstring>
#include <gtest/gtest.h>
#include <span>
#include <vector>

using namespace tetrace;
using namespace tetrace::test;

using Bytes = std::span<const std::byte>;
using RunItem = void(std::span<const Bytes> buffers, std::uint32_t group, std::uint32_t item);
#define TEXT(kernel) RunItem kernel##_kept, kernel##_plain, kernel##_rough
TEXT(project_half32);
TEXT(project_tet64);
TEXT(maria_tet80);
TEXT(single_bvh2);
TEXT(single_cwbvh);
#undef TEXT

namespace {

constexpr std::uint32_t launch_binding = TETRACE_WEBGPU_LAUNCH_BINDING;
constexpr std::uint64_t lines = 4000; ///< of each kind and scene

struct Text {
    KernelId kernel;
    RunItem *kept, *plain, *rough;
};

bool can_run()
{
#ifdef __x86_64__
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
    return true;
#endif
}

/// An image of one pixel: a ray from outside.
TraceJob job_of(const GivenRay& ray, const PackedScene& packed)
{
    TraceJob job;
    job.view = {ray.origin, ray.direction, {}, {}};
    job.width = job.height = 1;
    job.start_tet = NO_TET;
    job.max_steps = packed.tet_count + 1;
    return job;
}

Hit answer_of(RunItem* run, const std::vector<SceneBuffer>& arrays, const TraceJob& job, const PackedScene& packed)
{
    const LaunchParams params = launch_params(job, domain_of(packed), 8, 31);
    std::array<std::uint32_t, sizeof(LaunchParams) / 4 + 1> launch{}; // the last word is zero
    std::memcpy(launch.data(), &params, sizeof params);
    std::array<std::uint32_t, 2 * GUARD_WORDS + HIT_WORDS> output{};
    std::vector<Bytes> buffers(launch_binding + 1);
    for (std::size_t binding = 0; binding < arrays.size(); ++binding)
        buffers[binding] = arrays[binding].bytes;
    buffers[OUTPUT_BINDING] = std::as_bytes(std::span(output));
    buffers[launch_binding] = std::as_bytes(std::span(launch));
    run(buffers, 0, 0);
    Hit hit;
    std::memcpy(&hit, &output[GUARD_WORDS], sizeof hit);
    return hit;
}

struct UnsafeDifferences {
    std::uint64_t rays = 0, kept = 0, plain = 0, rough = 0;
};

bool is_same(const Hit& a, const Hit& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

void compare(const Text& text, const Scene& scene, const PackedScene& packed, UnsafeDifferences& found)
{
    const auto session = openmp_backend().open(0, text.kernel, {&scene.mesh, &packed}, {.threads = 1});
    const HardRays hard(scene);
    const auto arrays = scene_buffers(packed);
    for (std::uint64_t number = 0; number < hard_kinds * lines; ++number) {
        if (HardRays::kind_of(number) >= HardKind::from_vertex) continue;
        const TraceJob job = job_of(hard.ray(number), packed);
        Hit expected{};
        static_cast<void>(session->trace(job, std::span(&expected, 1)));
        ++found.rays;
        found.kept += is_same(answer_of(text.kept, arrays, job, packed), expected) ? 0 : 1;
        found.plain += is_same(answer_of(text.plain, arrays, job, packed), expected) ? 0 : 1;
        found.rough += is_same(answer_of(text.rough, arrays, job, packed), expected) ? 0 : 1;
    }
}

} // namespace

TEST(UnsafeMath, changes_no_word_of_what_is_kept_and_some_of_what_is_not)
{
    if (!can_run()) GTEST_SKIP() << "this processor lacks AVX2 or FMA";
    const Text texts[] = {
        {{.method = Method::project, .layout = Layout::half32},
         project_half32_kept,
         project_half32_plain,
         project_half32_rough},
        {{.method = Method::project, .layout = Layout::tet64},
         project_tet64_kept,
         project_tet64_plain,
         project_tet64_rough},
        {{.method = Method::maria, .layout = Layout::tet80}, maria_tet80_kept, maria_tet80_plain, maria_tet80_rough}};
    for (const Text& text : texts) {
        UnsafeDifferences found;
        for (const auto& [name, scene] : make_hard_scenes())
            compare(text, scene, pack(scene, text.kernel.layout, TetOrder::chains), found);
        EXPECT_GE(found.rays, 5 * lines);
        EXPECT_EQ(found.kept, 0u) << name_of(text.kernel.layout) << " of " << found.rays;
        EXPECT_EQ(found.rough, 0u) << name_of(text.kernel.layout) << ", with rough quotients";
        EXPECT_GT(found.plain, 0u) << name_of(text.kernel.layout) << " of " << found.rays;
    }
}

TEST(UnsafeMath, changes_no_word_of_bvhs_that_are_kept)
{
    if (!can_run()) GTEST_SKIP() << "this processor lacks AVX2 or FMA";
    const Text texts[] = {{{.structure = Structure::bvh, .method = Method::single, .layout = Layout::bvh2},
                           single_bvh2_kept,
                           single_bvh2_plain,
                           single_bvh2_rough},
                          {{.structure = Structure::bvh, .method = Method::single, .layout = Layout::cwbvh},
                           single_cwbvh_kept,
                           single_cwbvh_plain,
                           single_cwbvh_rough}};
    for (const Text& text : texts) {
        UnsafeDifferences found;
        for (const auto& [name, scene] : make_hard_scenes())
            compare(text, scene, make_bvh_scene(scene.mesh, text.kernel.layout), found);
        EXPECT_EQ(found.kept, 0u) << name_of(text.kernel.layout) << " of " << found.rays;
        EXPECT_EQ(found.rough, 0u) << name_of(text.kernel.layout) << ", with rough quotients";
        EXPECT_GT(found.plain, 0u) << name_of(text.kernel.layout) << " of " << found.rays;
    }
}
