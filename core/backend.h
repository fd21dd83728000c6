#pragma once

#include "core/camera.h"
#include "core/hit.h"
#include "core/kernel_id.h"
#include "core/packed_scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tetrace {

/// A device as its API describes it; usable, or with the reason why not and what would bring it.
struct Device {
    std::string name;
    std::string type;   ///< "cpu", "gpu", "emulated"
    std::string driver; ///< driver or library, with version
    std::string id;     ///< UUID or PCI id where there is one, else the name
    std::uint64_t memory_bytes = 0;
    unsigned threads = 1; ///< hardware threads or compute units
    bool usable = true;
    std::string reason; ///< why not, where not usable
};

/// What a session works on; the caller keeps it alive. `packed` is null for kernels of structure bvh.
struct SceneData {
    const TriangleMesh* mesh = nullptr;
    const PackedScene* packed = nullptr;
};

struct SessionOptions {
    unsigned threads = 0; ///< host threads; 0 is all that the process may use
};

/// One image's worth of primary rays.
struct TraceJob {
    View view;
    std::uint32_t width = 0, height = 0;
    std::uint32_t start_tet = NO_TET; ///< tet that holds view.origin, in packed order; NO_TET: rays enter from outside
    std::uint32_t max_steps = 0;      ///< a walk that long is LOST
};

/// Seconds that are paid once a session, apart from any kernel.
struct SetupTimes {
    double compile_s = 0; ///< kernels compiled, or a BVH built
    double upload_s = 0;  ///< data copied to where the kernel reads it
};

/// One scene on one device with one kernel. Every call throws Error, and only Error.
class Session {
public:
    virtual ~Session() = default;
    virtual void launch(const TraceJob& job) = 0;
    /// Waits for the launch; returns device seconds of the kernel alone.
    [[nodiscard]] virtual double wait() = 0;
    /// Copies the hits of the last launch, row after row; hits.size() == width * height.
    virtual void read_back(std::span<Hit> hits) = 0;
    [[nodiscard]] virtual SetupTimes setup_times() const = 0;
    /// Device bytes that the structure and its scene data occupy.
    [[nodiscard]] virtual std::uint64_t bytes() const = 0;
};

/// An API. Prints nothing, validates nothing, computes no statistics.
class Backend {
public:
    virtual ~Backend() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual std::string clock() const = 0; ///< which clock Session::wait reads
    [[nodiscard]] virtual std::vector<Device> devices() const = 0;
    /// Whether this build has the kernel for this API, whatever the host and its devices can run.
    [[nodiscard]] virtual bool has_kernel(const KernelId& kernel) const = 0;
    /// Empty where the kernel can run, else the reason.
    [[nodiscard]] virtual std::string why_not(const KernelId& kernel) const = 0;
    [[nodiscard]] virtual std::unique_ptr<Session> open(std::size_t device, const KernelId& kernel,
                                                        const SceneData& scene, const SessionOptions& options) = 0;
};

/// Every backend of this build, in CMake's order; those that cannot run here say so in their devices.
[[nodiscard]] const std::vector<Backend*>& all_backends();

} // namespace tetrace
