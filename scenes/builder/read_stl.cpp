#include "scenes/builder/mesh_source.h"

#include <fmt/format.h>

#include <cstring>

namespace tetrace {
namespace {

constexpr std::size_t header_bytes = 84;
constexpr std::size_t facet_bytes = 50;

std::uint32_t little_endian_word(std::string_view bytes, std::size_t at)
{
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i)
        word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    return word;
}

float little_endian_float(std::string_view bytes, std::size_t at)
{
    const std::uint32_t word = little_endian_word(bytes, at);
    float value = 0;
    std::memcpy(&value, &word, sizeof value);
    return value;
}

void add_last_three(MeshSource& source)
{
    const auto count = static_cast<std::int64_t>(source.soup().mesh.vertices.size());
    source.add_face({count - 3, count - 2, count - 1}, static_cast<std::size_t>(count), "facet");
}

void read_binary(MeshSource& source)
{
    const std::string_view bytes = source.bytes();
    const std::size_t facets = (bytes.size() - header_bytes) / facet_bytes;
    for (std::size_t facet = 0; facet < facets; ++facet) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t at =
                header_bytes + facet * facet_bytes + 12 * (corner + 1); // the first 12 bytes are the normal
            const auto place = fmt::format("facet {}, vertex {}", facet, corner);
            source.add_vertex({little_endian_float(bytes, at), little_endian_float(bytes, at + 4),
                               little_endian_float(bytes, at + 8)},
                              place);
        }
        add_last_three(source);
    }
}

// What must come next in a facet. Normals are ignored: the vertices decide.
void expect_line(const MeshSource& source, LineReader& lines, std::vector<std::string_view>& words,
                 std::string_view first, const std::string& facet)
{
    if (!lines.next(words)) source.fail(lines.place(facet), fmt::format("the file ends where '{}' should come", first));
    if (lower_case(words.front()) != first)
        source.fail(lines.place(facet), fmt::format("'{:.40}' where '{}' should come", words.front(), first));
}

void read_ascii(MeshSource& source)
{
    LineReader lines(source.bytes());
    std::vector<std::string_view> words;
    bool inside = false;
    std::size_t facets = 0;
    while (lines.next(words)) {
        const auto keyword = lower_case(words.front());
        const auto facet = fmt::format("facet {}", facets);
        if (inside != (keyword != "solid") || (inside && keyword != "facet" && keyword != "endsolid"))
            source.fail(lines.place(facet),
                        fmt::format("'{:.40}' where {} should come", words.front(), inside ? "'facet'" : "'solid'"));
        inside = keyword != "endsolid";
        if (keyword != "facet") continue;
        expect_line(source, lines, words, "outer", facet);
        for (int corner = 0; corner < 3; ++corner) {
            expect_line(source, lines, words, "vertex", facet);
            source.add_vertex(parse_position(source, words, 1, lines.place(facet)), lines.place(facet));
        }
        expect_line(source, lines, words, "endloop", facet);
        expect_line(source, lines, words, "endfacet", facet);
        add_last_three(source);
        ++facets;
    }
    if (inside) source.fail(lines.place("end"), "the file ends before 'endsolid'");
}

} // namespace

void read_stl(MeshSource& source)
{
    const std::string_view bytes = source.bytes();
    // Binary files may begin with "solid" too: the size decides.
    const std::uint64_t facets = bytes.size() >= header_bytes ? little_endian_word(bytes, 80) : 0;
    if (bytes.size() >= header_bytes && bytes.size() == header_bytes + facet_bytes * facets) return read_binary(source);
    const auto begin = bytes.find_first_not_of(" \t\r\n");
    const bool is_text = bytes.find('\0') == std::string_view::npos;
    if (is_text && begin != std::string_view::npos && lower_case(bytes.substr(begin, 5)) == "solid")
        return read_ascii(source);
    if (bytes.size() < header_bytes)
        source.fail("header", "it is neither ascii STL ('solid') nor as long as binary STL's header");
    source.fail("header", fmt::format("it announces {} facets, which take {} bytes, but the file has {}", facets,
                                      header_bytes + facet_bytes * facets, bytes.size()));
}

} // namespace tetrace
