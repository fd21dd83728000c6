// The table of kernels/kernel.h: which macro is set where and read where.
#include "tests/house/checkout.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <regex>

using namespace tetrace::test;

namespace {

struct MacroRow {
    std::vector<std::string> macros;
    std::vector<std::string> setters, readers; ///< files as the table names them: "bvh4.h", "walk_*.h"
};

std::vector<std::string> all_matches(const std::string& text, const std::regex& pattern)
{
    std::vector<std::string> found;
    for (std::sregex_iterator i(text.begin(), text.end(), pattern), end; i != end; ++i)
        found.push_back(i->str(i->size() - 1)); // the last group, or all
    return found;
}

std::vector<MacroRow> macro_rows()
{
    static const std::regex name(R"(\w+)"), file(R"([\w*/]+\.(?:h|cu|cpp|comp)\b)");
    std::vector<MacroRow> rows;
    std::istringstream lines(read_text(checkout / "kernels/kernel.h"));
    std::size_t set_by = 0, read_by = 0;
    for (std::string line; std::getline(lines, line) && line != "// clang-format on";)
        if (line.starts_with("// macro ")) {
            set_by = line.find("set by");
            read_by = line.find("read by");
        } else if (set_by != 0) {
            rows.push_back({all_matches(line.substr(3, set_by - 3), name),
                            all_matches(line.substr(set_by, read_by - set_by), file),
                            all_matches(line.substr(read_by), file)});
        }
    return rows;
}

/// Whether a row's name of files is that of this path.
bool is_of(const std::string& name, const std::string& path)
{
    std::string pattern = std::regex_replace(name, std::regex(R"(\.)"), R"(\.)");
    pattern = std::regex_replace(pattern, std::regex(R"(\*)"), R"(\w*)");
    return std::regex_match(path, std::regex("(.*/)?" + pattern));
}

bool is_any_of(const std::vector<std::string>& names, const std::string& path)
{
    return std::ranges::any_of(names, [&](const std::string& name) { return is_of(name, path); });
}

/// What is included into kernels, by its path in the checkout, without comments.
std::map<std::string, std::string> texts_of_kernels()
{
    std::map<std::string, std::string> texts;
    for (const std::string folder : {"kernels", "backends"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(checkout / folder)) {
            const std::string path = entry.path().lexically_relative(checkout).string();
            if (std::regex_match(path, std::regex(R"(.*\.(h|cu|comp)|backends/openmp/kernel\.cpp)")))
                texts[path] = std::regex_replace(read_text(entry.path()), std::regex("//[^\n]*"), "");
        }
    return texts;
}

} // namespace

TEST(KernelMacros, that_a_header_asks_for_are_in_the_table_with_that_header)
{
    static const std::regex condition(R"(\n *# *(?:if|elif|ifdef|ifndef)\b([^\n]*))"), name(R"(\b[A-Z][A-Z0-9_]+\b)");
    const auto rows = macro_rows();
    ASSERT_GT(rows.size(), 40U);
    std::size_t asked = 0;
    for (const auto& [path, text] : texts_of_kernels()) {
        if (!path.starts_with("kernels/")) continue;
        for (const std::string& asked_for : all_matches(text, condition))
            for (const std::string& macro : all_matches(asked_for, name)) {
                if (macro.starts_with("TETRACE_KERNELS_")) continue; // a guard, or whether a part is there
                const auto row = std::ranges::find_if(
                    rows, [&](const MacroRow& each) { return std::ranges::count(each.macros, macro) == 1; });
                if (row == rows.end()) {
                    ADD_FAILURE() << path << " asks for " << macro << ": kernels/kernel.h lacks it";
                    continue;
                }
                ++asked;
                const bool sets_default = contains(text, "define " + macro);
                EXPECT_TRUE(row->readers.empty() || sets_default || is_any_of(row->readers, path))
                    << path << ' ' << macro;
            }
    }
    EXPECT_GT(asked, 40U);
}

TEST(KernelMacros, are_set_and_read_in_each_file_that_the_table_names)
{
    const auto texts = texts_of_kernels();
    const auto some_file_has = [&](const std::string& file, const std::string& pattern) {
        return std::ranges::any_of(texts, [&](const auto& text) {
            return is_of(file, text.first) && std::regex_search(text.second, std::regex(pattern));
        });
    };
    for (const MacroRow& row : macro_rows())
        for (const std::string& macro : row.macros) {
            for (const std::string& file : row.setters)
                EXPECT_TRUE(some_file_has(file, "(define|struct) +" + macro + "\\b"))
                    << file << " does not set " << macro;
            for (const std::string& file : row.readers)
                EXPECT_TRUE(some_file_has(file, "\\b" + macro + "\\b")) << file << " does not read " << macro;
        }
}
