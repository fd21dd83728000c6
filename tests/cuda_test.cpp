// The CUDA backend without a GPU: on its host emulation, and on a library that poses as NVIDIA's driver
// (tests/stub_cuda). What it compiles for real GPUs is looked at, not run.
#include "backends/cuda/driver_backend.h"
#include "backends/cuda_host/backend.h"
#include "core/scene_buffers.h"
#include "core/self_test.h"
#include "tests/device_rays.h"
#include "tests/temporary_folder.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <regex>
#include <set>

namespace tetrace {
namespace {

/// The cuda backend on the library that poses as NVIDIA's driver.
std::unique_ptr<Backend> stub_backend(const std::function<cuda::Programs()>& programs)
{
    return std::make_unique<cuda::DriverBackend>(
        cuda::Platform{"cuda", "CUDA events", [] { return cuda::load_driver(TETRACE_STUB_CUDA); }, programs});
}

/// What a machine without nvcc has.
cuda::Programs programs_by_nvrtc()
{
    cuda::Programs programs = cuda::embedded_programs();
    programs.code = {};
    programs.compiler.clear();
    return programs;
}

/// What a machine has whose driver could use our code, and nothing else.
cuda::Programs programs_without_nvrtc()
{
    cuda::Programs programs = cuda::embedded_programs();
    programs.nvrtc = nullptr;
    return programs;
}

bool has_nvcc()
{
    return !cuda::embedded_programs().code.empty();
}

/// Operations that exact mode excludes: contracted, approximate, or flushing denormals.
std::vector<std::string> inexact_operations(const std::string& assembly)
{
    const std::regex inexact(
        R"((fma|mad)\.[a-z0-9.]*f32|[a-z0-9]+\.(approx|full)[a-z0-9.]*|[a-z0-9]+\.[a-z.]*ftz[a-z0-9.]*)");
    return {std::sregex_token_iterator(assembly.begin(), assembly.end(), inexact), {}};
}

/// The assembly among a kernel's code, which is there as text.
std::string assembly_of(const EmbeddedKernel& code)
{
    const std::string_view text = code.text();
    const std::size_t start = text.find(".version ");
    return start == std::string_view::npos ? "" : std::string(text.substr(start, text.find('\0', start) - start));
}

std::string assembly_by_nvrtc(const std::string& source, std::span<const std::string> options)
{
    const auto* text = find_kernel(cuda::embedded_sources(), source);
    const auto made = cuda::Nvrtc::installed().compile(text->text().data(), source, "compute_90", options);
    return {made.begin(), made.end()};
}

/// All work on each of the two drivers.
class CudaWithoutGpu : public ::testing::TestWithParam<const char*> {
protected:
    void SetUp() override
    {
        if (GetParam() == std::string("host")) {
            backend = &cuda_host_backend();
            return;
        }
        made = stub_backend(cuda::embedded_programs);
        backend = made.get();
        if (!backend->devices()[0].usable) GTEST_SKIP() << backend->devices()[0].reason;
    }
    void expect_openmps_hits(const KernelId& kernel, const DeviceRays& rays, const std::vector<TraceJob>& jobs,
                             const SessionOptions& options) const
    {
        const auto session = backend->open(0, kernel, rays.data(), options);
        for (const TraceJob& job : jobs)
            EXPECT_EQ(different_rays(traced(*session, job), openmp_hits(rays, job), 0), 0u)
                << name_of(kernel) << ' ' << name_of(kernel.schedule) << ' ' << job.width << 'x' << job.height
                << " tile height " << options.tile_height
                << (job.start_tet == NO_TET ? " from outside" : " from inside");
    }

    std::unique_ptr<Backend> made;
    Backend* backend = nullptr;
};

/// What a driver's failure becomes.
class CudaFailures : public ::testing::Test {
protected:
    [[nodiscard]] std::string error_with(const char* failure, const std::function<void()>& work) const
    {
        const ScopedVariable fail("TETRACE_STUB_FAIL", failure);
        return error_of(work);
    }
    void SetUp() override
    {
        if (!backend->devices()[0].usable) GTEST_SKIP() << backend->devices()[0].reason;
    }

