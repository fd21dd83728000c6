#include "core/isolation/driver_child.h"

#include "core/base/stopwatch.h"
#include "core/isolation/driver_server.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace tetrace {

namespace {

constexpr int tick_ms = 100;
constexpr double max_tick_s = 1;        ///< we were stopped too, if it took longer
constexpr double farewell_s = 5;        ///< for a process to end after its socket is closed
constexpr double compiler_patience = 3; ///< processor time of a call that compiles, in limits; rusticl needs 8 minutes
constexpr double busy_share = 0.01;     ///< of a processor: less than that is waiting

/// The instructions for posix_spawn(). Only its own calls may run before the program is replaced: other threads hold
/// locks.
class SpawnPlan {
public:
    explicit SpawnPlan(int socket)
    {
        ::posix_spawn_file_actions_init(&files_);
        ::posix_spawnattr_init(&attributes_);
        ::posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        // Standard output is for results.
        if (::fcntl(STDERR_FILENO, F_GETFD) >= 0)
            ::posix_spawn_file_actions_adddup2(&files_, STDERR_FILENO, STDOUT_FILENO);
        else
            ::posix_spawn_file_actions_addopen(&files_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        ::posix_spawn_file_actions_adddup2(&files_, socket, served_socket);
        sigset_t signals;
        sigemptyset(&signals);
        ::posix_spawnattr_setsigmask(&attributes_, &signals);
        for (const int signal : {SIGINT, SIGTERM, SIGPIPE})
            sigaddset(&signals, signal);
        ::posix_spawnattr_setsigdefault(&attributes_, &signals);
        // A group of its own: a hung driver is ended with the compilers that it started, and Ctrl-C is ours to answer.
        ::posix_spawnattr_setpgroup(&attributes_, 0);
        ::posix_spawnattr_setflags(&attributes_,
                                   POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    }
    ~SpawnPlan()
    {
        ::posix_spawn_file_actions_destroy(&files_);
        ::posix_spawnattr_destroy(&attributes_);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;

    [[nodiscard]] pid_t start(const std::string& program, std::vector<std::string> arguments) const
    {
        arguments.insert(arguments.begin(), "tetrace");
        std::vector<char*> pointers;
        for (std::string& argument : arguments)
            pointers.push_back(argument.data());
        pointers.push_back(nullptr);
        pid_t pid = -1;
        if (const int reason = ::posix_spawn(&pid, program.c_str(), &files_, &attributes_, pointers.data(), environ);
            reason != 0)
            throw Error(ErrorKind::driver, "starting a driver's process: " + program + ": " + std::strerror(reason));
        return pid;
    }

private:
    posix_spawn_file_actions_t files_{};
    posix_spawnattr_t attributes_{};
};

/// Waits for a process to end by itself; then kills it and what it started. Returns waitpid()'s status.
int reap(pid_t pid, double patience_s)
{
    const Stopwatch watch;
    siginfo_t info{};
    while (::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0 &&
           watch.seconds() < patience_s)
        ::usleep(500);
    ::kill(-pid, SIGKILL); // the unreaped process still keeps its number from being used again
    int status = 0;
    while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

/// That a process has used, all its threads together; 0 if it has ended.
double processor_s(pid_t pid)
{
    clockid_t clock{};
    timespec time{};
    if (::clock_getcpuclockid(pid, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return 0;
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// "0.5", "300".
std::string number_text(double number)
{
    std::ostringstream text;
    text << number;
    return text.str();
}

std::string signal_text(int signal)
{
    const char* const name = ::sigabbrev_np(signal);
    std::string text = "was ended by signal " + std::to_string(signal) + " (" +
                       (name != nullptr ? "SIG" + std::string(name) + ", " : "") + ::strsignal(signal) + ")";
    if (signal == SIGKILL) text += ", as the system does where memory is short,";
    return text;
}

std::string end_text(int status)
{
    if (WIFSIGNALED(status)) return signal_text(WTERMSIG(status));
    return "ended its process with exit code " + std::to_string(WEXITSTATUS(status));
}

} // namespace

double call_limit_s(std::uint64_t rays, std::uint64_t bytes)
{
    return 300 + 1e-3 * static_cast<double>(rays) + 1e-6 * static_cast<double>(bytes);
}

DriverChild::DriverChild(const DriverProcesses& processes, const std::string& backend)
    : backend_(backend), call_limit_s_(processes.call_limit_s), channel_(Descriptor())
{
    auto [ours, theirs] = Channel::make_pair();
    std::vector<std::string> arguments = processes.arguments;
    arguments.push_back(backend);
    arguments.push_back(std::to_string(::getpid()));
    pid_ = SpawnPlan(theirs.number()).start(processes.program, std::move(arguments));
    channel_ = std::move(ours);
}

DriverChild::~DriverChild()
{
    channel_ = Channel(Descriptor()); // the process ends when it sees this
    if (!is_lost()) static_cast<void>(reap(pid_, farewell_s));
}

ByteReader DriverChild::call(const DriverCall& call)
{
    if (is_lost()) throw Error(ErrorKind::internal, "a call for a driver's process that is gone: " + call.doing);
    const double limit_s = call_limit_s_ > 0 ? call_limit_s_ : call.limit_s;
    if (!channel_.send(call.request.bytes(), call.file)) lose(end(farewell_s), call.doing);
    if (const std::string why = await_answer(limit_s, call.compiles); !why.empty()) {
        static_cast<void>(end(0));
        lose(why + ", and was ended,", call.doing);
    }
    auto answer = channel_.receive();
    if (!answer) lose(end(farewell_s), call.doing);
    ByteReader reader(std::move(answer->bytes));
    get_outcome(reader);
    return reader;
}

/// Counts only the time in which we ran ourselves: Ctrl-Z, a debugger and a machine that sleeps stop the driver too.
/// A compiler at work is charged its processor time, and at least a quarter of the clock's: one that polls is hung too.
std::string DriverChild::await_answer(double limit_s, bool compiles) const
{
    double idle_s = 0, busy_s = 0, used_s = processor_s(pid_);
    for (Stopwatch tick; idle_s < limit_s; tick = Stopwatch()) {
        if (channel_.wait(static_cast<int>(std::clamp(1e3 * (limit_s - idle_s), 1.0, double{tick_ms})))) return {};
        const double waited_s = std::min(tick.seconds(), max_tick_s);
        const double now_s = compiles ? processor_s(pid_) : used_s;
        const double worked_s = now_s - std::exchange(used_s, now_s);
        if (worked_s < busy_share * waited_s)
            idle_s += waited_s;
        else
            busy_s +=
                std::clamp(worked_s, waited_s / 4, waited_s); // several threads are charged no more than the clock
        if (busy_s >= compiler_patience * limit_s)
            return "gave no answer for " + number_text(compiler_patience * limit_s) + " s of processor time";
    }
    return "gave no answer for " + number_text(limit_s) + " s";
}

std::string DriverChild::end(double patience_s)
{
    const int status = reap(std::exchange(pid_, -1), patience_s);
    channel_ = Channel(Descriptor());
    return end_text(status);
}

void DriverChild::lose(const std::string& how, const std::string& doing) const
{
    throw Error(ErrorKind::driver, "the driver of " + backend_ + (driver_.empty() ? "" : " (" + driver_ + ")") + " " +
                                       how + " while " + doing);
}

std::shared_ptr<const RemoteScene> DriverChild::find_scene(const void* here)
{
    std::erase_if(scenes_, [](const auto& scene) { return scene.expired(); });
    for (const auto& known : scenes_)
        if (auto scene = known.lock(); scene != nullptr && scene->here == here) return scene;
    return nullptr;
}

std::shared_ptr<const RemoteScene> DriverChild::add_scene(const void* here)
{
    auto scene = std::make_shared<const RemoteScene>(RemoteScene{here, next_scene_++});
    scenes_.push_back(scene);
    return scene;
}

} // namespace tetrace
