// Meshes, scenes and archives.
#include "core/base/hash.h"
#include "core/mesh/scene.h"
#include "scenes/builder/mesh_reader.h"
#include "scenes/mesh_files.h"
#include "scenes/scene_file.h"
#include "tests/fuzz/memory_file.h"
#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

namespace tetrace::fuzz {

namespace {

template <const char* const& Name>
void read_as(std::string_view bytes)
{
    may_refuse([&] { (void)parse_mesh(Name, bytes); });
}

constexpr const char *ply = "mesh.ply", *obj = "mesh.obj", *off = "mesh.off", *stl = "mesh.stl", *gltf = "mesh.glb",
                     *medit = "mesh.mesh", *gmsh = "mesh.msh", *vtk = "mesh.vtk", *vtu = "mesh.vtu";

// The places of the .tet format (scenes/scene_file.cpp): a header of 32 bytes, 7 entries of 48, a checksum.
constexpr std::size_t header_bytes = 32, entry_bytes = 48, sections = 7;
constexpr std::size_t table_end = header_bytes + sections * entry_bytes;

template <class Value>
Value value_at(const std::string& bytes, std::size_t place)
{
    Value value{};
    std::memcpy(&value, bytes.data() + place, sizeof value);
    return value;
}
template <class Value>
void put_at(std::string& bytes, std::size_t place, const Value& value)
{
    std::memcpy(bytes.data() + place, &value, sizeof value);
}

std::span<const std::byte> part(const std::string& bytes, std::size_t place, std::size_t count)
{
    return std::as_bytes(std::span(bytes)).subspan(place, count);
}

/// The file's bytes with sizes and checksums as a writer would have put them: otherwise nothing else is ever read.
std::string with_checksums(std::string bytes)
{
    bytes.resize(std::max(bytes.size(), table_end + 8));
    put_at(bytes, 16, std::uint64_t{bytes.size()});
    for (std::size_t i = 0; i < sections; ++i) {
        const std::size_t entry = header_bytes + i * entry_bytes;
        const auto offset = value_at<std::uint64_t>(bytes, entry + 16),
                   size = value_at<std::uint64_t>(bytes, entry + 24);
        if (offset > bytes.size() || size > bytes.size() - offset) continue;
        put_at(bytes, entry + 40, hash_bytes(part(bytes, offset, size)));
    }
    struct Table {
        std::array<std::byte, table_end - header_bytes> bytes;
    };
    put_at(bytes, table_end,
           hash_of(value_at<Table>(bytes, header_bytes).bytes, hash_bytes(part(bytes, 0, header_bytes))));
    return bytes;
}

/// The first byte says whether the checksums are made right.
void read_tet(std::string_view bytes)
{
    if (bytes.empty()) return;
    const std::string given(bytes.substr(1));
    const MemoryFile file(bytes[0] % 4 == 0 ? given : with_checksums(given));
    may_refuse([&] { (void)read_scene(file.path()); });
}

void read_archive(std::string_view bytes)
{
    const MemoryFile file(bytes);
    for (const char* const member : {"data/a.off", "b"})
        may_refuse([&] { (void)read_archive_member(file.path(), member, 1 << 20); });
}

constexpr std::array<Target, 11> targets = {{{"ply", read_as<ply>},
                                             {"obj", read_as<obj>},
                                             {"off", read_as<off>},
                                             {"stl", read_as<stl>},
                                             {"gltf", read_as<gltf>},
                                             {"medit", read_as<medit>},
                                             {"gmsh", read_as<gmsh>},
                                             {"vtk", read_as<vtk>},
                                             {"vtu", read_as<vtu>},
                                             {"tet", read_tet},
                                             {"archive", read_archive}}};

} // namespace

std::span<const Target> file_targets()
{
    return targets;
}

} // namespace tetrace::fuzz