    std::unique_ptr<Backend> backend = stub_backend(cuda::embedded_programs);
    DeviceRays rays{make_cubes(3), Layout::tet80};
    TraceJob job = rays.from_outside(20, 20);
};

class CudaNvrtc : public ::testing::Test {
protected:
    void SetUp() override
    {
        if (!nvrtc.reason().empty()) GTEST_SKIP() << nvrtc.reason();
    }
    const cuda::Nvrtc& nvrtc = cuda::Nvrtc::installed();
};

} // namespace

TEST_P(CudaWithoutGpu, says_that_it_is_an_emulation)
{
    const Device& device = backend->devices().at(0);
    EXPECT_EQ(device.type, "emulated");
    EXPECT_EQ(device.implementation, "cuda-host");
    EXPECT_TRUE(contains(device.name, "host emulation of CUDA"));
    EXPECT_TRUE(contains(device.driver, "emulated"));
    EXPECT_EQ(device.uuid + device.pci, "") << "it is no GPU that other APIs show too";
    EXPECT_GT(device.memory_bytes, 0u);
}

TEST_P(CudaWithoutGpu, is_exact_in_exact_mode)
{
    const SelfTest test = judge_self_test(backend->probe(0, MathMode::exact, self_test_operations()));
    EXPECT_EQ(test, SelfTest{}) << test.text();
}

TEST_P(CudaWithoutGpu, hits_are_openmps_for_each_layout_schedule_and_tile)
{
    for (const Layout layout : {Layout::tet80, Layout::tet96}) {
        const DeviceRays rays(make_cubes(8), layout);
        const std::vector<TraceJob> jobs{rays.from_outside(64, 64), rays.from_outside(61, 35),
                                         rays.from_outside(1, 1),   rays.from_inside(40, 24),
                                         rays.from_inside(33, 50),  rays.from_outside(5, 90, 3)};
        for (const Schedule schedule : {Schedule::tiles, Schedule::persistent})
            for (const unsigned tile_height : {0u, 4u, 8u})
                expect_openmps_hits({.layout = layout, .schedule = schedule}, rays, jobs,
                                    {.threads = 2, .tile_height = tile_height});
    }
}

TEST_P(CudaWithoutGpu, hits_are_openmps_for_an_image_of_many_launches)
{
    const DeviceRays rays(make_cubes(8), Layout::tet96);
    for (const Schedule schedule : {Schedule::tiles, Schedule::persistent})
        expect_openmps_hits({.layout = Layout::tet96, .schedule = schedule}, rays,
                            {rays.from_outside(401, 390), rays.from_outside(401, 390, 0)}, {.threads = 1});
}

TEST_P(CudaWithoutGpu, a_job_launched_twice_gives_the_same_hits)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    const auto session = backend->open(0, {}, rays.data(), {});
    const auto first = traced(*session, rays.from_outside(50, 50));
    (void)traced(*session, rays.from_inside(20, 90));
    EXPECT_EQ(traced(*session, rays.from_outside(50, 50)), first);
    EXPECT_EQ(session->bytes(), rays.packed().bytes());
    EXPECT_GT(session->setup_times().upload_s, 0);
}

TEST_P(CudaWithoutGpu, wait_tells_the_seconds_of_all_launches)
{
    const DeviceRays rays(make_cubes(4), Layout::tet80);
    double largest_share = 0; // a busy machine makes a share smaller, never larger
    for (int i = 0; i < 8; i++) {
        const auto session = backend->open(0, {}, rays.data(), {}); // its first image is launched in steps
        const auto start = std::chrono::steady_clock::now();
        session->launch(rays.from_outside(300, 300));
        const double seconds = session->wait();
        const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        EXPECT_LT(seconds, wall_s);
        largest_share = std::max(largest_share, seconds / wall_s);
    }
    EXPECT_GT(largest_share, 0.25) << "the last of the three launches has a tenth of the tiles";
}

TEST_P(CudaWithoutGpu, fast_mode_finds_the_same_faces_but_for_rays_on_edges)
{
    const KernelId kernel{.math = MathMode::fast};
    if (const auto reason = cuda_host_backend().why_not(0, kernel); !reason.empty()) GTEST_SKIP() << reason;
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const TraceJob job = rays.from_outside(128, 128);
    const auto right = openmp_hits(rays, job);
    const auto session = backend->open(0, kernel, rays.data(), {});
    EXPECT_LE(distant_rays(traced(*session, job), right), right.size() / 1000);
    EXPECT_TRUE(judge_self_test(backend->probe(0, MathMode::fast, self_test_operations())).contracts);
}

