// Embree's entry points and trees: each gives the hits of single rays, up to Embree's own differences between them.
#include "backends/embree/accelerator.h"
#include "backends/embree/backend.h"
#include "core/rays/ray_set.h"
#include "kernels/layouts/layout.h"
#include "tests/support/bvh_meshes.h"
#include "tests/support/device_rays.h"
#include "tests/support/random.h"

#include <bit>
#include <limits>

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Of Embree's rows with a task, those that its version and this processor can trace.
std::vector<KernelId> kernels_here(Task task)
{
    std::vector<KernelId> kernels;
    for (const KernelId& kernel : kernels_of(task))
        if (is_embree(kernel.layout) && embree_backend().why_not(0, kernel).empty()) kernels.push_back(kernel);
    return kernels;
}

const KernelId& single_of(const std::vector<KernelId>& kernels)
{
    return *std::ranges::find_if(kernels, [](const KernelId& kernel) {
        return kernel.method == Method::single && kernel.layout == Layout::embree;
    });
}

/// Rays whose hits differ by more than rounding.
std::size_t different(const std::vector<Hit>& a, const std::vector<Hit>& b)
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const float allowed = 1e-4F * std::max(1.0F, std::abs(b[i].t));
        const bool same = a[i].face_id == b[i].face_id && a[i].tet == b[i].tet && a[i].steps == b[i].steps;
        if (!same || !(std::abs(a[i].t - b[i].t) <= allowed)) ++count;
    }
    return count;
}

std::size_t hits_among(const std::vector<Hit>& hits)
{
    return static_cast<std::size_t>(std::ranges::count_if(hits, [](const Hit& hit) { return hit.face_id != NO_HIT; }));
}

std::vector<Hit> traced_by(const KernelId& kernel, const TriangleMesh& mesh, const TraceJob& job,
                           std::span<const Quad> rays = {})
{
    const auto session = embree_backend().open(0, kernel, {&mesh, nullptr}, {.threads = 2});
    if (!rays.empty()) session->set_rays(rays);
    return traced(*session, job);
}

/// Chords through the middle of the domain, half of them with an end before it.
std::vector<Quad> chords(std::size_t count)
{
    Random random(7);
    std::vector<Quad> directions, origins;
    const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
    const auto place = [&] { return random.between(-0.5F, 0.5F); };
    for (std::size_t i = 0; i < count; ++i) {
        const Float3 from{place(), place(), -2}, to{place(), place(), 2};
        directions.push_back({bits(to.x - from.x), bits(to.y - from.y), bits(to.z - from.z), NO_HALF_FACE});
        const float end = i % 2 == 0 ? 0.125F : std::numeric_limits<float>::infinity();
        origins.push_back({bits(from.x), bits(from.y), bits(from.z), bits(end)});
    }
    directions.insert(directions.end(), origins.begin(), origins.end());
    return directions;
}

embree::Abilities library(int version, unsigned native_width, bool has_streams)
{
    return {version, native_width, has_streams};
}

} // namespace

TEST(Embree, every_method_and_tree_hits_what_single_rays_hit_whatever_the_images_size)
{
    const Scene scene = make_cubes(7);
    const DeviceRays rays(scene, Layout::half32);
    const auto kernels = kernels_here(Task::trace);
    ASSERT_GE(kernels.size(), 3u);
    for (const TraceJob& job : jobs_of_all_kinds(rays)) {
        const auto right = traced_by(single_of(kernels), scene.mesh, job);
        for (const KernelId& kernel : kernels)
            EXPECT_LE(different(traced_by(kernel, scene.mesh, job), right), right.size() / 500)
                << name_of(kernel) << ' ' << job.width << " x " << job.height;
    }
}

TEST(Embree, every_method_and_tree_hits_what_single_rays_hit_of_given_rays_however_many_they_are)
{
    const TriangleMesh mesh = make_cubes(7).mesh;
    const auto kernels = kernels_here(Task::rays);
    ASSERT_GE(kernels.size(), 3u);
    for (const std::size_t count : {8u, 24u, 256u, 2000u})
        for (const bool any : {false, true}) {
            const auto quads = chords(count);
            const TraceJob job = given_job(count, 1000, any);
            const auto right = traced_by(single_of(kernels), mesh, job, quads);
            EXPECT_GT(hits_among(right), 0u);
            EXPECT_LT(hits_among(right), count) << "rays with an end before the mesh hit nothing";
            for (const KernelId& kernel : kernels)
                EXPECT_LE(different(traced_by(kernel, mesh, job, quads), right), count / 500)
                    << name_of(kernel) << ' ' << count << (any ? ", any hit" : "");
        }
}

