#pragma once

#include "backends/vulkan/pass_order.h"
#include "backends/vulkan/program.h"
#include "backends/vulkan/rt/acceleration.h"
#include "core/device/launch.h"
#include "core/device/scene_buffers.h"

#include <optional>
#include <vector>

namespace tetrace::vulkan {

/// Every array of a scene as texels, arrays of quads separate from arrays of words:
/// kernels/language/scene_view_texels_glsl.h.
[[nodiscard]] std::vector<TexelBinding> texel_bindings(Layout layout);
/// The same of given rays.
inline constexpr TexelBinding rays_as_texels{FIRST_QUADS_BINDING + RAYS_BINDING, vk::Format::eR32G32B32A32Uint};

/// One packed scene in the buffers of one device, or the driver's own BVH of a mesh, and its programs.
class VulkanSession : public Session {
public:
    /// Throws Error{unsupported} with both numbers where a limit or the memory is too small.
    VulkanSession(const FoundDevice& found, const KernelId& kernel, const PackedScene& scene,
                  const SessionOptions& options);
    /// For kernels of layout rt; the device has the kernel's RayTracer.
    VulkanSession(const FoundDevice& found, const KernelId& kernel, const TriangleMesh& mesh,
                  const SessionOptions& options);
    ~VulkanSession() override;
    VulkanSession(const VulkanSession&) = delete;
    VulkanSession& operator=(const VulkanSession&) = delete;

    void set_rays(std::span<const Quad> quads) override;
    [[nodiscard]] double wait() override;
    [[nodiscard]] SetupTimes setup_times() const override { return setup_; }
    [[nodiscard]] std::uint64_t bytes() const override { return bytes_; }

private:
    void start(std::span<const TraceJob> jobs) override;
    void read_output(std::span<std::uint32_t> words) override;

    void make_scene_buffers(const PackedScene& scene);
    void make_program();
    /// Whether rays that meet ties are deferred to a program of their own (docs/spec/devices.md, W9).
    [[nodiscard]] bool leaves_rays() const { return programs_.size() > 1; }
    /// Adds to the times of the session's set-up.
    void compile();
    /// For the first job whose rays start in a tet.
    void compile_starts_inside();
    void bind_scene(Program& program);
    void bind_rays(Buffer rays);
    /// Each job has a set of buffers of its own, for its part of the output.
    void bind_output();
    /// For the jobs of start().
    void resize_output();
    [[nodiscard]] std::uint64_t output_bytes() const { return parts_.words() * sizeof(std::uint32_t); }
    /// Command buffer and timestamps number `index` of a launch, made when first asked for.
    const vk::raii::CommandBuffer& commands_for(std::size_t index);
    /// The first launch of all jobs poisons the output before its kernels.
    void enqueue(std::span<const LaunchPiece> pieces, std::uint32_t passes);
    /// Records the dispatches of that many tiles, such that each of the device's threads gets tiles from all over the
    /// image.
    void record_dispatches(const vk::raii::CommandBuffer& commands, LaunchParams params, std::uint32_t tiles) const;
    /// Records that no ray of the pieces is deferred yet.
    void record_none_left(const vk::raii::CommandBuffer& commands, std::span<const LaunchPiece> pieces) const;
    /// Records the program that traces the rays of the pieces which programs_.front() has deferred.
    void record_left(const vk::raii::CommandBuffer& commands, std::span<const LaunchPiece> pieces) const;
    /// Waits for enqueued work, and counts its times.
    void take_times();

    Context context_; // outlives all that follows
    TetParts tet_parts_;
    std::uint64_t max_buffer_bytes_;
    unsigned tile_height_;
    KernelId kernel_;
    std::filesystem::path program_cache_;
    std::string given_program_;       ///< SPIR-V; empty: the embedded one
    bool starts_outside_ = true;      ///< all rays so far start outside: the program cannot start otherwise
    bool in_texels_ = false;          ///< the scene's arrays are read as texels
    std::uint32_t stack_entries_ = 0; ///< as ProgramId has it
    PackedDomain domain_;
    std::uint64_t bytes_ = 0;
    SetupTimes setup_;

    std::vector<Buffer> arrays_;     ///< by binding
    std::vector<Buffer> more_parts_; ///< of the tets, from the second on
    std::optional<Acceleration> acceleration_;
    Buffer rays_, output_, staging_;
    OutputParts parts_;         ///< of output_
    bool fills_output_ = false; ///< by the next commands
    Buffer left_; ///< of each job the rays that programs_.front() leaves: DEFERRED_PIXELS and so on of layout.h
    OutputParts left_parts_;        ///< of left_
    std::vector<Program> programs_; ///< the kernel, and if it defers ties the one that traces those rays

    struct Chunk {
        vk::raii::CommandBuffer commands{nullptr};
        vk::raii::QueryPool times{nullptr};
    };
    std::vector<Chunk> chunks_; ///< those of the largest launch so far
    /// What a chunk that has not been waited for runs.
    struct Enqueued {
        std::uint32_t tiles, passes;
    };
    std::vector<Enqueued> enqueued_;
    PassOrder order_{context_};
    Launches launches_;
};

} // namespace tetrace::vulkan
