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
    [[nodiscard]] double wait() override;
    [[nodiscard]] SetupTimes setup_times() const override { return times_; }
    [[nodiscard]] std::uint64_t bytes() const override { return scene_bytes_; }

private:
    void start(std::span<const TraceJob> jobs) override;
    void read_output(std::span<std::uint32_t> words) override;
    /// Adds to the times of the session's set-up.
    void compile();
    /// Replaces the program, which cannot start rays in a tet, by one that can.
    void compile_starts_inside();
    void upload(const PackedScene& scene);
    void set_arguments();
    void resize_output(const OutputParts& parts);
    void enqueue(std::span<const LaunchPiece> pieces, std::uint32_t passes);
    /// counter: the number of its counter. event: for the kernel's times, or null.
    void enqueue_piece(const LaunchPiece& piece, std::size_t counter, cl::CommandQueue& queue,
                       const std::vector<cl::Event>& after, cl::Event* event);
    /// Runs the kernel on no pixel, in as many groups as these tiles take.
    void enqueue_on_nothing(std::uint32_t tiles);
    /// Before pieces that are in flight together, for drivers that require the widest launch to come first.
    void enqueue_widest_first(std::span<const LaunchPiece> pieces);
    /// All pieces together. events: gets their events, or null.
    void enqueue_together(std::span<const LaunchPiece> pieces, std::vector<cl::Event>* events);
    /// Passes that are in flight together.
    void enqueue_in_flight(std::span<const LaunchPiece> pieces, std::uint32_t passes);
    void require_queues(std::size_t queues, std::size_t counters);
    [[nodiscard]] std::size_t groups_for(std::uint32_t tiles) const;
    /// Waits for enqueued work, and counts its times.
    void take_times();
    template <class Work>
    void run(const char* doing, std::uint64_t output_bytes, const Work& work);
    [[nodiscard]] std::uint64_t output_bytes() const { return parts_.words() * sizeof(std::uint32_t); }

    /// Tiles of a launch that was enqueued, how often it runs, and events of its kernels: those of the first and of the
    /// last to end are among them.
    struct Enqueued {
        std::uint32_t tiles, passes;
        std::vector<cl::Event> events;
    };

    std::shared_ptr<Context> context_;
    KernelId kernel_id_;
    ProgramCache cache_;
    std::filesystem::path program_file_;
    bool starts_outside_; ///< the program cannot start in a tet: the registers for that would slow a GPU
    unsigned tile_height_;
    std::uint64_t max_buffer_bytes_;
    PackedDomain domain_;
    TetParts tet_parts_;
    std::uint64_t scene_bytes_ = 0;
    SetupTimes times_;
    Launches launches_;
    std::uint32_t max_tiles_ = 0;          ///< of the launches that enqueue_widest_first() has made of this program
    std::vector<cl::CommandQueue> queues_; ///< the first is for all but the further pieces of a launch
    cl::Kernel kernel_;
    std::vector<cl::Buffer> arrays_;                   ///< by binding
    std::array<cl::Buffer, MAX_TET_PARTS> more_parts_; ///< from 1 on; 0 is arrays_[0]
    cl::Buffer output_, rays_;
    OutputParts parts_;               ///< of output_
    std::vector<cl::Buffer> outputs_; ///< of each job, in output_
    std::vector<cl::Buffer>
        counters_; ///< of persistent groups: the tiles that each piece of a launch has taken, for each output
    std::vector<Enqueued> enqueued_;
};

} // namespace tetrace::opencl
