// VTK's XML format for unstructured grids: https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
#include "scenes/builder/vtk_cells.h"
#include "scenes/builder/vtu_array.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tetrace {
namespace {

constexpr const char* convert_vtu = "convert it, for example: meshio convert FILE.vtu NEW.mesh";

/// A Piece of the grid: its arrays.
struct VtuPiece {
    std::size_t points = 0, cells = 0;
    std::optional<VtuArray> positions, corners, offsets, types, regions;
    std::size_t rank = no_region_array; ///< of the array of regions
    std::string place;
};

class VtuReader {
public:
    explicit VtuReader(MeshSource& source) : source_(source), tags_(source) {}

    void read()
    {
        while (tags_.next(tag_)) {
            if (tag_.name == "AppendedData") {
                read_appended();
                break;
            }
            read_tag();
        }
        if (!has_grid_)
            source_.fail("header", "it has no UnstructuredGrid",
                         fmt::format("a .vtu file begins with VTKFile: {}", convert_vtu));
        for (const VtuPiece& piece : pieces_)
            add_piece(piece);
        if (std::ranges::all_of(pieces_, [](const VtuPiece& piece) { return !piece.regions; }))
            note_without_regions(source_);
    }

private:
    [[nodiscard]] std::string place(const std::string& element) const { return tags_.place(element, tag_.begin); }

    void read_tag()
    {
        if (tag_.name == "VTKFile" && tag_.opens) return read_head();
        if (tag_.name == "UnstructuredGrid" && tag_.opens) has_grid_ = true;
        if (tag_.name == "Piece" && tag_.opens) return begin_piece();
        const bool is_section =
            tag_.name == "Points" || tag_.name == "Cells" || tag_.name == "CellData" || tag_.name == "PointData";
        if (is_section) section_ = tag_.opens && !tag_.closes ? tag_.name : std::string_view();
        if (tag_.name == "DataArray" && tag_.opens && !pieces_.empty()) read_array();
    }
    void read_head()
    {
        const std::string_view type = tag_.attribute("type"), compressor = tag_.attribute("compressor"),
                               header = tag_.attribute("header_type"), order = tag_.attribute("byte_order");
        if (type != "UnstructuredGrid")
            source_.fail(place("VTKFile"), fmt::format("its type is '{}', not UnstructuredGrid", type), convert_vtu);
        if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
            source_.fail(place("VTKFile"), fmt::format("it is compressed by {}", compressor),
                         "only zlib is read; save it with zlib or uncompressed, or convert it: meshio convert FILE.vtu "
                         "NEW.mesh");
        if (!header.empty() && header != "UInt32" && header != "UInt64")
            source_.fail(place("VTKFile"), fmt::format("its header_type is '{}', not UInt32 or UInt64", header),
                         convert_vtu);
        encoding_.is_compressed = !compressor.empty();
        encoding_.header_bytes = header == "UInt64" ? 8 : 4;
        encoding_.is_big_endian = order == "BigEndian";
    }
    std::size_t whole_attribute(const char* name, std::size_t otherwise)
    {
        const std::string_view text = tag_.attribute(name);
        if (text.empty()) return otherwise;
        const auto value = parse_integer(text);
        if (!value || *value < 0)
            source_.fail(place(std::string(tag_.name)),
                         fmt::format("{} is '{:.40}', which is not a whole number", name, text));
        return static_cast<std::size_t>(*value);
    }
    void begin_piece()
    {
        VtuPiece& piece = pieces_.emplace_back();
        piece.place = place("Piece");
        piece.points = whole_attribute("NumberOfPoints", 0);
        piece.cells = whole_attribute("NumberOfCells", 0);
    }
    void read_array()
    {
        VtuPiece& piece = pieces_.back();
        VtuArray array;
        array.name = tag_.attribute("Name");
        array.type = tag_.attribute("type");
        array.format = lower_case(tag_.attribute("format"));
        array.components = whole_attribute("NumberOfComponents", 1);
        array.offset = whole_attribute("offset", 0);
        array.place = place(fmt::format("array {:.40}", array.name.empty() ? std::string(section_) : array.name));
        array.text = tag_.text;
        const std::size_t rank = region_rank(array.name);
        if (!tag_.closes) find_text(array);
        if (section_ == "Points")
            piece.positions = std::move(array);
        else if (section_ == "Cells" && array.name == "connectivity")
            piece.corners = std::move(array);
        else if (section_ == "Cells" && array.name == "offsets")
            piece.offsets = std::move(array);
        else if (section_ == "Cells" && array.name == "types")
            piece.types = std::move(array);
        else if (section_ == "CellData" && array.components <= 1 && rank < piece.rank) {
            piece.regions = std::move(array);
            piece.rank = rank;
        }
    }
    /// To the array's end: its text may follow tags that say what is in it.
    void find_text(VtuArray& array)
    {
        const auto is_blank = [](std::string_view text) {
            return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
        };
        for (std::size_t depth = 1; depth > 0;) {
            if (!tags_.next(tag_)) source_.fail(array.place, "the file ends inside it");
            if (tag_.opens && !tag_.closes) ++depth;
            if (!tag_.opens) --depth;
            if (depth == 1 && is_blank(array.text)) array.text = tag_.text;
        }
    }
    void read_appended()
    {
        const std::string_view kind = tag_.attribute("encoding");
        if (kind != "raw" && kind != "base64")
            source_.fail(place("AppendedData"), fmt::format("its encoding is '{}', not raw or base64", kind),
                         convert_vtu);
        encoding_.is_appended_raw = kind == "raw";
        const auto begin = static_cast<std::size_t>(tag_.text.data() - source_.bytes().data());
        const auto underscore = source_.bytes().find_first_not_of(" \t\r\n", begin);
        if (underscore == std::string_view::npos || source_.bytes()[underscore] != '_')
            source_.fail(place("AppendedData"), "its data do not begin with an underscore");
        encoding_.appended = source_.bytes().substr(underscore + 1);
    }

