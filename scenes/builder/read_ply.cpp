#include "scenes/builder/mesh_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

// Source of the format: Turk, "The PLY Polygon File Format", 1994.

namespace tetrace {
namespace {

using Words = std::vector<std::string_view>;

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class Encoding { ascii, little, big };

struct Property {
    std::string name;
    Scalar type = Scalar::float32;
    std::optional<Scalar> list_size; ///< the type of the length, if it is a list
};

struct Element {
    std::string name;
    std::int64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;
};

std::size_t size_of(Scalar type)
{
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

Scalar parse_type(const MeshSource& source, std::string_view word, const std::string& place)
{
    constexpr std::array<std::string_view, 8> old_names = {"char", "uchar", "short", "ushort",
                                                           "int",  "uint",  "float", "double"};
    constexpr std::array<std::string_view, 8> new_names = {"int8",  "uint8",  "int16",   "uint16",
                                                           "int32", "uint32", "float32", "float64"};
    for (std::size_t i = 0; i < old_names.size(); ++i)
        if (word == old_names[i] || word == new_names[i]) return static_cast<Scalar>(i);
    source.fail(place, fmt::format("the type '{:.40}' is not read", word),
                "export the mesh again, with integers as int and other numbers as float or double");
}

Encoding parse_encoding(const MeshSource& source, const Words& words, const std::string& place)
{
    if (words.size() >= 2) {
        if (words[1] == "ascii") return Encoding::ascii;
        if (words[1] == "binary_little_endian") return Encoding::little;
        if (words[1] == "binary_big_endian") return Encoding::big;
    }
    source.fail(place, "the format is none of ascii, binary_little_endian, binary_big_endian");
}

Property parse_property(const MeshSource& source, const Words& words, const std::string& place)
{
    if (words.size() >= 5 && words[1] == "list") {
        const Scalar length = parse_type(source, words[2], place);
        if (length >= Scalar::float32) source.fail(place, "a list's length is not an integer");
        return {std::string(words[4]), parse_type(source, words[3], place), length};
    }
    if (words.size() < 3) source.fail(place, "a property without type or name");
    return {std::string(words[2]), parse_type(source, words[1], place), std::nullopt};
}

Element parse_element(const MeshSource& source, const Words& words, const std::string& place)
{
    const auto count = words.size() >= 3 ? parse_integer(words[2]) : std::nullopt;
    if (!count) source.fail(place, "an element without name or count");
    // Each of its messages has its name as place: a long one, made for each of many elements, takes minutes.
    return {std::string(words[1].substr(0, 40)), *count, {}};
}

Header parse_header(const MeshSource& source, LineReader& lines)
{
    Header header;
    std::string_view line;
    if (!lines.next_raw(line) || split_words(line) != Words{"ply"})
        source.fail("header", "it does not begin with 'ply'", "this is not a PLY file: give it the right extension");
    while (lines.next_raw(line)) {
        const Words words = split_words(line);
        const auto place = lines.place("header");
        if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
        if (words[0] == "end_header") return header;
        if (words[0] == "format") {
            header.encoding = parse_encoding(source, words, place);
        } else if (words[0] == "element") {
            header.elements.push_back(parse_element(source, words, place));
        } else if (words[0] == "property" && !header.elements.empty()) {
            header.elements.back().properties.push_back(parse_property(source, words, place));
        } else {
            source.fail(place, fmt::format("'{:.40}' is not expected here", words[0]));
        }
    }
    source.fail("header", "'end_header' is missing");
}

// The values of one element, whatever its encoding, as doubles (exact for every type of PLY).
class ValueReader {
public:
    ValueReader(const MeshSource& source, const Header& header, LineReader& lines)
        : source_(source), encoding_(header.encoding), lines_(lines), at_(lines.offset())
    {
        std::uint64_t elements = 0;
        for (const Element& element : header.elements)
            elements += static_cast<std::uint64_t>(element.count);
        by_words_ = encoding_ == Encoding::ascii && lines.has_fewer_lines(elements);
    }

    void begin_element(const std::string& place)
    {
        place_ = place;
        if (encoding_ != Encoding::ascii || (by_words_ && word_ < words_.size())) return;
        if (!lines_.next(words_)) source_.fail(lines_.place(place_), "the file ends before it");
        word_ = 0;
    }
    double coordinate(Scalar type)
    {
        return encoding_ == Encoding::ascii ? parse_coordinate(source_, next_word(), place()) : binary(type);
    }
    std::int64_t integer(Scalar type)
    {
        if (encoding_ != Encoding::ascii) return whole(binary(type));
        const auto value = parse_integer(next_word());
        if (!value) source_.fail(place(), "an index or a list's length is not an integer");
        return *value;
    }
    void skip(Scalar type)
    {
        encoding_ == Encoding::ascii ? static_cast<void>(next_word()) : static_cast<void>(binary(type));
    }
    std::int64_t list_length(const Property& list)
    {
        const std::int64_t length = integer(*list.list_size);
        const std::size_t least = encoding_ == Encoding::ascii ? 2 : size_of(list.type);
        if (length < 0 || static_cast<std::uint64_t>(length) > source_.bytes().size() / least)
            source_.fail(place(), fmt::format("a list of {} entries is longer than the file", length));
        return length;
    }
    [[nodiscard]] bool has_more()
    {
        if (encoding_ != Encoding::ascii) return at_ != source_.bytes().size();
        return (by_words_ && word_ < words_.size()) || lines_.next(words_);
    }
    [[nodiscard]] std::string place() const
    {
        return encoding_ == Encoding::ascii ? lines_.place(place_) : fmt::format("{} (byte {})", place_, at_);
    }

private:
    std::int64_t whole(double value) const
    {
        if (!(std::abs(value) < 0x1p62) || value != std::nearbyint(value))
            source_.fail(place(), "an index is not an integer");
        return static_cast<std::int64_t>(value);
    }
    std::string_view next_word()
    {
        if (word_ == words_.size()) {
            if (!by_words_) source_.fail(place(), "the line has too few values");
            if (!lines_.next(words_)) source_.fail(place(), "the file ends inside it");
            word_ = 0;
        }
        return words_[word_++];
    }
    double binary(Scalar type)
    {
        const std::size_t size = size_of(type);
        if (source_.bytes().size() - at_ < size) source_.fail(place(), "the file ends inside it");
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const auto byte =
                static_cast<unsigned char>(source_.bytes()[at_ + (encoding_ == Encoding::little ? size - 1 - i : i)]);
            bits = bits << 8 | byte;
        }
        at_ += size;
        return value_of(type, bits);
    }
    static double value_of(Scalar type, std::uint64_t bits)
    {
        switch (type) {
        case Scalar::int8: return static_cast<std::int8_t>(bits);
        case Scalar::int16: return static_cast<std::int16_t>(bits);
        case Scalar::int32: return static_cast<std::int32_t>(bits);
        case Scalar::float32: return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
        case Scalar::float64: return std::bit_cast<double>(bits);
        default: return static_cast<double>(bits);
        }
    }

    const MeshSource& source_;
    Encoding encoding_;
    LineReader& lines_;
    bool by_words_ = false; // ascii: elements do not begin on lines of their own
    Words words_;
    std::size_t word_ = 0;
    std::size_t at_;
    std::string place_;
};

void skip_property(ValueReader& values, const Property& property)
{
    const std::int64_t count = property.list_size ? values.list_length(property) : 1;
    for (std::int64_t i = 0; i < count; ++i)
        values.skip(property.type);
}

void read_vertex(MeshSource& source, ValueReader& values, const Element& element)
{
    std::array<double, 3> position{NAN, NAN, NAN};
    for (const Property& property : element.properties) {
        const auto axis =
            property.name.size() == 1 ? std::string_view("xyz").find(property.name) : std::string_view::npos;
        if (axis == std::string_view::npos || property.list_size)
            skip_property(values, property);
        else
            position[axis] = values.coordinate(property.type);
    }
    source.add_vertex({position[0], position[1], position[2]}, values.place());
}

// The indices of vertices of a face, or of a strip of triangles.
std::vector<std::int64_t> read_indices(ValueReader& values, const Element& element)
{
    std::vector<std::int64_t> indices;
    for (const Property& property : element.properties) {
        const bool wanted =
            property.list_size && (property.name == "vertex_indices" || property.name == "vertex_index");
        if (!wanted) {
            skip_property(values, property);
            continue;
        }
        const std::int64_t count = values.list_length(property);
        for (std::int64_t i = 0; i < count; ++i)
            indices.push_back(values.integer(property.type));
    }
    return indices;
}

// Every three vertices in a row are a triangle; every other one is reversed, so that all have one orientation. A
// negative index begins a new strip. Triangles with a vertex twice join strips, and are none.
void add_strips(MeshSource& source, const std::vector<std::int64_t>& indices, std::size_t vertex_count,
                const std::string& place)
{
    std::size_t first = 0;
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] < 0) first = i + 1;
        if (i < first + 2) continue;
        const auto a = indices[i - 2], b = indices[i - 1], c = indices[i];
        if (a == b || b == c || c == a) continue;
        const bool is_turned = (i - first) % 2 == 1;
        source.add_face({is_turned ? b : a, is_turned ? a : b, c}, vertex_count, place);
    }
}

