// What only CUDA has, without a GPU: that its two substitutes, the host emulation and a library that poses as NVIDIA's
// driver (tests/stub_cuda), say so; a driver's failures; NVRTC; the code that real GPUs get, which is looked at, not
// run. device_test.cpp and the other tests of each_device.h have what is claimed of every API.
#include "backends/cuda/driver_backend.h"
#include "backends/cuda_host/backend.h"
#include "backends/cuda_host/driver.h"
#include "core/device/scene_buffers.h"
#include "core/device/self_test.h"
#include "tests/support/device_rays.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <cstring>
#include <regex>
#include <set>

using namespace tetrace;
using namespace tetrace::test;

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

/// text: a kernel's source, which messages call `name`.
std::string assembly_of_text(const std::string& text, const std::string& name, std::span<const std::string> options)
{
    const auto made = cuda::Nvrtc::installed().compile(text.c_str(), name, "compute_90", options);
    return {made.begin(), made.end()};
}

std::string assembly_by_nvrtc(const std::string& source, std::span<const std::string> options)
{
    return assembly_of_text(std::string(find_kernel(cuda::embedded_sources(), source)->text()), source, options);
}

/// A kernel's source, with multiply_add() as two operations.
std::string without_fused(const EmbeddedKernel& source)
{
    std::string text(source.text());
    const std::string fused = "__fmaf_rn(a, b, c)";
    const std::size_t at = text.find(fused);
    return at == std::string::npos ? text : text.replace(at, fused.size(), "a * b + c");
}

/// On each of the two.
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
    EXPECT_EQ(device.kind, DeviceKind::emulated);
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

TEST_P(CudaWithoutGpu, contracts_in_fast_mode)
{
    if (const auto reason = cuda_host_backend().why_not(0, {.math = MathMode::fast}); !reason.empty())
        GTEST_SKIP() << reason;
    EXPECT_TRUE(judge_self_test(backend->probe(0, MathMode::fast, self_test_operations())).contracts);
}

INSTANTIATE_TEST_SUITE_P(each, CudaWithoutGpu, ::testing::Values("host", "stub"),
                         [](const auto& driver) { return std::string(driver.param); });

TEST(CudaDriver, says_what_it_made_of_a_kernel_and_how_many_of_its_warps_fit)
{
    auto loaded = cuda::load_driver(TETRACE_STUB_CUDA);
    ASSERT_TRUE(loaded.usable()) << loaded.reason;
    loaded.driver.function_attribute = [](int* value, int attribute, cuda::FunctionHandle) -> cuda::Result {
        *value = 10 * attribute;
        return attribute < 7 ? cuda::success : cuda::error_invalid_value;
    };
    loaded.driver.blocks_per_multiprocessor = [](int* blocks, cuda::FunctionHandle, int threads, std::size_t shared) {
        *blocks = shared == 0 ? 1024 / threads : 3; // shared memory: the stacks of BVHs
        return cuda::success;
    };
    loaded.driver.device_attribute = [](int* value, int attribute, cuda::Ordinal device) -> cuda::Result {
        *value = attribute == 39 ? 2048 : 32; // threads of a multiprocessor and of a warp; the host's warps have one
        return attribute == 39 || attribute == cuda::attribute_warp_size
                   ? cuda::success
                   : cuda_host::emulated_driver().device_attribute(value, attribute, device);
    };
    const cuda::DriverBackend backend({"cuda", "CUDA events", [&] { return loaded; }, cuda::embedded_programs});
    if (!backend.devices()[0].usable) GTEST_SKIP() << backend.devices()[0].reason;
    const auto compiled = [&](Layout layout, Method method, Schedule schedule) {
        const KernelId kernel{
            .structure = structure_of(layout), .method = method, .layout = layout, .schedule = schedule};
        return backend.compiled(0, kernel, true, {}).statistics;
    };
    const auto walk = compiled(Layout::tet80, Method::maria, Schedule::tiles);
    EXPECT_EQ(walk.at("NUM_REGS"), 40);
    EXPECT_EQ(walk.at("LOCAL_SIZE_BYTES"), 30);
    EXPECT_FALSE(walk.contains("CACHE_MODE_CA")) << "the driver does not know it";
    EXPECT_EQ(walk.at("blocks per multiprocessor"), 16);
    EXPECT_EQ(walk.at("warps per multiprocessor"), 32);
    EXPECT_EQ(walk.at("max warps per multiprocessor"), 64);
    EXPECT_EQ(compiled(Layout::tet80, Method::maria, Schedule::persistent).at("blocks per multiprocessor"), 8);
    EXPECT_EQ(compiled(Layout::bvh2, Method::single, Schedule::tiles).at("warps per multiprocessor"), 6);
}

