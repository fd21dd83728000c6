// On every OpenCL device that can be used here: its hits are openmp's, whatever the layout, schedule, tile, image,
// camera and number of buffers.
#include "backends/opencl/backend.h"
#include "backends/opencl/device.h"
#include "backends/opencl/errors.h"
#include "core/scene_buffers.h"
#include "core/self_test.h"
#include "tests/device_rays.h"
#include "tests/temporary_folder.h"

#include <algorithm>
#include <chrono>

namespace tetrace {
namespace fs = std::filesystem;
namespace {

/// Runs a test's body on each usable device; visibly skipped where there is none.
class Opencl : public ::testing::Test {
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
                << backend.devices()[device].name << ' ' << name_of(kernel) << ' ' << name_of(kernel.schedule) << ' '
                << job.width << 'x' << job.height << " tile height " << options.tile_height
                << (job.start_tet == NO_TET ? " from outside" : " from inside");
    }

    Backend& backend = opencl_backend();
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

TEST_F(Opencl, every_device_is_exact_in_exact_mode)
{
    for (const std::size_t device : usable)
        EXPECT_TRUE(self_test(device, MathMode::exact).is_exact()) << self_test(device, MathMode::exact).text();
}

TEST_F(Opencl, hits_are_openmps_for_each_layout_schedule_and_tile)
{
    for (const Layout layout : {Layout::tet80, Layout::tet96}) {
        const DeviceRays rays(make_cubes(8), layout);
        ASSERT_NE(rays.from_inside(8, 8).start_tet, NO_TET);
        ASSERT_EQ(rays.from_outside(8, 8).start_tet, NO_TET);
        for (const std::size_t device : usable)
            for (const Schedule schedule : {Schedule::tiles, Schedule::persistent})
                for (const unsigned tile_height : {0u, 4u, 8u})
                    expect_openmps_hits(device, {.layout = layout, .schedule = schedule}, rays, all_jobs(rays),
                                        {.tile_height = tile_height});
    }
}

TEST_F(Opencl, hits_are_openmps_with_the_tets_in_parts)
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

TEST_F(Opencl, hits_are_openmps_for_an_image_of_many_launches)
{
    const DeviceRays rays(make_cubes(8), Layout::tet96);
    for (const std::size_t device : usable)
        for (const Schedule schedule : {Schedule::tiles, Schedule::persistent})
            expect_openmps_hits(device, {.layout = Layout::tet96, .schedule = schedule}, rays,
                                {rays.from_outside(401, 390), rays.from_outside(401, 390, 0)}, {.threads = 1});
}

TEST_F(Opencl, a_job_launched_twice_gives_the_same_hits)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {}, rays.data(), {});
        const auto first = traced(*session, rays.from_outside(50, 50));
        (void)traced(*session, rays.from_inside(20, 90));
        EXPECT_EQ(traced(*session, rays.from_outside(50, 50)), first);
        EXPECT_EQ(session->bytes(), rays.packed().bytes());
        EXPECT_GT(session->setup_times().compile_s, 0);
        EXPECT_GT(session->setup_times().upload_s, 0);
    }
}

TEST_F(Opencl, wait_tells_the_device_seconds_of_all_launches)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    for (const std::size_t device : usable) {
        double largest_share = 0; // a busy machine makes a share smaller, never larger
        for (int i = 0; i < 8; i++) {
            const auto session = backend.open(device, {}, rays.data(), {}); // its first image is launched in steps
            const auto start = std::chrono::steady_clock::now();
            session->launch(rays.from_outside(300, 300));
            const double seconds = session->wait();
            const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            EXPECT_LT(seconds, wall_s);
            largest_share = std::max(largest_share, seconds / wall_s);
        }
        const bool has_latency = backend.devices()[device].type == "gpu"; // longer than such an image takes
        EXPECT_GT(largest_share, has_latency ? 0 : 0.25) << "the last of three steps has a tenth of the tiles";
    }
}

TEST_F(Opencl, sessions_of_a_device_live_side_by_side)
{
    const DeviceRays a(make_cubes(3), Layout::tet80), b(make_cubes(5), Layout::tet96);
    for (const std::size_t device : usable) {
        const auto first = backend.open(device, {.layout = Layout::tet80}, a.data(), {});
        const auto second = backend.open(device, {.layout = Layout::tet96}, b.data(), {});
        const TraceJob job_a = a.from_outside(30, 30), job_b = b.from_inside(40, 40);
        first->launch(job_a);
        second->launch(job_b);
        (void)second->wait();
        (void)first->wait();
        std::vector<Hit> hits(30 * 30);
        first->read_back(hits);
        EXPECT_EQ(different_rays(hits, openmp_hits(a, job_a), 3), 0u);
    }
}

