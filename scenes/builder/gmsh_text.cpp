#include "scenes/builder/gmsh_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <map>

namespace tetrace {
namespace {

class GmshBinary {
public:
    explicit GmshBinary(const MeshSource& source) : source_(source), bytes_(source.bytes()) {}

    /// Empty if the file is not binary.
    [[nodiscard]] std::string text()
    {
        const std::string_view first = line(), format = line();
        const std::vector<std::string_view> words = split_words(format);
        if (first != "$MeshFormat" || words.size() < 3 || words[1] != "1") return "";
        if (words[2] != "8" || take<std::int32_t>() != 1)
            fail("its numbers have another size, or their bytes another order");
        add("$MeshFormat\n{} 0 8\n$EndMeshFormat\n", words[0]);
        if (words[0] != "2.2" && words[0] != "4.1") return std::move(text_); // which are not read
        while (bytes_.find('$', at_) != std::string_view::npos)
            put_section(words[0] == "4.1");
        return std::move(text_);
    }

private:
    void put_section(bool is_new)
    {
        at_ = bytes_.find('$', at_);
        const std::string name(line());
        if (name.starts_with("$End")) return;
        place_ = name;
        if (name == "$Nodes" || name == "$Elements" || name == "$Entities") {
            add("{}\n", name);
            if (name == "$Entities") put_entities();
            if (name == "$Nodes") is_new ? put_node_blocks() : put_nodes();
            if (name == "$Elements") is_new ? put_element_blocks() : put_elements();
            add("$End{}\n", name.substr(1));
        }
        at_ = bytes_.find("$End" + name.substr(1), at_);
        if (at_ == std::string_view::npos) fail("its end is missing");
        line();
    }

    void put_entities()
    {
        std::uint64_t counts[4];
        for (std::uint64_t& count : counts)
            count = put<std::uint64_t>();
        for (std::size_t dimension = 0; dimension < 4; ++dimension)
            for (std::uint64_t i = 0; i < counts[dimension]; ++i) {
                put<std::int32_t>();
                put<double>(dimension == 0 ? 3 : 6);
                put<std::int32_t>(put<std::uint64_t>()); // groups
                if (dimension > 0) put<std::int32_t>(put<std::uint64_t>());
                text_ += '\n';
            }
    }
    void put_nodes()
    {
        const std::uint64_t count = put_count();
        for (std::uint64_t i = 0; i < count; ++i) {
            put<std::int32_t>();
            put<double>(3);
            text_ += '\n';
        }
    }
    void put_node_blocks()
    {
        const std::uint64_t blocks = put_blocks();
        for (std::uint64_t block = 0; block < blocks; ++block) {
            const auto dimension = put<std::int32_t>();
            put<std::int32_t>();
            const bool has_parameters = put<std::int32_t>() == 1;
            const auto count = put<std::uint64_t>();
            text_ += '\n';
            put<std::uint64_t>(count);
            const std::int32_t size = has_parameters ? 3 + std::clamp(dimension, 0, 3) : 3;
            for (std::uint64_t i = 0; i < count; ++i)
                put<double>(static_cast<std::uint64_t>(size));
            text_ += '\n';
        }
    }
    void put_elements()
    {
        const std::uint64_t count = put_count();
        for (std::uint64_t done = 0; done < count;) {
            const auto type = take<std::int32_t>(), here = take<std::int32_t>(), tags = take<std::int32_t>();
            if (here <= 0 || tags < 0) fail("a negative number of elements or tags");
            for (std::int32_t i = 0; i < here; ++i) {
                put<std::int32_t>();
                add("{} {} ", type, tags);
                put<std::int32_t>(static_cast<std::uint64_t>(tags) + nodes_of(type));
                text_ += '\n';
            }
            done += static_cast<std::uint64_t>(here);
        }
    }
    void put_element_blocks()
    {
        const std::uint64_t blocks = put_blocks();
        for (std::uint64_t block = 0; block < blocks; ++block) {
            put<std::int32_t>(2);
            const auto type = put<std::int32_t>();
            const auto count = put<std::uint64_t>();
            text_ += '\n';
            for (std::uint64_t i = 0; i < count; ++i) {
                put<std::uint64_t>(1 + nodes_of(type));
                text_ += '\n';
            }
        }
    }

    /// The number of blocks; those of nodes or elements, and their range, follow it.
    std::uint64_t put_blocks()
    {
        const auto blocks = put<std::uint64_t>();
        put<std::uint64_t>(3);
        text_ += '\n';
        return blocks;
    }
    /// A number of its own line, which is text.
    std::uint64_t put_count()
    {
        const std::string_view word = line();
        const auto count = parse_integer(word);
        if (!count || *count < 0) fail(fmt::format("'{:.40}' is not a number of them", word));
        add("{}\n", *count);
        return static_cast<std::uint64_t>(*count);
    }
    [[nodiscard]] std::uint64_t nodes_of(std::int32_t type) const
    {
        static const std::map<std::int32_t, std::uint64_t> nodes = {
            {1, 2},   {2, 3},  {3, 4},  {4, 4},  {5, 8},  {6, 6},   {7, 5},   {8, 3},  {9, 6},   {10, 9},
            {11, 10}, {15, 1}, {16, 8}, {26, 4}, {27, 5}, {21, 10}, {23, 15}, {28, 6}, {29, 20}, {30, 35}};
        const auto known = nodes.find(type);
        if (known == nodes.end())
            source_.fail(place_, fmt::format("elements of type {} are not tets", type), split_into_tets);
        return known->second;
    }

    template <class Value>
    Value take()
    {
        Value value{};
        if (sizeof value > bytes_.size() - at_) fail("the file ends inside it");
        std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }
    /// Returns the last one.
    template <class Value>
    Value put(std::uint64_t count = 1)
    {
        Value value{};
        for (std::uint64_t i = 0; i < count; ++i)
            add("{} ", value = take<Value>());
        return value;
    }
    std::string_view line()
    {
        const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
        std::string_view result = bytes_.substr(at_, end - at_);
        at_ = std::min(end + 1, bytes_.size());
        if (result.ends_with('\r')) result.remove_suffix(1);
        return result;
    }
    template <class... Values>
    void add(fmt::format_string<Values...> format, Values&&... values)
    {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    }
    [[noreturn]] void fail(const std::string& problem) const { source_.fail(place_, problem); }

    const MeshSource& source_;
    std::string_view bytes_;
    std::size_t at_ = 0;
    std::string place_ = "$MeshFormat", text_;
};

} // namespace

std::string gmsh_text(const MeshSource& source)
{
    return GmshBinary(source).text();
}

} // namespace tetrace
