// The stored form, before xz, little endian: u64 vertices of the mesh | u64 further vertices | these, 3 floats each |
// u64 tets | 4 vertices of each, u32.
#include "scenes/stored_tets.h"

#include "core/base/error.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <lzma.h>

namespace tetrace {

namespace {

using Corners = std::array<std::uint32_t, 4>;
using Triple = std::array<std::uint32_t, 3>;

constexpr std::uint64_t max_stored_bytes = std::uint64_t{1} << 30; // before compression

void put(std::vector<std::byte>& bytes, std::span<const std::byte> more)
{
    bytes.insert(bytes.end(), more.begin(), more.end());
}

void put_size(std::vector<std::byte>& bytes, std::uint64_t size)
{
    put(bytes, std::as_bytes(std::span(&size, 1)));
}

[[noreturn]] void refuse(const std::string& why)
{
    throw Error(ErrorKind::invalid_input, "reading stored tets: " + why);
}

/// Takes parts from the front of bytes that outlive it.
class StoredReader {
public:
    explicit StoredReader(std::span<const std::byte> bytes) : rest_(bytes) {}

    template <class Element>
    [[nodiscard]] std::vector<Element> take(std::uint64_t count)
    {
        if (count > rest_.size() / sizeof(Element)) refuse("they are cut off (damaged)");
        std::vector<Element> elements(static_cast<std::size_t>(count));
        const std::size_t bytes = elements.size() * sizeof(Element);
        if (bytes > 0) std::memcpy(elements.data(), rest_.data(), bytes);
        rest_ = rest_.subspan(bytes);
        return elements;
    }
    [[nodiscard]] std::uint64_t count() { return take<std::uint64_t>(1).front(); }
    [[nodiscard]] bool is_at_end() const { return rest_.empty(); }

private:
    std::span<const std::byte> rest_;
};

std::vector<std::byte> compressed(std::span<const std::byte> bytes)
{
    lzma_options_lzma options;
    lzma_lzma_preset(&options, 9 | LZMA_PRESET_EXTREME);
    options.lc = 0, options.lp = 2, options.pb = 4; // 16-byte records of words
    lzma_filter filters[] = {{LZMA_FILTER_LZMA2, &options}, {LZMA_VLI_UNKNOWN, nullptr}};
    std::vector<std::byte> stream(lzma_stream_buffer_bound(bytes.size()));
    std::size_t written = 0;
    const lzma_ret result = lzma_stream_buffer_encode(
        filters, LZMA_CHECK_CRC64, nullptr, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
        reinterpret_cast<unsigned char*>(stream.data()), &written, stream.size());
    if (result != LZMA_OK)
        throw Error(ErrorKind::internal, fmt::format("storing tets: xz says {}", static_cast<int>(result)));
    stream.resize(written);
    return stream;
}

std::vector<std::byte> decompressed(std::span<const std::byte> stream)
{
    lzma_stream coder = LZMA_STREAM_INIT;
    std::vector<std::byte> bytes;
    if (lzma_stream_decoder(&coder, std::numeric_limits<std::uint64_t>::max(), 0) != LZMA_OK)
        throw Error(ErrorKind::internal, "reading stored tets: xz does not start");
    coder.next_in = reinterpret_cast<const unsigned char*>(stream.data());
    coder.avail_in = stream.size();
    lzma_ret result = LZMA_OK;
    while (result == LZMA_OK && bytes.size() < max_stored_bytes) {
        const std::size_t done = bytes.size();
        bytes.resize(done + (std::size_t{1} << 22));
        coder.next_out = reinterpret_cast<unsigned char*>(bytes.data() + done);
        coder.avail_out = bytes.size() - done;
        result = lzma_code(&coder, LZMA_FINISH);
        bytes.resize(bytes.size() - coder.avail_out);
    }
    lzma_end(&coder);
    if (result != LZMA_STREAM_END) refuse(fmt::format("xz says {} (damaged)", static_cast<int>(result)));
    return bytes;
}

Triple corners_of(const Tet& tet, std::size_t face)
{
    Triple corners{};
    for (std::size_t i = 0, n = 0; i < 4; ++i)
        if (i != face) corners[n++] = tet.vertices[i];
    std::ranges::sort(corners);
    return corners;
}

/// A half-face by the vertices of its face.
struct Half {
    Triple corners;
    std::uint32_t half_face;

