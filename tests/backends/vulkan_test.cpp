// What only Vulkan has: its program cache, staging, texels, validation layers, limits, timestamps, errors.
// device_test.cpp and the other tests of each_device.h have what is claimed of every API.
#include "backends/vulkan/backend.h"
#include "backends/vulkan/context.h"
#include "backends/vulkan/instance.h"
#include "backends/vulkan/session.h"
#include "core/device/given_quads.h"
#include "tests/backends/each_device.h"
#include "tests/support/bvh_scene.h"
#include "tests/support/device_rays.h"
#include "tests/support/given_scene.h"
#include "tests/support/hard_scenes.h"
#include "tests/support/stack_case.h"
#include "tests/support/temporary_folder.h"

using namespace tetrace;
using namespace tetrace::test;

namespace {

/// Before the instance is made: in all builds, not only in debug ones.
class Vulkan : public UsableDevices {
protected:
    Vulkan() : UsableDevices(vulkan_backend()) {}
};

} // namespace

TEST_F(Vulkan, a_program_cache_changes_no_hit_and_is_filled)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TraceJob job = rays.from_outside(20, 20);
    for (const std::size_t device : usable) {
        const TemporaryFolder folder;
        const SessionOptions options{.program_cache = folder / "programs"};
        for (int pass = 0; pass < 2; ++pass) {
            const auto session = backend.open(device, {}, rays.data(), options);
            EXPECT_EQ(different_rays(traced(*session, job), openmp_hits(rays, job), 3), 0u);
        }
        EXPECT_FALSE(std::filesystem::is_empty(folder / "programs"));
        EXPECT_FALSE(backend.open(device, {}, rays.data(), {})->setup_times().compile_cached) << "no cache, no hit";
    }
}

TEST_F(Vulkan, an_allocation_over_the_devices_largest_is_refused_with_both_numbers)
{
    for (vulkan::FoundDevice found : vulkan::find_devices()) {
        if (!found.facts.usable) continue;
        found.limits.allocation_bytes = 1000;
        const vulkan::Context context(found);
        const std::string refused = error_of([&] { vulkan::Buffer(context, 4096, vulkan::BufferUse::device); });
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
                for (const TraceJob& job : jobs_of_all_kinds(rays))
                    EXPECT_EQ(different_rays(traced(session, job), openmp_hits(rays, job), 3), 0u) << texels;
            }
            found.limits.texels = 100; // too few for the scene: storage buffers again
            vulkan::VulkanSession session(found, {.layout = layout}, rays.packed(), {});
            const TraceJob job = rays.from_outside(61, 35);
            EXPECT_EQ(different_rays(traced(session, job), openmp_hits(rays, job), 3), 0u);
        }
    }
}

TEST_F(Vulkan, rays_left_at_ties_get_openmps_hits)
{
    const auto lines = even_lines(8, 1);
    const Scene grid = grid_of({lines, lines, lines});
    for (const Layout layout :
         {Layout::half32, Layout::tet64, Layout::tet80, Layout::tet96, Layout::tet20, Layout::tet16}) {
        const DeviceRays rays(grid, layout);
        const KernelId kernel{.method = Method::project, .layout = layout};
        const auto on_host = openmp_backend().open(0, kernel, rays.data(), {.threads = 2});
        for (vulkan::FoundDevice found : vulkan::find_devices()) {
            if (!found.facts.usable) continue;
            found.reads_texels = true; // the programs that leave ties
            vulkan::VulkanSession session(found, kernel, rays.packed(), {});
            // More than a group of them in an image, none, then more again; at last from inside, with none left.
            std::vector<TraceJob> jobs = {along_lines(17, 17, {0.25f, 0, 3}), rays.from_outside(7, 3),
                                          between_lines(50, 41), along_lines(50, 41, {0, 0, 4}),
                                          rays.from_inside(20, 20)};
            jobs[2].passes = 3;
            for (const TraceJob& job : jobs)
                EXPECT_EQ(different_rays(traced(session, job), traced(*on_host, job), 3), 0u)
                    << name_of(layout) << ' ' << job.width << 'x' << job.height;
        }
    }
}

namespace {

/// Calls expect_right with every usable device, once as an emulated device and once as another.
void with_devices_of_all_kinds(const std::function<void(const vulkan::FoundDevice&)>& expect_right)
{
    for (vulkan::FoundDevice found : vulkan::find_devices()) {
        if (!found.facts.usable) continue;
        for (const bool selects : {false, true})
            for (const unsigned shares : {1u, 2u, 7u, 1000u}) {
                found.selects_minima = selects;
                found.reads_texels = selects;
                found.shares = shares;
                SCOPED_TRACE(found.facts.name + (selects ? ", selects, " : ", minima, ") + std::to_string(shares));
                expect_right(found);
            }
    }
}

} // namespace

