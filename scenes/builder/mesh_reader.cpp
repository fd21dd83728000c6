#include "scenes/builder/mesh_reader.h"

#include "core/base/files.h"
#include "core/base/hash.h"
#include "scenes/builder/mesh_source.h"
#include "scenes/gltf_buffers.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

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
    if (!bytes.starts_with(mark)) return bytes;
    const std::string_view text = bytes.substr(mark.size());
    const bool is_text = lower_case(text.substr(0, 5)) == "solid" && text.find('\0') == std::string_view::npos;
    return extension != ".stl" || is_text ? text : bytes;
}

bool is_utf_16(std::string_view bytes, const std::string& extension)
{
    if (extension != ".stl") return bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF");
    const std::string begin = lower_case(bytes.substr(0, 12));
    return begin == std::string_view("\xFF\xFEs\0o\0l\0i\0d\0", 12) ||
           begin == std::string_view("\xFE\xFF\0s\0o\0l\0i\0d", 12);
}

// OFF may lack its keyword, and then begins with its numbers of vertices, faces and perhaps edges.
bool begins_as_off(std::string_view bytes)
{
    std::vector<std::string_view> words;
    if (!LineReader(bytes).next(words)) return false;
    const auto is_integer = [](std::string_view word) { return parse_integer(word).has_value(); };
    const bool is_counts = words.size() == 2 || words.size() == 3;
    return (is_counts && std::all_of(words.begin(), words.end(), is_integer)) ||
           lower_case(words.front()).find("off") != std::string::npos;
}

// Of a name without extension, as a pipe has. OBJ has nothing that it begins with.
std::string format_of(std::string_view bytes)
{
    const std::string begin = lower_case(bytes.substr(0, bytes.find_first_of("\r\n\0", 0, 3)).substr(0, 80));
    if (begin.starts_with("ply")) return ".ply";
    if (begin.starts_with("gltf")) return ".glb";
    if (begin.starts_with("{")) return ".gltf";
    if (begin.starts_with("meshversionformatted")) return ".mesh";
    if (begin.starts_with("$meshformat")) return ".msh";
    if (begin.starts_with("# vtk")) return ".vtk";
    if (begin.starts_with("<?xml") || begin.starts_with("<vtkfile")) return ".vtu";
    if (begin.starts_with("solid") || bytes.substr(0, 200).find('\0') != std::string_view::npos) return ".stl";
    return begins_as_off(bytes) ? ".off" : ".obj";
}

void read_as(const std::string& extension, MeshSource& source)
{
    if (extension == ".ply") return read_ply(source);
    if (extension == ".obj") return read_obj(source);
    if (extension == ".off") return read_off(source);
    if (extension == ".stl") return read_stl(source);
    if (extension == ".glb" || extension == ".gltf") return read_gltf(source);
    if (extension == ".mesh") return read_medit(source);
    if (extension == ".msh") return read_gmsh(source);
    if (extension == ".ele") return read_tetgen(source);
    if (extension == ".node") return read_points(source);
    if (extension == ".vtk") return read_vtk(source);
    if (extension == ".vtu") return read_vtu(source);
    source.fail("name", "the format '" + extension + "' is not known",
                "use a file with the extension .ply, .obj, .off, .stl, .glb or .gltf, or one of tets: .mesh, .msh, "
                ".ele, .vtk or .vtu; meshio converts others to them: meshio convert FILE NEW.mesh");
}

MeshSoup parse(const std::filesystem::path& path, std::string_view bytes, const std::filesystem::path& folder)
{
    std::string extension = lower_case(path.extension().string());
    MeshSource source(path.string(), without_byte_order_mark(bytes, extension), folder);
    if (bytes.empty()) source.fail("file", "it is empty");
    if (bytes.starts_with("\x1F\x8B\x08"))
        source.fail("file", "it is compressed by gzip",
                    "unpack it: zcat FILE > NEW, or zcat FILE | tetrace build --scene /dev/stdin");
    if (is_utf_16(bytes, extension))
        source.fail("file", "its text is UTF-16", "convert it: iconv -f UTF-16 -t UTF-8 FILE > NEW");
    if (extension.empty()) extension = format_of(source.bytes());
    read_as(extension, source);
    return source.finish();
}

} // namespace

MeshSoup read_mesh(const std::filesystem::path& given)
{
    std::filesystem::path path = given;
    std::error_code ignored; // then the points have no tets
    if (lower_case(path.extension().string()) == ".node")
        if (const auto tets = std::filesystem::path(path).replace_extension(".ele");
            std::filesystem::exists(tets, ignored))
            path = tets;
    const std::string bytes = read_bytes(path);
    const std::string extension = lower_case(path.extension().string());
    const bool has_other_files = extension == ".gltf" || extension == ".ele";
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    MeshSoup soup = parse(path, bytes, has_other_files ? folder : "");
    Hasher hasher;
    hasher.add(std::as_bytes(std::span(bytes)));
    if (extension == ".gltf") add_gltf_buffers(hasher, path, bytes);
    if (extension == ".ele") add_file(hasher, std::filesystem::path(path).replace_extension(".node"));
    soup.source_hash = hasher.hash();
    return soup;
}

MeshSoup parse_mesh(const std::filesystem::path& path, std::string_view bytes)
{
    MeshSoup soup = parse(path, bytes, {});
    soup.source_hash = hash_bytes(std::as_bytes(std::span(bytes)));
    return soup;
}

} // namespace tetrace
