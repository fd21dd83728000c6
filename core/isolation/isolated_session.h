#pragma once

#include "core/isolation/isolated_backend.h"

namespace tetrace {

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
