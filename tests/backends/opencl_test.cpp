// What only OpenCL has: its program cache, what its drivers say of themselves, its errors.
// device_test.cpp and the other tests of each_device.h have what is claimed of every API.
#include "backends/opencl/backend.h"
#include "backends/opencl/device.h"
#include "backends/opencl/errors.h"
#include "backends/opencl/session.h"
#include "core/device/given_quads.h"
#include "tests/support/bvh_scene.h"
#include "tests/support/device_rays.h"
#include "tests/support/stack_case.h"
#include "tests/support/temporary_folder.h"

using namespace tetrace;
using namespace tetrace::test;

namespace fs = std::filesystem;

namespace {

class Opencl : public UsableDevices {
protected:
    Opencl() : UsableDevices(opencl_backend()) {}

    /// A session whose program tetrace keeps, which it leaves to PoCL otherwise.
    static std::unique_ptr<opencl::OpenclSession> keeping(std::size_t device, const DeviceRays& rays,
                                                          const SessionOptions& options, const KernelId& kernel = {})
    {
        opencl::FoundDevice found = opencl::find_devices().at(device);
        found.keeps_programs = false;
        return std::make_unique<opencl::OpenclSession>(std::make_shared<opencl::Context>(found, 0), kernel,
                                                       rays.packed(), options);
    }
};

} // namespace

TEST_F(Opencl, a_second_session_finds_its_program_in_the_cache)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TraceJob job = rays.from_outside(20, 20);
    for (const std::size_t device : usable) {
        const TemporaryFolder folder;
        const SessionOptions options{.program_cache = folder / "programs"};
        EXPECT_FALSE(keeping(device, rays, options)->setup_times().compile_cached);
        const auto second = keeping(device, rays, options);
        EXPECT_TRUE(second->setup_times().compile_cached);
        EXPECT_EQ(different_rays(traced(*second, job), openmp_hits(rays, job), 3), 0u);
        EXPECT_FALSE(keeping(device, rays, options, {.math = MathMode::fast})->setup_times().compile_cached)
            << "another math mode is another program";
    }
}

// PoCL 3.1 ended the process at this: always with 16 threads, mostly with 2 (docs/findings.md, 13).
TEST_F(Opencl, launches_that_grow_while_others_are_in_flight_give_openmps_hits)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    for (const std::size_t device : usable) {
        const auto session = backend.open(device, {}, rays.data(), {});
        for (std::uint32_t round = 0; round < 20; ++round) {
            std::vector<TraceJob> jobs;
            for (std::uint32_t i = 1; i <= 8; ++i)
                jobs.push_back(rays.from_outside(8, 8 * (8 * round + i)));
            std::vector<Hit> single;
            for (const TraceJob& job : jobs)
                for (const Hit& hit : openmp_hits(rays, job))
                    single.push_back(hit);
            EXPECT_EQ(different_rays(traced(*session, jobs), single, 3), 0u) << "round " << round;
        }
    }
}

TEST_F(Opencl, hits_of_bvhs_are_openmps_however_much_of_a_stack_is_in_the_groups_memory)
{
    for (const Layout layout : {Layout::bvh2, Layout::bvh4, Layout::cwbvh}) {
        const StackCase stacks(layout);
        for (opencl::FoundDevice found : opencl::find_devices())
            for (const auto& [stack_top, tile_height] :
                 {std::pair{0u, 8u}, std::pair{1u, 4u}, std::pair{STACK_TOP_OF_GPUS, 8u}}) {
                if (!found.facts.usable) continue;
                found.stack_top = stack_top;
                opencl::OpenclSession session(std::make_shared<opencl::Context>(found, 0), stacks.kernel,
                                              stacks.full.packed, {.tile_height = tile_height});
                EXPECT_EQ(stacks.wrong_rays(session), 0u) << found.facts.name << ' ' << name_of(layout) << ' '
                                                          << stack_top << " entries, tile height " << tile_height;
            }
    }
}

TEST_F(Opencl, compilers_warn_of_no_kernel) // PoCL writes the number of its warnings into the user's table
{
    for (const std::size_t device : usable)
        for (const KernelId& kernel : {KernelId{.method = Method::maria, .layout = Layout::tet80},
                                       KernelId{.method = Method::project, .layout = Layout::half32},
                                       KernelId{.method = Method::project, .layout = Layout::tet64},
                                       KernelId{.method = Method::single, .layout = Layout::bvh2},
                                       KernelId{.method = Method::single, .layout = Layout::bvh4},
                                       KernelId{.method = Method::single, .layout = Layout::cwbvh}})
            for (const bool starts_outside : {true, false}) {
                const std::string messages = backend.compiled(device, kernel, starts_outside, {}).messages;
                EXPECT_EQ(messages.find("warning"), std::string::npos) << name_of(kernel) << ": " << messages;
            }
}

