#pragma once

#include "core/base/error.h"
#include "core/mesh/triangle_mesh.h"
#include "scenes/builder/mesh_reader.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tetrace {

/// What a file says of a tet.
struct FileTet {
    std::int64_t number, region;
};

/// The remedy for elements that are not tets.
inline constexpr const char* split_into_tets = "split them into tets of four corners, for example with Gmsh";

/// A mesh file's bytes, and the soup that a format's reader fills from them.
///
/// Why no library reads them: results/readers.md. Each library accepts some damaged files (cut short, a NaN, an index
/// of no vertex), and their messages seldom name the place.
class MeshSource {
public:
    /// folder: where the file's other files are; empty: they are refused.
    MeshSource(std::string name, std::string_view bytes, std::filesystem::path folder)
        : name_(std::move(name)), bytes_(bytes), folder_(std::move(folder))
    {
    }

    [[nodiscard]] std::string_view bytes() const { return bytes_; }
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] std::size_t vertex_count() const { return positions_.size(); }

    /// Throws Error{invalid_input}: "reading <file>: <place>: <problem>; <remedy>".
    [[noreturn]] void fail(const std::string& place, const std::string& problem, const std::string& remedy) const;
    /// fail() with the remedy that fits files cut short or edited by hand.
    [[noreturn]] void fail(const std::string& place, const std::string& problem) const;

    /// Throws if `count` elements of at least `min_bytes` each cannot be in the file.
    void require_room(const std::string& elements, std::int64_t count, std::size_t min_bytes) const;
    /// Adds a vertex; throws if a coordinate is not finite as a float.
    void add_vertex(Double3 position, const std::string& place);
    /// Adds a polygon; throws if an index is not below `vertex_count`.
    void add_face(const std::vector<std::int64_t>& corners, std::size_t vertex_count, const std::string& place);
    /// Adds a tet of four corners; throws if an index is not below `vertex_count`, or a number is too large.
    void add_tet(const std::vector<std::int64_t>& corners, std::size_t vertex_count, FileTet tet,
                 const std::string& place);
    /// A sentence for the user.
    void note(std::string sentence) { notes_.push_back(std::move(sentence)); }

    /// Rounds the vertices and cuts the polygons, each of which is in the place among the triangles where it was added.
    /// If there are tets, the triangles are their hull and the faces between regions, and no others.
    /// Throws if there are no vertices, and neither triangles nor tets, or for what surface_of() refuses. The source is
    /// empty then.
    [[nodiscard]] MeshSoup finish();

private:
    struct Polygon {
        std::size_t triangle; ///< before which its own are inserted
        std::size_t corner, corners;
    };

    void place_vertices(MeshSoup& soup);
    void finish_tets(MeshSoup& soup);
    void cut_polygons(MeshSoup& soup) const;

    std::string name_;
    std::string_view bytes_;
    std::filesystem::path folder_;
    std::vector<Double3> positions_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<std::uint32_t> corners_; ///< of the polygons
    std::vector<Polygon> polygons_;
    std::vector<TetCorners> tets_;
    std::vector<SourceTet> source_tets_;
    std::vector<std::string> notes_;
    std::uint64_t skipped_faces_ = 0; ///< of fewer than three corners
};

/// Splits text into lines and lines into words, and counts lines for messages.
class LineReader {
public:
    /// Lines end with LF or CR LF; with CR if the first line does.
    explicit LineReader(std::string_view text);

    /// The next line's words without comment (from '#' on) and line end; false at the end of the text. Blank lines are
    /// skipped.
    bool next(std::vector<std::string_view>& words);
    /// The next line as it is.
    bool next_raw(std::string_view& line);
    [[nodiscard]] std::size_t offset() const { return at_; }
    /// Whether fewer lines that are not blank follow than `records`: then values have to be taken word by word.
    [[nodiscard]] bool has_fewer_lines(std::uint64_t records) const;
    [[nodiscard]] std::string place(const std::string& element) const; ///< "<element> (line <n>)"
    [[nodiscard]] std::size_t line() const { return line_; }

private:
    std::string_view text_;
    char end_of_line_ = '\n';
    std::size_t at_ = 0;
    std::size_t line_ = 0;
};

[[nodiscard]] std::vector<std::string_view> split_words(std::string_view line);
/// A decimal number, rounded to the nearest double that rounds to the nearest float; infinite if it is outside the
/// range; nothing if it is not a number.
[[nodiscard]] std::optional<double> parse_number(std::string_view word);
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view word);
[[nodiscard]] std::string lower_case(std::string_view word);

/// A coordinate; throws if the word is not a number, and says if it has a decimal comma.
[[nodiscard]] double parse_coordinate(const MeshSource& source, std::string_view word, const std::string& place);
/// Three coordinates from words [first, first + 3); throws if they are missing or not numbers.
[[nodiscard]] Double3 parse_position(const MeshSource& source, const std::vector<std::string_view>& words,
                                     std::size_t first, const std::string& place);

void read_ply(MeshSource& source);
void read_obj(MeshSource& source);
void read_off(MeshSource& source);
void read_stl(MeshSource& source);
void read_gltf(MeshSource& source);
void read_medit(MeshSource& source);
void read_gmsh(MeshSource& source);
void read_tetgen(MeshSource& source);
void read_points(MeshSource& source);
void read_vtk(MeshSource& source);
void read_vtu(MeshSource& source);

} // namespace tetrace
