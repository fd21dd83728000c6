// The `.tet` format, little endian throughout, no padding between parts:
//   FileHeader | SectionEntry per section | checksum of both (8 bytes) | the sections, in the table's order
// Every byte is under a checksum, and header and table state each size twice: no allocation rests on one number.
#include "scenes/scene_file.h"

#include "core/base/error.h"
#include "core/base/exact.h"
#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/mesh/entry_grid.h"
#include "scenes/scene_information.h"

#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <new>
#include <span>
#include <string_view>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace tetrace {

static_assert(std::endian::native == std::endian::little, ".tet files are little endian and are not swapped");
static_assert(sizeof(float) == 4 && sizeof(Float3) == 12 && sizeof(Tet) == 48, "written as they lie in memory");

namespace {

// As in PNG: the first byte is not a text, the line ends catch transfers in text mode.
constexpr std::array<char, 8> magic = {'\x89', 'T', 'E', 'T', '\r', '\n', '\x1a', '\n'};

struct FileHeader {
    std::array<char, 8> magic;
    std::uint32_t version;
    std::uint32_t sections;
    std::uint64_t bytes; ///< of the whole file
    std::uint64_t scene_hash;
};
struct SectionEntry {
    std::array<char, 16> name; ///< padded with zeros
    std::uint64_t offset, bytes, elements, checksum;
};
static_assert(sizeof(FileHeader) == 32 && sizeof(SectionEntry) == 48, "written as they lie in memory");

struct SectionKind {
    std::string_view name;
    std::size_t element_bytes;
};
constexpr std::array<SectionKind, 7> kinds = {{{"information", 1},
                                               {"mesh vertices", sizeof(Float3)},
                                               {"triangles", 3 * sizeof(std::uint32_t)},
                                               {"origins", sizeof(std::uint32_t)},
                                               {"tet vertices", sizeof(Float3)},
                                               {"tets", sizeof(Tet)},
                                               {"domain lines", sizeof(float)}}};
enum SectionId : std::size_t { information, mesh_vertices, triangles, origins, tet_vertices, tets, domain_lines };

constexpr std::uint32_t max_divisions = 128; // those of the finest cubes; the entry grid grows with their square

using Table = std::array<SectionEntry, kinds.size()>;
constexpr std::size_t header_bytes = sizeof(FileHeader) + sizeof(Table) + sizeof(std::uint64_t);

std::uint64_t header_checksum(const FileHeader& header, const Table& table)
{
    return hash_of(table, hash_bytes(std::as_bytes(std::span(&header, 1))));
}

std::vector<float> joined_lines(const Domain& domain)
{
    std::vector<float> lines;
    for (const std::vector<float>& axis : domain.lines)
        lines.insert(lines.end(), axis.begin(), axis.end());
    return lines;
}

/// One file being read; every failure names it, the section and the reason.
class SceneReader {
public:
    SceneReader(const std::filesystem::path& path, SceneFileKind kind);
    ~SceneReader() { ::close(file_); }
    SceneReader(const SceneReader&) = delete;
    SceneReader& operator=(const SceneReader&) = delete;

    [[nodiscard]] Scene read();

private:
    void read_header();
    void check_table() const;
    template <class Element>
    [[nodiscard]] std::vector<Element> read_section(SectionId id);
    void set_lines(Domain& domain, const std::vector<float>& lines) const;
    void check_mesh(const Scene& scene) const;
    void check_domain(const Scene& scene) const;
    void check_coordinates(SectionId id, const std::vector<Float3>& points) const;
    void read_bytes(std::span<std::byte> bytes, std::string_view section) const;
    [[noreturn]] void refuse(std::string_view section, std::string_view reason) const;

    std::filesystem::path path_;
    SceneFileKind kind_;
    int file_ = -1;
    std::uint64_t file_bytes_ = 0;
    FileHeader header_{};
    Table table_{};
};

SceneReader::SceneReader(const std::filesystem::path& path, SceneFileKind kind) : path_(path), kind_(kind)
{
    // Without O_NONBLOCK a named pipe would hang here until somebody writes to it.
    file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file_ < 0 && (errno == ENOENT || errno == ENOTDIR))
        throw Error(ErrorKind::missing, fmt::format("reading scene {}: the file does not exist", path.string()));
    if (file_ < 0) refuse("file", std::strerror(errno));
    struct stat status {};
    const bool regular = ::fstat(file_, &status) == 0 && S_ISREG(status.st_mode);
    if (!regular) {
        ::close(file_); // the destructor is not run if a constructor throws
        refuse("file", "it is not a regular file");
    }
    file_bytes_ = static_cast<std::uint64_t>(status.st_size);
}