TEST_P(CudaWithoutGpu, refuses_what_exceeds_a_limit_with_both_numbers)
{
    const DeviceRays rays(make_cubes(8), Layout::tet80);
    const std::string bytes = std::to_string(scene_buffers(rays.packed())[0].bytes.size());
    const std::string scene = error_of([&] { (void)backend->open(0, {}, rays.data(), {.max_buffer_bytes = 20'000}); });
    EXPECT_TRUE(scene.starts_with("unsupported: ")) << scene;
    EXPECT_TRUE(contains(scene, bytes) && contains(scene, "20000"));
    const auto session = backend->open(0, {}, rays.data(), {.max_buffer_bytes = 300'000});
    const std::string image = error_of([&] { session->launch(rays.from_outside(200, 100)); });
    EXPECT_TRUE(image.starts_with("unsupported: ") && contains(image, "480512")) << image;
    EXPECT_EQ(traced(*session, rays.from_outside(20, 10)).size(), 200u) << "the session lives on";
}

TEST_P(CudaWithoutGpu, yardstick_is_plausible)
{
    const auto yardstick = backend->yardstick(0, {});
    ASSERT_TRUE(yardstick.has_value());
    EXPECT_GT(yardstick->copy_bytes_per_s, 1e6);
    EXPECT_GT(yardstick->launch_s, 0);
}

TEST_P(CudaWithoutGpu, has_the_kernels_of_the_cdt)
{
    EXPECT_TRUE(
        backend->has_kernel({.layout = Layout::tet96, .math = MathMode::fast, .schedule = Schedule::persistent}));
    EXPECT_FALSE(
        backend->has_kernel({.structure = Structure::bvh, .method = Method::single, .layout = Layout::embree}));
    EXPECT_TRUE(contains(backend->why_not(0, {.method = Method::single}), "has no kernel"));
}

INSTANTIATE_TEST_SUITE_P(on, CudaWithoutGpu, ::testing::Values("host", "stub"),
                         [](const auto& driver) { return std::string(driver.param); });

TEST(CudaDriver, that_is_not_there_is_a_device_that_says_so)
{
    const auto loaded = cuda::load_driver("libcuda-of-no-machine.so.1");
    EXPECT_FALSE(loaded.usable());
    EXPECT_TRUE(contains(loaded.reason, "no NVIDIA driver") && contains(loaded.reason, "nvidia-driver"));
    cuda::DriverBackend backend({"cuda", "CUDA events", [&] { return loaded; }, cuda::embedded_programs});
    ASSERT_EQ(backend.devices().size(), 1u);
    EXPECT_FALSE(backend.devices()[0].usable);
    EXPECT_EQ(backend.why_not(0, {}), loaded.reason);
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    EXPECT_EQ(error_of([&] { (void)backend.open(0, {}, rays.data(), {}); }), "missing: " + loaded.reason);
}

TEST(CudaDriver, a_library_without_its_functions_is_refused_by_name)
{
    const auto loaded = cuda::load_driver("libm.so.6");
    EXPECT_TRUE(contains(loaded.reason, "cuModuleLoadDataEx"));
}

TEST(CudaDriver, of_a_build_without_compilers_is_listed_with_the_reason)
{
    const auto backend = stub_backend([] { return cuda::Programs{.sources = cuda::embedded_sources()}; });
    EXPECT_FALSE(backend->devices().at(0).usable);
    EXPECT_TRUE(contains(backend->devices()[0].reason, "without nvcc"));
}

TEST_F(CudaFailures, of_memory_make_a_row_unsupported_with_both_numbers)
{
    const std::string error = error_with("alloc", [&] { (void)backend->open(0, {}, rays.data(), {}); });
    EXPECT_TRUE(error.starts_with("unsupported: ")) << error;
    EXPECT_TRUE(contains(error, std::to_string(scene_buffers(rays.packed())[0].bytes.size()) + " bytes"));
    EXPECT_TRUE(contains(error, "bytes of memory free"));
}

TEST_F(CudaFailures, of_an_images_memory_leave_the_session_alive)
{
    const auto session = backend->open(0, {}, rays.data(), {});
    EXPECT_TRUE(contains(error_with("alloc", [&] { session->launch(job); }), "bytes for the image's hits"));
    EXPECT_EQ(traced(*session, job), openmp_hits(rays, job));
}

TEST_F(CudaFailures, of_a_launch_name_the_drivers_error)
{
    const auto session = backend->open(0, {}, rays.data(), {});
    const std::string error = error_with("launch", [&] { session->launch(job); });
    EXPECT_TRUE(error.starts_with("internal: ") && contains(error, "CUDA_ERROR_LAUNCH_OUT_OF_RESOURCES")) << error;
    EXPECT_EQ(traced(*session, job), openmp_hits(rays, job));
}

TEST_F(CudaFailures, of_a_launch_leave_no_hits_of_the_image_before)
{
    const auto session = backend->open(0, {}, rays.data(), {});
    std::vector<Hit> hits = traced(*session, job);
    (void)error_with("launch", [&] { session->launch(job); });
    session->read_back(hits);
    EXPECT_TRUE(std::all_of(hits.begin(), hits.end(), [](const Hit& hit) { return hit.face_id == POISON; }));
}

TEST_F(CudaFailures, a_lost_device_is_told_and_the_next_session_gets_a_new_context)
{
    {
        const auto session = backend->open(0, {}, rays.data(), {});
        const std::string error = error_with("lost", [&] { (void)traced(*session, job); });
        EXPECT_TRUE(error.starts_with("internal: ") && contains(error, "CUDA_ERROR_LAUNCH_FAILED")) << error;
        EXPECT_TRUE(contains(error, "context is lost"));
        EXPECT_TRUE(error_of([&] { (void)traced(*session, job); }).starts_with("internal: "));
        EXPECT_EQ(openmp_hits(rays, job).size(), 400u) << "other rows go on";
    }
    const auto session = backend->open(0, {}, rays.data(), {});
    EXPECT_EQ(traced(*session, job), openmp_hits(rays, job));
}

TEST_F(CudaFailures, a_lost_context_is_lost_to_every_session_that_shares_it_and_to_none_after_the_last)
{
    auto bystander = backend->open(0, {}, rays.data(), {});
    {
        const auto culprit = backend->open(0, {}, rays.data(), {});
        (void)error_with("lost", [&] { (void)traced(*culprit, job); });
    }
    EXPECT_TRUE(contains(error_of([&] { (void)traced(*bystander, job); }), "context is lost"));
    EXPECT_TRUE(contains(error_of([&] { (void)backend->open(0, {}, rays.data(), {}); }), "context is lost"));
    bystander.reset();
    EXPECT_EQ(traced(*backend->open(0, {}, rays.data(), {}), job), openmp_hits(rays, job));
}

TEST_F(CudaFailures, code_newer_than_the_driver_names_both_versions)
{
    if (!has_nvcc()) GTEST_SKIP() << "this build has no code of nvcc's";
    backend = stub_backend(programs_without_nvrtc);
    const std::string error = error_with("module", [&] { (void)backend->open(0, {}, rays.data(), {}); });
    EXPECT_TRUE(error.starts_with("unsupported: ")) << error;
    EXPECT_TRUE(contains(error, "CUDA_ERROR_UNSUPPORTED_PTX_VERSION"));
    EXPECT_TRUE(contains(error, "made by " + programs_without_nvrtc().compiler) && contains(error, "of CUDA 13.0"));
}

TEST_F(CudaFailures, nvrtc_is_tried_where_the_driver_cannot_use_the_builds_code)
{
    if (const std::string reason = cuda::Nvrtc::installed().reason(); !reason.empty()) GTEST_SKIP() << reason;
    const std::string error = error_with("module", [&] { (void)backend->open(0, {}, rays.data(), {}); });
    EXPECT_TRUE(error.starts_with("unsupported: ") && contains(error, "made by NVRTC")) << error;
}

TEST_F(CudaNvrtc, compiles_what_nvcc_did_not_and_keeps_it)
{
    const auto backend = stub_backend(programs_by_nvrtc);
    const DeviceRays rays(make_cubes(3), Layout::tet80);
    const TraceJob job = rays.from_outside(20, 20);
    const TemporaryFolder folder;
    const SessionOptions options{.program_cache = folder / "programs"};
    const auto first = backend->open(0, {}, rays.data(), options);
    EXPECT_FALSE(first->setup_times().compile_cached);
    EXPECT_GT(first->setup_times().compile_s, 1e-3);
    EXPECT_EQ(traced(*first, job), openmp_hits(rays, job));
    EXPECT_TRUE(backend->open(0, {}, rays.data(), options)->setup_times().compile_cached);
    EXPECT_FALSE(backend->open(0, {.math = MathMode::fast}, rays.data(), options)->setup_times().compile_cached)
        << "another math mode is another program";
    EXPECT_EQ(judge_self_test(backend->probe(0, MathMode::exact, self_test_operations())), SelfTest{});
}

TEST_F(CudaNvrtc, targets_the_device_or_the_newest_that_is_older)
{
    EXPECT_EQ(nvrtc.target(90), "sm_90");
    EXPECT_TRUE(nvrtc.target(999).starts_with("compute_")) << nvrtc.target(999);
    EXPECT_TRUE(error_of([&] { (void)nvrtc.target(20); }).starts_with("unsupported: "));
}

TEST_F(CudaNvrtc, shows_its_log_where_a_source_is_wrong)
{
    const std::string error = error_of([&] { (void)nvrtc.compile("__global__ void f() { g(); }", "f", "sm_90", {}); });
    EXPECT_TRUE(error.starts_with("internal: ") && contains(error, "\"g\" is undefined")) << error;
}

TEST_F(CudaNvrtc, every_source_is_exact_in_exact_mode_and_contracts_without_its_option)
{
    for (const EmbeddedKernel& source : cuda::embedded_sources()) {
        const std::string name(source.name);
        auto options = cuda::compiler_options({name, MathMode::exact});
        const std::string exact = assembly_by_nvrtc(name, options);
        EXPECT_TRUE(contains(exact, "div.rn.f32"));
        EXPECT_EQ(inexact_operations(exact), std::vector<std::string>{}) << name;
        std::erase(options, "--fmad=false");
        EXPECT_NE(inexact_operations(assembly_by_nvrtc(name, options)), std::vector<std::string>{}) << name;
        options = cuda::compiler_options({name, MathMode::fast});
        EXPECT_TRUE(contains(assembly_by_nvrtc(name, options), "div.approx")) << name;
    }
}

TEST(CudaCode, has_machine_code_for_each_architecture)
{
    if (!has_nvcc()) GTEST_SKIP() << "this build has no code of nvcc's";
    for (const EmbeddedKernel& code : cuda::embedded_programs().code) {
        const std::string_view text = code.text();
        std::set<int> architectures;
        // Machine code is an ELF file whose flags name the architecture, in the second byte since CUDA 13, else the
        // first.
        for (std::size_t at = text.find("\177ELF"); at != std::string_view::npos; at = text.find("\177ELF", at + 1)) {
            std::uint32_t flags = 0;
            std::memcpy(&flags, text.data() + at + 48, sizeof(flags));
            const int version = text[at + 8];
            architectures.insert(static_cast<int>(version >= 8 ? flags >> 8 & 255 : flags & 255));
        }
        EXPECT_EQ(architectures, (std::set<int> TETRACE_CUDA_ARCHITECTURES)) << code.name;
    }
}

TEST(CudaCode, is_exact_in_exact_mode_and_contracts_in_fast_mode)
{
    if (!has_nvcc()) GTEST_SKIP() << "this build has no code of nvcc's";
    for (const EmbeddedKernel& code : cuda::embedded_programs().code) {
        const std::string assembly = assembly_of(code);
        EXPECT_TRUE(contains(assembly, ".target sm_")) << code.name << " has no assembly for later devices";
        const bool exact = code.name.ends_with("_exact");
        EXPECT_EQ(inexact_operations(assembly).empty(), exact) << code.name;
        EXPECT_EQ(assembly.find("div.rn.f32") != std::string::npos, exact) << code.name;
    }
}

} // namespace tetrace
