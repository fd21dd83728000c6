// The program on a library that poses as NVIDIA's driver (tests/stub_cuda): the cuda backend from the loader to the
// exit code.
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <sys/wait.h>

using namespace tetrace;
using namespace tetrace::test;

namespace {

struct CudaRun {
    int code = -1;
    std::string out, errors;
};

/// Runs the program with the stub in front of any driver of this machine. failure: of the stub, empty for none.
CudaRun run(const std::string& arguments, const std::string& failure = "")
{
    const TemporaryFolder folder;
    const ScopedVariable libraries("LD_LIBRARY_PATH", TETRACE_STUB_FOLDER);
    const ScopedVariable cache("XDG_CACHE_HOME", folder / "cache");
    const ScopedVariable fail("TETRACE_STUB_FAIL", failure);
    const std::string command =
        "cd '" + folder.path().string() + "' && '" TETRACE_PROGRAM "' " + arguments + " > stdout 2> stderr";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder / "stdout"), read_text(folder / "stderr")};
}

/// The table's line of the backend: "cdt maria tet80  <backend> ...".
std::string row_of(const std::string& table, const std::string& backend)
{
    const std::size_t start = table.find("cdt maria tet80  " + backend);
    return start == std::string::npos ? "" : table.substr(start, table.find('\n', start) - start);
}

/// Whatever else this machine had to do.
bool is_right(const std::string& row)
{
    return contains(row, "ok") || contains(row, "noisy");
}

const char* const small_bench =
    "bench --backend openmp,cuda --method maria --layout tet80 --scene cubes --resolution 6 "
    "--size 24 --samples 3 --sample-time 0 --threads 2";

/// Skipped where no kernel can be had: neither nvcc when this was built, nor NVRTC now.
class CudaProgram : public ::testing::Test {
protected:
    void SetUp() override
    {
        if (contains(run("devices").out, "was built without compiled CUDA kernels"))
            GTEST_SKIP() << "no nvcc and no NVRTC";
    }
};

} // namespace

TEST_F(CudaProgram, lists_the_stub_as_an_emulation)
{
    const CudaRun ended = run("devices --require cuda");
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "cuda       host emulation of CUDA, emulated"));
}

TEST_F(CudaProgram, measures_the_stub_and_openmp)
{
    const CudaRun ended = run(small_bench);
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(is_right(row_of(ended.out, "openmp")));
    EXPECT_TRUE(is_right(row_of(ended.out, "cuda")));
}

TEST_F(CudaProgram, each_failure_is_its_rows_status_and_openmps_row_goes_on)
{
    const struct {
        const char *failure, *status, *reason;
    } expected[] = {{"alloc", "unsupported", "bytes of memory free"},
                    {"launch", "error", "CUDA_ERROR_LAUNCH_OUT_OF_RESOURCES"},
                    {"lost", "error", "CUDA_ERROR_LAUNCH_FAILED"},
                    {"module", "unsupported", "CUDA_ERROR_UNSUPPORTED_PTX_VERSION"}};
    for (const auto& [failure, status, reason] : expected) {
        const CudaRun ended = run(small_bench, failure);
        EXPECT_TRUE(contains(ended.out, std::string("/api:cuda: ") + status + ": ")) << failure;
        EXPECT_TRUE(contains(ended.out + ended.errors, reason)) << failure;
        EXPECT_TRUE(is_right(row_of(ended.out, "openmp"))) << failure;
    }
}

TEST_F(CudaProgram, crash_at_a_launch_is_its_rows_error_and_openmps_row_goes_on)
{
    const CudaRun ended = run(small_bench, "crash-launch");
    EXPECT_EQ(ended.code, 1) << ended.errors;
    EXPECT_TRUE(contains(row_of(ended.out, "cuda"), "error"));
    EXPECT_TRUE(contains(ended.out + ended.errors, "the driver of cuda (")) << ended.out;
    EXPECT_TRUE(contains(ended.out + ended.errors, "SIGABRT")) << ended.out;
    EXPECT_TRUE(is_right(row_of(ended.out, "openmp")));
}

TEST(CudaDriver, that_crashes_at_its_start_is_named_and_openmps_row_goes_on)
{
    const CudaRun ended = run(small_bench, "crash");
    EXPECT_EQ(ended.code, 1) << ended.errors;
    EXPECT_TRUE(contains(ended.out + ended.errors,
                         "the driver of cuda was ended by signal 6 (SIGABRT, Aborted) while listing its devices"));
    EXPECT_TRUE(is_right(row_of(ended.out, "openmp")));
    EXPECT_TRUE(contains(run("devices", "crash").out, "openmp"));
}