TEST(CudaDriver, that_reports_nothing_of_its_code_is_unsupported)
{
    const auto& host = cuda_host_backend();
    EXPECT_FALSE(host.devices()[0].reports_code);
    EXPECT_TRUE(contains(error_of([&] { (void)host.compiled(0, KernelId{}, true, {}); }), "does not report its code"));
}

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
    EXPECT_TRUE(contains(backend->devices()[0].reason, "without compiled CUDA kernels"));
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
    EXPECT_TRUE(contains(error_with("alloc", [&] { session->launch(job); }), "bytes for the output"));
    EXPECT_EQ(traced(*session, job), openmp_hits(rays, job));
}

TEST_F(CudaFailures, of_a_launch_name_the_drivers_error)
{
    const auto session = backend->open(0, {}, rays.data(), {});
    const std::string error = error_with("launch", [&] { session->launch(job); });
    EXPECT_TRUE(error.starts_with("driver: ") && contains(error, "CUDA_ERROR_LAUNCH_OUT_OF_RESOURCES")) << error;
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

TEST_F(CudaFailures, a_lost_device_is_reported_and_the_next_session_gets_a_new_context)
{
    {
        const auto session = backend->open(0, {}, rays.data(), {});
        const std::string error = error_with("lost", [&] { (void)traced(*session, job); });
        EXPECT_TRUE(error.starts_with("driver: ") && contains(error, "CUDA_ERROR_LAUNCH_FAILED")) << error;
        EXPECT_TRUE(contains(error, "context is lost"));
        EXPECT_TRUE(error_of([&] { (void)traced(*session, job); }).starts_with("driver: "));
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
    if (!has_nvcc()) GTEST_SKIP() << "this build lacks nvcc's code";
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
    EXPECT_TRUE(error.starts_with("driver: ") && contains(error, "\"g\" is undefined")) << error;
}

TEST_F(CudaNvrtc, every_source_is_exact_in_exact_mode_and_each_structures_contracts_without_its_option)
{
    for (const EmbeddedKernel& source : cuda::embedded_sources()) {
        const std::string name(source.name);
        auto options = cuda::compiler_options({name, MathMode::exact});
        const std::string exact = assembly_of_text(without_fused(source), name, options);
        const bool divides = name != "defects";
        EXPECT_EQ(contains(exact, "div.rn.f32"), divides);
        EXPECT_EQ(inexact_operations(exact), std::vector<std::string>{}) << name;
        if (name != "defects" && name != "project_half32" && name != "single_bvh2") continue; // one takes seconds
        std::erase(options, "--fmad=false");
        EXPECT_NE(inexact_operations(assembly_by_nvrtc(name, options)), std::vector<std::string>{}) << name;
        options = cuda::compiler_options({name, MathMode::fast});
        EXPECT_EQ(contains(assembly_by_nvrtc(name, options), "div.approx"), divides) << name;
    }
}

TEST(CudaCode, has_machine_code_for_each_architecture)
{
    if (!has_nvcc()) GTEST_SKIP() << "this build lacks nvcc's code";
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
    if (!has_nvcc()) GTEST_SKIP() << "this build lacks nvcc's code";
    for (const EmbeddedKernel& code : cuda::embedded_programs().code) {
        const std::string assembly = assembly_of(code);
        EXPECT_TRUE(contains(assembly, ".target sm_")) << code.name << " lacks assembly for later devices";
        const bool exact = code.name.ends_with("_exact");
        auto inexact = inexact_operations(assembly);
        if (code.name.starts_with("single_")) std::erase(inexact, "fma.rn.f32"); // of a BVH's boxes
        EXPECT_EQ(inexact.empty(), exact) << code.name;
        const bool divides = exact && !code.name.starts_with("defects_");
        EXPECT_EQ(assembly.find("div.rn.f32") != std::string::npos, divides) << code.name;
    }
}
