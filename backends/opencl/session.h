#pragma once

#include "backends/opencl/context.h"
#include "backends/opencl/program.h"
#include "core/device/launch.h"
#include "core/device/scene_buffers.h"

#include <array>
#include <memory>
#include <vector>

namespace tetrace::opencl {

/// A packed scene in a device's buffers, and the kernel that reads it.
class OpenclSession : public Session {
public:
    /// Compiles and uploads. Throws Error as Backend::open says.
    OpenclSession(std::shared_ptr<Context> context, const KernelId& kernel, const PackedScene& scene,
                  const SessionOptions& options);

    void set_rays(std::span<const Quad> quads) override;
    void launch(const TraceJob& job) override;
    [[nodiscard]] double wait() override;
    [[nodiscard]] SetupTimes setup_times() const override { return times_; }
    [[nodiscard]] std::uint64_t bytes() const override { return scene_bytes_; }

private:
    void read_output(std::span<std::uint32_t> words) override;
    /// Adds to the times of the session's set-up.
    void compile();
    /// Replaces the program, which cannot start rays in a tet, by one that can.
    void compile_starts_inside();
    void upload(const PackedScene& scene);
    void set_arguments();
    void resize_output(std::size_t words);
    void enqueue(const LaunchParams& params, std::uint32_t tiles, std::uint32_t passes);
    [[nodiscard]] std::size_t groups_for(std::uint32_t tiles) const;
    /// Waits for enqueued work, and counts its times.
    void take_times();
    template <class Work>
    void run(const char* doing, std::uint64_t output_bytes, const Work& work);
    [[nodiscard]] std::uint64_t output_bytes() const { return output_words_ * sizeof(std::uint32_t); }

    /// Tiles of a launch that was enqueued, how often it runs, and the events of its first and last pass.
    struct Enqueued {
        std::uint32_t tiles, passes;
        cl::Event first, last;
    };

    std::shared_ptr<Context> context_;
    KernelId kernel_id_;
    ProgramCache cache_;
    bool starts_outside_; ///< the program has no start in a tet: registers that it would need slow a GPU
    unsigned tile_height_;
    std::uint64_t max_buffer_bytes_;
    PackedDomain domain_;
    TetParts parts_;
    std::uint64_t scene_bytes_ = 0;
    SetupTimes times_;
    Launches launches_;
    cl::CommandQueue queue_;
    cl::Kernel kernel_;
    std::vector<cl::Buffer> arrays_;                   ///< by binding
    std::array<cl::Buffer, MAX_TET_PARTS> more_parts_; ///< from 1 on; 0 is arrays_[0]
    cl::Buffer output_, counter_, rays_;
    std::size_t output_words_ = 0;
    std::vector<Enqueued> enqueued_;
};

} // namespace tetrace::opencl