void SceneReader::refuse(std::string_view section, std::string_view reason) const
{
    throw Error(ErrorKind::invalid_input,
                fmt::format("reading scene {}: section `{}`: {}; make the file again with `tetrace build`",
                            path_.string(), section, reason));
}

void SceneReader::read_bytes(std::span<std::byte> bytes, std::string_view section) const
{
    while (!bytes.empty()) {
        const ssize_t count = ::read(file_, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) refuse(section, std::strerror(errno));
        if (count == 0) refuse(section, "the file ends before it does (truncated?)");
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
}

void SceneReader::read_header()
{
    read_bytes(std::as_writable_bytes(std::span(&header_, 1)), "header");
    if (header_.magic != magic) refuse("header", "this is not a .tet file (its first 8 bytes differ)");
    if (header_.version != scene_file_version)
        refuse("header", fmt::format("written by version {} of the format, this program reads version {}",
                                     header_.version, scene_file_version));
    read_bytes(std::as_writable_bytes(std::span(table_)), "table");
    std::uint64_t checksum = 0;
    read_bytes(std::as_writable_bytes(std::span(&checksum, 1)), "table");
    if (checksum != header_checksum(header_, table_)) refuse("header", "its checksum does not match (damaged)");
}

void SceneReader::check_table() const
{
    if (header_.sections != kinds.size())
        refuse("header", fmt::format("it states {} sections, the format has {}", header_.sections, kinds.size()));
    if (header_.bytes != file_bytes_)
        refuse("header", fmt::format("the file has {} bytes and should have {}", file_bytes_, header_.bytes));
    std::uint64_t end = header_bytes;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        const SectionEntry& entry = table_[i];
        std::array<char, 16> name{};
        kinds[i].name.copy(name.data(), name.size());
        if (entry.name != name) refuse(kinds[i].name, "the table names another section in its place");
        // end <= file_bytes_ holds from section to section, so nothing here can overflow.
        if (entry.offset != end || entry.bytes > file_bytes_ - end) refuse(kinds[i].name, "it is outside the file");
        if (entry.bytes % kinds[i].element_bytes != 0 || entry.bytes / kinds[i].element_bytes != entry.elements)
            refuse(kinds[i].name, "its bytes and its number of elements do not agree");
        const bool is_of_tets = i == tet_vertices || i == tets;
        const bool should_be_empty = kind_ == SceneFileKind::mesh_only && is_of_tets;
        if (entry.elements == 0 && i != origins && !should_be_empty)
            refuse(kinds[i].name, "it is empty; every scene has some");
        if (entry.elements != 0 && should_be_empty) refuse(kinds[i].name, "it is not empty, as it should be");
        end += entry.bytes;
    }
    if (end != file_bytes_) refuse("file", fmt::format("{} bytes follow the last section", file_bytes_ - end));
    if (table_[origins].elements != 0 && table_[origins].elements != table_[triangles].elements)
        refuse("origins",
               fmt::format("{} of them for {} triangles", table_[origins].elements, table_[triangles].elements));
    if (table_[tets].elements > MAX_TETS) refuse("tets", fmt::format("more than {} tets", MAX_TETS));
}

template <class Element>
std::vector<Element> SceneReader::read_section(SectionId id)
{
    const SectionEntry& entry = table_[id];
    std::vector<Element> elements(static_cast<std::size_t>(entry.elements));
    read_bytes(std::as_writable_bytes(std::span(elements)), kinds[id].name);
    if (hash_of(elements) != entry.checksum) refuse(kinds[id].name, "its checksum does not match (damaged)");
    return elements;
}

void SceneReader::set_lines(Domain& domain, const std::vector<float>& lines) const
{
    const std::uint64_t per_axis = std::uint64_t{domain.divisions} + 1;
    if (domain.divisions == 0 || domain.divisions > max_divisions || lines.size() != 3 * per_axis)
        refuse("domain lines", fmt::format("{} lines for {} divisions", lines.size(), domain.divisions));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto first = lines.begin() + static_cast<std::ptrdiff_t>(axis * per_axis);
        domain.lines[axis].assign(first, first + static_cast<std::ptrdiff_t>(per_axis));
        for (std::size_t i = 0; i < per_axis; ++i) {
            const bool ascending = i == 0 || domain.lines[axis][i - 1] < domain.lines[axis][i];
            if (!std::isfinite(domain.lines[axis][i]) || !ascending)
                refuse("domain lines", fmt::format("line {} of axis {} is not above the one before", i, axis));
        }
    }
}

