// The program as containers run it: as a user without a home, on a read-only file system, with few processors and
// little memory.
#include "tests/support/program_fixture.h"

#include <nlohmann/json.hpp>
#include <unistd.h>

using namespace tetrace::test;

namespace fs = std::filesystem;

namespace {

constexpr const char* one_row = " --scene cubes --resolution 4 --layout tet80 --size 16 --views 0";

/// Runs the program in a control group of its own, below the group of this process: with a CPU quota or a memory limit.
/// Exit code 77: the machine does not let it be made.
constexpr const char* group_script = R"(controller=$1 limit=$2; shift 2
folder_of() { sed -n "s/^[0-9]*:$1:\(.*\)$/\1/p" /proc/self/cgroup | head -n 1; }
split=$(sed -n 's/^[0-9]*:\([^:]*\):.*$/\1/p' /proc/self/cgroup | grep -w "$controller")
if [ -n "$split" ]; then group=/sys/fs/cgroup/$controller$(folder_of "$split")
else group=/sys/fs/cgroup$(folder_of ''); fi
group=${group%/}/tetrace-test-$$
mkdir "$group" 2> /dev/null || exit 77
if [ -f "$group/cpu.cfs_quota_us" ]; then echo "$limit" > "$group/cpu.cfs_quota_us"
elif [ -f "$group/memory.limit_in_bytes" ]; then echo "$limit" > "$group/memory.limit_in_bytes"
elif [ $controller = cpu ] && [ -f "$group/cpu.max" ]; then echo "$limit 100000" > "$group/cpu.max"
elif [ $controller = memory ] && [ -f "$group/memory.max" ]; then echo "$limit" > "$group/memory.max"
else rmdir "$group"; exit 77; fi && sh -c 'echo $$ > "$0/cgroup.procs" || exit 77; exec "$@"' "$group" "$@"
code=$?
until rmdir "$group" 2> /dev/null; do tries=x$tries; [ $tries = xxxxxxxxxxxxxxxxxxxx ] && break; sleep 0.1; done
exit $code
)";

/// With single blanks between words.
std::string unwrapped(const std::string& text)
{
    std::istringstream words(text);
    std::string line;
    for (std::string word; words >> word;)
        line += word + ' ';
    return line;
}

class Containers : public ProgramTest {
protected:
    void SetUp() override
    {
        fs::permissions(folder_.path(), fs::perms(0755));
        fs::create_directories(temporary_);
        fs::permissions(temporary_, fs::perms(0777));
    }
    void TearDown() override { std::system(fmt::format("rm -rf '{}'", temporary_.string()).c_str()); }

    /// A shell command with the program's arguments, without the variables that name caches.
    [[nodiscard]] Ended run_by(const std::string& command, const std::string& arguments) const
    {
        const int status = std::system(
            fmt::format("cd '{0}' && env -u XDG_CACHE_HOME -u POCL_CACHE_DIR -u MESA_SHADER_CACHE_DIR {1} '{2}' {3} "
                        "> stdout 2> stderr",
                        folder_.path().string(), command, TETRACE_PROGRAM, arguments)
                .c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder_ / "stdout"),
                read_text(folder_ / "stderr")};
    }
    [[nodiscard]] Ended run_as_nobody(const std::string& variables, const std::string& arguments) const
    {
        return run_by(fmt::format("TMPDIR='{}' {} {}", temporary_.string(), variables, nobody()), arguments);
    }
    [[nodiscard]] Ended run_in_group(const std::string& controller, std::uint64_t limit,
                                     const std::string& arguments) const
    {
        write_file(folder_ / "in-group", group_script);
        return run_by(
            fmt::format("XDG_CACHE_HOME='{}' sh ./in-group {} {}", (folder_ / "cache").string(), controller, limit),
            arguments);
    }
    [[nodiscard]] static std::string nobody()
    {
        return ::getuid() == 0 ? "setpriv --reuid=65534 --regid=65534 --clear-groups" : "";
    }
    [[nodiscard]] bool may_run_as_nobody() const { return run_as_nobody("", "--version").code == 0; }
    /// Whether this machine has a driver of OpenCL on the processor.
    [[nodiscard]] bool has_opencl()
    {
        return contains(run("check --backend opencl" + std::string(one_row)).out, "bit-exact");
    }
    [[nodiscard]] std::vector<fs::path> left() const
    {
        std::vector<fs::path> paths;
        for (const auto& entry : fs::directory_iterator(temporary_))
            paths.push_back(entry.path());
        return paths;
    }

    fs::path temporary_ = folder_ / "temporary";
};

} // namespace

