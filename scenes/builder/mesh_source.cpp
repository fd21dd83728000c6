#include "scenes/builder/mesh_source.h"

#include "core/base/printable.h"
#include "scenes/builder/polygon.h"
#include "scenes/builder/triple_hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <unordered_map>

namespace tetrace {
namespace {

constexpr std::string_view blanks = " \t\r\n\v\f";

} // namespace

void MeshSource::fail(const std::string& place, const std::string& problem, const std::string& remedy) const
{
    // All may quote the file.
    throw Error(ErrorKind::invalid_input,
                printable_line(fmt::format("reading {}: {}: {}; {}", name_, place, problem, remedy)));
}

void MeshSource::fail(const std::string& place, const std::string& problem) const
{
    fail(place, problem, "the file is damaged or cut short: fetch or export it again");
}

void MeshSource::require_room(const std::string& elements, std::int64_t count, std::size_t min_bytes) const
{
    if (count < 0) fail("header", fmt::format("a negative number of {}, {}", elements, count));
    const auto most = bytes_.size() / min_bytes + 1;
    if (static_cast<std::uint64_t>(count) > most)
        fail("header", fmt::format("it announces {} {}, but {} bytes cannot hold more than {}", count, elements,
                                   bytes_.size(), most));
}

void MeshSource::add_vertex(Double3 position, const std::string& place)
{
    const Float3 rounded = to_float(position);
    for (int axis = 0; axis < 3; ++axis) {
        const float value = rounded[axis];
        if (std::isfinite(value)) continue;
        fail(place,
             fmt::format("coordinate {} is {}", "xyz"[axis],
                         std::isnan(value) ? "not a number" : "infinite or outside float's range"),
             "remove or repair the vertex (MeshLab: Filters, Cleaning and Repairing), or scale the mesh down");
    }
    if (positions_.size() >= std::numeric_limits<std::int32_t>::max())
        fail(place, "more than 2^31 vertices", "simplify the mesh: TetGen counts in 32 bits");
    positions_.push_back(position);
}

void MeshSource::add_face(const std::vector<std::int64_t>& corners, std::size_t vertex_count, const std::string& place)
{
    for (const std::int64_t corner : corners)
        if (corner < 0 || static_cast<std::uint64_t>(corner) >= vertex_count)
            fail(place, fmt::format("vertex index {} is out of range (the mesh has {} vertices, counted from 0)",
                                    corner, vertex_count));
    const auto index = [&](std::size_t i) { return static_cast<std::uint32_t>(corners[i]); };
    if (corners.size() < 3) {
        ++skipped_faces_;
    } else if (corners.size() == 3) {
        triangles_.push_back({index(0), index(1), index(2)});
    } else {
        polygons_.push_back({triangles_.size(), corners_.size(), corners.size()});
        for (std::size_t i = 0; i < corners.size(); ++i)
            corners_.push_back(index(i));
    }
}

void MeshSource::add_tet(const std::vector<std::int64_t>& corners, std::size_t vertex_count, FileTet tet,
                         const std::string& place)
{
    TetCorners indices{};
    for (std::size_t i = 0; i < 4; ++i) {
        if (corners[i] < 0 || static_cast<std::uint64_t>(corners[i]) >= vertex_count)
            fail(place, fmt::format("a corner is none of the {} vertices of the file", vertex_count));
        indices[i] = static_cast<std::uint32_t>(corners[i]);
    }
    const auto number = static_cast<std::uint32_t>(tet.number);
    const auto region = static_cast<std::int32_t>(tet.region);
    if (number != tet.number || region != tet.region)
        fail(place, fmt::format("its number {} or its region {} has more than 32 bits", tet.number, tet.region),
             "number tets and regions anew");
    if (tets_.size() >= MAX_TETS) fail(place, fmt::format("more than {} tets", MAX_TETS), "use a coarser mesh");
    tets_.push_back(indices);
    source_tets_.push_back({number, region});
}

MeshSoup MeshSource::finish()
{
    if (positions_.empty()) fail("mesh", "it lacks vertices", "export the mesh again, with its geometry");
    if (!tets_.empty()) {
        MeshSoup soup;
        finish_tets(soup);
        return soup;
    }
    if (triangles_.empty() && polygons_.empty())
        fail("mesh", "it lacks triangles", "a point cloud or a curve has no surface: reconstruct one first");
    MeshSoup soup;
    place_vertices(soup);
    soup.mesh.triangles = std::move(triangles_);
    if (skipped_faces_ > 0) note(fmt::format("{} faces of fewer than three corners skipped", skipped_faces_));
    soup.notes = std::move(notes_);
    cut_polygons(soup);
    return soup;
}

namespace {

struct Box {
    Double3 low{}, high{};
    double rounding = 0; // the largest change of a coordinate by rounding it to float

