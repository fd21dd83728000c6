#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tetrace::test {

/// A text of the tree, named from the root.
struct Text {
    std::string file, text;
};

/// Reads sources, scripts and pages below a root; no results, pictures or builds.
[[nodiscard]] std::vector<Text> read_texts(const std::filesystem::path& root);

/// The claims of each page of docs/spec, by page: "project.md" has "P1", "P2", ...; a claim is a heading "### P1. ...".
using Claims = std::map<std::string, std::set<std::string>>;
[[nodiscard]] Claims claims_of(const std::vector<Text>& texts);

/// A sentence for each claim number that two headings have.
[[nodiscard]] std::vector<std::string> repeated_claims(const std::vector<Text>& texts);

/// A sentence for each citation of the specification ("docs/spec/project.md, P3"; within its pages also "project.md,
/// P3" and "P3") that names no page, or no claim of the page.
[[nodiscard]] std::vector<std::string> broken_citations(const std::vector<Text>& texts);

/// A sentence for each test that a claim names in backticks ("*Tests*: ..."), and that no test source has.
[[nodiscard]] std::vector<std::string> missing_tests(const std::vector<Text>& texts);

/// A sentence for each relative link of a page, and each path in its text, that leads nowhere.
[[nodiscard]] std::vector<std::string> broken_links(const std::filesystem::path& root, const std::vector<Text>& texts);

} // namespace tetrace::test
