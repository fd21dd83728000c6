#include "scenes/mesh_files.h"

#include "core/base/error.h"
#include "core/base/files.h"
#include "core/base/hash.h"
#include "scenes/cache.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

namespace tetrace {

namespace {

using Archive = std::unique_ptr<::archive, decltype(&archive_read_free)>;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& member, std::string_view reason)
{
    throw Error(ErrorKind::invalid_input, fmt::format("unpacking {} from {}: {}; reinstall the package of the archive",
                                                      member, path.string(), reason));
}

std::string_view reason_of(::archive* archive)
{
    const char* reason = archive_error_string(archive);
    return reason != nullptr ? reason : "damaged";
}

Archive open_archive(const std::filesystem::path& path, const std::string& member)
{
    Archive archive(archive_read_new(), &archive_read_free);
    if (archive == nullptr) fail(path, member, "not enough memory");
    archive_read_support_filter_gzip(archive.get());
    archive_read_support_format_tar(archive.get());
    if (archive_read_open_filename(archive.get(), path.c_str(), 64 * 1024) != ARCHIVE_OK)
        fail(path, member, reason_of(archive.get()));
    return archive;
}

bool is_member(archive_entry* entry, const std::string& member)
{
    const char* name = archive_entry_pathname(entry);
    if (name == nullptr) return false;
    const std::string_view path = name;
    return path == member || (path.starts_with("./") && path.substr(2) == member);
}

} // namespace

std::vector<std::byte> read_archive_member(const std::filesystem::path& path, const std::string& member,
                                           std::size_t max_bytes)
{
    const Archive archive = open_archive(path, member);
    archive_entry* entry = nullptr;
    int status = ARCHIVE_OK;
    while ((status = archive_read_next_header(archive.get(), &entry)) == ARCHIVE_OK || status == ARCHIVE_WARN)
        if (is_member(entry, member)) break;
    if (status == ARCHIVE_EOF) fail(path, member, "the archive lacks this member");
    if (status != ARCHIVE_OK && status != ARCHIVE_WARN) fail(path, member, reason_of(archive.get()));
    if (archive_entry_filetype(entry) != AE_IFREG) fail(path, member, "it is not a regular file");
    const la_int64_t size = archive_entry_size(entry);
    if (size < 0 || static_cast<std::uint64_t>(size) > max_bytes)
        fail(path, member, fmt::format("it has {} bytes, at most {} are accepted", size, max_bytes));

    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    std::size_t filled = 0;
    while (filled < bytes.size()) {
        const la_ssize_t got = archive_read_data(archive.get(), bytes.data() + filled, bytes.size() - filled);
        if (got < 0) fail(path, member, reason_of(archive.get()));
        if (got == 0) fail(path, member, "the archive ends within it");
        filled += static_cast<std::size_t>(got);
    }
    return bytes;
}

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path)
{
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension;
}

bool may_have_tets(const fs::path& mesh)
{
    constexpr std::array<std::string_view, 6> of_surfaces = {".ply", ".obj", ".off", ".stl", ".glb", ".gltf"};
    return std::ranges::find(of_surfaces, lower_extension(mesh)) == of_surfaces.end();
}

bool is_stream(const fs::path& path)
{
    std::error_code ignored; // what cannot be looked at is not there for us
    const fs::file_status status = fs::status(path, ignored);
    if (fs::is_fifo(status) || fs::is_socket(status)) return true;
    const std::string name = fs::absolute(path, ignored).lexically_normal().string();
    return fs::is_regular_file(status) && (name.starts_with("/dev/") || name.starts_with("/proc/"));
}

fs::path spooled_mesh(const fs::path& stream)
{
    static std::map<std::string, fs::path> copies;
    fs::path& copy = copies[stream.string()];
    if (!copy.empty()) return copy;
    const std::optional<std::string> bytes = file_bytes(stream);
    if (!bytes || bytes->empty())
        throw Error(ErrorKind::invalid_input,
                    fmt::format("reading mesh {}: {}", stream.string(),
                                bytes ? "it is empty: write a mesh to it, once" : std::strerror(errno)));
    const fs::path target = cached_mesh_path(stream.filename().string(), hash_of(*bytes));
    AtomicFile file(target);
    file.write(std::as_bytes(std::span(*bytes)));
    file.commit();
    return copy = target;
}