TEST_F(Containers, user_without_a_home_has_every_device_and_leaves_nothing)
{
    if (!may_run_as_nobody()) GTEST_SKIP() << "no user but root may run the program here";
    const bool opencl = has_opencl();
    const Ended ended = run_as_nobody("HOME=/nonexistent", "check" + std::string(one_row));
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "/nonexistent/.cache cannot be written to (")) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, temporary_.string() + "/tetrace-cache-")) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, " until this run ends")) << ended.errors;
    EXPECT_EQ(bool(contains(ended.out, "  opencl ")), opencl) << ended.out;
    EXPECT_EQ(left(), std::vector<fs::path>{});
    EXPECT_EQ(run_as_nobody("HOME=", "check --backend openmp" + std::string(one_row)).code, 0);
}

TEST_F(Containers, scene_built_without_a_home_is_kept_in_a_folder_that_is_named)
{
    if (!may_run_as_nobody()) GTEST_SKIP() << "no user but root may run the program here";
    const std::string build = "build --scene terrain@500 --size 16 --views 0";
    const Ended ended = run_as_nobody("HOME=/nonexistent", build);
    if (ended.code == 3) GTEST_SKIP() << "the builder was not built";
    ASSERT_EQ(ended.code, 0) << ended.errors;
    ASSERT_EQ(left().size(), 1u);
    const std::string kept = left().front().string();
    EXPECT_TRUE(contains(ended.errors, kept + ", which is kept; set XDG_CACHE_HOME to it")) << ended.errors;
    const Ended again = run_as_nobody("XDG_CACHE_HOME=" + kept, build + " --format csv");
    EXPECT_EQ(again.code, 0) << again.errors;
    EXPECT_TRUE(contains(again.out, ",yes,")) << again.out;
    EXPECT_EQ(again.errors.find("cannot be written"), std::string::npos);
}

TEST_F(Containers, scenes_of_a_cache_that_may_only_be_read_are_read)
{
    if (!may_run_as_nobody()) GTEST_SKIP() << "no user but root may run the program here";
    const std::string build = "build --scene terrain@500 --size 16 --views 0 --format csv";
    const Ended built = run(build);
    if (built.code == 3) GTEST_SKIP() << "the builder was not built";
    ASSERT_EQ(built.code, 0) << built.errors;
    const std::string closed = folder_ / "cache";
    for (const fs::path& folder : {fs::path(closed), fs::path(closed) / "tetrace"})
        fs::permissions(folder, fs::perms(0555));
    const Ended ended = run_as_nobody("XDG_CACHE_HOME=" + closed, build);
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, closed + " cannot be written to (Permission denied)")) << ended.errors;
    EXPECT_TRUE(contains(ended.out, ",yes,")) << "the scene was built again: " << ended.out;
}

TEST_F(Containers, read_only_file_system_has_every_device)
{
    write_file(folder_ / "script", "mount --make-rprivate / && mount -t tmpfs -o exec none /dev/shm && mount -t tmpfs "
                                   "-o noexec none /var/tmp && mount -o remount,ro,bind / || exit 77\n"
                                   "touch here 2> /dev/null && exit 77\nexec \"$@\"\n");
    write_file(folder_ / "stdout", ""), write_file(folder_ / "stderr", "");
    const Ended ended = run_by("HOME=/nonexistent unshare -m sh ./script " + nobody(), "check" + std::string(one_row));
    if (ended.code == 77 || contains(ended.errors, "unshare"))
        GTEST_SKIP() << "this user may not make a file system read-only: " << ended.errors;
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.errors, " are in /dev/shm/")) << "drivers run code from there: " << ended.errors;
    EXPECT_TRUE(contains(ended.errors, "/nonexistent/.cache cannot be written to (")) << ended.errors;
    EXPECT_EQ(bool(contains(ended.out, "  opencl ")), has_opencl()) << ended.out;
}