std::size_t min_bytes(const Element& element, Encoding encoding)
{
    if (encoding == Encoding::ascii) return std::max<std::size_t>(2 * element.properties.size(), 1);
    std::size_t bytes = 0;
    for (const Property& property : element.properties)
        bytes += size_of(property.list_size.value_or(property.type));
    return std::max<std::size_t>(bytes, 1);
}

// An element without properties needs no bytes, so nothing bounds how many of them a file announces.
void require_properties(const MeshSource& source, const Element& element)
{
    if (element.properties.empty() && element.count > 0)
        source.fail("header",
                    fmt::format("it announces {} elements '{}' without properties", element.count, element.name));
    const auto has = [&](std::string_view name) {
        return std::any_of(element.properties.begin(), element.properties.end(),
                           [&](const Property& p) { return p.name == name; });
    };
    if (element.name == "vertex" && !(has("x") && has("y") && has("z")))
        source.fail("header", "its vertices lack a property x, y or z", "export the mesh again, with positions");
    const bool has_faces = element.name == "face" || element.name == "tristrips";
    if (has_faces && !has("vertex_indices") && !has("vertex_index"))
        source.fail("header",
                    fmt::format("its {} lack the list vertex_indices", element.name == "face" ? "faces" : "strips"),
                    "export the mesh again, as polygons");
}

} // namespace

void read_ply(MeshSource& source)
{
    LineReader lines(source.bytes());
    const Header header = parse_header(source, lines);
    std::size_t vertex_count = 0;
    for (const Element& element : header.elements) {
        source.require_room("elements '" + element.name + "'", element.count, min_bytes(element, header.encoding));
        require_properties(source, element);
        if (element.name == "vertex") vertex_count += static_cast<std::size_t>(element.count);
    }
    ValueReader values(source, header, lines);
    for (const Element& element : header.elements) {
        for (std::int64_t i = 0; i < element.count; ++i) {
            values.begin_element(fmt::format("{} {}", element.name, i));
            if (element.name == "vertex")
                read_vertex(source, values, element);
            else if (element.name == "face")
                source.add_face(read_indices(values, element), vertex_count, values.place());
            else if (element.name == "tristrips")
                add_strips(source, read_indices(values, element), vertex_count, values.place());
            else
                for (const Property& property : element.properties)
                    skip_property(values, property);
        }
    }
    if (values.has_more()) source.note("data after the last announced element were ignored");
}

} // namespace tetrace
