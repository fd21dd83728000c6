#pragma once

#include "scenes/builder/mesh_source.h"

#include <string_view>
#include <utility>
#include <vector>

namespace tetrace {

/// A tag of an XML text, and what follows it.
struct XmlTag {
    std::string_view name;
    bool opens = false, closes = false; ///< both: it is empty, <name/>
    std::vector<std::pair<std::string_view, std::string_view>> attributes;
    std::string_view text; ///< up to the next tag, as it is
    std::size_t begin = 0; ///< in the file

    /// Empty if it is missing.
    [[nodiscard]] std::string_view attribute(std::string_view wanted) const;
};

/// The tags of a file one after the other: all of XML that files of meshes need, which are not even well-formed where
/// bytes are appended. Comments and instructions are skipped; entities stay as they are.
class XmlTags {
public:
    explicit XmlTags(const MeshSource& source) : source_(source), bytes_(source.bytes()) {}

    /// False at the end. Throws if a tag is damaged.
    bool next(XmlTag& tag);

    /// "<element> (line <n>)"
    [[nodiscard]] std::string place(const std::string& element, std::size_t at) const;

private:
    [[nodiscard]] std::size_t after(std::string_view mark);
    [[noreturn]] void fail_damaged(const XmlTag& tag) const;
    void read_attributes(std::string_view rest, XmlTag& tag) const;

    const MeshSource& source_;
    std::string_view bytes_;
    std::size_t at_ = 0;
};

} // namespace tetrace