TEST_F(Containers, program_starts_without_the_loaders_of_opencl_and_vulkan)
{
    const Ended linked = run(TETRACE_PROGRAM, "/usr/bin/ldd");
    EXPECT_TRUE(contains(linked.out, "libc.so")) << linked.errors;
    for (const char* const loader : {"OpenCL", "vulkan"})
        EXPECT_EQ(linked.out.find(loader), std::string::npos) << linked.out;
    fs::create_directories(folder_ / "broken");
    for (const char* const name : {"libOpenCL.so.1", "libvulkan.so.1", "libvulkan.so"})
        write_file(folder_ / "broken" / name, std::string(200, 'x'));
    const std::string broken = fmt::format("LD_LIBRARY_PATH='{}'", (folder_ / "broken").string());
    const Ended devices = run_by(broken, "devices --format csv");
    EXPECT_EQ(devices.code, 0) << devices.errors;
    for (const char* const part :
         {"the OpenCL loader cannot be opened", "libOpenCL.so.1: invalid ELF header",
          "the Vulkan loader libvulkan.so.1 cannot be opened", "libvulkan.so.1: invalid ELF header"})
        EXPECT_TRUE(contains(devices.out, part)) << devices.out;
    const Ended check = run_by(broken, "check" + std::string(one_row));
    EXPECT_EQ(check.code, 0) << check.errors;
    EXPECT_TRUE(contains(check.out, "Missing   opencl: no device: the OpenCL loader cannot be opened")) << check.out;
    EXPECT_EQ(run_by(broken, "check --backend opencl" + std::string(one_row)).code, 3);
}

TEST_F(Containers, driver_that_is_installed_twice_has_its_devices_once)
{
    const auto copy_twice = [&](const char* from, const char* folder) {
        fs::create_directories(folder_ / folder);
        std::error_code ignored; // then no driver is installed
        for (const auto& entry : fs::directory_iterator(from, ignored))
            for (const char* const name : {"1-", "2-"})
                fs::copy_file(entry.path(), folder_ / folder / (name + entry.path().filename().string()));
    };
    copy_twice("/etc/OpenCL/vendors", "vendors");
    copy_twice("/usr/share/vulkan/icd.d", "icd.d");
    std::string icds;
    for (const auto& entry : fs::directory_iterator(folder_ / "icd.d"))
        icds += (icds.empty() ? "" : ":") + entry.path().string();
    const std::string devices = "devices --format csv";
    const Ended once = run_by("", devices);
    EXPECT_TRUE(contains(once.out, "opencl,") && contains(once.out, "vulkan,")) << once.out << once.errors;
    const std::string folders = fmt::format("OCL_ICD_VENDORS='{}' VK_ICD_FILENAMES='{}' VK_DRIVER_FILES='{}'",
                                            (folder_ / "vendors").string(), icds, icds);
    EXPECT_EQ(run_by(folders, devices).out, once.out);
}

TEST_F(Containers, driver_that_cannot_compile_is_a_failure_of_the_driver)
{
    if (!has_opencl()) GTEST_SKIP() << "OpenCL has no device here";
    write_file(folder_ / "script",
               "mount --make-rprivate / && mount -o remount,ro,bind / && mount -o remount,ro,bind /dev/shm || exit 77\n"
               "touch /tmp/here /var/tmp/here /dev/shm/here 2> /dev/null && exit 77\nexec \"$@\"\n");
    write_file(folder_ / "stdout", ""), write_file(folder_ / "stderr", "");
    const Ended ended = run_by("HOME=/nonexistent unshare -m sh ./script", "check" + std::string(one_row));
    if (ended.code == 77 || contains(ended.errors, "unshare"))
        GTEST_SKIP() << "some folder can be written to: " << ended.errors;
    EXPECT_TRUE(contains(ended.errors, ", nor can a temporary folder: ")) << ended.errors;
    // PoCL lists no device if its cache is missing, and one that cannot compile if it is read-only.
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(ended.out, "Missing   opencl: no device: PoCL lists no device")) << ended.out;
    fs::create_directories(folder_ / "home/.cache/pocl/kcache");
    const Ended failed = run_by(fmt::format("HOME='{}' unshare -m sh ./script", (folder_ / "home").string()),
                                "check" + std::string(one_row));
    EXPECT_EQ(failed.code, 1) << failed.out;
    EXPECT_TRUE(contains(failed.out, "api:opencl: error: compiling ")) << failed.out;
}

