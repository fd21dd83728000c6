#pragma once

#include "backends/cuda/device.h"
#include "core/device/launch.h"

#include <deque>
#include <vector>

namespace tetrace::cuda {

/// Runs one kernel on a packed scene in a device's memory.
class CudaSession : public Session {
public:
    /// scene: packed in the kernel's layout. tile_height: 4 or 8.
    CudaSession(const Driver& driver, Ordinal device, const Programs& programs, const KernelId& kernel,
                const PackedScene& scene, const SessionOptions& options, unsigned tile_height);
    ~CudaSession() override;

    void set_rays(std::span<const Quad> quads) override;
    [[nodiscard]] double wait() override;
    [[nodiscard]] SetupTimes setup_times() const override { return setup_; }
    [[nodiscard]] std::uint64_t bytes() const override { return bytes_; }

private:
    void start(std::span<const TraceJob> jobs) override;
    void read_output(std::span<std::uint32_t> words) override;
    void make_current();
    void upload(const PackedScene& scene);
    void poison_output(std::size_t words);
    void start_launch(std::span<const LaunchPiece> pieces, std::uint32_t passes);
    void join_streams();
    void launch_tiles(const LaunchPiece& piece, StreamHandle stream);
    void launch_persistent(const LaunchPiece& piece, Address counter, StreamHandle stream);
    void clear_counters(std::size_t count);
    [[nodiscard]] Address output_of(std::size_t job) const;
    /// A kernel's entry point.
    struct Entry {
        FunctionHandle function;
        unsigned resident_blocks; ///< as many as the device holds at once
    };
    [[nodiscard]] const Entry& entry_of(const LaunchPiece& piece) const
    {
        return entries_[piece.job % entries_.size()];
    }
    [[nodiscard]] Entry entry(Ordinal device, const std::string& name);
    /// Waits for the current launch, if any, and counts its time.
    void finish_launch();

    OpenDevice device_;
    LoadedProgram program_;
    Task task_;
    Schedule schedule_;
    std::uint32_t stack_bytes_;  ///< of a thread, in its block's memory
    Entry outside_, inside_;     ///< for rays of an image that begin outside the domain, or in a tet
    std::vector<Memory> arrays_; ///< by binding
    std::vector<Address>
        scene_; ///< the kernels' argument: SceneView of kernels/language/scene_view_cuda.h, word for word
    PackedDomain domain_;
    Memory output_, rays_;
    Memory counters_; ///< of persistent threads: the rays that each piece of each pass has taken
    EventTimer timer_;
    SideStreams outputs_;           ///< a stream for each output of passes that are in flight together
    std::deque<SideStreams> sides_; ///< of each of these streams, for the pieces of a pass
    unsigned tile_height_, threads_;
    std::uint64_t max_buffer_bytes_;
    Launches launches_;
    std::vector<Entry> entries_;       ///< of each job
    OutputParts parts_;                ///< of the jobs
    std::uint32_t launched_tiles_ = 0; ///< of the current launch; 0: there is none
    std::uint32_t launched_passes_ = 1;
    SetupTimes setup_;
    std::uint64_t bytes_;
};

} // namespace tetrace::cuda