TEST_F(Opencl, survives_a_damaged_program_cache_and_mends_it)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TraceJob job = rays.from_outside(20, 20);
    const TemporaryFolder folder;
    const SessionOptions options{.program_cache = folder / "programs"};
    const std::size_t device = usable.front();
    (void)keeping(device, rays, options);
    const fs::path file = fs::directory_iterator(folder / "programs")->path();
    const std::string whole = read_text(file);
    const auto bent = [&](std::size_t position) {
        std::string text = whole;
        text[position] = static_cast<char>(text[position] ^ 1);
        return text;
    };
    for (const std::string& damaged : {std::string(), whole.substr(0, 7), whole.substr(0, whole.size() / 2), bent(0),
                                       bent(whole.size() - 1), std::string(100, 'x')}) {
        write_file(file, damaged);
        const auto session = keeping(device, rays, options);
        EXPECT_FALSE(session->setup_times().compile_cached);
        EXPECT_EQ(different_rays(traced(*session, job), openmp_hits(rays, job), 3), 0u);
        EXPECT_TRUE(keeping(device, rays, options)->setup_times().compile_cached);
    }
}

TEST_F(Opencl, does_without_a_cache_that_cannot_be_written)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TemporaryFolder folder;
    write_file(folder / "file", "not a folder");
    EXPECT_NO_THROW((void)keeping(usable.front(), rays, {.program_cache = folder / "file"}));
}

TEST_F(Opencl, leaves_programs_to_a_driver_that_keeps_them_itself)
{
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    for (const std::size_t device : usable) {
        const TemporaryFolder folder;
        (void)backend.open(device, {}, rays.data(), {.program_cache = folder / "programs"});
        const bool is_pocl = opencl::find_devices().at(device).facts.implementation.starts_with("pocl-");
        EXPECT_EQ(fs::exists(folder / "programs"), !is_pocl);
    }
}

TEST_F(Opencl, a_buffer_fits_into_a_devices_memory)
{
    for (const std::size_t device : usable)
        EXPECT_LE(backend.devices()[device].max_buffer_bytes, backend.devices()[device].memory_bytes);
}

TEST(OpenclImplementation, is_read_from_whatever_drivers_say)
{
    using opencl::implementation_of;
    EXPECT_EQ(implementation_of("Portable Computing Language", "3.1+debian", "OpenCL 3.0 PoCL 3.1+debian  Linux"),
              "pocl-3.1");
    EXPECT_EQ(implementation_of("Portable Computing Language", "6.0+debian", "OpenCL 3.0 PoCL 6.0+debian"), "pocl-6.0");
    EXPECT_EQ(implementation_of("Oclgrind", "Oclgrind 21.10", "OpenCL 1.2 (Oclgrind 21.10)"), "oclgrind-21.10");
    EXPECT_EQ(implementation_of("NVIDIA CUDA", "580.82.07", "OpenCL 3.0 CUDA 13.0.97"), "nvidia-opencl-580");
    EXPECT_EQ(implementation_of("rusticl", "25.0.7-2", "OpenCL 3.0 "), "rusticl-25.0");
    EXPECT_EQ(implementation_of("Intel(R) OpenCL Graphics", "23.05.25593.11", "OpenCL 3.0 "),
              "intel-r-opencl-graphics-23.05");
    EXPECT_EQ(implementation_of("AMD Accelerated Parallel Processing", "3513.0 (HSA1.1,LC)", "OpenCL 2.1 AMD-APP.dbg"),
              "amd-accelerated-parallel-processing-3513.0");
    EXPECT_EQ(implementation_of("Some Driver", "beta", "OpenCL 1.2 Some 7.9.1"), "some-driver-7.9");
    EXPECT_EQ(implementation_of("Some Driver", "", "OpenCL 1.2"), "some-driver") << "its OpenCL is no driver's version";
    EXPECT_EQ(implementation_of("", "", ""), "opencl");
    EXPECT_EQ(implementation_of("NVIDIA CUDA", "", ""), "nvidia-opencl");
}

TEST(OpenclErrors, name_the_call_the_code_and_the_device)
{
    const opencl::Doing task{"launching", "a device", 1234, 999};
    const Error lost = opencl::to_error(cl::Error(CL_OUT_OF_RESOURCES, "clFinish"), task);
    EXPECT_EQ(lost.kind(), ErrorKind::driver);
    EXPECT_TRUE(contains(lost.what(), "launching on 'a device': clFinish gave CL_OUT_OF_RESOURCES"));
    const Error full = opencl::to_error(cl::Error(CL_MEM_OBJECT_ALLOCATION_FAILURE, "clCreateBuffer"), task);
    EXPECT_EQ(full.kind(), ErrorKind::unsupported);
    EXPECT_TRUE(contains(full.what(), "1234") && contains(full.what(), "999"));
    EXPECT_EQ(opencl::error_name(-1001), "CL_PLATFORM_NOT_FOUND_KHR");
    EXPECT_EQ(opencl::error_name(-9999), "OpenCL error -9999");
}
