#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tetrace::test {

/// One file that includes another, both named from the root.
struct Include {
    std::string from, to;
};

/// The sources of a tree, and what they include by name from its root.
struct Sources {
    std::map<std::string, int> files; ///< how many each folder has
    std::vector<Include> includes;
};

/// Reads kernels, core, scenes, backends, bench and tests below a root.
[[nodiscard]] Sources read_sources(const std::filesystem::path& root);

/// Which folder may include which. A folder that is not listed is a part of the listed one that contains it.
class House {
public:
    /// Reads lines "folder -> folder folder ..."; "core/*" means every folder below core, and before the arrow each
    /// folder in core without a line of its own. A '#' begins a comment.
    explicit House(const std::filesystem::path& table);

    /// The listed folder that contains a file; empty without one.
    [[nodiscard]] std::string listed_folder(const std::string& file) const;
    /// "a.cpp includes b.h: core/base -> core/rays is not an arrow of the house" for each include without an arrow.
    [[nodiscard]] std::vector<std::string> forbidden(const std::vector<Include>& includes) const;
    /// "core/base -> core/rays" for each arrow that no include needs.
    [[nodiscard]] std::vector<std::string> unused(const std::vector<Include>& includes) const;
    /// A folder from which arrows lead back to itself; empty if there is none.
    [[nodiscard]] std::string circle() const;

private:
    [[nodiscard]] static bool covers(const std::string& arrow, const std::string& room);
    /// The line of a folder: its own, else that of its parent's "/*"; null without one.
    [[nodiscard]] const std::string* line_of(const std::string& room) const;
    [[nodiscard]] bool allows(const std::string& from, const std::string& to) const;

    std::map<std::string, std::vector<std::string>> arrows_;
};

} // namespace tetrace::test
