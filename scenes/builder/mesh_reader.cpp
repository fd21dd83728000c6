#include "scenes/builder/mesh_reader.h"

#include "core/base/files.h"
#include "core/base/hash.h"
#include "scenes/builder/mesh_source.h"

#include <cerrno>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

namespace tetrace {
namespace {

std::string read_bytes(const std::filesystem::path& path)
{
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored))
        throw Error(ErrorKind::missing, "reading " + path.string() + ": the file does not exist; check the path");
    if (std::filesystem::is_directory(path, ignored))
        throw Error(ErrorKind::invalid_input, "reading " + path.string() + ": it is a folder; name a mesh file");
    std::optional<std::string> bytes = file_bytes(path);
    if (!bytes)
        throw Error(ErrorKind::missing,
                    "reading " + path.string() + ": " + std::strerror(errno) + "; check its rights and its disk");
    return std::move(*bytes);
}

// Some editors put UTF-8's mark before text. A binary STL may begin with any bytes, and its offsets count from them.
std::string_view without_byte_order_mark(std::string_view bytes, const std::string& extension)
{
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    return bytes.starts_with(mark) && extension != ".stl" ? bytes.substr(mark.size()) : bytes;
}

void read_as(const std::string& extension, MeshSource& source)
{
    if (extension == ".ply") return read_ply(source);
    if (extension == ".obj") return read_obj(source);
    if (extension == ".off") return read_off(source);
    if (extension == ".stl") return read_stl(source);
    if (extension == ".glb" || extension == ".gltf") return read_gltf(source);
    source.fail("name", "the format '" + extension + "' is not known",
                "use a file with the extension .ply, .obj, .off, .stl, .glb or .gltf");
}

} // namespace

MeshSoup read_mesh(const std::filesystem::path& path)
{
    return parse_mesh(path, read_bytes(path));
}

MeshSoup parse_mesh(const std::filesystem::path& path, std::string_view bytes)
{
    const std::string extension = lower_case(path.extension().string());
    MeshSource source(path.string(), without_byte_order_mark(bytes, extension));
    if (bytes.empty()) source.fail("file", "it is empty");
    read_as(extension, source);
    MeshSoup& soup = source.soup();
    if (soup.mesh.vertices.empty())
        source.fail("mesh", "it lacks vertices", "export the mesh again, with its geometry");
    if (soup.mesh.triangles.empty())
        source.fail("mesh", "it lacks triangles", "a point cloud or a curve has no surface: reconstruct one first");
    soup.source_hash = hash_bytes(std::as_bytes(std::span(bytes)));
    return std::move(soup);
}

} // namespace tetrace
