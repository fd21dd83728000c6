#pragma once

#include "scenes/builder/mesh_source.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// The JSON and the buffers of a glTF 2.0 file. Buffers in other files are read when they are first asked for.
/// Everything throws as MeshSource::fail does; `place` is the place of its message.
class GltfFile {
public:
    using Json = nlohmann::json;

    /// Refuses other versions, and required extensions that change where triangles are and are not read.
    explicit GltfFile(const MeshSource& source);

    [[nodiscard]] const MeshSource& source() const { return source_; }
    [[nodiscard]] const Json& root() const { return root_; }
    /// Of its own, and of the buffers read so far.
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

    /// A list of the root; an empty one if there is none.
    [[nodiscard]] const Json& list(const char* key) const;
    /// The element of a list of the root. what: its name in the message.
    [[nodiscard]] const Json& element(const char* key, std::uint64_t index, const std::string& place,
                                      const char* what) const;
    /// The bytes of a buffer view from `offset` on, and the view.
    [[nodiscard]] std::string_view view(std::uint64_t index, std::uint64_t offset, const std::string& place);

    /// A whole number of an object. otherwise: if it is missing; nothing: it must not be.
    [[nodiscard]] std::uint64_t integer(const Json& object, const char* key, std::optional<std::uint64_t> otherwise,
                                        const std::string& place) const;
    /// An array of numbers of this size; empty if it is missing.
    [[nodiscard]] std::vector<double> numbers(const Json& object, const char* key, std::size_t size,
                                              const std::string& place) const;

private:
    std::string_view split_binary();
    void require_readable() const;
    std::string_view buffer(std::uint64_t index, const std::string& place);
    std::string read_file(const std::string& uri, const std::string& place) const;

    const MeshSource& source_;
    Json root_;
    std::string_view chunk_; ///< of .glb
    std::vector<std::optional<std::string>> buffers_;
    std::size_t bytes_;
};

/// A member of an object, or a null value.
[[nodiscard]] const nlohmann::json& member(const nlohmann::json& object, const char* key);
/// What an object has of an extension, or a null value.
[[nodiscard]] const nlohmann::json& extension(const nlohmann::json& object, const char* name);

} // namespace tetrace