    std::vector<double> values(const VtuPiece& piece, const std::optional<VtuArray>& array, const char* name,
                               std::size_t count) const
    {
        if (!array) source_.fail(piece.place, fmt::format("its array of {} is missing", name));
        std::vector<double> values = values_of(source_, *array, encoding_);
        if (values.size() != count)
            source_.fail(array->place, fmt::format("it has {} numbers and should have {}", values.size(), count));
        return values;
    }
    /// Of a number that counts, or names something.
    std::int64_t whole(double value, const std::optional<VtuArray>& array) const
    {
        if (!(std::abs(value) <= 0x1p53) || value != std::floor(value))
            source_.fail(array->place, fmt::format("{} is not a whole number", value));
        return static_cast<std::int64_t>(value);
    }
    void add_piece(const VtuPiece& piece)
    {
        if (piece.points == 0 && piece.cells == 0) return;
        constexpr std::size_t max_count = std::size_t{1} << 32;
        if (piece.points > max_count || piece.cells > max_count)
            source_.fail(piece.place, "it has more than 2^32 points or cells", "use a coarser mesh");
        const std::size_t first_vertex = source_.vertex_count();
        const std::vector<double> positions = values(piece, piece.positions, "points", 3 * piece.points);
        for (std::size_t i = 0; i < piece.points; ++i)
            source_.add_vertex({positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]},
                               fmt::format("point {}", i));
        const std::vector<double> types = values(piece, piece.types, "types", piece.cells),
                                  ends = values(piece, piece.offsets, "offsets", piece.cells);
        const std::size_t corners = ends.empty() ? 0 : static_cast<std::size_t>(std::max(0.0, ends.back()));
        add_cells(piece, first_vertex, types, ends, values(piece, piece.corners, "connectivity", corners));
    }
    void add_cells(const VtuPiece& piece, std::size_t first_vertex, const std::vector<double>& types,
                   const std::vector<double>& ends, const std::vector<double>& corners)
    {
        std::vector<double> regions;
        if (piece.regions) regions = values(piece, piece.regions, "regions", piece.cells);
        std::int64_t begin = 0;
        std::vector<std::int64_t> cell;
        for (std::size_t i = 0; i < piece.cells; ++i) {
            const std::string where = fmt::format("cell {}", next_cell_);
            const std::int64_t end = whole(ends[i], piece.offsets);
            if (end < begin || static_cast<std::size_t>(end) > corners.size())
                source_.fail(where, "its offsets are wrong");
            cell.clear();
            for (; begin < end; ++begin) {
                const std::int64_t corner = whole(corners[static_cast<std::size_t>(begin)], piece.corners);
                if (corner < 0 || static_cast<std::size_t>(corner) >= piece.points)
                    source_.fail(where, fmt::format("a corner is none of the {} vertices of the file", piece.points));
                cell.push_back(corner + static_cast<std::int64_t>(first_vertex));
            }
            const std::int64_t region = piece.regions ? region_of_value(source_, regions[i], piece.regions->place) : 0;
            add_vtk_cell(source_, whole(types[i], piece.types), cell, {next_cell_++, region}, where);
        }
    }

    MeshSource& source_;
    XmlTags tags_;
    XmlTag tag_;
    VtuEncoding encoding_;
    std::string_view section_;
    bool has_grid_ = false;
    std::vector<VtuPiece> pieces_;
    std::int64_t next_cell_ = 0; ///< its number, through all pieces
};

} // namespace

void read_vtu(MeshSource& source)
{
    VtuReader(source).read();
}

} // namespace tetrace