TEST_F(Opencl, fast_mode_finds_the_same_faces_but_for_rays_on_edges)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const TraceJob job = rays.from_outside(128, 128);
    const auto right = openmp_hits(rays, job);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {.math = MathMode::fast}, rays.data(), {});
        EXPECT_LE(distant_rays(traced(*session, job), right), right.size() / 1000);
    }
}

TEST(DeviceRaysTolerances, fail_for_wrong_answers)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const TraceJob job = rays.from_outside(128, 128);
    TraceJob shifted = job; // by a tenth of a pixel
    shifted.view.corner.x += 0.1F * job.view.step_x.x;
    shifted.view.corner.y += 0.1F * job.view.step_x.y;
    shifted.view.corner.z += 0.1F * job.view.step_x.z;
    const auto right = openmp_hits(rays, job), wrong = openmp_hits(rays, shifted);
    EXPECT_GT(distant_rays(wrong, right), right.size() / 1000);
    EXPECT_GT(different_rays(wrong, right, 3), right.size() / 10);
    auto nearly = right;
    const auto hit = std::find_if(nearly.begin(), nearly.end(), [](const Hit& h) { return h.t > 0; });
    ASSERT_NE(hit, nearly.end());
    for (int i = 0; i < 4; i++)
        hit->t = std::nextafter(hit->t, 1e9F);
    EXPECT_EQ(different_rays(nearly, right, 3), 1u);
    EXPECT_EQ(different_rays(nearly, right, 4), 0u);
}

TEST_F(Opencl, a_second_session_finds_its_program_in_the_cache)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TraceJob job = rays.from_outside(20, 20);
    for (const std::size_t device : usable) {
        const TemporaryFolder folder;
        const SessionOptions options{.program_cache = folder / "programs"};
        EXPECT_FALSE(backend.open(device, {}, rays.data(), options)->setup_times().compile_cached);
        const auto second = backend.open(device, {}, rays.data(), options);
        EXPECT_TRUE(second->setup_times().compile_cached);
        EXPECT_EQ(different_rays(traced(*second, job), openmp_hits(rays, job), 3), 0u);
        EXPECT_FALSE(backend.open(device, {.math = MathMode::fast}, rays.data(), options)->setup_times().compile_cached)
            << "another math mode is another program";
    }
}

TEST_F(Opencl, survives_a_damaged_program_cache_and_mends_it)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TraceJob job = rays.from_outside(20, 20);
    const TemporaryFolder folder;
    const SessionOptions options{.program_cache = folder / "programs"};
    const std::size_t device = usable.front();
    (void)backend.open(device, {}, rays.data(), options);
    const fs::path file = fs::directory_iterator(folder / "programs")->path();
    const std::string whole = read_text(file);
    const auto bent = [&](std::size_t position) {
        std::string text = whole;
        text[position] = static_cast<char>(text[position] ^ 1);
        return text;
    };
    for (const std::string& damaged : {std::string(), whole.substr(0, 7), whole.substr(0, whole.size() / 2), bent(0),
                                       bent(whole.size() - 1), std::string(100, 'x')}) {
        write_text(file, damaged);
        const auto session = backend.open(device, {}, rays.data(), options);
        EXPECT_FALSE(session->setup_times().compile_cached);
        EXPECT_EQ(different_rays(traced(*session, job), openmp_hits(rays, job), 3), 0u);
        EXPECT_TRUE(backend.open(device, {}, rays.data(), options)->setup_times().compile_cached);
    }
}

TEST_F(Opencl, does_without_a_cache_that_cannot_be_written)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TemporaryFolder folder;
    write_text(folder / "file", "not a folder");
    EXPECT_NO_THROW((void)backend.open(usable.front(), {}, rays.data(), {.program_cache = folder / "file"}));
}

TEST_F(Opencl, refuses_what_exceeds_a_limit_with_both_numbers)
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

TEST_F(Opencl, yardsticks_are_plausible)
{
    for (const std::size_t device : usable) {
        const auto yardstick = backend.yardstick(device, {});
        ASSERT_TRUE(yardstick.has_value());
        EXPECT_GT(yardstick->copy_bytes_per_s, 1e6);
        EXPECT_GT(yardstick->launch_s, 0);
    }
}

