// Legacy VTK in ASCII, up to version 5.1: https://docs.vtk.org/en/latest/vtk_file_formats/vtk_legacy_file_format.html
#include "scenes/builder/vtk_cells.h"
#include "scenes/builder/word_reader.h"

#include <fmt/format.h>

namespace tetrace {
namespace {

class VtkReader {
public:
    explicit VtkReader(MeshSource& source) : source_(source), words_(source, source.bytes()) {}

    void read()
    {
        read_header();
        while (!words_.peek().empty()) {
            const std::string keyword(words_.next());
            words_.begin(keyword);
            if (keyword == "POINTS")
                read_points();
            else if (keyword == "CELLS")
                read_cells();
            else if (keyword == "CELL_TYPES")
                read_types();
            else if (keyword == "CELL_DATA")
                is_of_cells_ = words_.integer() >= 0;
            else if (keyword == "POINT_DATA")
                is_of_cells_ = words_.integer() < 0;
            else if (keyword == "SCALARS")
                read_scalars();
            else if (keyword == "FIELD")
                read_fields();
            else if (keyword == "METADATA")
                words_.skip_block();
            else
                words_.skip_numbers();
        }
        add_cells();
    }

private:
    void read_header()
    {
        if (!words_.next_line().starts_with("# vtk DataFile"))
            words_.fail("it does not begin with '# vtk DataFile'",
                        "this is not a legacy VTK file: convert it, for example with meshio");
        words_.next_line(); // the title
        if (lower_case(words_.next()) != "ascii")
            words_.fail("it is binary", "save it as ASCII, for example: meshio ascii FILE.vtk");
        if (words_.next() != "DATASET" || words_.next() != "UNSTRUCTURED_GRID")
            words_.fail("its dataset is not an UNSTRUCTURED_GRID", "only those have tets: convert it");
    }
    void read_points()
    {
        const std::size_t count = words_.count("points", 6);
        words_.next(); // their type
        for (std::size_t i = 0; i < count; ++i) {
            words_.begin(fmt::format("point {}", i));
            source_.add_vertex(words_.position(), words_.place());
        }
    }
    /// Either a size before each cell's corners, or, since 5.1, offsets and all corners.
    void read_cells()
    {
        const std::size_t count = words_.count("cells", 2), size = words_.count("corners", 2);
        const bool has_offsets = words_.peek() == "OFFSETS";
        if (!has_offsets) {
            for (std::size_t i = 0; i < count; ++i) {
                words_.begin(fmt::format("cell {}", i));
                add_corners(words_.count("corners of a cell", 2));
            }
            return;
        }
        words_.next();
        words_.next();
        std::vector<std::int64_t> offsets(count);
        for (std::int64_t& offset : offsets)
            if (offset = words_.integer(); offset < 0 || static_cast<std::uint64_t>(offset) > size)
                words_.fail(fmt::format("an offset is {}, and there are {} corners", offset, size));
        if (words_.next() != "CONNECTIVITY") words_.fail("CONNECTIVITY is missing");
        words_.next();
        for (std::size_t i = 0; i + 1 < count; ++i) {
            words_.begin(fmt::format("cell {}", i));
            const std::int64_t corners = offsets[i + 1] - offsets[i];
            if (corners < 0) words_.fail("its offsets are wrong");
            add_corners(static_cast<std::size_t>(corners));
        }
    }
    void add_corners(std::size_t corners)
    {
        std::vector<std::int64_t>& cell = cells_.emplace_back(corners);
        for (std::int64_t& corner : cell)
            corner = words_.integer();
        lines_.push_back(words_.line());
    }
    void read_types()
    {
        types_.resize(words_.count("cells", 2));
        for (std::int64_t& type : types_)
            type = words_.integer();
    }

    void read_scalars()
    {
        const std::string name(words_.next());
        words_.next(); // their type
        const std::size_t components = parse_integer(words_.peek()) ? words_.count("components", 2) : 1;
        if (words_.peek() == "LOOKUP_TABLE") {
            words_.next();
            words_.next();
        }
        read_array(name, components);
    }
    void read_fields()
    {
        words_.next(); // its name
        const std::size_t arrays = words_.count("arrays", 4);
        for (std::size_t i = 0; i < arrays; ++i) {
            const std::string name(words_.next());
            const std::size_t components = words_.count("components", 2);
            words_.integer();
            words_.next();
            read_array(name, components);
            if (words_.peek() == "METADATA") words_.skip_block();
        }
    }
    void read_array(const std::string& name, std::size_t components)
    {
        const std::size_t rank = region_rank(name);
        if (!is_of_cells_ || components != 1 || rank >= rank_) {
            words_.skip_numbers();
            return;
        }
        rank_ = rank;
        words_.begin(fmt::format("array {}", name));
        regions_.assign(cells_.size(), 0);
        for (std::int64_t& region : regions_)
            region = region_of_value(source_, words_.number(), words_.place());
    }

    void add_cells()
    {
        if (types_.size() != cells_.size())
            words_.fail(fmt::format("{} cells have {} types", cells_.size(), types_.size()));
        for (std::size_t i = 0; i < cells_.size(); ++i)
            add_cell(i);
        if (regions_.empty()) note_without_regions(source_);
    }
    void add_cell(std::size_t index)
    {
        add_vtk_cell(source_, types_[index], cells_[index],
                     {static_cast<std::int64_t>(index), regions_.empty() ? 0 : regions_[index]},
                     fmt::format("cell {} (line {})", index, lines_[index]));
    }

    MeshSource& source_;
    WordReader words_;
    std::vector<std::vector<std::int64_t>> cells_;
    std::vector<std::size_t> lines_; ///< of the cells
    std::vector<std::int64_t> types_, regions_;
    bool is_of_cells_ = false;
    std::size_t rank_ = no_region_array; ///< of the array that regions are from
};

} // namespace

void read_vtk(MeshSource& source)
{
    VtkReader(source).read();
}

} // namespace tetrace
