// On every device of every API that can be used here: it computes exactly in exact mode, and correctly reports its
// properties, and which limit a scene or an image exceeds. Hits, searches and sessions are in device_hits_test.cpp,
// device_search_test.cpp and device_session_test.cpp; what only one API has is in its own test.
#include "core/device/scene_buffers.h"
#include "tests/backends/each_device.h"
#include "tests/support/cut_anew.h"
#include "tests/support/temporary_folder.h"

using namespace tetrace;
using namespace tetrace::test;

namespace {

class Devices : public EachDevice {};

} // namespace

TEST_P(Devices, say_what_they_are)
{
    for (const std::size_t index : usable) {
        const Device& device = backend.devices()[index];
        EXPECT_FALSE(device.name.empty() || device.driver.empty() || device.id.empty());
        EXPECT_TRUE(device.kind == DeviceKind::gpu || device.kind == DeviceKind::emulated) << name_of(device.kind);
        EXPECT_NE(device.implementation.find('-'), std::string::npos) << device.implementation;
        EXPECT_GE(device.max_group_items, 64u);
        EXPECT_GT(device.memory_bytes, 0u);
        const bool is_loaded = backend.name() != "cuda-host" && !device.implementation.starts_with("oclgrind");
        EXPECT_EQ(std::filesystem::is_regular_file(device.library), is_loaded) << device.library;
        EXPECT_TRUE(device.uuid.empty() || device.uuid.size() == 32) << device.uuid;
        EXPECT_EQ(device.max_buffer_bytes != 0, GetParam().cuts_tets) << "0: memory is the limit";
    }
}

TEST_P(Devices, have_the_kernels_of_the_cdt_and_no_others)
{
    EXPECT_TRUE(backend.has_kernel({.layout = Layout::tet96, .math = MathMode::fast}));
    EXPECT_EQ(backend.has_kernel({.schedule = Schedule::persistent}), GetParam().is_persistent);
    EXPECT_EQ(backend.has_kernel({.schedule = Schedule::persistent, .task = Task::rays}), GetParam().is_persistent);
    EXPECT_TRUE(backend.has_kernel({.method = Method::ms06, .task = Task::search}));
    EXPECT_FALSE(backend.has_kernel({.schedule = Schedule::persistent, .task = Task::search}));
    EXPECT_FALSE(backend.has_kernel({.structure = Structure::bvh, .layout = Layout::embree}));
    EXPECT_FALSE(backend.has_kernel({.method = Method::single}));
    EXPECT_TRUE(contains(backend.why_not(0, {.method = Method::single}), "lacks kernel"));
}

TEST_P(Devices, compute_exactly_in_exact_mode)
{
    for (const std::size_t device : usable)
        EXPECT_TRUE(self_test(device).is_exact()) << self_test(device).text();
}

TEST_P(Devices, have_plausible_yardsticks)
{
    for (const std::size_t device : usable) {
        const auto yardstick = backend.yardstick(device, {});
        ASSERT_TRUE(yardstick.has_value());
        EXPECT_GT(yardstick->copy_bytes_per_s, 1e6);
        EXPECT_GT(yardstick->launch_s, 0);
    }
}

TEST_P(Devices, refuse_what_exceeds_a_limit_with_both_numbers)
{
    Scene cubes = make_cubes(8);
    cubes.domain = cut_anew(cubes.domain, 1); // short lists of boundary faces: the tets are what is too many
    const DeviceRays rays(cubes, Layout::tet80);
    const TraceJob small = rays.from_outside(20, 10);
    const std::string bytes = std::to_string(scene_buffers(rays.packed())[0].bytes.size());
    for (const std::size_t device : usable) {
        const std::string scene =
            error_of([&] { (void)backend.open(device, {}, rays.data(), {.max_buffer_bytes = 20'000}); });
        EXPECT_TRUE(scene.starts_with("unsupported: ")) << scene;
        EXPECT_TRUE(contains(scene, bytes) && contains(scene, "20000"));
        const auto session = backend.open(device, {}, rays.data(), {.max_buffer_bytes = 300'000});
        const std::string image = error_of([&] { session->launch(rays.from_outside(200, 100)); });
        EXPECT_TRUE(image.starts_with("unsupported: ")) << image;
        EXPECT_TRUE(contains(image, "480512") && contains(image, "300000"));
        EXPECT_EQ(wrong_rays(device, traced(*session, small), openmp_hits(rays, small)), 0u) << "the session lives on";
    }
}

INSTANTIATE_TEST_SUITE_P(each, Devices, ::testing::ValuesIn(apis()), case_name);