    friend auto operator<=>(const Half&, const Half&) = default;
};

/// Sets neighbours and occlusive faces, which the vertices determine.
void join(std::vector<Tet>& tets, const std::vector<Triple>& triangles)
{
    std::vector<Half> halves, occlusive;
    halves.reserve(4 * tets.size());
    for (std::uint32_t i = 0; i < tets.size(); ++i)
        for (std::uint32_t face = 0; face < 4; ++face)
            halves.push_back({corners_of(tets[i], face), make_half_face(i, face)});
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        Triple corners = triangles[i];
        std::ranges::sort(corners);
        occlusive.push_back({corners, i});
    }
    std::ranges::sort(halves);
    std::ranges::sort(occlusive);
    for (std::size_t i = 0; i < halves.size(); ++i) {
        const auto [corners, half_face] = halves[i];
        Tet& tet = tets[half_face_tet(half_face)];
        const std::uint32_t face = half_face_index(half_face);
        const auto is_other = [&, &corners = corners](std::size_t at) {
            return at < halves.size() && halves[at].corners == corners;
        };
        tet.neighbours[face] = i > 0 && is_other(i - 1) ? halves[i - 1].half_face
                               : is_other(i + 1)        ? halves[i + 1].half_face
                                                        : NO_HALF_FACE;
        const auto found = std::ranges::lower_bound(occlusive, corners, {}, &Half::corners);
        tet.faces[face] =
            found != occlusive.end() && found->corners == corners ? found->half_face : std::uint32_t{FREE_FACE};
    }
}

} // namespace

std::vector<std::byte> store_tets(const Scene& scene)
{
    const auto& vertices = scene.mesh.vertices;
    const auto& all = scene.tets.vertices;
    if (all.size() < vertices.size() || !std::equal(vertices.begin(), vertices.end(), all.begin()))
        throw Error(ErrorKind::unsupported, "storing tets: their first vertices are not those of the mesh");
    std::vector<std::byte> bytes;
    put_size(bytes, vertices.size());
    put_size(bytes, all.size() - vertices.size());
    put(bytes, std::as_bytes(std::span(all).subspan(vertices.size())));
    put_size(bytes, scene.tets.tets.size());
    for (const Tet& tet : scene.tets.tets)
        put(bytes, std::as_bytes(std::span(tet.vertices)));
    std::vector<std::byte> stored = compressed(bytes);
    if (with_stored_tets(scene, stored).tets != scene.tets)
        throw Error(ErrorKind::unsupported, "storing tets: their vertices do not determine their occlusive faces");
    return stored;
}

Scene with_stored_tets(const Scene& placed, std::span<const std::byte> stored)
{
    const std::vector<std::byte> bytes = decompressed(stored);
    StoredReader reader(bytes);
    Scene scene = placed;
    if (reader.count() != scene.mesh.vertices.size()) refuse("they are of another mesh");
    scene.tets.vertices = scene.mesh.vertices;
    const auto further = reader.take<Float3>(reader.count());
    scene.tets.vertices.insert(scene.tets.vertices.end(), further.begin(), further.end());
    const auto tets = reader.take<Corners>(reader.count());
    if (!reader.is_at_end() || tets.size() > MAX_TETS) refuse("bytes follow the last tet (damaged)");
    scene.tets.tets.clear();
    for (const Corners& corners : tets) {
        if (std::ranges::max(corners) >= scene.tets.vertices.size()) refuse("a tet has a vertex that is missing");
        scene.tets.tets.push_back({corners, {}, {}});
    }
    join(scene.tets.tets, scene.mesh.triangles);
    return scene;
}

} // namespace tetrace
