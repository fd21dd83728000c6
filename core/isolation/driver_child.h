#pragma once

#include "core/isolation/channel.h"
#include "core/isolation/messages.h"

#include <functional>
#include <memory>
#include <string>
#include <sys/types.h>
#include <vector>

namespace tetrace {

/// How the processes of drivers are started, and how long they may take.
struct DriverProcesses {
    std::string program = "/proc/self/exe"; ///< calls serve_driver() when it is started with `arguments`
    std::vector<std::string> arguments;     ///< the backend's name and served_by() follow them
    double call_limit_s = 0;                ///< of each call; 0: by the size of its work, see call_limit_s()
};

/// Seconds that a call may take, with this many rays to trace or bytes to copy: far more than any driver needs that
/// will ever answer. The slowest known, an interpreter of kernels, takes a millisecond a ray.
[[nodiscard]] double call_limit_s(std::uint64_t rays, std::uint64_t bytes = 0);

/// A call for a driver's process: "<doing>" is what it does, for the text that says how it ended.
struct DriverCall {
    std::string doing;
    ByteWriter request;
    int file = -1; ///< goes with the request
    double limit_s = 0;
    bool compiles = false; ///< may take 3 times its limit in processor time, of whatever length on a busy machine
};

/// A scene that a driver's process has, for as long as a session holds this.
struct RemoteScene {
    const void* here; ///< the caller's; it lives as long as the session
    std::uint64_t number;
};

/// A process that serves one backend (driver_server.h). It is killed and reaped when this ends; it also ends when the
/// process that started it does, however that ends.
class DriverChild {
public:
    /// Throws Error{driver} if no process can be started.
    DriverChild(const DriverProcesses& processes, const std::string& backend);
    ~DriverChild();
    DriverChild(const DriverChild&) = delete;
    DriverChild& operator=(const DriverChild&) = delete;

    /// What an answer has after its outcome. Throws what the call threw there. Throws Error{driver} if the process
    /// ended or is past its limit: it is then gone, and is_lost().
    [[nodiscard]] ByteReader call(const DriverCall& call);
    [[nodiscard]] bool is_lost() const { return pid_ < 0; }

    /// How error texts name the driver: "pocl-3.1, cpu-haswell"; empty: only the backend is named.
    void set_driver(std::string driver) { driver_ = std::move(driver); }

    /// The scene if the process has it; else null.
    [[nodiscard]] std::shared_ptr<const RemoteScene> find_scene(const void* here);
    /// A scene that the process is about to be sent.
    [[nodiscard]] std::shared_ptr<const RemoteScene> add_scene(const void* here);

private:
    /// Empty when the process has answered. Else why it is given up: "gave no answer for 300 s".
    [[nodiscard]] std::string await_answer(double limit_s, bool compiles) const;
    /// Gives the process that long to end by itself, ends it, and says how: "was ended by signal 11 (...)".
    [[nodiscard]] std::string end(double patience_s);
    [[noreturn]] void lose(const std::string& how, const std::string& doing) const;

    std::string backend_, driver_;
    double call_limit_s_;
    Channel channel_;
    pid_t pid_ = -1;
    std::vector<std::weak_ptr<const RemoteScene>> scenes_;
    std::uint64_t next_scene_ = 1;
};

} // namespace tetrace
