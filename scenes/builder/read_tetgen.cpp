// TetGen's .node and .ele: https://wias-berlin.de/software/tetgen/fformats.html
#include "core/base/files.h"
#include "scenes/builder/delaunay.h"
#include "scenes/builder/word_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tetrace {
namespace {

/// The words of each element's line behind its number; numbers follow each other, from 0 or 1. Returns the first.
template <class Add>
std::int64_t read_numbered(WordReader& words, const std::string& element, std::size_t count, std::size_t min_words,
                           const Add& add)
{
    std::int64_t first = 0;
    for (std::size_t i = 0; i < count; ++i) {
        words.begin(fmt::format("{} {} of {}", element, i + 1, count));
        std::vector<std::string_view> line = words.next_words();
        const std::int64_t number = words.integer_of(line.front());
        if (i == 0) first = number;
        if (first < 0 || first > 1 || number != first + static_cast<std::int64_t>(i))
            words.fail(fmt::format("it has the number {}; numbers follow each other, from 0 or 1", number));
        if (line.size() <= min_words)
            words.fail(fmt::format("{} values on its line, at least {} are needed", line.size() - 1, min_words));
        line.erase(line.begin());
        add(number, line);
    }
    return first;
}

using NodeWords = std::vector<std::string_view>;

/// Returns the number of the first. add: called with each line's words, and whether the last of them is a marker.
template <class Add>
std::int64_t read_nodes(const MeshSource& source, std::string_view text, const Add& add)
{
    WordReader words(source, text);
    words.begin("the .node file, header");
    const std::size_t count = words.count("vertices", 8);
    const auto header = words.next_words();
    if (words.integer_of(header.front()) != 3)
        words.fail(fmt::format("its points have {} dimensions", header.front()), "tets need 3: export a mesh of 3");
    const bool has_markers = header.size() > 2 && words.integer_of(header[2]) != 0;
    return read_numbered(words, "the .node file, vertex", count, has_markers ? 4 : 3,
                         [&](std::int64_t, const NodeWords& line) { add(words, line, has_markers); });
}

std::int64_t region_of(const WordReader& words, std::string_view word)
{
    const auto value = parse_number(word);
    if (!value || !(std::abs(*value) < 0x1p31) || *value != std::floor(*value))
        words.fail(fmt::format("its region, '{:.40}', is not a whole number of 32 bits", word));
    return static_cast<std::int64_t>(*value);
}

} // namespace

void read_tetgen(MeshSource& source)
{
    std::filesystem::path nodes = source.folder() / std::filesystem::path(source.name()).filename();
    nodes.replace_extension(".node");
    const auto text = source.folder().empty() ? std::nullopt : file_bytes(nodes);
    if (!text)
        source.fail("vertices", fmt::format("they are in {}, which cannot be read", nodes.filename().string()),
                    "keep FILE.node and FILE.ele in one folder");
    const std::int64_t first = read_nodes(source, *text, [&](const WordReader& words, const NodeWords& line, bool) {
        source.add_vertex(parse_position(source, line, 0, words.place()), words.place());
    });
    WordReader words(source, source.bytes());
    const std::size_t count = words.count("tets", 10);
    const auto header = words.next_words();
    const std::int64_t corners = words.integer_of(header.front());
    if (corners != 4 && corners != 10)
        words.fail(fmt::format("its elements have {} corners", corners), split_into_tets);
    const auto size = static_cast<std::size_t>(corners);
    read_numbered(words, "tet", count, size, [&](std::int64_t number, const std::vector<std::string_view>& line) {
        std::vector<std::int64_t> indices;
        for (std::size_t i = 0; i < 4; ++i)
            indices.push_back(std::max<std::int64_t>(words.integer_of(line[i]), -1) - first);
        const std::int64_t region = line.size() > size ? region_of(words, line[size]) : 0;
        source.add_tet(indices, source.vertex_count(), {number, region}, words.place());
    });
}

void read_points(MeshSource& source)
{
    std::vector<Float3> points;
    std::vector<std::int64_t> markers;
    read_nodes(source, source.bytes(), [&](const WordReader& words, const NodeWords& line, bool has_markers) {
        const Float3 point = to_float(parse_position(source, line, 0, words.place())); // before tets depend on it
        source.add_vertex(to_double(point), words.place());
        points.push_back(point);
        markers.push_back(has_markers ? region_of(words, line.back()) : 0);
    });
    const std::vector<TetCorners> tets = delaunay_tets(points);
    if (tets.empty())
        source.fail("vertices", fmt::format("all {} lie in a plane, and tets of points need a volume", points.size()),
                    "for a mesh, keep FILE.ele in the same folder");
    for (std::size_t i = 0; i < tets.size(); ++i) {
        const auto& [a, b, c, d] = tets[i];
        const std::int64_t region = std::min({markers[a], markers[b], markers[c], markers[d]});
        source.add_tet({a, b, c, d}, points.size(), {static_cast<std::int64_t>(i), region}, fmt::format("tet {}", i));
    }
}

} // namespace tetrace