namespace {

constexpr std::size_t max_member = std::size_t{256} << 20;
// The same place in Debian 12 (libcgal-demo 5.5.1) and 13 (6.0.1).
constexpr const char* package_archive = "usr/share/doc/libcgal-dev/data.tar.gz";

bool is_file(const fs::path& path)
{
    std::error_code ignored; // whatever cannot be looked at is not there for us
    return fs::is_regular_file(path, ignored);
}

/// Looks in one folder: a mesh by one of its names, else an archive; true where something was found.
bool locate_in(const fs::path& folder, const CatalogueEntry& entry, MeshLocation& found)
{
    for (const std::string& name : entry.file_names)
        if (found.file.empty() && is_file(folder / name)) found.file = folder / name;
    if (found.file.empty() && is_file(folder / entry.archive_member)) found.file = folder / entry.archive_member;
    for (const fs::path& archive : {folder / "data.tar.gz", folder / package_archive})
        if (found.file.empty() && found.archive.empty() && is_file(archive)) found.archive = archive;
    return !found.file.empty() || !found.archive.empty();
}

std::string how_to_get(const CatalogueEntry& entry, const std::string& looked)
{
    return fmt::format(
        "scene {}: its mesh is not here ({}). Install Debian's package libcgal-demo; where documentation is "
        "left out on installing, as in slim images, unpack it: `apt-get download libcgal-demo && dpkg -x "
        "libcgal-demo_*.deb meshes && export TETRACE_MESHES=$PWD/meshes`. Or set TETRACE_MESHES to a folder "
        "that holds {}",
        entry.name, looked, fmt::join(entry.file_names, " or "));
}

fs::path unpacked(const CatalogueEntry& entry, const fs::path& archive)
{
    // A newer package has other bytes or another date, and gets a folder of its own.
    const auto date = fs::last_write_time(archive).time_since_epoch().count();
    const std::string key = fmt::format("{} {} {}", archive.string(), fs::file_size(archive), date);
    fs::path target = cached_mesh_path(fs::path(entry.archive_member).filename().string(), hash_of(key));
    if (is_file(target)) return target;
    const std::vector<std::byte> bytes = read_archive_member(archive, entry.archive_member, max_member);
    AtomicFile file(target);
    file.write(bytes);
    file.commit();
    return target;
}

/// 9 significant digits restore each float bit for bit.
std::string off_text(const TriangleMesh& mesh)
{
    std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
    for (const Float3& vertex : mesh.vertices)
        fmt::format_to(std::back_inserter(text), "{:.9g} {:.9g} {:.9g}\n", vertex.x, vertex.y, vertex.z);
    for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles)
        fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", triangle[0], triangle[1], triangle[2]);
    return text;
}

std::string mesh_text(const ProceduralScene& scene)
{
    const ProceduralMesh& generator = *scene.entry.procedural;
    if (generator.make_points != nullptr)
        return generator.make_points(scene.triangles.value_or(generator.usual_points));
    return off_text(scene.triangles ? generator.make(*scene.triangles) : generator.usual());
}

} // namespace

MeshLocation locate_mesh(const CatalogueEntry& entry)
{
    MeshLocation found;
    const char* given = std::getenv("TETRACE_MESHES");
    std::string looked = "TETRACE_MESHES is not set";
    if (given != nullptr && *given != '\0') {
        std::error_code ignored; // what cannot be looked at is not a folder for us
        if (!fs::is_directory(given, ignored)) {
            found.reason = how_to_get(entry, fmt::format("TETRACE_MESHES is {}, which is not a folder", given));
            return found;
        }
        if (locate_in(given, entry, found)) return found;
        looked = fmt::format("TETRACE_MESHES is {}, which does not hold it", given);
    }
    const fs::path installed = fs::path("/") / package_archive;
    if (is_file(installed))
        found.archive = installed;
    else
        found.reason = how_to_get(entry, fmt::format("no {}, and {}", installed.string(), looked));
    return found;
}

std::uint64_t hash_of_mesh_file(const ProceduralScene& scene)
{
    return hash_of(mesh_text(scene));
}

fs::path mesh_file(const ProceduralScene& scene)
{
    const std::string text = mesh_text(scene);
    const char* const ending = scene.entry.procedural->make_points == nullptr ? ".off" : ".node";
    fs::path target = cached_mesh_path(scene.entry.name + ending, hash_of(text));
    if (file_bytes(target) == text) return target;
    AtomicFile file(target);
    file.write(std::as_bytes(std::span(text)));
    file.commit();
    return target;
}

fs::path mesh_file(const CatalogueEntry& entry)
{
    if (entry.procedural) return mesh_file(ProceduralScene{entry, {}});
    const MeshLocation found = locate_mesh(entry);
    if (!found.reason.empty()) throw Error(ErrorKind::missing, found.reason);
    return found.file.empty() ? unpacked(entry, found.archive) : found.file;
}

} // namespace tetrace
