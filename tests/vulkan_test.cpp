// On every Vulkan device that can be used here: its hits are openmp's, whatever the layout, tile, image, camera and
// number of buffers; and the validation layers, where they are installed, have nothing to say.
#include "backends/vulkan/backend.h"
#include "backends/vulkan/instance.h"
#include "backends/vulkan/session.h"
#include "backends/vulkan/ticks.h"
#include "core/scene_buffers.h"
#include "core/self_test.h"
#include "tests/device_rays.h"
#include "tests/temporary_folder.h"

namespace tetrace {
namespace {

/// Before the instance is made: in all builds, not only in debug ones.
[[maybe_unused]] const int validation_is_on = ::setenv("TETRACE_VULKAN_VALIDATION", "1", 1);

/// Runs a test's body on each usable device; visibly skipped where there is none.
class Vulkan : public ::testing::Test {
protected:
    void SetUp() override
    {
        for (std::size_t i = 0; i < backend.devices().size(); i++)
            if (backend.devices()[i].usable) usable.push_back(i);
        if (usable.empty()) GTEST_SKIP() << backend.devices().front().reason;
    }
    [[nodiscard]] SelfTest self_test(std::size_t device, MathMode math) const
    {
        return judge_self_test(backend.probe(device, math, self_test_operations()));
    }
    /// Expects the hits of openmp, exactly or as near as the device's division lets them be.
    void expect_openmps_hits(std::size_t device, const KernelId& kernel, const DeviceRays& rays,
                             const std::vector<TraceJob>& jobs, const SessionOptions& options) const
    {
        const auto session = backend.open(device, kernel, rays.data(), options);
        const std::uint64_t ulps = self_test(device, kernel.math).allowed_ulps();
        for (const TraceJob& job : jobs)
            EXPECT_EQ(different_rays(traced(*session, job), openmp_hits(rays, job), ulps), 0u)
                << backend.devices()[device].name << ' ' << name_of(kernel) << ' ' << job.width << 'x' << job.height
                << " tile height " << options.tile_height
                << (job.start_tet == NO_TET ? " from outside" : " from inside");
    }

    Backend& backend = vulkan_backend();
    std::vector<std::size_t> usable;
};

/// Images that are, and are not, multiples of a tile; cameras outside and inside.
std::vector<TraceJob> all_jobs(const DeviceRays& rays)
{
    return {rays.from_outside(64, 64), rays.from_outside(61, 35),   rays.from_outside(7, 3),
            rays.from_inside(40, 24),  rays.from_outside(1, 1),     rays.from_inside(33, 50),
            rays.from_outside(200, 1), rays.from_outside(5, 90, 3), rays.from_outside(64, 64, 2)};
}

} // namespace

TEST_F(Vulkan, every_device_is_exact_in_exact_mode)
{
    for (const std::size_t device : usable)
        EXPECT_TRUE(self_test(device, MathMode::exact).is_exact()) << self_test(device, MathMode::exact).text();
}

TEST_F(Vulkan, hits_are_openmps_for_each_layout_and_tile)
{
    for (const Layout layout : {Layout::tet80, Layout::tet96}) {
        const DeviceRays rays(make_cubes(8), layout);
        for (const std::size_t device : usable)
            for (const unsigned tile_height : {0u, 4u, 8u})
                expect_openmps_hits(device, {.layout = layout}, rays, all_jobs(rays), {.tile_height = tile_height});
    }
}

TEST_F(Vulkan, hits_are_openmps_with_the_tets_in_parts)
{
    for (const Layout layout : {Layout::tet80, Layout::tet96}) {
        const DeviceRays rays(make_cubes(8), layout);
        for (const std::uint64_t limit : {200'000, 130'000, 40'000}) {
            if (limit == 40'000 && layout == Layout::tet96) continue; // more parts than there may be
            ASSERT_GT(tet_parts(rays.packed(), limit).count, 1u);
            for (const std::size_t device : usable)
                expect_openmps_hits(device, {.layout = layout}, rays,
                                    {rays.from_outside(39, 39), rays.from_inside(20, 20)}, {.max_buffer_bytes = limit});
        }
    }
}

TEST_F(Vulkan, hits_are_openmps_for_an_image_of_many_launches)
{
    const DeviceRays rays(make_cubes(8), Layout::tet96);
    for (const std::size_t device : usable)
        expect_openmps_hits(device, {.layout = Layout::tet96}, rays,
                            {rays.from_outside(401, 390), rays.from_outside(401, 390, 0)}, {});
}

TEST_F(Vulkan, a_job_launched_twice_gives_the_same_hits)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {}, rays.data(), {});
        const auto first = traced(*session, rays.from_outside(50, 50));
        (void)traced(*session, rays.from_inside(20, 90));
        EXPECT_EQ(traced(*session, rays.from_outside(50, 50)), first);
        EXPECT_GE(session->bytes(), rays.packed().bytes());
        EXPECT_GT(session->setup_times().compile_s, 0);
        EXPECT_GT(session->setup_times().upload_s, 0);
    }
}

