#include "core/base/cache_home.h"
#include "tests/support/temporary_folder.h"

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <optional>
#include <thread>

using namespace tetrace;
using namespace tetrace::test;

namespace fs = std::filesystem;

namespace {

/// A home below a file: nobody can write there, root neither.
class CacheHomes : public testing::Test {
protected:
    CacheHomes()
    {
        write_file(folder_ / "file", "");
        fs::create_directories(folder_ / "temporary");
    }
    [[nodiscard]] std::size_t temporary_folders() const
    {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_ / "temporary"), fs::directory_iterator()));
    }
    [[nodiscard]] static std::string variable(const char* name)
    {
        const char* const value = std::getenv(name);
        return value != nullptr ? value : "";
    }

    TemporaryFolder folder_;
    const std::string closed_ = (folder_ / "file/home").string();
    ScopedVariable temporary{"TMPDIR", folder_ / "temporary"};
    ScopedVariable home{"HOME", closed_}, xdg{"XDG_CACHE_HOME", nullptr};
    ScopedVariable pocl{"POCL_CACHE_DIR", nullptr}, mesa{"MESA_SHADER_CACHE_DIR", nullptr};
};

/// Answers a system call of this process, and of those that it starts, so from now on. False where filters are refused.
bool answer(unsigned call, unsigned with)
{
    sock_filter filter[] = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                            BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1), BPF_STMT(BPF_RET | BPF_K, with),
                            BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
    const sock_fprog program{std::size(filter), filter};
    return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

} // namespace

TEST_F(CacheHomes, closed_one_is_replaced_by_a_temporary_folder_that_is_removed)
{
    {
        const CacheHome cache;
        EXPECT_TRUE(variable("XDG_CACHE_HOME").starts_with((folder_ / "temporary/tetrace-cache-").string()));
        EXPECT_EQ(cache_home(), variable("XDG_CACHE_HOME"));
        EXPECT_EQ(closed_cache_home(), closed_ + "/.cache");
        EXPECT_EQ(cache.note(), closed_ +
                                    "/.cache cannot be written to (Not a directory): built scenes and compiled "
                                    "kernels are in " +
                                    variable("XDG_CACHE_HOME") +
                                    " until this run ends; set XDG_CACHE_HOME to a folder that can be written to");
        write_file(cache_home() / "scene", "x");
        EXPECT_EQ(temporary_folders(), 1u);
        EXPECT_EQ(CacheHome().note(), "") << "a process that is started from this one has what it needs";
    }
    EXPECT_EQ(temporary_folders(), 0u);
}

TEST_F(CacheHomes, temporary_folder_is_removed_after_a_signal_ends_the_program)
{
    for (const int signal : {SIGKILL, SIGHUP, SIGINT}) {
        const pid_t program = ::fork();
        if (program == 0) {
            const CacheHome cache;
            write_file(cache_home() / "scene", "x");
            if (temporary_folders() == 1) ::raise(signal);
            ::_exit(0);
        }
        int status = 0;
        ASSERT_EQ(::waitpid(program, &status, 0), program);
        EXPECT_TRUE(WIFSIGNALED(status)) << "it had a folder";
        for (int i = 0; i < 3000 && temporary_folders() > 0; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        EXPECT_EQ(temporary_folders(), 0u);
    }
}

// The process that removes it begins with setsid(), and closes the files that it has from this one.
TEST_F(CacheHomes, temporary_folder_is_removed_without_its_remover_and_without_close_range)
{
    for (const auto& [call, with] : {std::pair(SYS_close_range, SECCOMP_RET_ERRNO | unsigned{ENOSYS}),
                                     std::pair(SYS_setsid, unsigned{SECCOMP_RET_KILL_PROCESS})}) {
        int ends[2] = {};
        ASSERT_EQ(::pipe(ends), 0);
        const pid_t program = ::fork();
        if (program == 0) {
            ::alarm(30); // in place of waiting for ever
            if (!answer(static_cast<unsigned>(call), with)) ::_exit(77);
            bool is_released = false;
            {
                const CacheHome cache;
                ::close(ends[1]);
                char word = 0;
                is_released = temporary_folders() == 1 && ::read(ends[0], &word, 1) == 0;
            }
            ::_exit(is_released && temporary_folders() == 0 ? 0 : 1);
        }
        ::close(ends[1]); // first, for the program waits until nobody has it
        ::close(ends[0]);
        int status = 0;
        ASSERT_EQ(::waitpid(program, &status, 0), program);
        if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "system calls cannot be filtered here";
        EXPECT_EQ(status, 0) << call;
    }
}

TEST_F(CacheHomes, folder_that_is_kept_is_named)
{
    std::optional<CacheHome> cache(std::in_place);
    cache->keep();
    EXPECT_TRUE(contains(cache->note(), ", which is kept; set XDG_CACHE_HOME to it to find them again"));
    cache.reset();
    EXPECT_EQ(temporary_folders(), 1u);
}

TEST_F(CacheHomes, open_one_is_left_as_it_is)
{
    const ScopedVariable open("HOME", folder_ / "home");
    const CacheHome cache;
    EXPECT_EQ(cache.note(), "");
    EXPECT_EQ(variable("XDG_CACHE_HOME"), "");
    EXPECT_EQ(temporary_folders(), 0u);
    EXPECT_FALSE(fs::exists(folder_ / "home")) << "nothing is made before it is needed";
}

TEST_F(CacheHomes, drivers_own_variables_are_replaced_only_if_their_folders_are_closed)
{
    const ScopedVariable open("HOME", folder_ / "home");
    const ScopedVariable opencl("POCL_CACHE_DIR", closed_), vulkan("MESA_SHADER_CACHE_DIR", folder_ / "mesa");
    const CacheHome cache;
    EXPECT_TRUE(contains(variable("POCL_CACHE_DIR"), "/temporary/tetrace-cache-"));
    EXPECT_EQ(variable("MESA_SHADER_CACHE_DIR"), (folder_ / "mesa").string());
    EXPECT_EQ(variable("XDG_CACHE_HOME"), "");
    EXPECT_TRUE(contains(cache.note(), closed_ + " cannot be written to"));
}
