#include "core/device/open_checks.h"

#include "core/base/error.h"

#include <algorithm>

namespace tetrace {

void require_kernel(const Backend& backend, std::size_t device, const KernelId& kernel)
{
    if (const Device& wanted = backend.devices().at(device); !wanted.usable)
        throw Error(ErrorKind::missing, wanted.reason);
    if (const std::string reason = backend.why_not(device, kernel); !reason.empty())
        throw Error(ErrorKind::unsupported, reason);
}

const PackedScene& packed_scene(const Backend& backend, std::size_t device, const KernelId& kernel,
                                const SceneData& scene)
{
    require_kernel(backend, device, kernel);
    if (scene.packed == nullptr || scene.packed->layout != kernel.layout)
        throw Error(ErrorKind::internal, "opening " + backend.name() + ": the scene is not packed as " +
                                             std::string(name_of(kernel.layout)));
    return *scene.packed;
}

std::uint64_t max_buffer(const Device& device, const SessionOptions& options)
{
    if (device.max_buffer_bytes == 0 || options.max_buffer_bytes == 0)
        return device.max_buffer_bytes + options.max_buffer_bytes;
    return std::min(device.max_buffer_bytes, options.max_buffer_bytes);
}

unsigned tile_height_of(const SessionOptions& options)
{
    return options.tile_height != 0 ? options.tile_height : 8;
}

} // namespace tetrace
