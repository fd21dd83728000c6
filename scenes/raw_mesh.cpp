#include "scenes/raw_mesh.h"

#include "core/base/error.h"
#include "core/base/files.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <span>

namespace tetrace {

namespace {

using RawCounts = std::array<std::uint64_t, 2>; // of vertices and triangles; then these

} // namespace

void write_raw_mesh(const std::filesystem::path& path, const TriangleMesh& mesh)
{
    const RawCounts counts = {mesh.vertices.size(), mesh.triangles.size()};
    AtomicFile file(path);
    file.write(std::as_bytes(std::span(counts)));
    file.write(std::as_bytes(std::span(mesh.vertices)));
    file.write(std::as_bytes(std::span(mesh.triangles)));
    file.commit();
}

TriangleMesh read_raw_mesh(const std::filesystem::path& path)
{
    const std::string bytes = file_bytes(path).value_or("");
    RawCounts counts{};
    if (bytes.size() >= sizeof(counts)) std::memcpy(counts.data(), bytes.data(), sizeof(counts));
    constexpr std::size_t one = sizeof(Float3);
    static_assert(one == sizeof(TriangleMesh::triangles[0]), "both are three words");
    if (counts[0] + counts[1] != (bytes.size() - sizeof(counts)) / one)
        throw Error(ErrorKind::internal,
                    fmt::format("reading {}: it is not what tetrace-builder wrote", path.string()));
    TriangleMesh mesh;
    mesh.vertices.resize(counts[0]);
    mesh.triangles.resize(counts[1]);
    std::memcpy(mesh.vertices.data(), bytes.data() + sizeof(counts), one * counts[0]);
    std::memcpy(mesh.triangles.data(), bytes.data() + sizeof(counts) + one * counts[0], one * counts[1]);
    return mesh;
}

} // namespace tetrace
