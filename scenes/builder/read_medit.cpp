// MEDIT's .mesh: keywords, each with a count and its elements. P. Frey, "MEDIT: An interactive mesh visualization
// software", INRIA RT-0253, 2001.
#include "scenes/builder/word_reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace tetrace {
namespace {

void read_medit_vertices(MeshSource& source, WordReader& words)
{
    const std::size_t count = words.count("vertices", 8);
    for (std::size_t i = 1; i <= count; ++i) {
        words.begin(fmt::format("vertex {}", i));
        const Double3 position = words.position();
        words.integer(); // its reference
        source.add_vertex(position, words.place());
    }
}

/// Their corners, counted from 0, and reference.
template <class Add>
void read_medit_elements(WordReader& words, const char* element, const char* elements, std::size_t corners,
                         const Add& add)
{
    const std::size_t count = words.count(elements, 2 * corners + 2);
    std::vector<std::int64_t> indices(corners);
    for (std::size_t i = 1; i <= count; ++i) {
        words.begin(fmt::format("{} {}", element, i));
        for (std::int64_t& index : indices)
            index = std::max<std::int64_t>(words.integer(), 0) - 1;
        add(static_cast<std::int64_t>(i), indices, words.integer());
    }
}

void read_section(MeshSource& source, WordReader& words, std::string_view keyword)
{
    const auto add_face = [&](std::int64_t, const std::vector<std::int64_t>& corners, std::int64_t) {
        source.add_face(corners, source.vertex_count(), words.place());
    };
    words.begin(std::string(keyword));
    if (keyword == "Dimension") {
        if (const auto dimension = words.integer(); dimension != 3)
            words.fail(fmt::format("the mesh has {} dimensions", dimension), "tets need 3: export a mesh of 3");
    } else if (keyword == "Vertices")
        read_medit_vertices(source, words);
    else if (keyword == "Triangles")
        read_medit_elements(words, "triangle", "triangles", 3, add_face);
    else if (keyword == "Quadrilaterals")
        read_medit_elements(words, "quadrilateral", "quadrilaterals", 4, add_face);
    else if (keyword == "Tetrahedra")
        read_medit_elements(words, "tet", "tets", 4,
                            [&](std::int64_t number, const std::vector<std::int64_t>& corners, std::int64_t region) {
                                source.add_tet(corners, source.vertex_count(), {number, region}, words.place());
                            });
    else if (keyword == "Hexahedra" || keyword == "Prisms" || keyword == "Pyramids" || keyword == "Pentahedra") {
        if (words.integer() > 0) words.fail("it has elements that are not tets", split_into_tets);
    } else if (parse_number(keyword))
        words.fail(fmt::format("'{:.40}' is in the place of a keyword", keyword));
    words.skip_numbers(); // of what is not needed
}

} // namespace

void read_medit(MeshSource& source)
{
    WordReader words(source, source.bytes());
    if (words.next() != "MeshVersionFormatted")
        words.fail("it does not begin with MeshVersionFormatted",
                   "this is not a MEDIT file in ASCII: convert it, for example with meshio, or give it the right "
                   "extension");
    words.integer();
    while (!words.peek().empty()) {
        const std::string_view keyword = words.next();
        if (keyword == "End") return;
        read_section(source, words, keyword);
    }
}

} // namespace tetrace