TEST(Embree, trees_are_built_as_their_layouts_say)
{
    const TriangleMesh mesh = needles(3000);
    const auto bytes_of = [&](Layout layout) {
        const KernelId kernel{
            .structure = Structure::bvh, .method = Method::packet8, .layout = layout, .math = MathMode::fast};
        return embree_backend().open(0, kernel, {&mesh, nullptr}, {.threads = 1})->bytes();
    };
    EXPECT_NE(bytes_of(Layout::embree), bytes_of(Layout::embree_medium)) << "only quality high splits triangles";
    EXPECT_EQ(embree::tree_of(Layout::embree), embree::Tree::high);
    EXPECT_EQ(embree::tree_of(Layout::embree_medium), embree::Tree::medium);
    EXPECT_EQ(embree::tree_of(Layout::embree_robust), embree::Tree::robust);
}

TEST(Embree, sessions_that_are_open_together_share_their_tree)
{
    const TriangleMesh mesh = needles(300), other = needles(301);
    const auto opened = [](Method method, Layout layout, const TriangleMesh& of, unsigned threads = 1) {
        const KernelId kernel{.structure = Structure::bvh, .method = method, .layout = layout, .math = MathMode::fast};
        return embree_backend().open(0, kernel, {&of, nullptr}, {.threads = threads});
    };
    const auto build_s = [](const auto& session) { return session->setup_times().compile_s; };
    auto single = opened(Method::single, Layout::embree, mesh);
    const double first_s = build_s(single);
    EXPECT_EQ(build_s(opened(Method::packet8, Layout::embree, mesh)), first_s);
    EXPECT_NE(build_s(opened(Method::single, Layout::embree_medium, mesh)), first_s);
    EXPECT_NE(build_s(opened(Method::single, Layout::embree, other)), first_s);
    EXPECT_NE(build_s(opened(Method::single, Layout::embree, mesh, 2)), first_s);
    single.reset();
    EXPECT_NE(build_s(opened(Method::single, Layout::embree, mesh)), first_s) << "none is left of it";
}

TEST(Embree, four_traces_no_packets_wider_than_the_processors_and_no_streams)
{
    EXPECT_EQ(embree::why_not_traced(library(4, 8, false), Method::single), "");
    EXPECT_EQ(embree::why_not_traced(library(4, 8, false), Method::packet8), "");
    EXPECT_EQ(embree::why_not_traced(library(4, 8, false), Method::packet16),
              "Embree 4 would trace packets of 16 as single rays: its native width on this processor is 8 (method "
              "packet8)");
    EXPECT_EQ(embree::why_not_traced(library(4, 16, false), Method::packet16), "");
    EXPECT_NE(embree::why_not_traced(library(4, 4, false), Method::packet8), "");
    for (const unsigned width : {4u, 8u, 16u})
        EXPECT_EQ(embree::why_not_traced(library(4, width, false), Method::stream),
                  "Embree 4 lacks ray streams (rtcIntersectNM); Embree 3 has them");
}

TEST(Embree, three_splits_packets_that_are_wider_than_the_processors)
{
    for (const unsigned width : {4u, 8u, 16u})
        for (const Method method : {Method::single, Method::packet8, Method::packet16, Method::stream})
            EXPECT_EQ(embree::why_not_traced(library(3, width, true), method), "") << width << ' ' << name_of(method);
    EXPECT_EQ(embree::why_not_traced(library(3, 1, false), Method::single), "");
    EXPECT_EQ(embree::why_not_traced(library(3, 1, false), Method::packet8),
              "Embree 3 would trace packets of 8 as single rays: its native width on this processor is 1");
    EXPECT_EQ(embree::why_not_traced(library(3, 1, false), Method::stream), "this build of Embree lacks ray streams");
}

TEST(Embree, device_has_the_native_width_and_says_what_it_was_configured_with)
{
    const Device& device = embree_backend().devices().front();
    EXPECT_EQ(device.group_width, embree::abilities().native_width);
    EXPECT_EQ(device.driver, embree::version_text());
#if defined(__x86_64__)
    EXPECT_TRUE(device.driver.ends_with(", frequency_level=simd512")) << device.driver;
#endif
}