TEST_F(Opencl, devices_say_what_they_are)
{
    for (const std::size_t index : usable) {
        const Device& device = backend.devices()[index];
        EXPECT_FALSE(device.name.empty() || device.driver.empty() || device.id.empty());
        EXPECT_TRUE(device.type == "gpu" || device.type == "emulated") << device.type;
        EXPECT_NE(device.implementation.find('-'), std::string::npos) << device.implementation;
        EXPECT_GE(device.max_group_items, 64u);
        EXPECT_GT(device.max_buffer_bytes, 0u);
        EXPECT_LE(device.max_buffer_bytes, device.memory_bytes);
        EXPECT_TRUE(device.uuid.empty() || device.uuid.size() == 32) << device.uuid;
    }
}

TEST(OpenclKernels, are_those_of_the_cdt)
{
    const Backend& backend = opencl_backend();
    EXPECT_TRUE(
        backend.has_kernel({.layout = Layout::tet96, .math = MathMode::fast, .schedule = Schedule::persistent}));
    EXPECT_FALSE(backend.has_kernel({.structure = Structure::bvh, .layout = Layout::embree}));
    EXPECT_FALSE(backend.has_kernel({.method = Method::single}));
    EXPECT_TRUE(contains(backend.why_not(0, {.method = Method::single}), "has no kernel"));
}

TEST(OpenclImplementation, is_read_from_whatever_drivers_say)
{
    using opencl::implementation_of;
    EXPECT_EQ(implementation_of("Portable Computing Language", "3.1+debian", "OpenCL 3.0 PoCL 3.1+debian  Linux"),
              "pocl-3.1");
    EXPECT_EQ(implementation_of("Portable Computing Language", "6.0+debian", "OpenCL 3.0 PoCL 6.0+debian"), "pocl-6.0");
    EXPECT_EQ(implementation_of("Oclgrind", "Oclgrind 21.10", "OpenCL 1.2 (Oclgrind 21.10)"), "oclgrind-21.10");
    EXPECT_EQ(implementation_of("NVIDIA CUDA", "580.82.07", "OpenCL 3.0 CUDA 13.0.97"), "nvidia-580");
    EXPECT_EQ(implementation_of("rusticl", "25.0.7-2", "OpenCL 3.0 "), "rusticl-25.0");
    EXPECT_EQ(implementation_of("Intel(R) OpenCL Graphics", "23.05.25593.11", "OpenCL 3.0 "),
              "intel-r-opencl-graphics-23.05");
    EXPECT_EQ(implementation_of("AMD Accelerated Parallel Processing", "3513.0 (HSA1.1,LC)", "OpenCL 2.1 AMD-APP.dbg"),
              "amd-accelerated-parallel-processing-3513.0");
    EXPECT_EQ(implementation_of("Some Driver", "beta", "OpenCL 1.2 Some 7.9.1"), "some-driver-7.9");
    EXPECT_EQ(implementation_of("Some Driver", "", "OpenCL 1.2"), "some-driver") << "its OpenCL is no driver's version";
    EXPECT_EQ(implementation_of("", "", ""), "opencl");
    EXPECT_EQ(implementation_of("NVIDIA CUDA", "", ""), "nvidia");
}

TEST(OpenclDevice, pci_addresses_are_as_the_system_writes_them)
{
    EXPECT_EQ(opencl::pci_text(0, 0x41, 0, 0), "0000:41:00.0");
    EXPECT_EQ(opencl::pci_text(1, 2, 0x1f, 7), "0001:02:1f.7");
}

TEST(OpenclErrors, name_the_call_the_code_and_the_device)
{
    const opencl::Task task{"launching", "a device", 1234, 999};
    const Error lost = opencl::to_error(cl::Error(CL_OUT_OF_RESOURCES, "clFinish"), task);
    EXPECT_EQ(lost.kind(), ErrorKind::internal);
    EXPECT_TRUE(contains(lost.what(), "launching on 'a device': clFinish gave CL_OUT_OF_RESOURCES"));
    const Error full = opencl::to_error(cl::Error(CL_MEM_OBJECT_ALLOCATION_FAILURE, "clCreateBuffer"), task);
    EXPECT_EQ(full.kind(), ErrorKind::unsupported);
    EXPECT_TRUE(contains(full.what(), "1234") && contains(full.what(), "999"));
    EXPECT_EQ(opencl::error_name(-1001), "CL_PLATFORM_NOT_FOUND_KHR");
    EXPECT_EQ(opencl::error_name(-9999), "OpenCL error -9999");
}

} // namespace tetrace