    [[nodiscard]] double side() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};

// Of the vertices that faces name: one far away that nothing uses is no part of the mesh.
Box box_of(const std::vector<Double3>& positions, const std::vector<bool>& used)
{
    constexpr double none = std::numeric_limits<double>::infinity();
    Box box{{none, none, none}, {-none, -none, -none}, 0};
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!used[i]) continue;
        const Double3 v = positions[i], change = v - to_double(to_float(v));
        box.low = {std::min(box.low.x, v.x), std::min(box.low.y, v.y), std::min(box.low.z, v.z)};
        box.high = {std::max(box.high.x, v.x), std::max(box.high.y, v.y), std::max(box.high.z, v.z)};
        box.rounding = std::max({box.rounding, std::abs(change.x), std::abs(change.y), std::abs(change.z)});
    }
    return box;
}

// Vertices at the same place as an earlier one as floats, but not as doubles.
std::uint64_t count_merged(const std::vector<Double3>& positions, const std::vector<Float3>& rounded)
{
    std::unordered_map<std::array<std::uint32_t, 3>, std::size_t, TripleHash> first;
    first.reserve(rounded.size());
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < rounded.size(); ++i) {
        const Float3 v = rounded[i];
        const auto key = std::array{std::bit_cast<std::uint32_t>(v.x + 0.0f), std::bit_cast<std::uint32_t>(v.y + 0.0f),
                                    std::bit_cast<std::uint32_t>(v.z + 0.0f)};
        const auto [at, is_new] = first.try_emplace(key, i);
        const Double3 a = positions[at->second], b = positions[i];
        if (!is_new && (a.x != b.x || a.y != b.y || a.z != b.z)) ++count;
    }
    return count;
}

} // namespace

void MeshSource::place_vertices(MeshSoup& soup)
{
    std::vector<bool> used(positions_.size(), false);
    for (const auto& tet : tets_)
        for (const std::uint32_t vertex : tet)
            used[vertex] = true;
    for (const auto& triangle : triangles_)
        for (const std::uint32_t vertex : triangle)
            used[vertex] = true;
    for (const std::uint32_t vertex : corners_)
        used[vertex] = true;
    const Box box = box_of(positions_, used);
    if (box.rounding > max_rounding * box.side()) soup.centre = (box.low + box.high) * 0.5;
    soup.mesh.vertices.reserve(positions_.size());
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        Double3& position = positions_[i];
        position = position - soup.centre;
        soup.mesh.vertices.push_back(to_float(position));
        if (used[i]) soup.rounding = std::max(soup.rounding, length(position - to_double(soup.mesh.vertices.back())));
    }
    if (soup.rounding > 0) soup.merged_by_rounding = count_merged(positions_, soup.mesh.vertices);
}

void MeshSource::finish_tets(MeshSoup& soup)
{
    if (const std::size_t faces = triangles_.size() + polygons_.size(); faces > 0)
        note(fmt::format("{} triangles and polygons skipped: faces of tets say where regions end", faces));
    triangles_.clear(); // their vertices need not be tets'
    corners_.clear();
    place_vertices(soup);
    for (std::size_t i = 0; i < tets_.size(); ++i) {
        TetCorners& tet = tets_[i];
        const auto side = [&](std::size_t corner) { return positions_[tet[corner]] - positions_[tet[0]]; };
        const double volume = dot(cross(side(1), side(2)), side(3));
        if (volume == 0)
            fail(fmt::format("tet {}", source_tets_[i].number), "it is flat",
                 "remove flat tets from the mesh, for example with Gmsh's or TetGen's optimiser");
        if (volume < 0) std::swap(tet[0], tet[1]); // those of a file may be either way round
    }
    soup.tets = std::move(tets_);
    soup.source_tets = std::move(source_tets_);
    std::size_t vertices = soup.mesh.vertices.size();
    keep_corners(soup.mesh.vertices, soup.tets);
    if (vertices -= soup.mesh.vertices.size(); vertices > 0)
        note(fmt::format("{} vertices dropped, at the place of another or of no tet", vertices));
    soup.notes = std::move(notes_);
    try {
        for (const TetSurface& face : surface_of(soup.tets, soup.source_tets))
            soup.mesh.triangles.push_back(face.corners);
    } catch (const Error& error) {
        fail("tets", error.what(), "repair the mesh: no tet may be there twice, and none may overlap another");
    }
}

void MeshSource::cut_polygons(MeshSoup& soup) const
{
    if (polygons_.empty()) return;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangles.reserve(soup.mesh.triangles.size() + corners_.size() - 2 * polygons_.size());
    std::uint64_t crossing = 0;
    auto next = soup.mesh.triangles.begin();
    std::vector<Float3> places;
    for (const Polygon& polygon : polygons_) {
        const auto before = soup.mesh.triangles.begin() + static_cast<std::ptrdiff_t>(polygon.triangle);
        triangles.insert(triangles.end(), next, before);
        next = before;
        const std::span corners(corners_.data() + polygon.corner, polygon.corners);
        places.clear();
        for (const std::uint32_t corner : corners)
            places.push_back(soup.mesh.vertices[corner]);
        const CutPolygon cut = cut_polygon(places);
        if (!cut.is_simple) ++crossing;
        for (const auto& [a, b, c] : cut.triangles)
            triangles.push_back({corners[a], corners[b], corners[c]});
    }
    triangles.insert(triangles.end(), next, soup.mesh.triangles.end());
    soup.mesh.triangles = std::move(triangles);
    if (crossing > 0)
        soup.notes.push_back(fmt::format("{} polygons cross or overlap themselves, and their triangles do too: export "
                                         "the mesh as triangles if that is wrong",
                                         crossing));
}

