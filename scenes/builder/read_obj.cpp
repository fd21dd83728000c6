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

// Programs add keywords of their own, for example vertex colours. A file without any vertex is of another format.
class UnknownKeywords {
public:
    void add(const MeshSource& source, std::string_view keyword, const LineReader& lines)
    {
        if (count_++ == 0)
            first_ = fmt::format("'{:.40}' is not a keyword of OBJ", keyword), place_ = lines.place("statement");
        if (keyword.find_first_not_of(letters) != std::string_view::npos) require_none(source);
    }
    void require_none(const MeshSource& source) const
    {
        if (count_ > 0) source.fail(place_, first_);
    }
    void note(MeshSource& source) const
    {
        if (count_ > 0) source.note(fmt::format("{} statements skipped, the first in {}: {}", count_, place_, first_));
    }

private:
    static constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
    std::uint64_t count_ = 0;
    std::string first_, place_;
};

} // namespace

void read_obj(MeshSource& source)
{
    LineReader lines(source.bytes());
    std::vector<Face> faces; // checked at the end: a face may name vertices that come later
    std::string statement;
    UnknownKeywords unknown;
    while (next_statement(lines, statement)) {
        const Words words = split_words(statement);
        if (words.empty()) continue;
        const std::string keyword = lower_case(words.front());
        if (keyword == "v") {
            const auto place = lines.place(fmt::format("vertex {}", source.vertex_count() + 1));
            source.add_vertex(parse_position(source, words, 1, place), place);
        } else if (keyword == "f" || keyword == "fo") {
            Face face{{}, lines.place(fmt::format("face {}", faces.size() + 1))};
            for (std::size_t i = 1; i < words.size(); ++i)
                face.corners.push_back(parse_corner(source, words[i], source.vertex_count(), face.place));
            faces.push_back(std::move(face));
        } else if (std::find(ignored_keywords.begin(), ignored_keywords.end(), keyword) == ignored_keywords.end()) {
            unknown.add(source, words.front(), lines);
        }
    }
    if (source.vertex_count() == 0) unknown.require_none(source);
    for (const Face& face : faces)
        source.add_face(face.corners, source.vertex_count(), face.place);
    unknown.note(source);
}

} // namespace tetrace