TEST_F(Containers, stack_that_is_too_small_for_threads_is_refused)
{
    for (const char* const size : {"16k", "16", "300 K", "20000B"}) {
        const Ended ended =
            run_by(fmt::format("OMP_STACKSIZE='{}'", size), "check --backend openmp" + std::string(one_row));
        EXPECT_EQ(ended.code, 2) << size;
        EXPECT_TRUE(contains(ended.errors, fmt::format("tetrace: OMP_STACKSIZE is {}: threads need", size)));
    }
    EXPECT_EQ(run_by("OMP_STACKSIZE=512k", "check --backend openmp,cuda-host" + std::string(one_row)).code, 0);
    const Ended limited =
        run_by("sh -c 'ulimit -s 128; exec \"$0\" \"$@\"'", "check --backend openmp" + std::string(one_row));
    EXPECT_EQ(limited.code, 2) << limited.errors;
    EXPECT_TRUE(contains(limited.errors, "`ulimit -s` is 128 KB")) << limited.errors;
}

TEST_F(Containers, cpu_quota_is_the_number_of_threads_and_what_it_stops_is_not_trusted)
{
    const Ended devices = run_in_group("cpu", 50'000, "devices");
    if (devices.code == 77) GTEST_SKIP() << "this machine lets no control group be made";
    EXPECT_EQ(devices.code, 0) << devices.errors;
    EXPECT_TRUE(contains(devices.out, "limited to 0.5 CPUs")) << devices.out;
    EXPECT_TRUE(contains(devices.out, "1 thread for this process")) << devices.out;
    const std::string bench =
        "bench --backend openmp --scene cubes --resolution 4 --layout tet80 --views 0 --samples 5 "
        "--size 512 --sample-time 0.1s --out r.json";
    const Ended ended = run_in_group("cpu", 50'000, bench);
    EXPECT_EQ(ended.code, 0) << ended.errors;
    EXPECT_TRUE(contains(unwrapped(ended.out), "the container's CPU quota stopped this run ")) << ended.out;
    EXPECT_TRUE(contains(unwrapped(ended.out), "do not trust these rates")) << ended.out;
    const auto section = nlohmann::json::parse(file("r.json")).at("tetrace");
    EXPECT_EQ(section.at("threads"), 1);
    EXPECT_GT(section.at("load").at("throttled_periods"), 0);
    EXPECT_TRUE(contains(section.at("rows")[0].dump(), "the container's CPU quota stopped it "))
        << section.at("rows")[0];
    const Ended shown = run("show r.json");
    EXPECT_TRUE(contains(unwrapped(shown.out), "the container's CPU quota stopped this run "))
        << shown.out << shown.errors;
    const Ended asked = run_in_group("cpu", 50'000, bench + " --threads 2");
    EXPECT_EQ(nlohmann::json::parse(file("r.json")).at("tetrace").at("threads"), 2) << asked.errors;
}

TEST_F(Containers, memory_limit_is_an_error_of_the_row_before_the_kernel_kills_the_process)
{
    constexpr std::uint64_t limit = 300'000'000;
    const std::string check = "check --backend openmp --scene cubes --resolution 4 --layout tet80 --views 0 --size ";
    const Ended small = run_in_group("memory", limit, check + "64");
    if (small.code == 77) GTEST_SKIP() << "this machine lets no control group be made";
    EXPECT_EQ(small.code, 0) << small.errors;
    const Ended large = run_in_group("memory", limit, check + "4096");
    EXPECT_EQ(large.code, 3) << large.out << large.errors;
    EXPECT_TRUE(contains(large.out + large.errors, "out of memory (this container may use "))
        << large.out << large.errors;
    const Ended devices = run_in_group("memory", limit, "devices --format csv");
    EXPECT_TRUE(contains(devices.out, ",299999232,") || contains(devices.out, ",300000000,")) << devices.out;
}

TEST_F(Containers, scene_builder_ends_with_a_message_in_a_container_with_little_memory)
{
    const Ended ended = run_in_group("memory", 120'000'000, "build --scene terrain@200000 --size 16 --views 0");
    if (ended.code == 77) GTEST_SKIP() << "this machine lets no control group be made";
    if (contains(ended.errors, "was not built")) GTEST_SKIP() << "the builder was not built";
    EXPECT_NE(ended.code, 0);
    EXPECT_TRUE(contains(ended.errors, "--memory-limit")) << ended.errors;
    EXPECT_EQ(ended.errors.find("signal 9"), std::string::npos) << ended.errors;
}