TEST_F(Vulkan, wait_tells_device_seconds)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {}, rays.data(), {});
        for (int image = 0; image < 2; image++) { // the first is launched in steps
            session->launch(rays.from_outside(200, 200));
            const double seconds = session->wait();
            EXPECT_GT(seconds, 0);
            EXPECT_LT(seconds, 60);
        }
    }
}

TEST_F(Vulkan, sessions_of_a_device_live_side_by_side)
{
    const DeviceRays a(make_cubes(3), Layout::tet80), b(make_cubes(5), Layout::tet96);
    for (const std::size_t device : usable) {
        const auto first = backend.open(device, {.layout = Layout::tet80}, a.data(), {});
        const auto second = backend.open(device, {.layout = Layout::tet96}, b.data(), {});
        const TraceJob job = a.from_outside(30, 30);
        first->launch(job);
        second->launch(b.from_inside(40, 40));
        (void)second->wait();
        (void)first->wait();
        std::vector<Hit> hits(30 * 30);
        first->read_back(hits);
        EXPECT_EQ(different_rays(hits, openmp_hits(a, job), 3), 0u);
    }
}

TEST_F(Vulkan, a_launch_that_nobody_waits_for_harms_nothing)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TraceJob job = rays.from_outside(20, 20);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {}, rays.data(), {});
        session->launch(rays.from_outside(90, 90));
        EXPECT_EQ(different_rays(traced(*session, job), openmp_hits(rays, job), 3), 0u);
        session->launch(rays.from_outside(90, 90));
    }
}

TEST_F(Vulkan, hits_that_are_read_before_anybody_waits_are_whole)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const TraceJob job = rays.from_outside(200, 200);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {}, rays.data(), {});
        (void)traced(*session, job); // the next one is not launched in steps that are waited for
        session->launch(job);
        std::vector<Hit> hits(std::size_t{job.width} * job.height);
        session->read_back(hits);
        EXPECT_EQ(different_rays(hits, openmp_hits(rays, job), 3), 0u);
        EXPECT_GT(session->wait(), 0) << "the launch's time is not lost";
    }
}

TEST_F(Vulkan, fast_mode_finds_the_same_faces_but_for_rays_on_edges)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const TraceJob job = rays.from_outside(128, 128);
    const auto right = openmp_hits(rays, job);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {.math = MathMode::fast}, rays.data(), {});
        EXPECT_LE(distant_rays(traced(*session, job), right), right.size() / 1000);
    }
}

TEST_F(Vulkan, a_program_cache_changes_no_hit_and_is_filled)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TraceJob job = rays.from_outside(20, 20);
    for (const std::size_t device : usable) {
        const TemporaryFolder folder;
        const SessionOptions options{.program_cache = folder / "programs"};
        for (int pass = 0; pass < 2; pass++) {
            const auto session = backend.open(device, {}, rays.data(), options);
            EXPECT_EQ(different_rays(traced(*session, job), openmp_hits(rays, job), 3), 0u);
        }
        EXPECT_FALSE(std::filesystem::is_empty(folder / "programs"));
        EXPECT_FALSE(backend.open(device, {}, rays.data(), {})->setup_times().compile_cached) << "no cache, no hit";
    }
}

TEST_F(Vulkan, refuses_what_exceeds_a_limit_with_both_numbers)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
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
        EXPECT_EQ(traced(*session, rays.from_outside(20, 10)).size(), 200u) << "the session lives on";
    }
}

