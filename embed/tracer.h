#pragma once

#include "core/device/backend.h"
#include "embed/include/tetrace/tetrace.h"
#include "scenes/load.h"

#include <memory>
#include <span>
#include <string_view>

namespace tetrace {

/// Whether one of the library's layouts has a kernel for given rays there.
[[nodiscard]] bool traces_given_rays(const Backend& backend);

/// A scene, packed in a layout, on a device.
class Tracer {
public:
    /// Throws Error{usage} for an unknown backend, device or layout, naming the known ones; else as
    /// pack(), build_bvh() and Backend::open() do.
    Tracer(std::shared_ptr<const LoadedScene> scene, std::string_view backend, std::uint32_t device,
           std::string_view layout);

    /// hits.size() == rays.size(). Throws Error{usage} before any hit is written, else as Session does.
    void trace(std::span<const tetrace_ray> rays, bool any_hit, std::span<tetrace_hit> hits);

private:
    [[nodiscard]] PackedScene packed(Layout layout) const;
    void trace_launch(std::span<const tetrace_ray> rays, std::size_t first, bool any_hit, std::span<tetrace_hit> hits);

    std::shared_ptr<const LoadedScene> scene_;
    Structure structure_ = Structure::cdt;
    PackedScene packed_; ///< empty for a driver's own BVH
    const Device* device_ = nullptr;
    std::unique_ptr<Session> session_;
};

} // namespace tetrace