LineReader::LineReader(std::string_view text) : text_(text)
{
    const auto end = text.find_first_of("\r\n");
    if (end != std::string_view::npos && text[end] == '\r' && text.substr(end + 1, 1) != "\n") end_of_line_ = '\r';
}

bool LineReader::next_raw(std::string_view& line)
{
    if (at_ >= text_.size()) return false;
    const auto end = std::min(text_.find(end_of_line_, at_), text_.size());
    line = text_.substr(at_, end - at_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    at_ = std::min(end + 1, text_.size());
    ++line_;
    return true;
}

bool LineReader::next(std::vector<std::string_view>& words)
{
    std::string_view line;
    while (next_raw(line)) {
        words = split_words(line.substr(0, line.find('#')));
        if (!words.empty()) return true;
    }
    words.clear();
    return false;
}

bool LineReader::has_fewer_lines(std::uint64_t records) const
{
    LineReader ahead = *this;
    std::string_view line;
    while (records > 0 && ahead.next_raw(line)) {
        const auto word = line.find_first_not_of(blanks);
        if (word != std::string_view::npos && line[word] != '#') --records;
    }
    return records > 0;
}

std::string LineReader::place(const std::string& element) const
{
    return fmt::format("{} (line {})", element, line_);
}

std::vector<std::string_view> split_words(std::string_view line)
{
    std::vector<std::string_view> words;
    for (auto begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
        const auto end = std::min(line.find_first_of(blanks, begin), line.size());
        words.push_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(blanks, end);
    }
    return words;
}

std::optional<double> parse_number(std::string_view word)
{
    if (word.starts_with('+')) word.remove_prefix(1);
    const char *const begin = word.data(), *const end = word.data() + word.size();
    double value = 0;
    const auto result = std::from_chars(begin, end, value);
    if (result.ptr != end || word.empty()) return std::nullopt;
    if (result.ec == std::errc::result_out_of_range) {
        const bool tiny = lower_case(word).find("e-") != std::string::npos;
        return tiny ? 0 : std::numeric_limits<double>::infinity();
    }
    // Close to the middle between two floats, rounding twice may end at the other one than rounding once.
    const auto single = [](double x) { return static_cast<float>(x); };
    constexpr double all = std::numeric_limits<double>::infinity();
    if (!std::isfinite(value) || single(std::nextafter(value, all)) == single(std::nextafter(value, -all)))
        return value;
    float once = 0;
    if (std::from_chars(begin, end, once).ec != std::errc{}) return value;
    return single(value) == once ? value : std::nextafter(value, static_cast<double>(once));
}

std::optional<std::int64_t> parse_integer(std::string_view word)
{
    if (word.starts_with('+')) word.remove_prefix(1);
    std::int64_t value = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
    if (result.ec != std::errc{} || result.ptr != word.data() + word.size()) return std::nullopt;
    return value;
}

std::string lower_case(std::string_view word)
{
    std::string text(word);
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

namespace {

// "0,5", or "1,2,3" for three numbers.
bool is_number_with_commas(std::string_view word)
{
    if (word.find(',') == std::string_view::npos || word.find_first_not_of(',') == std::string_view::npos) return false;
    for (std::size_t begin = 0, end = 0; begin < word.size(); begin = end + 1) {
        end = std::min(word.find(',', begin), word.size());
        if (end > begin && !parse_number(word.substr(begin, end - begin))) return false;
    }
    return true;
}

} // namespace

double parse_coordinate(const MeshSource& source, std::string_view word, const std::string& place)
{
    if (const auto value = parse_number(word)) return *value;
    if (is_number_with_commas(word))
        source.fail(place, fmt::format("'{:.40}' has a comma", word),
                    "write numbers with a decimal point, and nothing between them but blanks: export the mesh again, "
                    "in the locale C");
    source.fail(place, fmt::format("'{:.40}' is not a number", word));
}

Double3 parse_position(const MeshSource& source, const std::vector<std::string_view>& words, std::size_t first,
                       const std::string& place)
{
    const auto coordinate = [&](std::size_t axis) {
        if (words.size() <= first + axis) source.fail(place, "fewer than three coordinates");
        return parse_coordinate(source, words[first + axis], place);
    };
    return {coordinate(0), coordinate(1), coordinate(2)};
}

} // namespace tetrace