TEST_F(Vulkan, hits_of_walks_are_openmps_whatever_kind_of_device_it_is)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    with_devices_of_all_kinds([&](const vulkan::FoundDevice& found) {
        vulkan::VulkanSession session(found, {}, rays.packed(), {});
        for (const TraceJob& job : jobs_of_all_kinds(rays))
            EXPECT_EQ(different_rays(traced(session, job), openmp_hits(rays, job), 3), 0u);
    });
}

TEST_F(Vulkan, hits_of_bvhs_are_openmps_whatever_kind_of_device_it_is)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const GivenScene cubes{40, false, 6};
    for (const Layout layout : {Layout::bvh2, Layout::bvh4, Layout::cwbvh}) {
        const PackedScene packed = make_bvh_scene(cubes.scene.mesh, layout);
        const SceneData data{&cubes.scene.mesh, &packed};
        const auto on_host = openmp_backend().open(0, bvh_kernel(layout, Task::trace), data, {.threads = 2});
        const auto given_on_host = openmp_backend().open(0, bvh_kernel(layout, Task::rays), data, {.threads = 2});
        with_devices_of_all_kinds([&](const vulkan::FoundDevice& found) {
            vulkan::VulkanSession session(found, bvh_kernel(layout, Task::trace), packed, {});
            for (const TraceJob& job : {rays.from_outside(72, 50), rays.from_outside(61, 35, 2)})
                EXPECT_EQ(different_rays(traced(session, job), traced(*on_host, job), 3), 0u);
            vulkan::VulkanSession given(found, bvh_kernel(layout, Task::rays), packed, {});
            for (const RayKind kind : {RayKind::ao, RayKind::diffuse}) {
                const RaySet set = make_rays(kind, cubes.source());
                const auto quads = given_quads_offset(set, cubes.scene.mesh);
                const TraceJob job = given_job(set.rays.size(), 0, set.any_hit);
                given_on_host->set_rays(quads);
                given.set_rays(quads);
                EXPECT_EQ(different_rays(traced(given, job), traced(*given_on_host, job), 3), 0u) << name_of(kind);
            }
        });
    }
}

TEST_F(Vulkan, nearer_of_two_layers_is_openmps_in_the_form_of_gpus)
{
    TriangleMesh mesh; // two layers of 3 x 3 squares that cross, within three units in the last place of each other
    for (const int layer : {0, 1}) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                mesh.vertices.push_back({0.25F * static_cast<float>(i) - 0.375F, 0.25F * static_cast<float>(j) - 0.375F,
                                         0.5F + static_cast<float>(layer * (i - j)) * 0x1p-23F});
        for (std::uint32_t square = 0; square < 9; ++square) {
            const std::uint32_t corner = first + square / 3 * 4 + square % 3;
            mesh.triangles.push_back({corner, corner + 1, corner + 4});
            mesh.triangles.push_back({corner + 1, corner + 5, corner + 4});
        }
    }
    RaySet set{RayKind::random, RayOrder::tiles, false, 0, TILE_WIDTH, {}};
    for (std::uint32_t number = 0; number < 64; ++number) {
        const float x = static_cast<float>(number % 8) * 0.09F - 0.33F,
                    y = static_cast<float>(number / 8) * 0.09F - 0.32F;
        const Float3 direction{0.25F - x, 0.125F + y, -0.5F};
        const Float3 origin = snap_to_grid(Float3{x - 2 * direction.x, y - 2 * direction.y, 1.5F});
        set.rays.push_back({origin, direction, NO_END, NO_HALF_FACE, FREE_FACE, number});
    }
    const auto quads = given_quads_offset(set, mesh);
    const TraceJob job = given_job(set.rays.size(), 0, false);
    for (const Layout layout : {Layout::bvh2, Layout::bvh4, Layout::cwbvh}) {
        const KernelId kernel = bvh_kernel(layout, Task::rays);
        const PackedScene packed = make_bvh_scene(mesh, layout);
        const auto on_host = openmp_backend().open(0, kernel, {&mesh, &packed}, {.threads = 1});
        on_host->set_rays(quads);
        for (vulkan::FoundDevice found : vulkan::find_devices()) {
            if (!found.facts.usable) continue;
            found.reads_texels = false;
            vulkan::VulkanSession session(found, kernel, packed, {});
            session.set_rays(quads);
            EXPECT_EQ(different_rays(traced(session, job), traced(*on_host, job), 3), 0u) << name_of(layout);
        }
    }
}

