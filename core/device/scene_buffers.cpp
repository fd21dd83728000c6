#include "core/device/scene_buffers.h"

#include "core/base/error.h"
#include "core/pack/kernel_id.h"

#include <algorithm>
#include <bit>

namespace tetrace {

namespace {

template <class Element>
SceneBuffer buffer_of(const char* name, const std::vector<Element>& array)
{
    return {name, std::as_bytes(std::span(array))};
}

[[noreturn]] void reject(const char* name, std::uint64_t bytes, std::uint64_t limit, const char* more)
{
    throw Error(ErrorKind::unsupported, "the scene's array '" + std::string(name) + "' has " + std::to_string(bytes) +
                                            " bytes, the device's largest buffer " + std::to_string(limit) + more);
}

} // namespace

std::span<const SceneArray> scene_arrays(Layout layout)
{
    using uint = std::uint32_t;
    using uint4 = Quad;
#define SCENE_ARRAY(element, name, member, binding) {#name, binding, sizeof(element)},
    static constexpr SceneArray cdt[] = {
#include "kernels/layouts/cdt_arrays.h"
    };
    static constexpr SceneArray compact[] = {
#include "kernels/layouts/compact_arrays.h"
    };
    static constexpr SceneArray bvh[] = {
#include "kernels/bvh/bvh_arrays.h"
    };
#undef SCENE_ARRAY
    switch (traits_of(layout).family) {
    case Family::cdt: return cdt;
    case Family::compact: return compact;
    case Family::bvh: return bvh;
    case Family::foreign: break;
    }
    return {};
}

std::vector<SceneBuffer> scene_buffers(const PackedScene& scene)
{
    std::vector<SceneBuffer> buffers;
#define SCENE_ARRAY(element, name, member, binding)                                                                    \
    buffers.resize(std::max<std::size_t>(buffers.size(), binding + 1));                                                \
    buffers[binding] = buffer_of(#member, scene.member);
    switch (traits_of(scene.layout).family) {
    case Family::cdt:
#include "kernels/layouts/cdt_arrays.h"
        break;
    case Family::compact:
#include "kernels/layouts/compact_arrays.h"
        break;
    case Family::bvh:
#include "kernels/bvh/bvh_arrays.h"
        break;
    case Family::foreign: break;
    }
#undef SCENE_ARRAY
    return buffers;
}

std::span<const std::byte> TetParts::part(std::span<const std::byte> tets, unsigned index) const
{
    if (count == 1) return tets;
    const std::size_t size = std::size_t{1} << log2_bytes;
    const std::size_t begin = std::min(tets.size(), index * size);
    return tets.subspan(begin, std::min(size, tets.size() - begin));
}

TetParts tet_parts(const PackedScene& scene, std::uint64_t max_buffer_bytes)
{
    if (max_buffer_bytes == 0) return {};
    const auto buffers = scene_buffers(scene);
    const bool can_be_cut = structure_of(scene.layout) == Structure::cdt; // the tets, binding 0
    for (std::size_t binding = can_be_cut ? 1 : 0; binding < buffers.size(); ++binding)
        if (buffers[binding].bytes.size() > max_buffer_bytes)
            reject(buffers[binding].name, buffers[binding].bytes.size(), max_buffer_bytes, "");
    const std::uint64_t bytes = buffers[0].bytes.size();
    if (bytes <= max_buffer_bytes) return {};
    TetParts parts;
    parts.log2_bytes = static_cast<unsigned>(std::bit_width(max_buffer_bytes)) - 1;
    const std::uint64_t count = (bytes + (std::uint64_t{1} << parts.log2_bytes) - 1) >> parts.log2_bytes;
    if (parts.log2_bytes < 4 || count > MAX_TET_PARTS)
        reject(buffers[0].name, bytes, max_buffer_bytes, "; eight such buffers are not enough");
    parts.count = static_cast<unsigned>(count);
    return parts;
}

} // namespace tetrace
