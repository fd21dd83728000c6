#include "scenes/child_process.h"

#include "core/base/error.h"
#include "core/base/files.h"
#include "core/base/stopwatch.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <mutex>
#include <optional>
#include <poll.h>
#include <string_view>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace tetrace {

namespace {

constexpr std::size_t kept_bytes = 64 * 1024;
constexpr int tick_ms = 100;
constexpr double grace_s = 1.0; ///< between SIGTERM and SIGKILL

struct Pipe {
    Descriptor read, write;
};

/// Both ends above 2, so that the child's dup2() onto 0, 1 and 2 never overwrites one that it still needs.
Pipe make_pipe(const std::filesystem::path& program)
{
    const auto fail = [&] {
        throw Error(ErrorKind::internal,
                    fmt::format("starting {}: no pipe to it: {}", program.string(), std::strerror(errno)));
    };
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail();
    const Descriptor low_read(ends[0]), low_write(ends[1]);
    Pipe pipe{Descriptor(::fcntl(ends[0], F_DUPFD_CLOEXEC, 3)), Descriptor(::fcntl(ends[1], F_DUPFD_CLOEXEC, 3))};
    if (!pipe.read.open() || !pipe.write.open()) fail();
    return pipe;
}

// One flag for all runs at once: an interrupt is meant for the whole process.
std::atomic<int> interrupts{0};
static_assert(std::atomic<int>::is_always_lock_free, "set by a signal handler");

void note_interrupt(int)
{
    interrupts.fetch_add(1);
}

/// Counts SIGINT and SIGTERM in `interrupts` while at least one of these lives. Ignored signals stay ignored.
class InterruptGuard {
public:
    InterruptGuard()
    {
        const std::scoped_lock lock(mutex);
        if (users++ > 0) return;
        interrupts.store(0);
        for (std::size_t i = 0; i < signals.size(); ++i) {
            struct sigaction ours {};
            ours.sa_handler = note_interrupt;
            sigemptyset(&ours.sa_mask);
            ::sigaction(signals[i], nullptr, &before[i]);
            if (before[i].sa_handler != SIG_IGN) ::sigaction(signals[i], &ours, nullptr);
        }
    }
    ~InterruptGuard()
    {
        const std::scoped_lock lock(mutex);
        if (--users > 0) return;
        for (std::size_t i = 0; i < signals.size(); ++i)
            ::sigaction(signals[i], &before[i], nullptr);
    }
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

private:
    static constexpr std::array<int, 2> signals = {SIGINT, SIGTERM};
    static inline std::mutex mutex;
    static inline int users = 0;
    static inline std::array<struct sigaction, 2> before{};
};

/// What the child does between fork and exec. Only async-signal-safe calls: other threads may hold any lock.
struct Launch {
    const char* program;
    char* const* arguments;
    const ChildLimits* limits;
    pid_t parent;
    int out, errors, report;

