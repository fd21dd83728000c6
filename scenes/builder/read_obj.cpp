#include "scenes/builder/mesh_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tetrace {
namespace {

using Words = std::vector<std::string_view>;

// Statements of OBJ that carry no triangle.
constexpr std::array<std::string_view, 40> ignored_keywords = {
    "vt",     "vn",     "vp",     "g",     "s",     "o",        "mg",       "l",          "p",         "usemtl",
    "mtllib", "usemap", "maplib", "lod",   "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj", "deg",
    "bmat",   "step",   "cstype", "curv",  "curv2", "surf",     "parm",     "trim",       "hole",      "scrv",
    "sp",     "end",    "con",    "ctech", "stech", "call",     "csh",      "newmtl",     "group",     "usemat"};

struct Face {
    std::vector<std::int64_t> corners;
    std::string place;
};

// Corner "v/vt/vn": the vertex, counted from 1, or from the vertex before backwards where negative.
std::int64_t parse_corner(const MeshSource& source, std::string_view word, std::size_t vertices_so_far,
                          const std::string& place)
{
    const auto index = parse_integer(word.substr(0, word.find('/')));
    if (!index || *index == 0)
        source.fail(place, fmt::format("'{:.40}' is not a corner (v, v/vt, v//vn or v/vt/vn, counted from 1)", word));
    return *index > 0 ? *index - 1 : static_cast<std::int64_t>(vertices_so_far) + *index;
}

// A line that ends in a backslash goes on in the next.
bool next_statement(LineReader& lines, std::string& statement)
{
    std::string_view line;
    statement.clear();
    while (lines.next_raw(line)) {
        const auto text = line.substr(0, line.find('#'));
        const bool goes_on = text.size() == line.size() && text.ends_with('\\');
        statement += goes_on ? text.substr(0, text.size() - 1) : text;
        if (!goes_on) return true;
        statement += ' ';
    }
    return !statement.empty();
}

} // namespace

void read_obj(MeshSource& source)
{
    LineReader lines(source.bytes());
    std::vector<Face> faces; // checked at the end: a face may name vertices that come later
    std::string statement;
    while (next_statement(lines, statement)) {
        const Words words = split_words(statement);
        if (words.empty()) continue;
        const auto& vertices = source.soup().mesh.vertices;
        if (words.front() == "v") {
            const auto place = lines.place(fmt::format("vertex {}", vertices.size() + 1));
            source.add_vertex(parse_position(source, words, 1, place), place);
        } else if (words.front() == "f" || words.front() == "fo") {
            Face face{{}, lines.place(fmt::format("face {}", faces.size() + 1))};
            if (words.size() < 4) source.fail(face.place, "it has fewer than three corners");
            for (std::size_t i = 1; i < words.size(); ++i)
                face.corners.push_back(parse_corner(source, words[i], vertices.size(), face.place));
            faces.push_back(std::move(face));
        } else if (std::find(ignored_keywords.begin(), ignored_keywords.end(), words.front()) ==
                   ignored_keywords.end()) {
            source.fail(lines.place("statement"), fmt::format("'{:.40}' is not a keyword of OBJ", words.front()));
        }
    }
    for (const Face& face : faces)
        source.add_face(face.corners, source.soup().mesh.vertices.size(), face.place);
}

} // namespace tetrace