TEST_F(Vulkan, an_allocation_beyond_the_devices_largest_is_refused_with_both_numbers)
{
    for (vulkan::FoundDevice found : vulkan::find_devices()) {
        if (!found.facts.usable) continue;
        found.limits.allocation_bytes = 1000;
        const vulkan::Context context(found);
        const std::string refused = error_of([&] { vulkan::Buffer(context, 4096, vulkan::Place::device); });
        EXPECT_TRUE(refused.starts_with("unsupported: ")) << refused;
        EXPECT_TRUE(contains(refused, "4096") && contains(refused, "1000"));
    }
}

TEST_F(Vulkan, hits_are_openmps_where_the_host_does_not_see_the_devices_memory)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const TraceJob job = rays.from_outside(61, 35);
    for (vulkan::FoundDevice found : vulkan::find_devices()) {
        if (!found.facts.usable) continue;
        found.always_stages = true;
        vulkan::VulkanSession session(found, {}, rays.packed(), {});
        EXPECT_EQ(different_rays(traced(session, job), openmp_hits(rays, job), 3), 0u);
    }
}

TEST_F(Vulkan, hits_are_openmps_whether_the_scene_is_read_as_texels_or_from_storage_buffers)
{
    for (const Layout layout : {Layout::tet80, Layout::tet96}) {
        const DeviceRays rays(make_cubes(8), layout);
        for (vulkan::FoundDevice found : vulkan::find_devices()) {
            if (!found.facts.usable) continue;
            for (const bool texels : {false, true}) {
                found.reads_texels = texels;
                vulkan::VulkanSession session(found, {.layout = layout}, rays.packed(), {});
                for (const TraceJob& job : all_jobs(rays))
                    EXPECT_EQ(different_rays(traced(session, job), openmp_hits(rays, job), 3), 0u) << texels;
            }
            found.limits.texels = 100; // too few for the scene: storage buffers again
            vulkan::VulkanSession session(found, {.layout = layout}, rays.packed(), {});
            const TraceJob job = rays.from_outside(61, 35);
            EXPECT_EQ(different_rays(traced(session, job), openmp_hits(rays, job), 3), 0u);
        }
    }
}

TEST_F(Vulkan, what_the_validation_layers_say_fails_the_next_call)
{
    if (!vulkan::instance().validates())
        GTEST_SKIP() << "the validation layers are not installed (package vulkan-validationlayers)";
    for (const vulkan::FoundDevice& found : vulkan::find_devices()) {
        if (!found.facts.usable) continue;
        const vulkan::Context context(found);
        const auto wrong = vk::BufferCreateInfo{}.setSize(0).setUsage(vk::BufferUsageFlagBits::eTransferSrc);
        try {
            const vk::raii::Buffer buffer(context.device(), wrong);
        } catch (const vk::SystemError&) {
            ADD_FAILURE() << "the driver refused before the layers' message counted";
        }
        const std::string said = error_of([&] { context.check_validation("testing"); });
        EXPECT_TRUE(said.starts_with("internal: ") && contains(said, "VUID-VkBufferCreateInfo-size-00912")) << said;
        EXPECT_NO_THROW(context.check_validation("testing")) << "each message once";
    }
}

TEST_F(Vulkan, yardsticks_are_plausible)
{
    for (const std::size_t device : usable) {
        const auto yardstick = backend.yardstick(device, {});
        ASSERT_TRUE(yardstick.has_value());
        EXPECT_GT(yardstick->copy_bytes_per_s, 1e6);
        EXPECT_GT(yardstick->launch_s, 0);
    }
}

TEST_F(Vulkan, devices_say_what_they_are)
{
    for (const std::size_t index : usable) {
        const Device& device = backend.devices()[index];
        EXPECT_FALSE(device.name.empty() || device.driver.empty() || device.id.empty());
        EXPECT_TRUE(device.type == "gpu" || device.type == "emulated") << device.type;
        EXPECT_NE(device.implementation.find('-'), std::string::npos) << device.implementation;
        EXPECT_EQ(device.uuid.size(), 32u) << device.uuid;
        EXPECT_GE(device.max_group_items, 64u);
        EXPECT_GE(device.max_buffer_bytes, 128u << 20) << "the least that Vulkan allows";
        EXPECT_GT(device.group_width, 0u);
        EXPECT_GT(device.timer_period_s, 0);
        EXPECT_GT(device.memory_bytes, 0u);
    }
}