TEST_F(Vulkan, hits_of_bvhs_are_openmps_however_much_of_a_stack_is_in_the_groups_memory)
{
    for (const Layout layout : {Layout::bvh2, Layout::bvh4, Layout::cwbvh}) {
        const StackCase stacks(layout);
        for (vulkan::FoundDevice found : vulkan::find_devices())
            for (const unsigned stack_top : {0u, 1u, STACK_TOP_OF_GPUS})
                for (const unsigned tile_height : {4u, 8u}) {
                    if (!found.facts.usable) continue;
                    found.reads_texels = false; // modules that read texels lack STACK_TOP
                    found.stack_top = stack_top;
                    SessionOptions options{.tile_height = tile_height};
                    if (found.facts.max_steps != 0) // it ends long loops (docs/findings.md, 5)
                        options.program_file =
                            std::string(TETRACE_SPIRV_FOLDER "/").append(name_of(layout)).append("_without_loops.spv");
                    vulkan::VulkanSession session(found, stacks.kernel, stacks.full.packed, options);
                    EXPECT_EQ(stacks.wrong_rays(session), 0u) << found.facts.name << ' ' << name_of(layout) << ' '
                                                              << stack_top << " entries, tile height " << tile_height;
                }
    }
}

// As packing found, and the most: both without a top in the group's memory.
TEST_F(Vulkan, hits_of_bvhs_are_openmps_with_stacks_as_large_as_the_tree_needs)
{
    for (const Layout layout : {Layout::bvh2, Layout::bvh4, Layout::cwbvh}) {
        const StackCase stacks(layout);
        for (vulkan::FoundDevice found : vulkan::find_devices())
            for (const std::uint32_t entries : {stacks.full.packed.stack_entries, 0u}) {
                if (!found.facts.usable) continue;
                found.reads_texels = true;
                PackedScene packed = stacks.full.packed;
                packed.stack_entries = entries;
                vulkan::VulkanSession session(found, stacks.kernel, packed, {});
                EXPECT_EQ(stacks.wrong_rays(session), 0u)
                    << found.facts.name << ' ' << name_of(layout) << ' ' << entries << " entries";
            }
    }
}