    [[noreturn]] void operator()() const
    {
        ::setpgid(0, 0);
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (::getppid() != parent) ::_exit(127); // it died before prctl could tell us
        ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
        reset_signals();
        limit(RLIMIT_CORE, 0);
        if (limits->memory_bytes > 0) limit(RLIMIT_AS, limits->memory_bytes);
        if (limits->file_bytes > 0) limit(RLIMIT_FSIZE, limits->file_bytes);
        close_on_exec();
        const int nothing = ::open("/dev/null", O_RDONLY);
        if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
        if (nothing > STDIN_FILENO) ::close(nothing);
        ::dup2(out, STDOUT_FILENO);
        ::dup2(errors, STDERR_FILENO);
        ::execv(program, arguments);
        const int reason = errno;
        while (::write(report, &reason, sizeof reason) < 0 && errno == EINTR) {
        }
        ::_exit(127);
    }

private:
    /// All but the standard streams: whoever opened them may not have said so. Kernels before 5.11 cannot.
    static void close_on_exec()
    {
#if defined(SYS_close_range)
        constexpr unsigned cloexec = 4; // CLOSE_RANGE_CLOEXEC, which older headers lack
        ::syscall(SYS_close_range, 3u, ~0u, cloexec);
#endif
    }
    static void reset_signals()
    {
        for (const int signal : {SIGINT, SIGTERM, SIGPIPE, SIGXFSZ})
            ::signal(signal, SIG_DFL);
        sigset_t none;
        sigemptyset(&none);
        ::sigprocmask(SIG_SETMASK, &none, nullptr);
    }
    template <class Resource>
    static void limit(Resource resource, std::uint64_t value)
    {
        struct rlimit now {};
        ::getrlimit(resource, &now);
        // Soft and hard alike, so that the child cannot lift it; the hard limit that we have ourselves is not ours to
        // raise.
        now.rlim_max = now.rlim_max < value ? now.rlim_max : value;
        now.rlim_cur = now.rlim_max;
        ::setrlimit(resource, &now);
    }
};

/// A started child and its process group; both are gone, and reaped, when this is.
class Child {
public:
    Child(const std::filesystem::path& program, const std::vector<std::string>& arguments, const ChildLimits& limits);
    ~Child()
    {
        if (!reaped_) (void)end();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    [[nodiscard]] bool running() const
    {
        siginfo_t info{};
        const int result = ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
        return result == 0 ? info.si_pid == 0 : errno == EINTR;
    }
    [[nodiscard]] double processor_s() const
    {
        clockid_t clock{};
        timespec time{};
        if (::clock_getcpuclockid(pid_, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return 0;
        return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
    }
    void signal_group(int signal) const { ::kill(-pid_, signal); }
    /// Kills what is left of the group, while the unreaped child still keeps its number from being used again.
    [[nodiscard]] int end()
    {
        signal_group(SIGKILL);
        int status = 0;
        while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
        }
        reaped_ = true;
        return status;
    }

    Descriptor out, errors;

private:
    void await_exec(const std::filesystem::path& program, Pipe& report);

    pid_t pid_ = -1;
    bool reaped_ = false;
};

Child::Child(const std::filesystem::path& program, const std::vector<std::string>& arguments, const ChildLimits& limits)
{
    Pipe out_pipe = make_pipe(program), error_pipe = make_pipe(program), report = make_pipe(program);
    std::string name = program.string();
    std::vector<std::string> copies = arguments;
    std::vector<char*> pointers = {name.data()};
    for (std::string& argument : copies)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const Launch launch = {name.c_str(),         pointers.data(),        &limits,           ::getpid(),
                           out_pipe.write.get(), error_pipe.write.get(), report.write.get()};
    pid_ = ::fork();
    if (pid_ == 0) launch();
    if (pid_ < 0)
        throw Error(ErrorKind::internal, fmt::format("starting {}: no new process: {}", name, std::strerror(errno)));
    ::setpgid(pid_, pid_); // the child does the same; whoever comes first, the group is there before either goes on
    out = std::move(out_pipe.read);
    errors = std::move(error_pipe.read);
    for (const Descriptor* end : {&out, &errors})
        ::fcntl(end->get(), F_SETFL, O_NONBLOCK);
    await_exec(program, report);
}

void Child::await_exec(const std::filesystem::path& program, Pipe& report)
{
    report.write.close();
    int reason = 0;
    ssize_t got = 0;
    while ((got = ::read(report.read.get(), &reason, sizeof reason)) < 0 && errno == EINTR) {
    }
    if (got != sizeof reason) return; // closed by exec: the program runs
    (void)end();
    throw Error(ErrorKind::missing, fmt::format("starting {}: {}", program.string(), std::strerror(reason)));
}

void keep_tail(std::string& text, std::size_t slack)
{
    if (text.size() > kept_bytes + slack) text.erase(0, text.size() - kept_bytes);
}

/// Takes what a child writes: the tail of each stream, and its errors line by line.
class Output {
public:
    Output(ChildOutcome& outcome, const std::function<void(const std::string&)>& on_line)
        : outcome_(outcome), on_line_(on_line)
    {
    }

    /// Waits up to timeout_ms for output, and takes all that is there; false if both streams have ended.
    bool take(Child& child, int timeout_ms)
    {
        // poll() skips negative descriptors, which is what closed ones are.
        std::array<pollfd, 2> ends = {{{child.out.get(), POLLIN, 0}, {child.errors.get(), POLLIN, 0}}};
        ::poll(ends.data(), ends.size(), timeout_ms);
        drain(child.out, [this](std::string_view bytes) { add(outcome_.out, bytes); });
        drain(child.errors, [this](std::string_view bytes) { add_errors(bytes); });
        return child.out.open() || child.errors.open();
    }
    void finish()
    {
        if (!line_.empty()) flush_line();
        keep_tail(outcome_.out, 0);
        keep_tail(outcome_.errors, 0);
    }

private:
    static void add(std::string& text, std::string_view bytes)
    {
        text += bytes;
        keep_tail(text, kept_bytes);
    }
    void add_errors(std::string_view bytes)
    {
        add(outcome_.errors, bytes);
        for (const char c : bytes) {
            if (c != '\n') line_ += c;
            if (c == '\n' || line_.size() >= kept_bytes) flush_line();
        }
    }
    void flush_line()
    {
        const std::string line = std::exchange(line_, {});
        if (on_line_) on_line_(line);
    }
    // At most 1 MiB a call: a child that never stops writing must not keep us from looking at the clock.
    template <class Sink>
    static void drain(Descriptor& end, const Sink& sink)
    {
        std::array<char, 16 * 1024> buffer;
        for (int round = 0; end.open() && round < 64; ++round) {
            const ssize_t got = ::read(end.get(), buffer.data(), buffer.size());
            if (got > 0)
                sink(std::string_view(buffer.data(), static_cast<std::size_t>(got)));
            else if (got == 0 || (errno != EINTR && errno != EAGAIN))
                end.close();
            else if (errno == EAGAIN)
                return;
        }
    }

    ChildOutcome& outcome_;
    const std::function<void(const std::string&)>& on_line_;
    std::string line_;
};

/// Ends a child: asks it first, then kills it. Before that an interrupt may let it finish its work.
class Terminator {
public:
    using End = ChildOutcome::End;

    void check(const Child& child, const ChildLimits& limits, double elapsed_s)
    {
        const int count = interrupts.load();
        if (count > 0 && !interrupted_s_) {
            interrupted_s_ = elapsed_s;
            if (limits.finish_s > 0) child.signal_group(SIGINT);
        }
        const bool may_finish = limits.finish_s > 0 && count == 1 && elapsed_s <= *interrupted_s_ + limits.finish_s;
        if (reason_ == End::exited && count > 0 && !may_finish) ask(child, End::interrupted, elapsed_s);
        const bool is_late = limits.time_s > 0 && elapsed_s > limits.time_s;
        const bool is_spent = limits.processor_s > 0 && child.processor_s() > limits.processor_s;
        if (reason_ == End::exited && (is_late || is_spent)) ask(child, End::timed_out, elapsed_s);
        if (reason_ != End::exited && elapsed_s > asked_s_ + grace_s) child.signal_group(SIGKILL);
    }
    [[nodiscard]] End reason() const { return reason_; }
    [[nodiscard]] bool interrupted() const { return interrupted_s_.has_value(); }

private:
    void ask(const Child& child, End reason, double elapsed_s)
    {
        reason_ = reason;
        asked_s_ = elapsed_s;
        child.signal_group(SIGTERM);
    }

    End reason_ = End::exited;
    double asked_s_ = 0;
    std::optional<double> interrupted_s_; ///< when the first interrupt was seen
};

} // namespace

ChildOutcome run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                       const ChildLimits& limits, const std::function<void(const std::string&)>& on_error_line,
                       const std::function<void(double processor_s)>& on_tick)
{
    const InterruptGuard guard;
    const Stopwatch watch;
    ChildOutcome outcome;
    Output output(outcome, on_error_line);
    Terminator terminator;
    Child child(program, arguments, limits);
    double next_tick_s = 0;
    bool streams = true;
    while (child.running()) {
        // Without streams, poll() does not wake when the child ends: look more often.
        streams = output.take(child, streams ? tick_ms : tick_ms / 20);
        const double elapsed_s = watch.seconds();
        outcome.processor_s = child.processor_s();
        terminator.check(child, limits, elapsed_s);
        if (on_tick && elapsed_s >= next_tick_s) {
            on_tick(outcome.processor_s);
            next_tick_s = elapsed_s + tick_ms / 1000.0;
        }
    }
    outcome.processor_s = child.processor_s();
    const int status = child.end();
    output.take(child, 0);
    output.finish();
    outcome.wall_s = watch.seconds();
    outcome.end = terminator.reason();
    outcome.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
    outcome.interrupted = terminator.interrupted();
    if (outcome.end == ChildOutcome::End::exited && WIFSIGNALED(status))
        outcome.end = outcome.interrupted ? ChildOutcome::End::interrupted : ChildOutcome::End::signalled;
    return outcome;
}

} // namespace tetrace
