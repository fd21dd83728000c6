#pragma once

#include "core/isolation/driver_child.h"

#include <mutex>

namespace tetrace {

/// A backend whose drivers run in processes of their own, one for each device; this process never loads them. A driver
/// that ends its process, or gives no answer, is an Error{driver} of the call; the next call for the device starts
/// another process. A driver that does so while it lists its devices gives one that is broken, with the reason.
class IsolatedBackend : public Backend {
public:
    /// inner: answers here what no driver is needed for; the process finds it by its name.
    IsolatedBackend(const Backend& inner, DriverProcesses processes);

    void restart() override { children_.assign(children_.size(), nullptr); }

    [[nodiscard]] std::string name() const override { return inner_->name(); }
    [[nodiscard]] std::string clock() const override { return inner_->clock(); }
    [[nodiscard]] const std::vector<Device>& devices() const override;
    [[nodiscard]] bool has_kernel(const KernelId& kernel) const override { return inner_->has_kernel(kernel); }
    [[nodiscard]] std::string why_not(std::size_t device, const KernelId& kernel) const override;
    [[nodiscard]] std::unique_ptr<Session> open(std::size_t device, const KernelId& kernel, const SceneData& scene,
                                                const SessionOptions& options) override;
    [[nodiscard]] std::vector<std::uint32_t> probe(std::size_t device, MathMode math,
                                                   std::span<const Quad> operations) override;
    [[nodiscard]] std::optional<Yardstick> yardstick(std::size_t device, const SessionOptions& options) override;
    [[nodiscard]] CompiledCode compiled(std::size_t device, const std::optional<KernelId>& kernel, bool starts_outside,
                                        const std::filesystem::path& program_file) const override;
    [[nodiscard]] bool runs_defects() const override { return inner_->runs_defects(); }
    [[nodiscard]] std::vector<std::uint32_t> run_defect(std::size_t device, std::string_view name,
                                                        const DefectLaunch& launch) override;

    /// The device's process, started where there is none. Throws Error{missing} if the device cannot be used,
    /// Error{driver} where it cannot be found again.
    [[nodiscard]] std::shared_ptr<DriverChild> child_of(std::size_t device) const;

private:
    [[nodiscard]] std::vector<Device> list(DriverChild& child) const;
    void find_devices() const;
    [[nodiscard]] std::shared_ptr<DriverChild> start(std::size_t device) const;

    const Backend* inner_;
    DriverProcesses processes_;
    mutable std::once_flag once_;
    mutable std::vector<Device> devices_;
    mutable std::vector<std::shared_ptr<DriverChild>> children_; ///< device by device; null if none was needed yet
    mutable std::shared_ptr<DriverChild> spare_;                 ///< listed the devices; for the first that is used
};

/// A session in its device's process. If that process was lost by another session's call, this one is opened again in
/// the next process before it goes on: with its rays, and if it is waited for or read, after its last launch.
class IsolatedSession : public Session {
public:
    /// Opens it, as Backend::open does. backend and scene outlive it.
    IsolatedSession(const IsolatedBackend& backend, std::size_t device, const KernelId& kernel, const SceneData& scene,
                    SessionOptions options);
    ~IsolatedSession() override;
    IsolatedSession(const IsolatedSession&) = delete;
    IsolatedSession& operator=(const IsolatedSession&) = delete;

    void set_rays(std::span<const Quad> quads) override;
    [[nodiscard]] double wait() override;
    [[nodiscard]] double download_s() const override { return download_s_; }
    [[nodiscard]] SetupTimes setup_times() const override { return facts_.setup; }
    [[nodiscard]] std::uint64_t bytes() const override { return facts_.bytes; }

private:
    void start(std::span<const TraceJob> jobs) override;
    void read_output(std::span<std::uint32_t> words) override;

    /// Whether the session is where it was left. Else it has been opened again, with its rays.
    bool is_still_open();
    /// As is_still_open(), and the last jobs have been launched again, and waited for.
    void require_launched();
    void open();
    void send_rays();
    void send_jobs();
    double await_jobs();
    /// Calls this session; takes its facts from the answer.
    ByteReader call(Request what, const std::string& doing, const ByteWriter& arguments, const SharedMemory& memory,
                    double limit_s);
    /// Of all jobs.
    [[nodiscard]] std::uint64_t rays() const;

    const IsolatedBackend* backend_;
    std::size_t device_;
    KernelId kernel_;
    SceneData scene_;
    SessionOptions options_;

    std::shared_ptr<DriverChild> child_;
    std::shared_ptr<const RemoteScene> remote_scene_; ///< of child_
    std::uint64_t number_ = 0;                        ///< of the session in child_; 0: it could not be opened there

    SharedMemory rays_; ///< kept for another process
    std::uint64_t quads_ = 0;
    bool has_rays_ = false;
    std::vector<TraceJob> jobs_; ///< of the last launch; empty: there was none
    SharedMemory output_;
    SessionFacts facts_;
    double download_s_ = 0;
};

} // namespace tetrace
