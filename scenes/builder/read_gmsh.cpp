// Gmsh's .msh, versions 2.2 and 4.1: https://gmsh.info/doc/texinfo/gmsh.html#Gmsh-file-formats
#include "scenes/builder/gmsh_text.h"
#include "scenes/builder/word_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <unordered_map>

namespace tetrace {
namespace {

class GmshReader {
public:
    explicit GmshReader(MeshSource& source)
        : source_(source), text_(gmsh_text(source)),
          words_(source, text_.empty() ? source.bytes() : text_, text_.empty())
    {
    }

    void read()
    {
        if (words_.next() != "$MeshFormat")
            words_.fail("it does not begin with $MeshFormat", "this is not a Gmsh file: give it the right extension");
        read_format();
        while (!words_.peek().empty()) {
            const std::string section(words_.next());
            words_.begin(section);
            if (section == "$Entities") read_entities();
            if (section == "$Nodes") is_new_ ? read_node_blocks() : read_nodes();
            if (section == "$Elements") is_new_ ? read_element_blocks() : read_elements();
            while (words_.next() != "$End" + section.substr(1)) {
            }
        }
    }

private:
    using Line = std::vector<std::string_view>;

    void read_format()
    {
        const std::string version(words_.next());
        is_new_ = version == "4.1";
        if (!is_new_ && version != "2.2" && version != "2.1" && version != "2")
            words_.fail(fmt::format("version {:.40} of the format is not read", version),
                        "save it as version 4.1 or 2.2: gmsh FILE -save -format msh41 -o NEW.msh");
        while (words_.next() != "$EndMeshFormat") {
        }
    }

    /// Physical groups of the volumes.
    void read_entities()
    {
        std::int64_t counts[4];
        for (std::int64_t& count : counts)
            count = words_.integer();
        for (std::size_t dimension = 0; dimension < 4; ++dimension)
            for (std::int64_t i = 0; i < counts[dimension]; ++i) {
                words_.begin(fmt::format("entity {} of dimension {}", i + 1, dimension));
                const std::int64_t tag = words_.integer();
                for (std::size_t k = 0; k < (dimension == 0 ? 3 : 6); ++k)
                    words_.number();
                const std::int64_t groups = words_.integer();
                for (std::int64_t k = 0; k < groups; ++k) {
                    const std::int64_t group = words_.integer();
                    if (dimension == 3 && k == 0) groups_[tag] = group;
                }
                const std::int64_t sides = dimension == 0 ? 0 : words_.integer();
                for (std::int64_t k = 0; k < sides; ++k)
                    words_.next();
            }
    }

    void add_node(std::int64_t tag, Double3 position)
    {
        if (!vertices_.emplace(tag, source_.vertex_count()).second)
            words_.fail(fmt::format("node {} is there twice", tag));
        source_.add_vertex(position, words_.place());
    }
    void read_nodes()
    {
        const std::size_t count = words_.count("nodes", 8);
        for (std::size_t i = 0; i < count; ++i) {
            words_.begin(fmt::format("node {} of {}", i + 1, count));
            const std::int64_t tag = words_.integer();
            add_node(tag, words_.position());
        }
    }
    void read_node_blocks()
    {
        const std::int64_t blocks = words_.integer();
        words_.next_words();
        for (std::int64_t block = 0; block < blocks; ++block) {
            words_.begin(fmt::format("block {} of nodes", block + 1));
            const std::int64_t dimension = words_.integer();
            words_.integer();
            const bool has_parameters = words_.integer() == 1;
            std::vector<std::int64_t> tags(words_.count("nodes", 6));
            for (std::int64_t& tag : tags)
                tag = words_.integer();
            for (const std::int64_t tag : tags) {
                words_.begin(fmt::format("node {}", tag));
                const Double3 position = words_.position();
                for (std::int64_t i = 0; has_parameters && i < dimension; ++i)
                    words_.number();
                add_node(tag, position);
            }
        }
    }

    void read_elements()
    {
        const std::size_t count = words_.count("elements", 6);
        for (std::size_t i = 0; i < count; ++i) {
            words_.begin(fmt::format("element {} of {}", i + 1, count));
            const Line line = words_.next_words();
            const std::int64_t tags = line.size() > 2 ? words_.integer_of(line[2]) : -1;
            if (tags < 0 || static_cast<std::uint64_t>(tags) > line.size() - 3) words_.fail("its line is too short");
            const auto tag = [&](std::size_t at) {
                return tags > static_cast<std::int64_t>(at) ? words_.integer_of(line[3 + at]) : 0;
            };
            const std::int64_t region = tag(0) != 0 ? tag(0) : tag(1); // the group, or the entity
            add_element(words_.integer_of(line[1]), words_.integer_of(line[0]), region,
                        Line(line.begin() + 3 + tags, line.end()));
        }
    }
    void read_element_blocks()
    {
        const std::int64_t blocks = words_.integer();
        words_.next_words();
        for (std::int64_t block = 0; block < blocks; ++block) {
            words_.begin(fmt::format("block {} of elements", block + 1));
            words_.integer();
            const std::int64_t entity = words_.integer(), type = words_.integer();
            const std::size_t count = words_.count("elements", 4);
            const auto group = groups_.find(entity);
            for (std::size_t i = 0; i < count; ++i) {
                words_.begin(fmt::format("element {} of block {}", i + 1, block + 1));
                const Line line = words_.next_words();
                add_element(type, words_.integer_of(line[0]), group != groups_.end() ? group->second : entity,
                            Line(line.begin() + 1, line.end()));
            }
        }
    }

    /// Of an element of higher order only the corners, which come first.
    void add_element(std::int64_t type, std::int64_t number, std::int64_t region, const Line& nodes)
    {
        static const std::map<std::int64_t, std::size_t> corners = {{15, 0}, {1, 0}, {8, 0},  {26, 0}, {27, 0}, {28, 0},
                                                                    {2, 3},  {9, 3}, {21, 3}, {23, 3}, {3, 4},  {10, 4},
                                                                    {16, 4}, {4, 4}, {11, 4}, {29, 4}, {30, 4}};
        const auto known = corners.find(type);
        if (known == corners.end())
            words_.fail(fmt::format("element {} has type {}, which is not a tet", number, type), split_into_tets);
        if (known->second == 0) return; // a point or a line
        if (nodes.size() < known->second) words_.fail("its line has too few nodes");
        std::vector<std::int64_t> indices;
        for (std::size_t i = 0; i < known->second; ++i) {
            const auto vertex = vertices_.find(words_.integer_of(nodes[i]));
            if (vertex == vertices_.end()) words_.fail(fmt::format("node {:.40} is not in the file", nodes[i]));
            indices.push_back(static_cast<std::int64_t>(vertex->second));
        }
        const bool is_tet = type == 4 || type == 11 || type == 29 || type == 30;
        if (is_tet)
            source_.add_tet(indices, source_.vertex_count(), {number, region}, words_.place());
        else
            source_.add_face(indices, source_.vertex_count(), words_.place());
    }

    MeshSource& source_;
    std::string text_; ///< of a binary file
    WordReader words_;
    bool is_new_ = false;
    std::unordered_map<std::int64_t, std::int64_t> groups_; ///< per volume
    std::unordered_map<std::int64_t, std::size_t> vertices_;
};

} // namespace

void read_gmsh(MeshSource& source)
{
    GmshReader(source).read();
}

} // namespace tetrace
