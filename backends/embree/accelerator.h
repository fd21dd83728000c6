#pragma once

#include "core/mesh/triangle_mesh.h"
#include "core/pack/kernel_id.h"

#include <atomic>
#include <cstdint>
#include <string>

#if TETRACE_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace tetrace::embree {

/// How Embree builds its tree; no tree is the fastest in every scene (docs/embree.md).
enum class Tree {
    high,   ///< build quality high: with spatial splits
    medium, ///< build quality medium: without
    robust, ///< scene flag robust: watertight, in Embree 3 and 4 without spatial splits
};

/// The tree of a layout of Embree's.
[[nodiscard]] Tree tree_of(Layout layout);

/// A triangle mesh in an Embree scene of its own device.
class Accelerator {
public:
    /// threads: of the build. Throws Error{internal} with Embree's reason.
    Accelerator(const TriangleMesh& mesh, Tree tree, unsigned threads);
    ~Accelerator();
    Accelerator(const Accelerator&) = delete;
    Accelerator& operator=(const Accelerator&) = delete;

    [[nodiscard]] double build_s() const { return build_s_; }
    [[nodiscard]] std::uint64_t bytes() const { return static_cast<std::uint64_t>(bytes_.load()); }

    /// For queries (queries.h).
    [[nodiscard]] RTCScene scene() const { return scene_; }

private:
    static bool count_bytes(void* accelerator, ssize_t bytes, bool post);

    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    std::atomic<std::int64_t> bytes_ = 0;
    double build_s_ = 0;
};

/// The version, and what its devices are configured with: "Embree 3.13.5, frequency_level=simd512".
[[nodiscard]] std::string version_text();

/// What an Embree library traces together on this processor.
struct Abilities {
    int version = 0;           ///< major
    unsigned native_width = 1; ///< rays of the widest packet that it does not split; 1: it traces rays one by one
    bool has_streams = false;
};
/// Those of the library that this program is linked with. Throws Error{internal} with Embree's reason.
[[nodiscard]] Abilities abilities();

/// Empty if rays are traced by the method as its name says, or by narrower packets; else the reason
/// (docs/embree.md).
[[nodiscard]] std::string why_not_traced(const Abilities& abilities, Method method);

} // namespace tetrace::embree