void SceneReader::check_coordinates(SectionId id, const std::vector<Float3>& points) const
{
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Float3 point = points[i];
        // Also what keeps NaN and infinity from the exact tests that follow.
        for (const float value : {point.x, point.y, point.z})
            if (!(std::abs(value) <= 64.0f) || snap_to_grid(value) != value)
                refuse(
                    kinds[id].name,
                    fmt::format("vertex {} has the coordinate {}, larger than 64 or off the grid of 2^-40", i, value));
    }
}

void SceneReader::check_mesh(const Scene& scene) const
{
    check_coordinates(mesh_vertices, scene.mesh.vertices);
    check_coordinates(tet_vertices, scene.tets.vertices);
    for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i)
        for (const std::uint32_t vertex : scene.mesh.triangles[i])
            if (vertex >= scene.mesh.vertices.size())
                refuse("triangles",
                       fmt::format("triangle {} names vertex {} of {}", i, vertex, scene.mesh.vertices.size()));
    if (scene.source_tets.size() > scene.tets.tets.size())
        refuse("information", fmt::format("it has the numbers of {} tets, and there are {}", scene.source_tets.size(),
                                          scene.tets.tets.size()));
    if (kind_ == SceneFileKind::whole)
        if (const auto defect = find_defect(scene.tets, scene.mesh.triangles.size())) refuse("tets", defect->what);
    if (scene_hash(scene) != header_.scene_hash) refuse("header", "the scene's hash is not the one that it states");
}

void SceneReader::check_domain(const Scene& scene) const
{
    const Double3 size = to_double(scene.domain.high()) - to_double(scene.domain.low());
    if (const auto gap = find_gap(scene.tets, scene.mesh, size)) refuse("tets", gap->what);
    std::string weak;
    try {
        weak = find_weak_side(scene, make_entry_grid(scene.domain, scene.tets));
    } catch (const Error& error) {
        refuse("domain lines", error.what());
    }
    if (!weak.empty()) refuse("domain lines", weak);
}

Scene SceneReader::read()
{
    read_header();
    check_table();
    Scene scene;
    if (!unpack_information(read_section<char>(information), scene)) refuse("information", "its fields cannot be read");
    scene.mesh.vertices = read_section<Float3>(mesh_vertices);
    scene.mesh.triangles = read_section<std::array<std::uint32_t, 3>>(triangles);
    scene.origins = read_section<std::uint32_t>(origins);
    scene.tets.vertices = read_section<Float3>(tet_vertices);
    scene.tets.tets = read_section<Tet>(tets);
    set_lines(scene.domain, read_section<float>(domain_lines));
    check_mesh(scene);
    if (kind_ == SceneFileKind::whole) check_domain(scene);
    return scene;
}

} // namespace

void write_scene(const std::filesystem::path& path, const Scene& scene)
{
    const std::vector<char> info = pack_information(scene);
    const std::vector<float> lines = joined_lines(scene.domain);
    const std::array<std::span<const std::byte>, kinds.size()> sections = {
        std::as_bytes(std::span(info)),
        std::as_bytes(std::span(scene.mesh.vertices)),
        std::as_bytes(std::span(scene.mesh.triangles)),
        std::as_bytes(std::span(scene.origins)),
        std::as_bytes(std::span(scene.tets.vertices)),
        std::as_bytes(std::span(scene.tets.tets)),
        std::as_bytes(std::span(lines))};

    Table table{};
    std::uint64_t end = header_bytes;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        kinds[i].name.copy(table[i].name.data(), table[i].name.size());
        table[i].offset = end;
        table[i].bytes = sections[i].size();
        table[i].elements = sections[i].size() / kinds[i].element_bytes;
        table[i].checksum = hash_bytes(sections[i]);
        end += sections[i].size();
    }
    const FileHeader header = {magic, scene_file_version, kinds.size(), end, scene_hash(scene)};
    const std::uint64_t checksum = header_checksum(header, table);

    AtomicFile file(path);
    file.write(std::as_bytes(std::span(&header, 1)));
    file.write(std::as_bytes(std::span(table)));
    file.write(std::as_bytes(std::span(&checksum, 1)));
    for (const std::span<const std::byte> section : sections)
        file.write(section);
    file.commit();
}

Scene read_scene(const std::filesystem::path& path, SceneFileKind kind)
{
    try {
        return SceneReader(path, kind).read();
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::unsupported, fmt::format("reading scene {}: not enough memory for it", path.string()));
    }
}

} // namespace tetrace
