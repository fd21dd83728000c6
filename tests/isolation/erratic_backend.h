#pragma once

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/device/defects.h"
#include "core/device/launch.h"
#include "core/isolation/messages.h"

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <new>
#include <stdexcept>
#include <unistd.h>

namespace tetrace::test {

/// What a driver does at a call, as SessionOptions::program_cache says it: "launch abort". Calls: open, set_rays,
/// launch, relaunch, wait, read, close; reopen, while the environment has MOODY_REOPENS; and list, by MOODY_AT_LIST.
inline void misbehave(const std::string& mood, const std::string& call)
{
    if (mood.rfind(call + " ", 0) != 0) return;
    const std::string how = mood.substr(call.size() + 1);
    if (how == "abort") std::signal(SIGABRT, SIG_DFL), std::abort();
    if (how == "segv") std::signal(SIGSEGV, SIG_DFL), std::raise(SIGSEGV);
    if (how == "kill") std::raise(SIGKILL);
    if (how == "exit") ::_exit(7);
    while (how == "hang")
        ::pause();
    const std::clock_t begin = std::clock();
    while (how == "spin" || (how == "work" && std::clock() - begin < 8 * CLOCKS_PER_SEC / 10)) {
    }
    if (how == "bad_alloc") throw std::bad_alloc();
    if (how == "other") throw std::runtime_error("something else");
    for (const ErrorKind kind :
         {ErrorKind::missing, ErrorKind::unsupported, ErrorKind::internal, ErrorKind::wrong_result})
        if (how == std::to_string(static_cast<int>(kind))) throw Error(kind, how + ": 12 of 34 bytes\nat " + call);
}

/// Answers that depend on every bit that a session was given, and moods.
class ErraticSession : public Session {
public:
    ErraticSession(const KernelId& kernel, const SceneData& scene, const SessionOptions& options)
        : mood_(options.program_cache.string()), task_(kernel.task)
    {
        misbehave(mood_, "open");
        if (std::getenv("MOODY_REOPENS") != nullptr) misbehave(mood_, "reopen");
        ByteWriter all;
        all.put(kernel);
        put_options(all, options);
        if (scene.packed != nullptr || scene.mesh != nullptr) {
            const SharedMemory arrays = put_scene(all, kernel, scene);
            add(arrays.bytes());
        }
        add(all.bytes());
    }
    ~ErraticSession() override { misbehave(mood_, "close"); }

    void set_rays(std::span<const Quad> quads) override
    {
        misbehave(mood_, "set_rays");
        rays_ = hash_of(quads, 1);
    }
    void start(std::span<const TraceJob> jobs) override
    {
        misbehave(mood_, "launch");
        if (misbehaves_at_second_launch_) misbehave(mood_, "relaunch");
        misbehaves_at_second_launch_ = true;
        ByteWriter bytes;
        bytes.put_all(jobs);
        job_ = hash_of(bytes.bytes(), 2);
        ++launches_;
    }
    [[nodiscard]] double wait() override
    {
        misbehave(mood_, "wait");
        return 1.0 / 3 + static_cast<double>(job_ % 1000);
    }
    [[nodiscard]] SetupTimes setup_times() const override { return {0.1, 0.2 * launches_, launches_ > 0, 0.3}; }
    [[nodiscard]] std::uint64_t bytes() const override { return 1'000'000'000'007 + static_cast<unsigned>(launches_); }

private:
    void read_output(std::span<std::uint32_t> words) override
    {
        misbehave(mood_, "read");
        std::ranges::fill(words, POISON);
        if (mood_ == "writes outside") words[0] = 0;
        const OutputParts parts = output_parts(words_per_ray(task_));
        std::uint64_t i = 0;
        for (std::size_t job = 0; job < parts.count(); ++job)
            for (std::uint32_t& result : parts.results(words, job)) {
                const std::uint64_t word = (given_ ^ rays_ ^ job_) * ++i;
                result = static_cast<std::uint32_t>(task_ == Task::search ? word % 5 : word);
            }
    }
    void add(std::span<const std::byte> bytes) { given_ = hash_of(bytes, given_); }

    std::string mood_;
    Task task_;
    std::uint64_t given_ = 0, rays_ = 0, job_ = 0;
    int launches_ = 0;
    bool misbehaves_at_second_launch_ = false;
};

/// Two devices whose facts are all different from the defaults.
class ErraticBackend : public Backend {
public:
    ErraticBackend()
    {
        for (unsigned i = 0; i < 2; ++i) {
            Device device{"caf\xc3\xa9 " + std::to_string(i),
                          DeviceKind::emulated,
                          "driver 1.2",
                          "erratic-1.2",
                          "the id",
                          "0123456789abcdef0123456789abcdef",
                          "0000:41:00.0",
                          "/opt/erratic/liberratic.so",
                          1ull << 40,
                          3ull << 33,
                          1024 + i,
                          32 + i,
                          65'535,
                          1.0 / 3,
                          7,
                          true,
                          false,
                          false,
                          ""};
            devices_.push_back(device);
        }
    }
    [[nodiscard]] std::string name() const override { return "erratic"; }
    [[nodiscard]] std::string clock() const override { return "erratic clock"; }
    [[nodiscard]] const std::vector<Device>& devices() const override
    {
        if (const char* mood = std::getenv("MOODY_AT_LIST")) misbehave(std::string("list ") + mood, "list");
        return devices_;
    }
    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override { return kernel.schedule == Schedule::tiles; }
    [[nodiscard]] std::string why_not(std::size_t device, const KernelId& kernel) const override
    {
        return kernel.math == MathMode::fast ? "device " + std::to_string(device) + " is never fast" : "";
    }
    [[nodiscard]] std::unique_ptr<Session> open(std::size_t, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override
    {
        return std::make_unique<ErraticSession>(kernel, scene, options);
    }
    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t device, MathMode math,
                                                   std::span<const Quad> operations) override
    {
        std::vector<std::uint32_t> words;
        for (const Quad& quad : operations)
            words.push_back(quad.x + 3 * quad.y + 5 * quad.z + 7 * quad.w + static_cast<unsigned>(device) +
                            static_cast<unsigned>(math));
        return words;
    }
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t device, const SessionOptions& options) override
    {
        if (device == 1) return std::nullopt;
        return Yardstick{1e12 / 3, 1e-6 / 3 * options.threads};
    }
    [[nodiscard]] bool runs_defects() const override { return true; }
    [[nodiscard]] std::vector<std::uint32_t> run_defect(std::size_t device, std::string_view name,
                                                        const DefectLaunch& launch) override
    {
        misbehave(std::string(name), "run_defect");
        return {static_cast<std::uint32_t>(device), static_cast<std::uint32_t>(name.size()), launch.items,
                launch.group_items};
    }

private:
    std::vector<Device> devices_;
};

} // namespace tetrace::test
