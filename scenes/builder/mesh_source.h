#pragma once

#include "core/base/error.h"
#include "core/mesh/triangle_mesh.h"
#include "scenes/builder/mesh_reader.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// A mesh file's bytes, and the soup that a format's reader fills from them.
///
/// Why no library reads them: results/readers.md. Each library accepts some damaged files (cut short, a NaN, an index
/// of no vertex), and their messages seldom name the place.
class MeshSource {
public:
    MeshSource(std::string name, std::string_view bytes) : name_(std::move(name)), bytes_(bytes) {}

    [[nodiscard]] std::string_view bytes() const { return bytes_; }
    [[nodiscard]] MeshSoup& soup() { return soup_; }

    /// Throws Error{invalid_input}: "reading <file>: <place>: <problem>; <remedy>".
    [[noreturn]] void fail(const std::string& place, const std::string& problem, const std::string& remedy) const;
    /// fail() with the remedy that fits files cut short or edited by hand.
    [[noreturn]] void fail(const std::string& place, const std::string& problem) const;

    /// Throws where `count` elements of at least `min_bytes` each cannot be in the file.
    void require_room(const std::string& elements, std::int64_t count, std::size_t min_bytes) const;
    /// Adds a vertex; throws where a coordinate is not a finite float.
    void add_vertex(Float3 position, const std::string& place);
    /// Adds a polygon as triangles (cut_polygon); throws where an index is not below `vertex_count`.
    void add_face(const std::vector<std::int64_t>& corners, std::size_t vertex_count, const std::string& place);

private:
    void add_polygon(const std::vector<std::int64_t>& corners);

    std::string name_;
    std::string_view bytes_;
    MeshSoup soup_;
};

/// Splits text into lines and lines into words, and counts lines for messages.
class LineReader {
public:
    explicit LineReader(std::string_view text) : text_(text) {}

    /// The next line's words without comment (from '#' on) and line end; false at the end of the text. Blank lines are
    /// skipped.
    bool next(std::vector<std::string_view>& words);
    /// The next line as it is.
    bool next_raw(std::string_view& line);
    [[nodiscard]] std::size_t offset() const { return at_; }
    [[nodiscard]] std::string place(const std::string& element) const; ///< "<element> (line <n>)"

private:
    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t line_ = 0;
};

[[nodiscard]] std::vector<std::string_view> split_words(std::string_view line);
/// A decimal number rounded once to the nearest float; infinite if it is outside the range; nothing if it is no number.
[[nodiscard]] std::optional<float> parse_float(std::string_view word);
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view word);
[[nodiscard]] std::string lower_case(std::string_view word);

/// Three coordinates from words [first, first + 3); throws where they are missing or no numbers.
[[nodiscard]] Float3 parse_position(const MeshSource& source, const std::vector<std::string_view>& words,
                                    std::size_t first, const std::string& place);

void read_ply(MeshSource& source);
void read_obj(MeshSource& source);
void read_off(MeshSource& source);
void read_stl(MeshSource& source);
/// Throws Error{invalid_input} if this was built without tinygltf.
void read_gltf(MeshSource& source);

} // namespace tetrace
