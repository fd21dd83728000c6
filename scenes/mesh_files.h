#pragma once

#include "scenes/catalogue.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tetrace {

/// Reads one member of a gzipped tar archive into memory.
/// Throws Error{invalid_input} naming archive and member where the member is missing, is not a regular file or is
/// larger than max_bytes, or if the archive is damaged.
[[nodiscard]] std::vector<std::byte> read_archive_member(const std::filesystem::path& archive,
                                                         const std::string& member, std::size_t max_bytes);

/// Whether a path is a pipe, or names what this process has open (/dev/stdin, /dev/fd/3), which another process cannot
/// read.
[[nodiscard]] bool is_stream(const std::filesystem::path& path);

/// A copy of a stream, in the cache; the stream is read once, whole, however often its path is asked for.
/// Throws Error{invalid_input} if it is empty or cannot be read, or if writing fails.
[[nodiscard]] std::filesystem::path spooled_mesh(const std::filesystem::path& stream);

/// In lower case, with its dot.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& path);

/// Whether a mesh file may have tets; those of unknown formats may.
[[nodiscard]] bool may_have_tets(const std::filesystem::path& mesh);

/// The mesh file of a catalogue row whose source is `file`, or why there is none.
struct MeshLocation {
    std::filesystem::path file;    ///< as a plain file; empty if it has to be unpacked, or is missing
    std::filesystem::path archive; ///< holds the row's archive_member
    std::string reason;            ///< why both are missing, and how to get them
};

/// Looks in the folder that TETRACE_MESHES names, then where Debian's libcgal-demo puts its data.
[[nodiscard]] MeshLocation locate_mesh(const CatalogueEntry& entry);

/// The mesh of a procedural scene, made in the cache. Throws Error{invalid_input} if writing fails.
[[nodiscard]] std::filesystem::path mesh_file(const ProceduralScene& scene);

/// XXH3 of that file's bytes (BuildInfo::source_hash), without writing it.
[[nodiscard]] std::uint64_t hash_of_mesh_file(const ProceduralScene& scene);

/// The mesh of a catalogue row as a plain file: found, unpacked into the cache, or made there.
/// Throws Error{missing} with the reason of locate_mesh, Error{invalid_input} where unpacking or writing fails.
[[nodiscard]] std::filesystem::path mesh_file(const CatalogueEntry& entry);

} // namespace tetrace
