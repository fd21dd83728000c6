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
    const auto count = static_cast<std::int64_t>(source.vertex_count());
    source.add_face({count - 3, count - 2, count - 1}, static_cast<std::size_t>(count), "facet");
}

void read_binary(MeshSource& source, std::uint64_t facets)
{
    const std::string_view bytes = source.bytes();
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

// The words of ascii STL, which may be all on one line.
class StlWords {
public:
    explicit StlWords(std::string_view text) : lines_(text) {}

    // False at the end of the text.
    bool next(std::string& keyword)
    {
        if (at_ == words_.size()) {
            at_ = 0;
            if (!lines_.next(words_)) return false;
        }
        keyword = lower_case(words_[at_++]);
        return true;
    }
    // What follows on the line is a name or a colour, unless it is a facet.
    void skip_name()
    {
        while (at_ < words_.size() && !(at_ + 1 < words_.size() && lower_case(words_[at_]) == "facet" &&
                                        lower_case(words_[at_ + 1]) == "normal"))
            ++at_;
    }
    [[nodiscard]] std::string place(const std::string& element) const { return lines_.place(element); }

private:
    LineReader lines_;
    std::vector<std::string_view> words_;
    std::size_t at_ = 0;
};

// A facet after its first word. Normals are ignored: the vertices decide.
class StlFacet {
public:
    StlFacet(const MeshSource& source, StlWords& words, std::string name)
        : source_(source), words_(words), name_(std::move(name))
    {
    }

    void read(MeshSource& source)
    {
        std::string word;
        for (int i = 0; i < 5 && word != "outer"; ++i) // after the normal
            take(word, "outer");
        require(word, "outer");
        expect("loop");
        for (int corner = 0; corner < 3; ++corner) {
            expect("vertex");
            const double x = coordinate(), y = coordinate(), z = coordinate();
            source.add_vertex({x, y, z}, words_.place(name_));
        }
        expect_end("endloop", "loop");
        expect_end("endfacet", "facet");
        add_last_three(source);
    }

private:
    void take(std::string& word, std::string_view wanted)
    {
        if (!words_.next(word))
            source_.fail(words_.place(name_), fmt::format("the file ends where '{}' should come", wanted));
    }
    void expect(std::string_view wanted)
    {
        std::string word;
        take(word, wanted);
        require(word, wanted);
    }
    void require(const std::string& word, std::string_view wanted)
    {
        if (word != wanted)
            source_.fail(words_.place(name_), fmt::format("'{:.40}' where '{}' should come", word, wanted));
    }
    // One word, or two.
    void expect_end(std::string_view wanted, std::string_view second)
    {
        std::string word;
        take(word, wanted);
        word == "end" ? expect(second) : require(word, wanted);
    }
    double coordinate()
    {
        std::string word;
        take(word, "a coordinate");
        return parse_coordinate(source_, word, words_.place(name_));
    }

    const MeshSource& source_;
    StlWords& words_;
    std::string name_;
};

// No facet may be lost.
bool has_facet(StlWords& words)
{
    for (std::string word; words.next(word);)
        if (word == "facet") return true;
    return false;
}

void read_ascii(MeshSource& source)
{
    StlWords words(source.bytes());
    bool inside = false;
    std::size_t facets = 0;
    for (std::string word; words.next(word);) {
        const auto facet = fmt::format("facet {}", facets);
        if (inside && word == "facet") {
            StlFacet(source, words, facet).read(source);
            ++facets;
        } else if (inside ? word == "endsolid" || word == "end" || word == "color" : word == "solid") {
            inside = !word.starts_with("end");
            words.skip_name();
        } else {
            const std::string place = words.place(facet);
            if (inside || facets == 0 || word == "facet" || has_facet(words))
                source.fail(place, fmt::format("'{:.40}' where {} should come", word, inside ? "'facet'" : "'solid'"));
            source.note("text after the last endsolid was ignored");
        }
    }
    if (inside) source.fail(words.place("end"), "the file ends before 'endsolid'");
}

} // namespace

void read_stl(MeshSource& source)
{
    const std::string_view bytes = source.bytes();
    // Binary files may begin with "solid" too: the size decides.
    const std::uint64_t facets = bytes.size() >= header_bytes ? little_endian_word(bytes, 80) : 0;
    const std::uint64_t needed = header_bytes + facet_bytes * facets;
    if (bytes.size() >= header_bytes && bytes.size() == needed) return read_binary(source, facets);
    const auto begin = bytes.find_first_not_of(" \t\r\n");
    const bool is_text = bytes.find('\0') == std::string_view::npos;
    if (is_text && begin != std::string_view::npos && lower_case(bytes.substr(begin, 5)) == "solid")
        return read_ascii(source);
    if (bytes.size() < header_bytes)
        source.fail("header", "it is neither ascii STL ('solid') nor as long as binary STL's header");
    const bool whole_facets_follow = bytes.size() > needed && (bytes.size() - needed) % facet_bytes == 0;
    if (bytes.size() < needed || facets == 0 || whole_facets_follow)
        source.fail("header", fmt::format("it announces {} facets, which take {} bytes, but the file has {}{}", facets,
                                          needed, bytes.size(),
                                          whole_facets_follow ? fmt::format(", enough for {}",
                                                                            (bytes.size() - header_bytes) / facet_bytes)
                                                              : ""));
    source.note(fmt::format("{} bytes after the last facet were ignored", bytes.size() - needed));
    read_binary(source, facets);
}

} // namespace tetrace