TEST(VulkanKernels, are_those_of_the_cdt_in_tiles)
{
    const Backend& backend = vulkan_backend();
    EXPECT_TRUE(backend.has_kernel({.layout = Layout::tet96, .math = MathMode::fast}));
    EXPECT_FALSE(backend.has_kernel({.schedule = Schedule::persistent}));
    EXPECT_FALSE(backend.has_kernel({.structure = Structure::bvh, .layout = Layout::embree}));
    EXPECT_TRUE(contains(backend.why_not(0, {.method = Method::single}), "has no kernel"));
}

TEST(VulkanImplementation, is_read_from_whatever_drivers_say)
{
    using vulkan::implementation_of;
    EXPECT_EQ(implementation_of("llvmpipe", "Mesa 22.3.6 (LLVM 15.0.6)"), "lavapipe-22.3");
    EXPECT_EQ(implementation_of("llvmpipe", "Mesa 25.0.7-2 (LLVM 19.1.7)"), "lavapipe-25.0");
    EXPECT_EQ(implementation_of("NVIDIA", "580.65.06"), "nvidia-580");
    EXPECT_EQ(implementation_of("radv", "Mesa 22.3.6"), "radv-22.3");
    EXPECT_EQ(implementation_of("Intel open-source Mesa driver", "Mesa 23.2.1-1ubuntu3"),
              "intel-open-source-mesa-driver-23.2");
    EXPECT_EQ(implementation_of("AMD (proprietary) ", "beta"), "amd-proprietary");
    EXPECT_EQ(implementation_of("Driver", "v7."), "driver-7");
    EXPECT_EQ(implementation_of("", ""), "unknown");
}

TEST(VulkanLimits, each_is_told_with_its_number)
{
    const vulkan::Limits good{VK_API_VERSION_1_1, 0, 64, 128, 13, 128, 128, 65535, 1u << 30};
    const auto reason = [&](auto member, auto value) {
        vulkan::Limits limits = good;
        limits.*member = value;
        return vulkan::why_not_usable(limits);
    };
    using vulkan::Limits;
    EXPECT_EQ(vulkan::why_not_usable(good), "");
    EXPECT_TRUE(contains(reason(&Limits::api_version, VK_API_VERSION_1_0), "Vulkan 1.0.0, 1.1 is needed"));
    EXPECT_TRUE(contains(reason(&Limits::queue_family, std::nullopt), "no queue"));
    EXPECT_TRUE(contains(reason(&Limits::push_constant_bytes, 64u), "push constants: 64, 80 are needed"));
    EXPECT_TRUE(contains(reason(&Limits::storage_buffers, 4u), "4, 6 are needed"));
    EXPECT_TRUE(contains(reason(&Limits::group_items, 32u), "32, 64 are needed"));
    EXPECT_TRUE(contains(reason(&Limits::group_height, 4u), "4, 8 are needed"));
}

TEST(VulkanTicks, count_through_a_wrap_and_ignore_invalid_bits)
{
    using vulkan::ticks_between;
    EXPECT_EQ(ticks_between(10, 25, 64), 15u);
    EXPECT_EQ(ticks_between(~std::uint64_t{0}, 4, 64), 5u);
    EXPECT_EQ(ticks_between((std::uint64_t{1} << 36) - 3, 7, 36), 10u);
    EXPECT_EQ(ticks_between(0xABC0'0000'0000'0001, 0x1230'0000'0000'0003, 36), 2u);
    EXPECT_EQ(ticks_between(1, 0, 1), 1u);
}

TEST(VulkanErrors, name_the_call_the_code_and_the_device)
{
    const vulkan::Task task{"launching", "a device", 1234, 999};
    const Error lost = vulkan::to_error(vk::DeviceLostError("vk::Queue::submit"), task);
    EXPECT_EQ(lost.kind(), ErrorKind::internal);
    EXPECT_TRUE(contains(lost.what(), "launching on 'a device': vk::Queue::submit: ErrorDeviceLost")) << lost.what();
    const Error full = vulkan::to_error(vk::OutOfDeviceMemoryError("vk::Device::allocateMemory"), task);
    EXPECT_EQ(full.kind(), ErrorKind::unsupported);
    EXPECT_TRUE(contains(full.what(), "1234") && contains(full.what(), "999"));
}

} // namespace tetrace