TEST_F(Vulkan, trees_of_about_one_depth_share_a_program)
{
    const auto programs = [](const std::filesystem::path& folder) {
        return std::distance(std::filesystem::directory_iterator(folder), {});
    };
    for (vulkan::FoundDevice found : vulkan::find_devices()) {
        if (!found.facts.usable) continue;
        const TemporaryFolder folder;
        const auto programs_after = [&](std::uint32_t depth) {
            const DeepTree tree(depth);
            const vulkan::VulkanSession session(found, bvh_kernel(Layout::bvh2, Task::trace),
                                                pack_bvh(tree.mesh, tree.bvh, Layout::bvh2),
                                                {.program_cache = folder / "programs"});
            return programs(folder / "programs");
        };
        found.reads_texels = true;
        EXPECT_EQ(programs_after(4), 2) << "5 entries: most rays, and those at near triangles";
        EXPECT_EQ(programs_after(7), 2) << "8 entries";
        EXPECT_EQ(programs_after(8), 4) << "9 entries";
        found.reads_texels = false;
        EXPECT_EQ(programs_after(4), 5);
        EXPECT_EQ(programs_after(8), 5) << "arrays in a GPU's registers are not sized";
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

TEST_F(Vulkan, devices_say_what_vulkan_promises)
{
    for (const std::size_t index : usable) {
        const Device& device = backend.devices()[index];
        EXPECT_EQ(device.uuid.size(), 32u) << device.uuid;
        EXPECT_GE(device.max_buffer_bytes, 128u << 20) << "the least that Vulkan allows";
        EXPECT_GT(device.group_width, 0u);
        EXPECT_GT(device.timer_period_s, 0);
    }
}

TEST(VulkanImplementation, is_read_from_whatever_drivers_say)
{
    using vulkan::implementation_of;
    EXPECT_EQ(implementation_of("llvmpipe", "Mesa 22.3.6 (LLVM 15.0.6)"), "lavapipe-22.3");
    EXPECT_EQ(implementation_of("llvmpipe", "Mesa 25.0.7-2 (LLVM 19.1.7)"), "lavapipe-25.0");
    EXPECT_EQ(implementation_of("NVIDIA", "580.65.06"), "nvidia-vulkan-580");
    EXPECT_EQ(implementation_of("radv", "Mesa 22.3.6"), "radv-22.3");
    EXPECT_EQ(implementation_of("SwiftShader driver", "5.0.0"), "swiftshader-5.0");
    EXPECT_EQ(implementation_of("Intel open-source Mesa driver", "Mesa 23.2.1-1ubuntu3"),
              "intel-open-source-mesa-driver-23.2");
    EXPECT_EQ(implementation_of("AMD (proprietary) ", "beta"), "amd-proprietary");
    EXPECT_EQ(implementation_of("Driver", "v7."), "driver-7");
    EXPECT_EQ(implementation_of("", ""), "unknown");
}

TEST(VulkanImplementation, only_lavapipe_before_mesa_25_limits_the_steps_of_a_walk)
{
    for (const char* const limited : {"lavapipe-22.3", "lavapipe-24.3", "lavapipe"})
        EXPECT_EQ(vulkan::max_steps_of(limited), 28'000u) << limited;
    for (const char* const free : {"lavapipe-25.0", "lavapipe-26.1", "radv-22.3", "nvidia-vulkan-580", "unknown"})
        EXPECT_EQ(vulkan::max_steps_of(free), 0u) << free;
}

TEST(VulkanImplementation, hardware_that_radv_invents_is_distinguished_from_hardware)
{
    ::unsetenv("RADV_FORCE_FAMILY");
    EXPECT_TRUE(vulkan::is_null_hardware("radv-22.3", "Null hardware (RADV GFX1100)"));
    EXPECT_FALSE(vulkan::is_null_hardware("radv-22.3", "AMD Radeon RX 7900 XTX (RADV NAVI31)"));
    ::setenv("RADV_FORCE_FAMILY", "navi31", 1);
    EXPECT_TRUE(vulkan::is_null_hardware("radv-25.0", "AMD Radeon RX 7900 XTX (RADV NAVI31)"));
    EXPECT_FALSE(vulkan::is_null_hardware("lavapipe-25.0", "llvmpipe"));
    ::unsetenv("RADV_FORCE_FAMILY");
}

TEST(VulkanLimits, each_is_reported_with_its_number)
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
    EXPECT_TRUE(contains(reason(&Limits::push_constant_bytes, 64u), "push constants: 64, 128 are needed"));
    EXPECT_TRUE(contains(reason(&Limits::storage_buffers, 4u), "4, 7 are needed"));
    EXPECT_TRUE(contains(reason(&Limits::group_items, 32u), "32, 64 are needed"));
    EXPECT_TRUE(contains(reason(&Limits::group_height, 4u), "4, 8 are needed"));
}

TEST(VulkanDevices, are_shared_where_the_driver_makes_no_more)
{
    std::weak_ptr<int> newest;
    const auto refuse = [](vk::Result why) {
        return [why]() -> int { throw vk::SystemError(vk::make_error_code(why)); };
    };
    const auto no_more = refuse(vk::Result::eErrorInitializationFailed);
    EXPECT_THROW((void)vulkan::made_or_shared(newest, no_more), vk::SystemError); // there is none to share
    auto first = vulkan::made_or_shared(newest, [] { return 1; });
    auto second = vulkan::made_or_shared(newest, [] { return 2; });
    EXPECT_EQ(*first, 1);
    EXPECT_EQ(vulkan::made_or_shared(newest, no_more), second);
    EXPECT_EQ(vulkan::made_or_shared(newest, refuse(vk::Result::eErrorTooManyObjects)), second);
    EXPECT_THROW((void)vulkan::made_or_shared(newest, refuse(vk::Result::eErrorDeviceLost)), vk::SystemError);
    second.reset();
    EXPECT_THROW((void)vulkan::made_or_shared(newest, no_more), vk::SystemError);
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
    const vulkan::Doing task{"launching", "a device", 1234, 999};
    const Error lost = vulkan::to_error(vk::DeviceLostError("vk::Queue::submit"), task);
    EXPECT_EQ(lost.kind(), ErrorKind::driver);
    EXPECT_TRUE(contains(lost.what(), "launching on 'a device': vk::Queue::submit: ErrorDeviceLost")) << lost.what();
    const Error full = vulkan::to_error(vk::OutOfDeviceMemoryError("vk::Device::allocateMemory"), task);
    EXPECT_EQ(full.kind(), ErrorKind::unsupported);
    EXPECT_TRUE(contains(full.what(), "1234") && contains(full.what(), "999"));
}
